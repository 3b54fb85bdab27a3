// The bake of radiosity: its bytes on any number of threads and after interruptions, and what is
// refused before anything runs.
#include "framework/test.h"
#include "techniques/bake_bytes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SMALL  "radiosity:texels=2048,rays=100,sources=16"
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

// ---- bytes

static struct bake_subject bake_of(const struct source *s, const char *gi)
{
    return (struct bake_subject){ .gi = gi, .pose = &s->pose, .least_bytes = 100000 };
}

TEST(bake_has_the_same_bytes_on_1_2_and_4_threads)
{
    struct source s;
    open_source(&s);
    const struct bake_subject bake = bake_of(&s, SMALL);
    bake_bytes_check_threads(&bake);
    close_source(&s);
}

TEST(bake_has_the_same_bytes_after_interruptions)
{
    static const double SHARES[] = { 0.1, 0.4, 0.7 };
    struct source s;
    open_source(&s);
    const struct bake_subject bake = bake_of(&s, LONGER);
    bake_bytes_check_interruptions(&bake, SHARES);
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
    return bake_of_gi(text, &s->pose, 0);
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
