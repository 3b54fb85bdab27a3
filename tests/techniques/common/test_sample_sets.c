// Properties of the sample tables that tools/samples generates.
#include "framework/test.h"

#include "samples/noise.h"
#include "techniques/common/sample_sets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct points points_of(enum sample_shape shape, int index)
{
    const struct sample_set *set = sample_set_at(shape, index);
    struct points out = { .ball = shape == SAMPLE_BALL, .count = set->count };
    for (int i = 0; i < set->count; i++) {
        const struct sample *s = &set->samples[i];
        out.at[i] = (struct point){ (double)s->x, (double)s->y, out.ball ? (double)s->z : 0.0 };
    }
    return out;
}

TEST(sample_sets_have_the_counts_of_the_option)
{
    const char *choice = SAMPLE_SET_CHOICES;
    for (int i = 0; i < SAMPLE_SET_COUNT; i++) {
        CHECK(sample_set_at(SAMPLE_DISK, i)->count == atoi(choice));
        CHECK(sample_set_at(SAMPLE_BALL, i)->count == atoi(choice));
        choice += strcspn(choice, "|") + (i + 1 < SAMPLE_SET_COUNT);
    }
    CHECK(strchr(choice, '|') == NULL);
    CHECK(sample_set_at(SAMPLE_DISK, SAMPLE_SET_COUNT - 1)->count == SAMPLE_SET_MOST);
}

TEST(sample_weights_and_shares_add_up_to_one)
{
    for (int k = 0; k < 2 * SAMPLE_SET_COUNT; k++) {
        const struct sample_set *set = sample_set_at(k % 2 ? SAMPLE_BALL : SAMPLE_DISK, k / 2);
        double weights = 0.0, shares = 0.0;
        for (int i = 0; i < set->count; i++) {
            weights += (double)set->samples[i].weight;
            shares += (double)set->samples[i].share;
        }
        CHECK_NEAR(weights, 1.0, 1e-6); // 33 numbers of eight decimals
        CHECK_NEAR(shares, 1.0, 1e-6);
    }
}

// Symmetry gives a plane through the center exactly half, and an odd set's first line needs no
// fetch.
TEST(sample_sets_are_symmetric_about_their_center)
{
    for (int k = 2; k < 2 * SAMPLE_SET_COUNT; k++) { // but the sets of one
        const enum sample_shape shape = k % 2 ? SAMPLE_BALL : SAMPLE_DISK;
        const struct sample_set *set = sample_set_at(shape, k / 2);
        for (int i = 0; i < set->count; i++) {
            const struct sample *a = &set->samples[i];
            // Opposite samples are adjacent; the center is its own opposite.
            const int place = i - set->count % 2;
            const struct sample *b = &set->samples[place < 0 ? 0 : (place ^ 1) + set->count % 2];
            const float z = shape == SAMPLE_BALL ? a->z + b->z : a->z - b->z;
            CHECK(a->x + b->x == 0.0f && a->y + b->y == 0.0f && z == 0.0f);
            // Weights come from cells of a grid and may differ by a few within a pair.
            CHECK_NEAR(a->weight, b->weight, 1e-3f);
        }
        CHECK(set->count % 2 == 0 || (set->samples[0].x == 0.0f && set->samples[0].y == 0.0f));
    }
}

TEST(sample_lines_have_the_length_of_the_spheres_chord)
{
    for (int k = 0; k < SAMPLE_SET_COUNT; k++) {
        const struct sample_set *set = sample_set_at(SAMPLE_DISK, k);
        for (int i = 0; i < set->count; i++) {
            const struct sample *s = &set->samples[i];
            CHECK_NEAR((double)(s->x * s->x + s->y * s->y + s->z * s->z), 1.0, 1e-6);
            CHECK(s->z > 0.2f); // a chord near the rim has little weight and length
        }
    }
}

static void check_voronoi(enum sample_shape shape, int side, double tolerance)
{
    struct grid grid;
    CHECK(grid_init(&grid, shape == SAMPLE_BALL, side));
    for (int k = 0; k < SAMPLE_SET_COUNT; k++) {
        const struct points points = points_of(shape, k);
        const struct voronoi v = voronoi_of(&points, &grid);
        for (int i = 0; i < points.count; i++) {
            CHECK_NEAR((double)sample_set_at(shape, k)->samples[i].weight, v.weight[i], tolerance);
            CHECK_NEAR((double)sample_set_at(shape, k)->samples[i].share, v.share[i], tolerance);
        }
    }
    grid_finish(&grid);
}

TEST(sample_weights_match_their_voronoi_regions)
{
    // The disk's grid is the tables' own. The ball's has half its side: regions of 1/33 of it have
    // 4000 cells, and a border through a tenth of them.
    check_voronoi(SAMPLE_DISK, 512, 1e-6);
    check_voronoi(SAMPLE_BALL, 64, 2e-3);
}

static void check_noise(enum sample_shape shape, int side)
{
    struct grid grid;
    CHECK(grid_init(&grid, shape == SAMPLE_BALL, side));
    for (int k = 0; k < SAMPLE_SET_COUNT; k++) {
        const struct sample_set *set = sample_set_at(shape, k);
        const struct points points = points_of(shape, k);
        const struct voronoi v = voronoi_of(&points, &grid);
        const struct noise noise = noise_of(&points, &v);
        print_message("%s of %d: noise %.4f, bias %.4f\n", points.ball ? "ball" : "disk",
                      points.count, noise.deviation, noise.bias);
        CHECK_NEAR(noise.deviation, (double)set->noise, 1e-3); // weights of a coarser grid
        CHECK_NEAR(noise.bias, (double)set->bias, 1e-3);
    }
    grid_finish(&grid);
}

TEST(sample_sets_have_the_noise_of_their_tables)
{
    check_noise(SAMPLE_DISK, 192);
    check_noise(SAMPLE_BALL, 40);
}

// Loos 2015, sec. 6.3.5: lines of few samples already have the noise of many points.
TEST(lines_are_less_noisy_than_points_of_twice_their_number)
{
    CHECK(sample_set_at(SAMPLE_DISK, 1)->noise < sample_set_at(SAMPLE_BALL, 5)->noise); // 5, 12
    CHECK(sample_set_at(SAMPLE_DISK, 4)->noise < sample_set_at(SAMPLE_BALL, 8)->noise); // 9, 33
}
