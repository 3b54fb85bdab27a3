// Pieces of transfer maps cover their texels once and fill bins without a gap.
#include "framework/test.h"
#include "techniques/ort/map_fixture.h"

#include "core/host.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const uint64_t BIN_TEXELS = (uint64_t)ORT_BIN_SIDE * ORT_BIN_SIDE;

// Pieces as in section 5.2.
static bool init_bins(struct ort_bins *out, struct host *host, uint32_t maps, uint32_t width,
                      uint32_t height, ort_mask_function *mask, void *user)
{
    return ort_bins_init(out, host, &(struct ort_bins_wish){ maps, width, height, 0, mask, user });
}

static struct ort_bins make_bins(struct test_maps *maps, uint32_t count)
{
    struct ort_bins bins;
    CHECK(init_bins(&bins, test_host(), count, maps->width, maps->height, test_maps_mask, maps));
    return bins;
}

// ---- the laws of bins

static void check_shape(const struct ort_piece *p, const struct test_maps *maps)
{
    CHECK(p->x % ORT_RUN == 0 && p->bin_x % ORT_RUN == 0);
    CHECK(p->width >= ORT_RUN && (p->width & (p->width - 1)) == 0 && p->height > 0);
    CHECK(p->bin_x + p->width <= ORT_BIN_SIDE && p->bin_y + p->height <= ORT_BIN_SIDE);
    CHECK(p->x + p->width < maps->width + ORT_RUN && p->y + p->height <= maps->height);
}

// Adds 1 to the texels of a rectangle that are in an image.
static void paint(uint8_t *image, uint32_t stride, const uint32_t at[2], const struct ort_piece *p)
{
    for (uint32_t y = at[1]; y < at[1] + p->height; y++)
        for (uint32_t x = at[0]; x < at[0] + p->width && x < stride; x++)
            image[(size_t)y * stride + x]++;
}

// Each texel that is not zero is in one piece, and no texel is in two. Returns the former.
static uint64_t check_map(const struct ort_bins *bins, struct test_maps *maps, uint32_t map)
{
    const size_t texels = (size_t)maps->width * maps->height;
    uint8_t *mask = host_alloc(test_host(), texels, 1),
            *pieces = host_alloc(test_host(), texels, 1);
    uint64_t occupied = 0;
    assert_true(mask && pieces);
    CHECK(test_maps_mask(maps, map, mask));
    for (uint32_t i = 0; i < bins->piece_count; i++) {
        const struct ort_piece *p = &bins->pieces[i];
        if (p->map == map) paint(pieces, maps->width, (uint32_t[]){ p->x, p->y }, p);
    }
    for (size_t i = 0; i < texels; i++) {
        if (pieces[i] > 1 || pieces[i] < mask[i]) fail_msg("texel %zu of map %u", i, map);
        occupied += mask[i];
    }
    host_free(test_host(), mask);
    host_free(test_host(), pieces);
    return occupied;
}

// No two pieces overlap, all bins but the last are full, and pieces are sorted.
static void check_packing(const struct ort_bins *bins)
{
    uint8_t *image = host_alloc(test_host(), BIN_TEXELS, 1);
    uint64_t sum = 0;
    assert_non_null(image);
    for (uint32_t i = 0; i < bins->piece_count; i++) {
        const struct ort_piece *p = &bins->pieces[i];
        const bool same = i > 0 && p[-1].bin == p->bin;
        CHECK(p->bin < bins->bin_count && (i == 0 || p[-1].bin <= p->bin));
        CHECK(!same || p[-1].bin_x < p->bin_x ||
              (p[-1].bin_x == p->bin_x && p[-1].bin_y < p->bin_y));
        if (!same) memset(image, 0, BIN_TEXELS);
        paint(image, ORT_BIN_SIDE, (uint32_t[]){ p->bin_x, p->bin_y }, p);
        sum += (uint64_t)p->width * p->height;
        if (i + 1 < bins->piece_count && p[1].bin == p->bin) continue;
        const bool last = p->bin + 1 == bins->bin_count;
        for (size_t t = 0; t < BIN_TEXELS; t++)
            if (image[t] > 1 || (!last && image[t] == 0)) fail_msg("texel %zu of a bin", t);
    }
    CHECK(sum == bins->packed);
    CHECK(bins->bin_count == (bins->packed + BIN_TEXELS - 1) / BIN_TEXELS);
    host_free(test_host(), image);
}

static void check_bins(const struct ort_bins *bins, struct test_maps *maps, uint32_t count)
{
    uint64_t occupied = 0;
    for (uint32_t i = 0; i < bins->piece_count; i++) check_shape(&bins->pieces[i], maps);
    for (uint32_t map = 0; map < count; map++) occupied += check_map(bins, maps, map);
    CHECK(occupied == bins->occupied && occupied <= bins->packed);
    check_packing(bins);
}

static void check_maps(enum map_kind kind, uint32_t width, uint32_t height, uint32_t seed,
                       uint32_t count)
{
    struct test_maps maps = test_maps_of(kind, width, height, seed);
    struct ort_bins bins = make_bins(&maps, count);
    check_bins(&bins, &maps, count);
    ort_bins_finish(&bins);
    test_maps_finish(&maps);
}

TEST(ort_pieces_cover_texels_once_and_fill_bins)
{
    static const uint32_t sizes[][2] = { { 8, 8 },     { 13, 70 },    { 64, 64 },  { 100, 60 },
                                         { 250, 257 }, { 1100, 300 }, { 90, 2500 } };
    for (int kind = 0; kind < MAP_KINDS; kind++)
        for (uint32_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
            for (uint32_t seed = 1; seed <= 2; seed++)
                check_maps((enum map_kind)kind, sizes[i][0], sizes[i][1], seed, 4);
}

TEST(ort_pieces_cover_large_maps)
{
    for (int kind = 0; kind < MAP_KINDS; kind++) check_maps((enum map_kind)kind, 2050, 1500, 3, 3);
    check_maps(MAP_DOTS, ORT_MAX_MAP_SIDE, 9, 1, 2);
    check_maps(MAP_DOTS, 9, ORT_MAX_MAP_SIDE, 1, 2);
    check_maps(MAP_FULL, ORT_MAX_MAP_SIDE, 9, 1, 2);
    check_maps(MAP_FULL, 9, ORT_MAX_MAP_SIDE, 1, 2);
}

TEST(ort_pieces_cover_least_maps)
{
    check_maps(MAP_FULL, 1, 1, 1, 3);
    check_maps(MAP_FULL, 8, 1, 1, 3);
    check_maps(MAP_FULL, 9, 1, 1, 3);
    check_maps(MAP_EMPTY, 1, 1, 1, 3);
}

// ---- exact results

TEST(ort_bins_of_no_maps_and_of_empty_maps_are_none)
{
    struct test_maps maps = test_maps_of(MAP_EMPTY, 100, 100, 1);
    for (uint32_t count = 0; count <= 3; count++) {
        struct ort_bins bins = make_bins(&maps, count);
        CHECK(bins.bin_count == 0 && bins.piece_count == 0 && bins.packed == 0);
        ort_bins_finish(&bins);
        ort_bins_finish(&bins);
    }
}

TEST(ort_full_maps_need_the_least_number_of_bins)
{
    struct test_maps maps = test_maps_of(MAP_FULL, ORT_BIN_SIDE, ORT_BIN_SIDE, 1);
    maps.rows = 700;
    for (uint32_t count = 1; count <= 9; count++) {
        struct ort_bins bins = make_bins(&maps, count);
        CHECK(bins.bin_count == (count * maps.rows + ORT_BIN_SIDE - 1) / ORT_BIN_SIDE);
        CHECK(bins.packed == bins.occupied && bins.piece_count == count + bins.cuts);
        CHECK(bins.cuts == bins.bin_count - 1);
        ort_bins_finish(&bins);
    }
}

// Heights of 400 and 624 rows, by turns.
static bool mask_bands(void *user, uint32_t map, uint8_t *mask)
{
    (void)user;
    const size_t rows = map % 2 ? 624 : 400, all = (size_t)ORT_BIN_SIDE * ORT_BIN_SIDE;
    memset(mask, 0, all);
    memset(mask, 1, rows * ORT_BIN_SIDE);
    return true;
}

TEST(ort_pieces_that_fit_are_not_cut)
{
    struct ort_bins bins;
    CHECK(init_bins(&bins, test_host(), 10, ORT_BIN_SIDE, ORT_BIN_SIDE, mask_bands, NULL));
    CHECK(bins.cuts == 0 && bins.bin_count == 5 && bins.piece_count == 10);
    ort_bins_finish(&bins);
}

// Texels at the corners, and the letter L.
static bool mask_corners(void *user, uint32_t map, uint8_t *mask)
{
    const uint32_t *side = user;
    for (uint32_t i = 0; i < *side * *side; i++) {
        const uint32_t x = i % *side, y = i / *side;
        const bool corner = x % (*side - 1) == 0 && y % (*side - 1) == 0;
        mask[i] = map == 0 ? corner : x < 16 || y >= *side - 16;
    }
    return true;
}

TEST(ort_pieces_of_corners_and_of_an_l_have_no_empty_runs)
{
    uint32_t side = ORT_BIN_SIDE;
    struct ort_bins bins;
    CHECK(init_bins(&bins, test_host(), 1, side, side, mask_corners, &side));
    CHECK(bins.occupied == 4 && bins.piece_count == 4 && bins.packed == 4 * ORT_RUN);
    ort_bins_finish(&bins);
    CHECK(init_bins(&bins, test_host(), 2, side, side, mask_corners, &side));
    CHECK(bins.occupied == 4 + 2 * 16 * side - 16 * 16 && bins.packed == bins.occupied + 28);
    ort_bins_finish(&bins);
}

TEST(ort_pieces_leave_out_the_hole_of_a_ring)
{
    struct test_maps maps = test_maps_of(MAP_RING, 512, 512, 1);
    struct ort_bins bins = make_bins(&maps, 1);
    CHECK((double)bins.packed < 1.4 * (double)bins.occupied);
    CHECK(bins.piece_count < 80);
    ort_bins_finish(&bins);
}

TEST(ort_bins_are_deterministic)
{
    struct test_maps maps = test_maps_of(MAP_ISLANDS, 300, 300, 5);
    struct ort_bins a = make_bins(&maps, 20), b = make_bins(&maps, 20);
    CHECK(a.piece_count == b.piece_count && a.cuts == b.cuts);
    CHECK(memcmp(a.pieces, b.pieces, a.piece_count * sizeof *a.pieces) == 0);
    ort_bins_finish(&a);
    ort_bins_finish(&b);
    test_maps_finish(&maps);
}

// ---- failures

TEST(ort_bins_fail_with_a_mask)
{
    struct test_maps maps = test_maps_of(MAP_DISCS, 64, 64, 1);
    struct ort_bins bins;
    maps.fails = 3;
    CHECK(!init_bins(&bins, test_host(), 4, 64, 64, test_maps_mask, &maps));
    CHECK(bins.pieces == NULL && bins.piece_count == 0);
    ort_bins_finish(&bins);
}

// Memory that ends after some allocations.
static void *scarce_reallocate(void *user, void *old, size_t bytes)
{
    int *left = user;
    if (bytes == 0) {
        free(old);
        return NULL;
    }
    return (*left)-- > 0 ? realloc(old, bytes) : NULL;
}

TEST(ort_bins_fail_when_out_of_memory)
{
    struct test_maps maps = test_maps_of(MAP_DOTS, 300, 300, 1);
    bool ok = false;
    int allocations = 0;
    for (; !ok && allocations < 200; allocations++) {
        int left = allocations;
        struct host host = { .reallocate = scarce_reallocate, .user = &left };
        struct ort_bins bins;
        ok = init_bins(&bins, &host, 4, 300, 300, test_maps_mask, &maps);
        CHECK(ok || host.failure == FAIL_MEMORY);
        ort_bins_finish(&bins);
    }
    CHECK(ok && allocations > 8);
}

// ---- tiles in the order of a gather

static void check_tiles(const struct ort_bins *bins, struct test_maps *maps, uint32_t count,
                        uint32_t rows)
{
    uint64_t occupied = 0;
    for (uint32_t i = 0; i < bins->piece_count; i++) {
        const struct ort_piece *p = &bins->pieces[i], *before = p - 1;
        check_shape(p, maps);
        CHECK(p->width == ORT_RUN && p->y % rows == 0 && p->height <= rows);
        CHECK(p->bin_y % rows == 0 && p->bin < bins->bin_count);
        // A stream: by workgroup, then by map; places follow each other.
        CHECK(i == 0 || before->x < p->x ||
              (before->x == p->x &&
               (before->y < p->y || (before->y == p->y && before->map < p->map))));
        CHECK(i == 0 || before->bin < p->bin || before->bin_x < p->bin_x ||
              (before->bin_x == p->bin_x && before->bin_y + rows == p->bin_y));
    }
    for (uint32_t map = 0; map < count; map++) occupied += check_map(bins, maps, map);
    CHECK(occupied == bins->occupied && bins->cuts == 0);
}

TEST(ort_tiles_follow_each_other_and_cover_each_texel_once)
{
    static const uint32_t ROWS[] = { 8, 64 };
    for (int kind = 0; kind < MAP_KINDS; kind++)
        for (size_t r = 0; r < 2; r++) {
            struct test_maps maps = test_maps_of((enum map_kind)kind, 203, 331, 7);
            struct ort_bins bins;
            CHECK(ort_bins_init(
                &bins, test_host(),
                &(struct ort_bins_wish){ 5, 203, 331, ROWS[r], test_maps_mask, &maps }));
            check_tiles(&bins, &maps, 5, ROWS[r]);
            ort_bins_finish(&bins);
            test_maps_finish(&maps);
        }
}

// ---- a case as in the paper, section 6.1

static double cpu_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

TEST(ort_bins_of_an_atlas_of_islands)
{
    enum { MAPS = 200, SIDE = 512 };
    struct test_maps maps = test_maps_of(MAP_ISLANDS, SIDE, SIDE, 1);
    const double begin_s = cpu_s();
    struct ort_bins bins = make_bins(&maps, MAPS);
    const double seconds = cpu_s() - begin_s;
    const double texels = (double)bins.bin_count * (double)BIN_TEXELS;
    const double occupied = (double)bins.occupied / texels, packed = (double)bins.packed / texels;
    const double pieces = (double)bins.piece_count / MAPS;
    printf("%u maps of %u²: %u bins, %.1f pieces a map, %u cuts, occupancy %.3f by texels and %.3f "
           "by pieces, %.2f s with masks\n",
           MAPS, SIDE, bins.bin_count, pieces, bins.cuts, occupied, packed, seconds);
    CHECK(pieces < 120.0 && (double)bins.cuts < MAPS);
    CHECK(occupied > 0.45 && packed > 0.9);
    check_bins(&bins, &maps, MAPS);
    ort_bins_finish(&bins);
    test_maps_finish(&maps);
}
