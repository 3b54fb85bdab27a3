#include "techniques/bake_bytes.h"

#include "core/files/file.h"
#include "framework/test.h"
#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

struct bake *bake_of_gi(const char *gi, const struct scene_pose *pose, uint64_t seed)
{
    struct gi_spec spec;
    if (!gi_spec_parse(&spec, test_host(), gi)) fail_msg("%s: %s", gi, test_last_message());
    const struct technique_bake how = { .pose = pose, .options = spec.options[0] };
    const struct bake_identity identity = { .program = "test", .seed = seed };
    struct bake *bake = gi_bake_create(test_host(), spec.technique[0], &how, identity);
    gi_spec_finish(&spec);
    return bake;
}

static struct bake *plan(const struct bake_subject *subject)
{
    struct bake *bake = bake_of_gi(subject->gi, subject->pose, 0);
    assert_non_null(bake);
    return bake;
}

// Saves and destroys it. The caller frees the bytes.
static struct file_bytes bytes_of(struct bake *bake)
{
    struct file_bytes bytes;
    CHECK(bake_save(bake, test_path("bake.safetensors"), false));
    CHECK(file_read(test_host(), test_path("bake.safetensors"), 0, &bytes));
    bake_destroy(bake);
    return bytes;
}

static struct file_bytes baked_on(const struct bake_subject *subject, int threads)
{
    struct bake *bake = plan(subject);
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = threads }));
    return bytes_of(bake);
}

// Frees b.
static void check_same(const struct bake_subject *subject, const struct file_bytes *a,
                       struct file_bytes *b)
{
    CHECK(a->size == b->size && a->size > subject->least_bytes);
    CHECK(memcmp(a->data, b->data, a->size) == 0);
    file_bytes_finish(test_host(), b);
}

void bake_bytes_check_threads(const struct bake_subject *subject)
{
    struct file_bytes one = baked_on(subject, 1);
    for (int threads = 2; threads <= 4; threads *= 2) {
        struct file_bytes more = baked_on(subject, threads);
        check_same(subject, &one, &more);
    }
    file_bytes_finish(test_host(), &one);
}

// Cancels where this share is done.
static bool stop_at(void *user, const struct bake_progress *progress)
{
    const double *share = user;
    return progress->done < *share;
}

// Each run is that of another program, which has the checkpoint alone.
static struct file_bytes baked_with_interruptions(const struct bake_subject *subject,
                                                  const double shares[3], int *interruptions)
{
    const char *checkpoint = test_path("bake.checkpoint");
    for (int i = 0;; i++) {
        double share = i < 3 ? shares[i] : 2.0;
        struct bake *bake = plan(subject);
        const struct bake_run_options how = {
            .threads = 2, .checkpoint = checkpoint, .progress = stop_at, .user = &share
        };
        if (bake_run(bake, &how)) return bytes_of(bake);
        CHECK(test_host()->failure == FAIL_CANCELLED && access(checkpoint, F_OK) == 0);
        bake_destroy(bake);
        ++*interruptions;
    }
}

void bake_bytes_check_interruptions(const struct bake_subject *subject, const double shares[3])
{
    int interruptions = 0;
    struct file_bytes whole = baked_on(subject, 0);
    struct file_bytes resumed = baked_with_interruptions(subject, shares, &interruptions);
    print_message("%d interruptions\n", interruptions);
    CHECK(interruptions >= 2);
    check_same(subject, &whole, &resumed);
    file_bytes_finish(test_host(), &whole);
}

void bake_bytes_check_shards(const struct bake_subject *subject)
{
    struct bake *merged = plan(subject);
    for (int i = 0; i < 2; i++) {
        const char *path = test_path("bake.part");
        struct bake *part = plan(subject);
        const struct bake_run_options how = { .threads = 1, .shard = i, .shard_count = 2 };
        CHECK(bake_run(part, &how) && !bake_is_complete(part) && bake_save_partial(part, path));
        CHECK(bake_merge(merged, path));
        bake_destroy(part);
    }
    CHECK(bake_run(merged, &(struct bake_run_options){ 0 }));
    struct file_bytes whole = baked_on(subject, 0), of_shards = bytes_of(merged);
    check_same(subject, &whole, &of_shards);
    file_bytes_finish(test_host(), &whole);
}

void bake_check_estimate(const struct bake_subject *subject)
{
    struct bake_estimate e;
    struct bake *bake = plan(subject);
    const struct bake_run_options how = { .threads = 1 };
    CHECK(bake_estimate(bake, &how, true, &e) && bake_run(bake, &how));
    print_message("estimated %.2f s, took %.2f s; %.3g rays, %.2f MB of memory, file of %.2f MB\n",
                  e.seconds, bake_seconds(bake), e.rays, 1e-6 * (double)e.peak_memory_bytes,
                  1e-6 * (double)e.file_bytes);
    CHECK(e.seconds > 0.0 && isfinite(e.seconds));
    CHECK_RELATIVE(e.file_bytes, bake_bytes(bake), 0.05);
    bake_destroy(bake);
}
