// Voronoi regions against brute force.
#include "framework/test.h"

#include "core/rng.h"
#include "techniques/ort/bake/regions.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_OFFSETS = 400 };

static uint32_t nearest(const struct ort_offset *offsets, uint32_t count, int32_t x, int32_t y)
{
    uint32_t best = 0;
    int64_t least = INT64_MAX;
    for (uint32_t i = 0; i < count; i++) {
        const int64_t dx = x - offsets[i].x, dy = y - offsets[i].y;
        if (dx * dx + dy * dy >= least) continue;
        least = dx * dx + dy * dy;
        best = i;
    }
    return best;
}

// Every offset of the square is in one span, that of its nearest offset; spans of a region go up.
static void check_regions(const struct ort_offset *offsets, uint32_t count, uint32_t width,
                          uint32_t height)
{
    struct ort_regions regions;
    const int32_t columns = (int32_t)(2 * width - 1), rows = (int32_t)(2 * height - 1);
    CHECK(ort_regions_init(&regions, test_host(), offsets, count, width, height));
    CHECK(regions.count == count && regions.first[0] == 0);
    int64_t covered = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = regions.first[i]; k < regions.first[i + 1]; k++) {
            const struct ort_span span = regions.spans[k];
            CHECK(k == regions.first[i] || regions.spans[k - 1].y < span.y);
            CHECK(abs(span.y) < (int32_t)height && span.x0 <= span.x1);
            CHECK(span.x0 > -(int32_t)width && span.x1 < (int32_t)width);
            for (int32_t x = span.x0; x <= span.x1; x++)
                CHECK(nearest(offsets, count, x, span.y) == i);
            covered += span.x1 - span.x0 + 1;
        }
    CHECK(covered == (int64_t)columns * rows);
    ort_regions_finish(&regions);
}

static void random_offsets(uint32_t seed, uint32_t count, uint32_t width, uint32_t height,
                           struct ort_offset *out)
{
    struct rng rng = rng_for(seed, 7, 0);
    for (uint32_t i = 0; i < count; i++) {
        out[i].x = (int32_t)(rng_u32(&rng) % (2 * width - 1)) - (int32_t)width + 1;
        out[i].y = (int32_t)(rng_u32(&rng) % (2 * height - 1)) - (int32_t)height + 1;
    }
}

TEST(regions_equal_brute_force)
{
    // Sides of the atlas and offsets; in small squares offsets repeat, and most distances tie.
    static const uint32_t sizes[][3] = { { 40, 40, 60 }, { 8, 5, 30 },  { 3, 3, 25 },
                                         { 64, 9, 100 }, { 1, 30, 5 },  { 30, 1, 5 },
                                         { 1, 1, 1 },    { 17, 33, 1 }, { 50, 50, 400 },
                                         { 2, 40, 12 } };
    struct ort_offset offsets[MOST_OFFSETS];
    for (uint32_t k = 0; k < 40; k++) {
        const uint32_t *size = sizes[k % 10];
        random_offsets(k, size[2], size[0], size[1], offsets);
        check_regions(offsets, size[2], size[0], size[1]);
    }
}

TEST(regions_give_ties_to_the_first_offset)
{
    struct ort_regions regions;
    const struct ort_offset right_first[] = { { 2, 0 }, { -2, 0 } };
    const struct ort_offset left_first[] = { { -2, 0 }, { 2, 0 } };
    CHECK(ort_regions_init(&regions, test_host(), right_first, 2, 4, 1));
    CHECK(regions.spans[0].x0 == 0 && regions.spans[1].x1 == -1);
    ort_regions_finish(&regions);
    CHECK(ort_regions_init(&regions, test_host(), left_first, 2, 4, 1));
    CHECK(regions.spans[0].x1 == 0 && regions.spans[1].x0 == 1);
    ort_regions_finish(&regions);
    const struct ort_offset same[] = { { 1, 1 }, { 1, 1 } };
    CHECK(ort_regions_init(&regions, test_host(), same, 2, 4, 4));
    CHECK(regions.first[1] == 7 && regions.first[2] == 7);
    ort_regions_finish(&regions);
    const struct ort_offset corners[] = { { 3, 3 }, { -3, 3 }, { 3, -3 }, { -3, -3 }, { 0, 0 } };
    check_regions(corners, 5, 4, 4);
}

TEST(regions_of_a_large_atlas_take_less_than_a_second)
{
    struct ort_offset offsets[MOST_OFFSETS];
    struct ort_regions regions;
    struct timespec begin, end;
    random_offsets(1, MOST_OFFSETS, 512, 512, offsets);
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
    CHECK(ort_regions_init(&regions, test_host(), offsets, MOST_OFFSETS, 512, 512));
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    const double seconds =
        (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
    if (getenv("AFTERGLOW_TEST_VERBOSE")) print_message("regions: %.3f s\n", seconds);
    CHECK(seconds < 1.0 * test_time_factor());
    ort_regions_finish(&regions);
}
