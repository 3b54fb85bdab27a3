// The bake of ort: its bytes on any number of threads, after interruptions and in shards; its
// estimate.
#include "techniques/bake_bytes.h"
#include "techniques/ort/bake_fixture.h"

#include <string.h>

#define SMALL  "texels=512,offsets=60,rays=128"
#define LONGER "texels=2048,offsets=60,rays=1024"

static struct bake_subject bake_of(const struct ort_fixture *f, const char *gi)
{
    return (struct bake_subject){ .gi = gi, .pose = &f->s.pose, .least_bytes = 100000 };
}

static void open_scene(struct ort_fixture *f)
{
    ort_fixture_boxes(f);
    ort_fixture_open(f, SMALL);
}

TEST(bake_has_the_same_bytes_on_1_2_and_4_threads)
{
    struct ort_fixture f;
    open_scene(&f);
    const struct bake_subject bake = bake_of(&f, "ort:" SMALL);
    bake_bytes_check_threads(&bake);
    ort_fixture_close(&f);
}

TEST(bakes_of_other_seeds_have_other_offsets)
{
    struct ort_fixture f;
    open_scene(&f);
    struct ort_baked baked[2];
    const struct tensor *offsets[2];
    for (uint64_t i = 0; i < 2; i++) {
        baked[i] = ort_fixture_bake(&f, "", i);
        offsets[i] = tensors_find(baked[i].tensors, "offsets");
    }
    CHECK(memcmp(offsets[0]->data, offsets[1]->data, offsets[0]->bytes) != 0);
    for (int i = 0; i < 2; i++) ort_baked_finish(&baked[i]);
    ort_fixture_close(&f);
}

TEST(bake_has_the_same_bytes_after_interruptions)
{
    static const double SHARES[] = { 0.01, 0.4, 0.8 };
    struct ort_fixture f;
    ort_fixture_boxes(&f);
    ort_fixture_open(&f, LONGER);
    const struct bake_subject bake = bake_of(&f, "ort:" LONGER);
    bake_bytes_check_interruptions(&bake, SHARES);
    ort_fixture_close(&f);
}

TEST(bake_in_two_shards_merges_to_the_same_bytes)
{
    struct ort_fixture f;
    open_scene(&f);
    const struct bake_subject bake = bake_of(&f, "ort:" SMALL);
    bake_bytes_check_shards(&bake);
    ort_fixture_close(&f);
}

TEST(estimate_of_a_bake_is_its_size_and_about_its_time)
{
    struct ort_fixture f;
    open_scene(&f);
    const struct bake_subject bake = bake_of(&f, "ort:" SMALL);
    bake_check_estimate(&bake);
    ort_fixture_close(&f);
}
