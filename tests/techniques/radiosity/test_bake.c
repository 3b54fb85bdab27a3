// The bake of radiosity: its bytes on any number of threads and after interruptions, and what is
// refused before anything runs.
#include "framework/test.h"
#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"

#include "core/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SMALL "radiosity:texels=2048,rays=100,sources=16"
// Takes a second or more.
#define LONGER "radiosity:texels=2048,rays=2000,sources=16"

struct source {
    struct scene *scene;
    struct scene_pose pose;
};

// Emissive surfaces, blocks that touch the floor, several charts.
static void open_source(struct source *s)
{
    s->scene = scene_load(test_host(), "@cornell");
    CHECK(s->scene && pose_init(&s->pose, s->scene, -1, 0.0f));
}

static void close_source(struct source *s)
{
    pose_finish(&s->pose);
    scene_destroy(s->scene);
}

// NULL: it is refused.
static struct bake *bake_of(const struct source *s, const char *text)
{
    struct gi_spec spec;
    CHECK(gi_spec_parse(&spec, test_host(), text));
    const struct technique_bake how = { .pose = &s->pose, .options = spec.options[0] };
    struct bake *bake = gi_bake_create(test_host(), spec.technique[0], &how,
                                       (struct bake_identity){ .program = "test" });
    gi_spec_finish(&spec);
    return bake;
}

// ---- bytes

// Saves and destroys it. The caller frees the bytes.
static struct file_bytes bytes_of(struct bake *bake)
{
    struct file_bytes bytes;
    CHECK(bake_save(bake, test_path("bake.safetensors"), false));
    CHECK(file_read(test_host(), test_path("bake.safetensors"), 0, &bytes));
    bake_destroy(bake);
    return bytes;
}

static struct file_bytes baked_on(const struct source *s, const char *text, int threads)
{
    struct bake *bake = bake_of(s, text);
    CHECK(bake && bake_run(bake, &(struct bake_run_options){ .threads = threads }));
    return bytes_of(bake);
}

static void check_same(struct file_bytes *a, struct file_bytes *b)
{
    CHECK(a->size == b->size && a->size > 100000);
    CHECK(memcmp(a->data, b->data, a->size) == 0);
    file_bytes_finish(test_host(), b);
}

TEST(bake_has_the_same_bytes_on_1_2_and_4_threads)
{
    struct source s;
    open_source(&s);
    struct file_bytes one = baked_on(&s, SMALL, 1);
    for (int threads = 2; threads <= 4; threads *= 2) {
        struct file_bytes more = baked_on(&s, SMALL, threads);
        check_same(&one, &more);
    }
    file_bytes_finish(test_host(), &one);
    close_source(&s);
}

// Cancels where this share is done.
static bool stop_at(void *user, const struct bake_progress *progress)
{
    const double *share = user;
    return progress->done < *share;
}

// Each run is that of another program, which has the checkpoint alone.
static struct file_bytes baked_with_interruptions(const struct source *s, const char *text,
                                                  int *interruptions)
{
    static double SHARES[] = { 0.1, 0.4, 0.7, 2.0 };
    const char *checkpoint = test_path("radiosity.checkpoint");
    struct bake *bake = NULL;
    for (int i = 0; !bake; i++) {
        bake = bake_of(s, text);
        const struct bake_run_options how = {
            .threads = 2, .checkpoint = checkpoint, .progress = stop_at, .user = &SHARES[i]
        };
        if (bake_run(bake, &how)) break;
        CHECK(test_host()->failure == FAIL_CANCELLED && access(checkpoint, F_OK) == 0);
        bake_destroy(bake);
        bake = NULL;
        ++*interruptions;
    }
    return bytes_of(bake);
}

TEST(bake_has_the_same_bytes_after_interruptions)
{
    struct source s;
    int interruptions = 0;
    open_source(&s);
    struct file_bytes whole = baked_on(&s, LONGER, 0);
    struct file_bytes resumed = baked_with_interruptions(&s, LONGER, &interruptions);
    CHECK(interruptions >= 2);
    check_same(&whole, &resumed);
    file_bytes_finish(test_host(), &whole);
    close_source(&s);
}

// ---- memory

static uint64_t memory_of(struct bake *bake)
{
    struct bake_estimate estimate;
    CHECK(bake_estimate(bake, &(struct bake_run_options){ .threads = 2 }, false, &estimate));
    return estimate.peak_memory_bytes;
}

static struct bake *bake_at(const struct source *s, double density)
{
    char text[128];
    snprintf(text, sizeof text, "radiosity:density=%.9g,rays=16,sources=8", density);
    return bake_of(s, text);
}

// The density that the newest message advises.
static double advised(void)
{
    const char *advice = strstr(test_last_message(), "; density=");
    if (!advice || !strstr(advice, " fits")) fail_msg("%s", test_last_message());
    return atof(advice + strlen("; density="));
}

static bool runs_within(struct bake *bake, uint64_t bytes)
{
    const bool ok =
        bake_run(bake, &(struct bake_run_options){ .threads = 2, .max_memory_bytes = bytes });
    CHECK(ok || test_host()->failure == FAIL_MEMORY);
    bake_destroy(bake);
    return ok;
}

TEST(density_beyond_the_memory_limit_is_refused_with_one_that_fits)
{
    static const double DENSITY = 40.0;
    struct source s;
    open_source(&s);
    struct bake *bake = bake_at(&s, DENSITY);
    const uint64_t limit = memory_of(bake) / 3;
    CHECK(!runs_within(bake, limit));
    CHECK(strstr(test_last_message(), "more than the limit"));
    const double fits = advised();
    print_message("density %.3g needs three times the limit, %.3g fits\n", DENSITY, fits);
    CHECK(fits > 0.0 && fits < DENSITY);
    CHECK(!runs_within(bake_at(&s, 1.25 * fits), limit));
    CHECK(runs_within(bake_at(&s, fits), limit));
    close_source(&s);
}

// However much memory there is.
TEST(density_of_more_texels_than_a_light_map_has_is_refused_with_one_that_fits)
{
    static const double DENSITY = 256.0;
    struct source s;
    open_source(&s);
    struct bake *bake = bake_at(&s, DENSITY);
    CHECK(!bake && test_host()->failure == FAIL_MEMORY);
    const double fits = advised();
    CHECK(fits > 0.5 * DENSITY && fits < DENSITY);
    bake = bake_at(&s, fits);
    CHECK(bake);
    bake_destroy(bake);
    close_source(&s);
}
