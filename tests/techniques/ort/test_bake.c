// The bake of ort: its bytes on any number of threads, after interruptions and in shards; its
// estimate.
#include "techniques/ort/bake_fixture.h"

#include "core/file.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

#define SMALL "texels=512,offsets=60,rays=128"

// Saves and destroys it. The caller frees the bytes.
static struct file_bytes bytes_of(struct bake *bake)
{
    struct file_bytes bytes;
    CHECK(bake_save(bake, test_path("bake.safetensors"), false));
    CHECK(file_read(test_host(), test_path("bake.safetensors"), 0, &bytes));
    bake_destroy(bake);
    return bytes;
}

static struct file_bytes baked_on(const struct ort_fixture *f, int threads)
{
    struct bake *bake = ort_fixture_plan(f, "", 0);
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = threads }));
    return bytes_of(bake);
}

static void check_same(const struct file_bytes *a, struct file_bytes *b)
{
    CHECK(a->size == b->size && a->size > 100000);
    CHECK(memcmp(a->data, b->data, a->size) == 0);
    file_bytes_finish(test_host(), b);
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
    struct file_bytes one = baked_on(&f, 1);
    for (int threads = 2; threads <= 4; threads *= 2) {
        struct file_bytes more = baked_on(&f, threads);
        check_same(&one, &more);
    }
    file_bytes_finish(test_host(), &one);
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

// ---- interruptions

// Cancels where this share is done.
static bool stop_at(void *user, const struct bake_progress *progress)
{
    const double *share = user;
    return progress->done < *share;
}

// Each run is that of another program, which has the checkpoint alone.
static struct file_bytes baked_with_interruptions(const struct ort_fixture *f, int *interruptions)
{
    static double SHARES[] = { 0.01, 0.4, 0.8, 2.0 };
    const char *checkpoint = test_path("ort.checkpoint");
    for (int i = 0;; i++) {
        struct bake *bake = ort_fixture_plan(f, "", 0);
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
    struct ort_fixture f;
    int interruptions = 0;
    ort_fixture_boxes(&f);
    ort_fixture_open(&f, "texels=2048,offsets=60,rays=1024"); // takes a second or more
    struct file_bytes whole = baked_on(&f, 0);
    struct file_bytes resumed = baked_with_interruptions(&f, &interruptions);
    print_message("%d interruptions\n", interruptions);
    CHECK(interruptions >= 2);
    check_same(&whole, &resumed);
    file_bytes_finish(test_host(), &whole);
    ort_fixture_close(&f);
}

// ---- shards

TEST(bake_in_two_shards_merges_to_the_same_bytes)
{
    struct ort_fixture f;
    open_scene(&f);
    struct bake *merged = ort_fixture_plan(&f, "", 0);
    for (int i = 0; i < 2; i++) {
        const char *path = test_path("ort.part");
        struct bake *part = ort_fixture_plan(&f, "", 0);
        const struct bake_run_options how = { .threads = 1, .shard = i, .shard_count = 2 };
        CHECK(bake_run(part, &how) && !bake_is_complete(part) && bake_save_partial(part, path));
        CHECK(bake_merge(merged, path));
        bake_destroy(part);
    }
    CHECK(bake_run(merged, &(struct bake_run_options){ 0 }));
    struct file_bytes whole = baked_on(&f, 0), of_shards = bytes_of(merged);
    check_same(&whole, &of_shards);
    file_bytes_finish(test_host(), &whole);
    ort_fixture_close(&f);
}

// ---- the estimate

TEST(estimate_of_a_bake_is_its_size_and_about_its_time)
{
    struct ort_fixture f;
    struct bake_estimate e;
    open_scene(&f);
    struct bake *bake = ort_fixture_plan(&f, "", 0);
    const struct bake_run_options how = { .threads = 1 };
    CHECK(bake_estimate(bake, &how, true, &e) && bake_run(bake, &how));
    print_message("estimated %.2f s, took %.2f s; %.3g rays, %.2f MB of memory, file of %.2f MB\n",
                  e.seconds, bake_seconds(bake), e.rays, 1e-6 * (double)e.peak_memory_bytes,
                  1e-6 * (double)e.file_bytes);
    CHECK(e.seconds > 0.0 && isfinite(e.seconds));
    CHECK_RELATIVE(e.file_bytes, bake_bytes(bake), 0.05);
    bake_destroy(bake);
    ort_fixture_close(&f);
}
