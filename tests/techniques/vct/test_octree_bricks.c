// Radiance in the sparse voxel octree: bricks of each level against a plain C twin, equal values on
// shared borders, leaves against the finest mip.
#include "techniques/vct/svo_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A point of a node from its children. In each child that contains it: the point composited with
// its inner neighbour along the direction; then the mean over the children.
static void point_of_children(const struct svo_tree *tree, const struct svo_pool *pool, int brick,
                              uint32_t depth, int direction, const int point[3], const int last[3],
                              double out[4])
{
    int node[3], parts = 0;
    svo_tree_node_coord(tree, brick, node);
    for (int k = 0; k < 4; k++) out[k] = 0.0;
    for (int i = 0; i < 8; i++) {
        int child[3], first[3];
        bool has = true;
        for (int a = 0; a < 3; a++) {
            const int upper = i >> a & 1;
            has = has && (point[a] == 1 || upper == point[a] / 2);
            child[a] = 2 * node[a] + upper;
            first[a] = point[a] == 1 ? 1 - upper : upper;
            has = has && 2 * child[a] < last[a]; // else it is outside of the grid
        }
        if (!has) continue;
        parts++;
        const int from = svo_tree_find(tree, child, depth + 1);
        if (from < 0) continue;
        const int axis = direction / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
        double sum[4] = { 0 }, columns = 0.0;
        for (int j = 0; j < 4; j++) {
            int at[3] = { first[0], first[1], first[2] };
            at[b] += j & 1;
            at[c] += j >> 1;
            if (2 * child[b] + at[b] > last[b] || 2 * child[c] + at[c] > last[c]) continue;
            columns++;
            const float *low = svo_pool_at(pool, from, direction, at);
            at[axis]++;
            const bool whole = 2 * child[axis] + at[axis] <= last[axis];
            static const float none[4] = { 0 };
            const float *high = whole ? svo_pool_at(pool, from, direction, at) : none;
            const float *near = direction % 2 == 0 ? low : high,
                        *far = direction % 2 == 0 ? high : low;
            const double before = (double)near[3], behind = (double)far[3];
            const double part = behind > 0.0
                                    ? vct_fixture_visible_alpha(1.0 - fmin(before, 1.0), behind,
                                                                fmin(before + behind, 1.0)) /
                                          behind
                                    : 0.0;
            for (int k = 0; k < 4; k++) sum[k] += (double)near[k] + part * (double)far[k];
        }
        for (int k = 0; k < 4; k++) out[k] += sum[k] / columns;
    }
    for (int k = 0; k < 4 && parts > 0; k++) out[k] /= parts;
}

typedef double brick_values[27][4]; // of one direction

// Neighbours along an axis average the points on their common face.
static void join(const struct svo_tree *tree, uint32_t depth, int axis, brick_values *bricks)
{
    const int first = (int)tree->levels[depth].first, count = (int)tree->levels[depth].count;
    const int b = (axis + 1) % 3, c = (axis + 2) % 3, step[3] = { 1, 3, 9 };
    for (int i = 0; i < count; i++) {
        int next[3];
        svo_tree_node_coord(tree, first + i, next);
        next[axis]++;
        const int other = next[axis] < 1 << depth ? svo_tree_find(tree, next, depth) : -1;
        if (other < 0) continue;
        for (int j = 0; j < 9; j++) {
            const int low = j % 3 * step[b] + j / 3 * step[c], high = low + 2 * step[axis];
            double *mine = bricks[i][high], *theirs = bricks[other - first][low];
            for (int k = 0; k < 4; k++) mine[k] = theirs[k] = 0.5 * (mine[k] + theirs[k]);
        }
    }
}

TEST_GPU(bricks_of_each_level_match_the_twin)
{
    struct vct_fixture fixture;
    svo_fixture_room(&fixture, gpu, true);
    vct_fixture_open(&fixture, "storage=svo,resolution=48");
    fixture_render(&fixture.frame_fixture);
    struct svo_tree tree = svo_tree_of(&fixture);
    struct svo_pool pool = svo_pool_of(&fixture);
    double most = 0.0;
    for (uint32_t depth = 0; depth + 1 < tree.params.depths; depth++) {
        const int count = (int)tree.levels[depth].count, first = (int)tree.levels[depth].first;
        const int height = (int)(tree.params.depths - 2 - depth); // of the children
        int last[3];
        for (int a = 0; a < 3; a++)
            last[a] =
                (fixture.vct->clipmap.levels[0].grid.cells[a] / 2 + (1 << height) - 1) >> height;
        brick_values *expected = calloc((size_t)count, sizeof *expected);
        for (int direction = 0; direction < pool.directions; direction++) {
            for (int i = 0; i < count; i++)
                for (int p = 0; p < 27; p++) {
                    const int point[3] = { p % 3, p / 3 % 3, p / 9 };
                    point_of_children(&tree, &pool, first + i, depth, direction, point, last,
                                      expected[i][p]);
                }
            for (int axis = 0; axis < 3; axis++) join(&tree, depth, axis, expected);
            for (int i = 0; i < count; i++)
                for (int p = 0; p < 27; p++) {
                    const int point[3] = { p % 3, p / 3 % 3, p / 9 };
                    const float *got = svo_pool_at(&pool, first + i, direction, point);
                    // Four roundings to half floats of 11 bits: one by the mean, three by the
                    // border passes.
                    for (int k = 0; k < 4; k++)
                        CHECK_NEAR((double)got[k], expected[i][p][k],
                                   2e-3 * fabs(expected[i][p][k]) + 1e-6);
                    most = fmax(most, expected[i][p][0]);
                }
        }
        free(expected);
    }
    CHECK(most > 0.0);
    free(pool.light);
    svo_tree_finish(&tree);
    vct_fixture_finish(&fixture);
}

// A point shared by several existing bricks has one value.
TEST_GPU(neighbours_have_equal_border_points)
{
    struct vct_fixture fixture;
    svo_fixture_room(&fixture, gpu, true);
    vct_fixture_open(&fixture, "storage=svo,resolution=48");
    fixture_render(&fixture.frame_fixture);
    struct svo_tree tree = svo_tree_of(&fixture);
    struct svo_pool pool = svo_pool_of(&fixture);
    const uint32_t leaves = tree.params.depths - 1;
    int shared = 0;
    for (uint32_t i = 0; i < tree.levels[leaves].count; i++) {
        const int brick = (int)(tree.levels[leaves].first + i);
        for (int axis = 0; axis < 3; axis++) {
            int next[3];
            svo_tree_node_coord(&tree, brick, next);
            next[axis]++;
            const int other = next[axis] < 1 << leaves ? svo_tree_find(&tree, next, leaves) : -1;
            if (other < 0) continue;
            int here[3] = { 1, 1, 1 }, there[3] = { 1, 1, 1 };
            here[axis] = 2;
            there[axis] = 0;
            for (int direction = 0; direction < pool.directions; direction++) {
                const float *a = svo_pool_at(&pool, brick, direction, here),
                            *b = svo_pool_at(&pool, other, direction, there);
                CHECK(memcmp(a, b, 4 * sizeof *a) == 0);
                shared += a[3] > 0.0f;
            }
        }
    }
    CHECK(shared > 100);
    free(pool.light);
    svo_tree_finish(&tree);
    vct_fixture_finish(&fixture);
}

// Sum of premultiplied radiance and opacity of one direction. The weight of a point is the part of
// its voxels inside the grid.
static void sum_of_leaves(const struct vct_fixture *fixture, int direction, double sum[4])
{
    struct svo_tree tree = svo_tree_of(fixture);
    struct svo_pool pool = svo_pool_of(fixture);
    const uint32_t leaves = tree.params.depths - 1;
    for (int k = 0; k < 4; k++) sum[k] = 0.0;
    for (uint32_t i = 0; i < tree.levels[leaves].count; i++)
        for (int p = 0; p < 27; p++) {
            const int brick = (int)(tree.levels[leaves].first + i),
                      point[3] = { p % 3, p / 3 % 3, p / 9 };
            int node[3];
            svo_tree_node_coord(&tree, brick, node);
            double weight = 1.0;
            for (int a = 0; a < 3; a++) {
                const int at = 2 * node[a] + point[a],
                          last = fixture->vct->clipmap.levels[0].grid.cells[a] / 2;
                if (point[a] == 2 && at < last) weight = 0.0; // counted in the next leaf, or empty
                if (a != direction / 2 && (at == 0 || at == last)) weight *= 0.5;
                if (at > last) weight = 0.0;
            }
            for (int k = 0; k < 4; k++)
                sum[k] += weight * (double)svo_pool_at(&pool, brick, direction, point)[k];
        }
    free(pool.light);
    svo_tree_finish(&tree);
}

static void sum_of_mip(const struct vct_fixture *fixture, int direction, double sum[4])
{
    float *light = vct_fixture_light(fixture, 0);
    const int dim = (int)vct_volume_dim(&fixture->vct->options);
    for (int k = 0; k < 4; k++) sum[k] = 0.0;
    for (int row = 0; row < dim * dim; row++)
        for (int x = 0; x < dim; x++)
            for (int k = 0; k < 4; k++)
                sum[k] += (double)light[4 * ((row * 6 + direction) * dim + x) + k];
    free(light);
}

// An empty room. No texel contains two walls behind each other: both storages have equal sums.
TEST_GPU(leaves_sum_to_the_finest_mip)
{
    double sums[2][6][4];
    for (int svo = 0; svo < 2; svo++) {
        struct vct_fixture fixture;
        svo_fixture_room(&fixture, gpu, false);
        vct_fixture_open(&fixture, svo ? "storage=svo,resolution=48,bounces=1"
                                       : "storage=mips,resolution=48,bounces=1");
        fixture_render(&fixture.frame_fixture);
        for (int direction = 0; direction < 6; direction++)
            (svo ? sum_of_leaves : sum_of_mip)(&fixture, direction, sums[svo][direction]);
        vct_fixture_finish(&fixture);
    }
    for (int direction = 0; direction < 6; direction++)
        for (int k = 0; k < 4; k++) {
            CHECK(sums[0][direction][k] > 10.0);
            CHECK_NEAR(sums[1][direction][k], sums[0][direction][k],
                       2e-3 * sums[0][direction][k]); // half floats
        }
}
