// The light in the sparse voxel octree: bricks of every level against a plain C twin, what
// neighbours share, and that leaves have what the finest mip has.
#include "techniques/svo_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// One point of a node from its children, along one axis after the other: of each child that has it
// the point and its inner neighbour, doubled, and of two children the mean.
static void point_of_children(const struct svo_tree *tree, const struct svo_pool *pool, int brick,
                              uint32_t depth, int way, const int point[3], const int last[3],
                              double out[4])
{
    int node[3], parts = 0;
    svo_tree_place(tree, brick, node);
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
        const int axis = way / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
        double sum[4] = { 0 }, columns = 0.0;
        for (int j = 0; j < 4; j++) {
            int at[3] = { first[0], first[1], first[2] };
            at[b] += j & 1;
            at[c] += j >> 1;
            if (2 * child[b] + at[b] > last[b] || 2 * child[c] + at[c] > last[c]) continue;
            columns++;
            const float *low = svo_pool_at(pool, from, way, at);
            at[axis]++;
            const bool whole = 2 * child[axis] + at[axis] <= last[axis];
            static const float none[4] = { 0 };
            const float *high = whole ? svo_pool_at(pool, from, way, at) : none;
            const float *near = way % 2 == 0 ? low : high, *far = way % 2 == 0 ? high : low;
            const double before = (double)near[3], behind = (double)far[3];
            const double part = behind > 0.0 ? vct_rig_shown(1.0 - fmin(before, 1.0), behind,
                                                             fmin(before + behind, 1.0)) /
                                                   behind
                                             : 0.0;
            for (int k = 0; k < 4; k++) sum[k] += (double)near[k] + part * (double)far[k];
        }
        for (int k = 0; k < 4; k++) out[k] += sum[k] / columns;
    }
    for (int k = 0; k < 4 && parts > 0; k++) out[k] /= parts;
}

typedef double brick_values[27][4]; // of one way

// Neighbours along an axis take the mean of what they share.
static void join(const struct svo_tree *tree, uint32_t depth, int axis, brick_values *bricks)
{
    const int first = (int)tree->levels[depth].first, count = (int)tree->levels[depth].count;
    const int b = (axis + 1) % 3, c = (axis + 2) % 3, step[3] = { 1, 3, 9 };
    for (int i = 0; i < count; i++) {
        int next[3];
        svo_tree_place(tree, first + i, next);
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

TEST_GPU(bricks_of_each_level_are_those_of_the_twin)
{
    struct vct_rig rig;
    svo_furnish(&rig, gpu, true);
    vct_rig_open(&rig, "storage=svo,resolution=48");
    fixture_render(&rig.frame_fixture);
    struct svo_tree tree = svo_tree_of(&rig);
    struct svo_pool pool = svo_pool_of(&rig);
    double most = 0.0;
    for (uint32_t depth = 0; depth + 1 < tree.params.depths; depth++) {
        const int count = (int)tree.levels[depth].count, first = (int)tree.levels[depth].first;
        const int height = (int)(tree.params.depths - 2 - depth); // of the children
        int last[3];
        for (int a = 0; a < 3; a++)
            last[a] = (rig.vct->clips[0].grid.cells[a] / 2 + (1 << height) - 1) >> height;
        brick_values *expected = calloc((size_t)count, sizeof *expected);
        for (int way = 0; way < pool.directions; way++) {
            for (int i = 0; i < count; i++)
                for (int p = 0; p < 27; p++) {
                    const int point[3] = { p % 3, p / 3 % 3, p / 9 };
                    point_of_children(&tree, &pool, first + i, depth, way, point, last,
                                      expected[i][p]);
                }
            for (int axis = 0; axis < 3; axis++) join(&tree, depth, axis, expected);
            for (int i = 0; i < count; i++)
                for (int p = 0; p < 27; p++) {
                    const int point[3] = { p % 3, p / 3 % 3, p / 9 };
                    const float *got = svo_pool_at(&pool, first + i, way, point);
                    // Four roundings to half floats of 11 bits: the mean's, and those of joining.
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
    vct_rig_finish(&rig);
}

// Points that lie in several bricks have one value where all of these are there.
TEST_GPU(neighbours_agree_on_what_they_share)
{
    struct vct_rig rig;
    svo_furnish(&rig, gpu, true);
    vct_rig_open(&rig, "storage=svo,resolution=48");
    fixture_render(&rig.frame_fixture);
    struct svo_tree tree = svo_tree_of(&rig);
    struct svo_pool pool = svo_pool_of(&rig);
    const uint32_t leaves = tree.params.depths - 1;
    int shared = 0;
    for (uint32_t i = 0; i < tree.levels[leaves].count; i++) {
        const int brick = (int)(tree.levels[leaves].first + i);
        for (int axis = 0; axis < 3; axis++) {
            int next[3];
            svo_tree_place(&tree, brick, next);
            next[axis]++;
            const int other = next[axis] < 1 << leaves ? svo_tree_find(&tree, next, leaves) : -1;
            if (other < 0) continue;
            int here[3] = { 1, 1, 1 }, there[3] = { 1, 1, 1 };
            here[axis] = 2;
            there[axis] = 0;
            for (int way = 0; way < pool.directions; way++) {
                const float *a = svo_pool_at(&pool, brick, way, here),
                            *b = svo_pool_at(&pool, other, way, there);
                CHECK(memcmp(a, b, 4 * sizeof *a) == 0);
                shared += a[3] > 0.0f;
            }
        }
    }
    CHECK(shared > 100);
    free(pool.light);
    svo_tree_finish(&tree);
    vct_rig_finish(&rig);
}

// Σ of what is seen along a way, where each point counts for the part of its voxels that lies in
// the grid.
static void sum_of_leaves(const struct vct_rig *rig, int way, double sum[4])
{
    struct svo_tree tree = svo_tree_of(rig);
    struct svo_pool pool = svo_pool_of(rig);
    const uint32_t leaves = tree.params.depths - 1;
    for (int k = 0; k < 4; k++) sum[k] = 0.0;
    for (uint32_t i = 0; i < tree.levels[leaves].count; i++)
        for (int p = 0; p < 27; p++) {
            const int brick = (int)(tree.levels[leaves].first + i),
                      point[3] = { p % 3, p / 3 % 3, p / 9 };
            int node[3];
            svo_tree_place(&tree, brick, node);
            double weight = 1.0;
            for (int a = 0; a < 3; a++) {
                const int at = 2 * node[a] + point[a], last = rig->vct->clips[0].grid.cells[a] / 2;
                if (point[a] == 2 && at < last)
                    weight = 0.0; // the next leaf has it, or nothing is there
                if (a != way / 2 && (at == 0 || at == last)) weight *= 0.5;
                if (at > last) weight = 0.0;
            }
            for (int k = 0; k < 4; k++)
                sum[k] += weight * (double)svo_pool_at(&pool, brick, way, point)[k];
        }
    free(pool.light);
    svo_tree_finish(&tree);
}

static void sum_of_mip(const struct vct_rig *rig, int way, double sum[4])
{
    float *light = vct_rig_light(rig, 0);
    const int dim = (int)vct_volume_dim(&rig->vct->options);
    for (int k = 0; k < 4; k++) sum[k] = 0.0;
    for (int row = 0; row < dim * dim; row++)
        for (int x = 0; x < dim; x++)
            for (int k = 0; k < 4; k++)
                sum[k] += (double)light[4 * ((row * 6 + way) * dim + x) + k];
    free(light);
}

// An empty room, of whose walls no two are behind each other in one texel: they show the same.
TEST_GPU(leaves_have_the_light_of_the_finest_mip)
{
    double sums[2][6][4];
    for (int svo = 0; svo < 2; svo++) {
        struct vct_rig rig;
        svo_furnish(&rig, gpu, false);
        vct_rig_open(&rig, svo ? "storage=svo,resolution=48,bounces=1"
                               : "storage=mips,resolution=48,bounces=1");
        fixture_render(&rig.frame_fixture);
        for (int way = 0; way < 6; way++)
            (svo ? sum_of_leaves : sum_of_mip)(&rig, way, sums[svo][way]);
        vct_rig_finish(&rig);
    }
    for (int way = 0; way < 6; way++)
        for (int k = 0; k < 4; k++) {
            CHECK(sums[0][way][k] > 10.0);
            CHECK_NEAR(sums[1][way][k], sums[0][way][k], 2e-3 * sums[0][way][k]); // half floats
        }
}
