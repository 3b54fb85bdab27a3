// The bake of prt: its bytes on any number of threads, after interruptions and in shards; its
// estimate.
#include "techniques/bake_bytes.h"
#include "techniques/prt/prt_fixture.h"

#include <string.h>

#define SMALL  "texels=1024,rays=128"
#define LONGER "texels=8192,rays=1024"

static struct bake_subject bake_of(const struct prt_fixture *f, const char *gi)
{
    return (struct bake_subject){ .gi = gi, .pose = &f->s.pose, .least_bytes = 20000 };
}

// A floor below a box and a sphere with a hole.
static void make_scene(struct prt_fixture *f)
{
    prt_fixture_init(f);
    fixture_floor(&f->s, 2, prt_fixture_diffuse(f, 0.7f));
    fixture_box(&f->s, vec3_of(-0.5f, 0.5f, -0.5f), vec3_of(0.5f, 1, 0.5f), false,
                fixture_matte(&f->s, vec3_of(0.8f, 0.5f, 0.2f)));
    prt_fixture_sphere(f, vec3_of(1, 1.5f, 0), 0.8f, 8, 2, true, prt_fixture_diffuse(f, 0.5f));
}

static void open_scene(struct prt_fixture *f)
{
    make_scene(f);
    prt_fixture_open(f, SMALL);
}

static const char *const BAKES[] = { "prt:" SMALL,
                                     "prt:" SMALL ",compression=pca",
                                     "prt:" SMALL ",compression=vq",
                                     "prt:" SMALL ",compression=cpca,clusters=16",
                                     "prt:" SMALL ",glossy=true",
                                     "prt:" SMALL ",glossy=true,compression=cpca,clusters=16",
                                     "prt:" SMALL ",at=vertex",
                                     "prt:" SMALL ",at=vertex,compression=cpca,clusters=16" };

TEST(bake_has_the_same_bytes_on_1_2_and_4_threads)
{
    struct prt_fixture f;
    open_scene(&f);
    for (size_t i = 0; i < sizeof BAKES / sizeof *BAKES; i++) {
        const struct bake_subject bake = bake_of(&f, BAKES[i]);
        bake_bytes_check_threads(&bake);
    }
    prt_fixture_close(&f);
}

TEST(bakes_of_other_seeds_have_other_rays)
{
    struct prt_fixture f;
    open_scene(&f);
    struct prt_baked baked[2];
    const struct tensor *direct[2];
    for (uint64_t i = 0; i < 2; i++) {
        baked[i] = prt_fixture_bake(&f, "", i);
        direct[i] = tensors_find(baked[i].tensors, PRT_DIRECT);
    }
    CHECK(memcmp(direct[0]->data, direct[1]->data, direct[0]->bytes) != 0);
    for (int i = 0; i < 2; i++) prt_baked_finish(&baked[i]);
    prt_fixture_close(&f);
}

TEST(bake_has_the_same_bytes_after_interruptions)
{
    static const double SHARES[] = { 0.01, 0.4, 0.8 };
    struct prt_fixture f;
    make_scene(&f);
    prt_fixture_open(&f, LONGER);
    const struct bake_subject bake = bake_of(&f, "prt:" LONGER);
    bake_bytes_check_interruptions(&bake, SHARES);
    prt_fixture_close(&f);
}

TEST(bake_in_two_shards_merges_to_the_same_bytes)
{
    struct prt_fixture f;
    open_scene(&f);
    const struct bake_subject bake = bake_of(&f, "prt:" SMALL);
    bake_bytes_check_shards(&bake);
    prt_fixture_close(&f);
}

TEST(estimate_of_a_bake_is_its_size_and_about_its_time)
{
    struct prt_fixture f;
    open_scene(&f);
    const struct bake_subject bake = bake_of(&f, "prt:" SMALL);
    bake_check_estimate(&bake);
    prt_fixture_close(&f);
}
