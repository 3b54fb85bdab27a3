// The choice of offsets: distinct, inside the square, by importance.
#include "framework/test.h"

#include "api/counting_allocator.h"
#include "core/rng.h"
#include "techniques/ort/bake/offsets.h"

#include <math.h>
#include <string.h>
#include <time.h>

enum { MOST = 7000 };

// Offsets that the importance callback saw.
struct record {
    struct ort_offset seen[2000];
    uint32_t count, calls, largest_later; // calls after the first
    uint32_t fail_at;                     // call that fails; 0: none
    float (*function)(struct ort_offset);
};

static bool record_importance(void *user, const struct ort_offset *offsets, uint32_t count,
                              float *out)
{
    struct record *record = user;
    if (++record->calls == record->fail_at) return false;
    if (record->calls > 1 && count > record->largest_later) record->largest_later = count;
    for (uint32_t i = 0; i < count; i++) {
        record->seen[record->count++] = offsets[i];
        out[i] = record->function(offsets[i]);
    }
    return true;
}

static float peak(struct ort_offset offset)
{
    return expf(-0.05f * (float)((offset.x - 5) * (offset.x - 5) + offset.y * offset.y)) + 1e-6f;
}

static float broad(struct ort_offset offset)
{
    return 600.0f - (float)(abs(offset.x) + abs(offset.y)) * 0.5f;
}

static float spike(struct ort_offset offset)
{
    return offset.x == 0 && offset.y == 0 ? 1.0f : 0.0f;
}

static float zero(struct ort_offset offset)
{
    return 0.0f * (float)offset.x;
}

static float not_a_number(struct ort_offset offset)
{
    return offset.x == offset.y ? NAN : 1.0f;
}

static int by_place(const void *a, const void *b)
{
    const struct ort_offset *p = a, *q = b;
    return p->y != q->y ? (p->y > q->y) - (p->y < q->y) : (p->x > q->x) - (p->x < q->x);
}

// Sorted, distinct, in the square.
static void check_offsets(const struct ort_offset *offsets, uint32_t count, uint32_t width,
                          uint32_t height)
{
    for (uint32_t i = 0; i < count; i++) {
        CHECK((uint32_t)abs(offsets[i].x) < width && (uint32_t)abs(offsets[i].y) < height);
        CHECK(i == 0 || by_place(&offsets[i - 1], &offsets[i]) < 0);
    }
}

static struct record choose(float (*function)(struct ort_offset), uint32_t width, uint32_t height,
                            uint32_t count, uint64_t seed, struct ort_offset *out)
{
    static struct record record;
    record = (struct record){ .function = function };
    const struct ort_offsets_wish wish = { .refinements = 1000,
                                           .width = width,
                                           .height = height,
                                           .count = count,
                                           .seed = seed,
                                           .importance = record_importance,
                                           .user = &record };
    memset(out, 0, count * sizeof *out);
    CHECK(ort_choose_offsets(test_host(), &wish, out));
    const uint64_t most = ort_offset_most(width, height);
    check_offsets(out, most < count ? (uint32_t)most : count, width, height);
    return record;
}

static struct ort_offset offsets[MOST], others[MOST];

TEST(offsets_number_is_that_of_differences_of_texels)
{
    CHECK(ort_offset_most(1, 1) == 1);
    CHECK(ort_offset_most(4, 3) == 35);
    CHECK(ort_offset_most(ORT_MOST_SIDE, ORT_MOST_SIDE) == UINT64_C(131071) * 131071);
}

TEST(offsets_are_distinct_and_inside_the_square_for_any_importance)
{
    float (*const functions[])(struct ort_offset) = { peak, broad, spike, zero };
    static const uint32_t sizes[][3] = { { 256, 256, 300 }, { 64, 16, 200 }, { 16, 300, 50 },
                                         { 3, 3, 20 },      { 2, 2, 8 },     { 5, 5, 80 },
                                         { 2, 200, 30 } };
    for (uint32_t k = 0; k < 28; k++) {
        const uint32_t *size = sizes[k % 7];
        choose(functions[k / 7], size[0], size[1], size[2], k, offsets);
    }
}

TEST(offsets_importance_is_asked_of_corners_and_of_distinct_offsets)
{
    static const uint32_t sizes[][2] = { { 512, 512 }, { 256, 64 }, { 20, 1000 }, { 7, 7 } };
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t width = sizes[k][0], height = sizes[k][1];
        struct record record = choose(broad, width, height, 100, 9, offsets);
        uint32_t corners = 0;
        CHECK(record.count <= ort_offset_most(width, height));
        CHECK(k == 3 || (record.count > 1000 && record.count < 1130 + 129)); // about 100 and 1000
        CHECK(record.largest_later <= 20);
        for (uint32_t i = 0; i < record.count; i++)
            corners += (uint32_t)abs(record.seen[i].x) == width - 1 &&
                       (uint32_t)abs(record.seen[i].y) == height - 1;
        CHECK(corners == 4);
        qsort(record.seen, record.count, sizeof *record.seen, by_place);
        check_offsets(record.seen, record.count, width, height);
    }
}

TEST(offsets_are_the_same_for_a_seed_and_others_for_another)
{
    choose(peak, 128, 128, 400, 77, offsets);
    choose(peak, 128, 128, 400, 77, others);
    CHECK(memcmp(offsets, others, 400 * sizeof *offsets) == 0);
    choose(peak, 128, 128, 400, UINT64_C(77) << 32, others);
    CHECK(memcmp(offsets, others, 400 * sizeof *offsets) != 0);
}

TEST(offsets_are_all_of_them_if_as_many_are_wanted)
{
    static const uint32_t sizes[][2] = { { 1, 1 }, { 1, 20 }, { 20, 1 }, { 9, 13 }, { 40, 40 } };
    for (uint32_t k = 0; k < 5; k++) {
        const uint64_t most = ort_offset_most(sizes[k][0], sizes[k][1]);
        const struct record record =
            choose(peak, sizes[k][0], sizes[k][1], MOST, k, offsets); // checks that they differ
        CHECK(record.calls == 0);
        CHECK(offsets[most - 1].x == (int32_t)sizes[k][0] - 1);
        CHECK(offsets[most - 1].y == (int32_t)sizes[k][1] - 1);
        choose(peak, sizes[k][0], sizes[k][1], (uint32_t)most, k, offsets);
        if (most > 1) choose(peak, sizes[k][0], sizes[k][1], (uint32_t)most - 1, k, offsets);
    }
}

TEST(offsets_follow_the_importance)
{
    // Nearly all of the importance is within 15 of its peak.
    choose(peak, 256, 256, 200, 3, offsets);
    int near = 0;
    for (int i = 0; i < 200; i++) near += hypot(offsets[i].x - 5.0, offsets[i].y) < 15.0;
    CHECK(near > 150);
    // Only the texels about the spike have any: they are found, and others fill up.
    choose(spike, 10, 10, 200, 3, offsets);
    bool center = false;
    for (int i = 0; i < 200; i++) center |= offsets[i].x == 0 && offsets[i].y == 0;
    CHECK(center);
}

static float ramp(struct ort_offset offset)
{
    return (float)(offset.x + 255);
}

// χ² of eight strips, for an importance that grows linearly from the left to the right.
TEST(offsets_of_a_linear_importance_have_its_distribution)
{
    int counts[8] = { 0 };
    for (uint64_t seed = 0; seed < 8; seed++) {
        choose(ramp, 256, 256, 1000, seed, offsets);
        for (int i = 0; i < 1000; i++) counts[(offsets[i].x + 255) * 8 / 511]++;
    }
    double sum = 0.0;
    for (int i = 0; i < 8; i++) {
        const double expected = 8000.0 * (2.0 * i + 1.0) / 64.0;
        sum += (counts[i] - expected) * (counts[i] - expected) / expected;
    }
    CHECK(sum < 30.0); // 7 degrees of freedom: one run in 10 000 is above
}

TEST(offsets_fail_with_the_importance)
{
    struct record record = { .function = peak };
    struct ort_offsets_wish wish = { .refinements = 1000,
                                     .width = 64,
                                     .height = 64,
                                     .count = 50,
                                     .importance = record_importance,
                                     .user = &record };
    for (uint32_t call = 1; call <= 51; call += 25) {
        record = (struct record){ .function = broad, .fail_at = call };
        CHECK(!ort_choose_offsets(test_host(), &wish, offsets));
        CHECK(record.calls == call);
    }
    record = (struct record){ .function = not_a_number };
    test_forget_messages();
    CHECK(!ort_choose_offsets(test_host(), &wish, offsets));
    CHECK(strstr(test_last_message(), "data point") != NULL);
}

TEST(offsets_fail_cleanly_without_memory)
{
    long failed = 0;
    for (long i = 1; i < 500; i = i < 20 ? i + 1 : i + 97) {
        struct record record = { .function = peak };
        struct counting_allocator allocator = { .refuse_at = i };
        struct host host = { .reallocate = counting_reallocate, .user = &allocator };
        const struct ort_offsets_wish wish = { .refinements = 1000,
                                               .width = 64,
                                               .height = 64,
                                               .count = 50,
                                               .importance = record_importance,
                                               .user = &record };
        const bool ok = ort_choose_offsets(&host, &wish, offsets);
        CHECK(ok == (allocator.asked < i));
        CHECK(allocator.blocks == 0);
        failed += !ok;
    }
    CHECK(failed > 20);
}

TEST(offsets_of_a_large_atlas_take_seconds_at_most)
{
    struct timespec begin, end;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
    choose(peak, 512, 512, 400, 1, offsets);
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    const double seconds =
        (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
    if (getenv("AFTERGLOW_TEST_VERBOSE")) print_message("400 offsets: %.3f s\n", seconds);
    CHECK(seconds < 5.0 * test_time_factor());
}
