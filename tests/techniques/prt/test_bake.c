// The bake of prt: its bytes on any number of threads, after interruptions and in shards; its
// estimate.
#include "techniques/prt/prt_fixture.h"

#include "core/file.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

#define SMALL "texels=1024,rays=128"

// Saves and destroys it. The caller frees the bytes.
static struct file_bytes bytes_of(struct bake *bake)
{
    struct file_bytes bytes;
    CHECK(bake_save(bake, test_path("bake.safetensors"), false));
    CHECK(file_read(test_host(), test_path("bake.safetensors"), 0, &bytes));
    bake_destroy(bake);
    return bytes;
}

static struct file_bytes baked_on(const struct prt_fixture *f, const char *more, int threads)
{
    struct bake *bake = prt_fixture_plan(f, more, 0);
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = threads }));
    return bytes_of(bake);
}

static void check_same(const struct file_bytes *a, struct file_bytes *b)
{
    CHECK(a->size == b->size && a->size > 20000);
    CHECK(memcmp(a->data, b->data, a->size) == 0);
    file_bytes_finish(test_host(), b);
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

static const char *const OPTIONS[] = { "",
                                       "compression=pca",
                                       "compression=vq",
                                       "compression=cpca,clusters=16",
                                       "glossy=true",
                                       "glossy=true,compression=cpca,clusters=16",
                                       "at=vertex",
                                       "at=vertex,compression=cpca,clusters=16" };

TEST(bake_has_the_same_bytes_on_1_2_and_4_threads)
{
    struct prt_fixture f;
    open_scene(&f);
    for (size_t i = 0; i < sizeof OPTIONS / sizeof *OPTIONS; i++) {
        struct file_bytes one = baked_on(&f, OPTIONS[i], 1);
        for (int threads = 2; threads <= 4; threads *= 2) {
            struct file_bytes more = baked_on(&f, OPTIONS[i], threads);
            check_same(&one, &more);
        }
        file_bytes_finish(test_host(), &one);
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

// ---- interruptions

// Cancels where this share is done.
static bool stop_at(void *user, const struct bake_progress *progress)
{
    const double *share = user;
    return progress->done < *share;
}

// Each run is that of another program, which has the checkpoint alone.
static struct file_bytes baked_with_interruptions(const struct prt_fixture *f, int *interruptions)
{
    static double SHARES[] = { 0.01, 0.4, 0.8, 2.0 };
    const char *checkpoint = test_path("prt.checkpoint");
    for (int i = 0;; i++) {
        struct bake *bake = prt_fixture_plan(f, "", 0);
        const struct bake_run_options how = {
            .threads = 2, .checkpoint = checkpoint, .progress = stop_at, .user = &SHARES[i]
        };
        if (bake_run(bake, &how)) return bytes_of(bake);
        CHECK(test_host()->failure == FAIL_CANCELLED && access(checkpoint, F_OK) == 0);
        bake_destroy(bake);
        ++*interruptions;
    }
}

TEST(bake_has_the_same_bytes_after_interruptions)
{
    struct prt_fixture f;
    int interruptions = 0;
    make_scene(&f);
    prt_fixture_open(&f, "texels=8192,rays=1024"); // takes a second or more
    struct file_bytes whole = baked_on(&f, "", 0);
    struct file_bytes resumed = baked_with_interruptions(&f, &interruptions);
    print_message("%d interruptions\n", interruptions);
    CHECK(interruptions >= 2);
    check_same(&whole, &resumed);
    file_bytes_finish(test_host(), &whole);
    prt_fixture_close(&f);
}

// ---- shards

TEST(bake_in_two_shards_merges_to_the_same_bytes)
{
    struct prt_fixture f;
    open_scene(&f);
    struct bake *merged = prt_fixture_plan(&f, "", 0);
    for (int i = 0; i < 2; i++) {
        const char *path = test_path("prt.part");
        struct bake *part = prt_fixture_plan(&f, "", 0);
        const struct bake_run_options how = { .threads = 1, .shard = i, .shard_count = 2 };
        CHECK(bake_run(part, &how) && !bake_is_complete(part) && bake_save_partial(part, path));
        CHECK(bake_merge(merged, path));
        bake_destroy(part);
    }
    CHECK(bake_run(merged, &(struct bake_run_options){ 0 }));
    struct file_bytes whole = baked_on(&f, "", 0), of_shards = bytes_of(merged);
    check_same(&whole, &of_shards);
    file_bytes_finish(test_host(), &whole);
    prt_fixture_close(&f);
}

// ---- the estimate

TEST(estimate_of_a_bake_is_its_size_and_about_its_time)
{
    struct prt_fixture f;
    struct bake_estimate e;
    open_scene(&f);
    struct bake *bake = prt_fixture_plan(&f, "", 0);
    const struct bake_run_options how = { .threads = 1 };
    CHECK(bake_estimate(bake, &how, true, &e) && bake_run(bake, &how));
    print_message("estimated %.2f s, took %.2f s; %.3g rays, %.2f MB of memory, file of %.2f MB\n",
                  e.seconds, bake_seconds(bake), e.rays, 1e-6 * (double)e.peak_memory_bytes,
                  1e-6 * (double)e.file_bytes);
    CHECK(e.seconds > 0.0 && isfinite(e.seconds));
    CHECK_RELATIVE(e.file_bytes, bake_bytes(bake), 0.05);
    bake_destroy(bake);
    prt_fixture_close(&f);
}
