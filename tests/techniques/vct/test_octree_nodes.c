// Nodes of the sparse voxel octree: equal to a plain C twin's, deterministic, and bounded by the
// capacity.
#include "techniques/vct/svo_tree.h"

#include "core/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- Twin: a node exists where the point of an occupied voxel is inside or on its border.

static bool *nodes_of_twin(const struct vct_fixture *fixture, const uint32_t *rest,
                           const uint32_t *moving, int depths, int depth)
{
    const int dim = 1 << depth, width = 2 << (depths - 1 - depth); // points over a node
    const int resolution = fixture->vct->options.resolution;
    bool *there = calloc((size_t)(dim * dim * dim), sizeof *there);
    for (int z = 0; z < resolution; z++)
        for (int y = 0; y < resolution; y++)
            for (int x = 0; x < resolution; x++) {
                if (!vct_fixture_occupied(fixture, rest, x, y, z) &&
                    !vct_fixture_occupied(fixture, moving, x, y, z))
                    continue;
                const int point[3] = { (x + 1) / 2, (y + 1) / 2, (z + 1) / 2 };
                for (int i = 0; i < 8; i++) {
                    int node[3];
                    bool inside = true;
                    for (int a = 0; a < 3; a++) {
                        node[a] = point[a] / width - (i >> a & 1);
                        // A point on the lower border belongs to the previous node too.
                        inside = inside && (!(i >> a & 1) || point[a] % width == 0) &&
                                 node[a] >= 0 &&
                                 4 * node[a] * (width / 2) <
                                     fixture->vct->clipmap.levels[0].grid.cells[a];
                    }
                    if (inside) there[(node[2] * dim + node[1]) * dim + node[0]] = true;
                }
            }
    return there;
}

static void check_nodes(const struct vct_fixture *fixture, const struct svo_tree *tree)
{
    uint32_t *rest = vct_fixture_mask(fixture, &fixture->vct->voxels.levels[0].static_set),
             *moving = vct_fixture_mask(fixture, &fixture->vct->voxels.levels[0].dynamic_set);
    uint32_t bricks = 0;
    for (uint32_t depth = 0; depth < tree->params.depths; depth++) {
        const int dim = 1 << depth;
        bool *there = nodes_of_twin(fixture, rest, moving, (int)tree->params.depths, (int)depth);
        uint32_t count = 0;
        for (int z = 0; z < dim; z++)
            for (int y = 0; y < dim; y++)
                for (int x = 0; x < dim; x++) {
                    const int node[3] = { x, y, z }, brick = svo_tree_find(tree, node, depth);
                    if ((brick >= 0) != there[(z * dim + y) * dim + x])
                        fail_msg("depth %u, node %d %d %d: brick %d", depth, x, y, z, brick);
                    if (brick < 0) continue;
                    count++;
                    int coord[3];
                    svo_tree_node_coord(tree, brick, coord);
                    CHECK(coord[0] == x && coord[1] == y && coord[2] == z);
                    CHECK((uint32_t)brick >= bricks); // bricks of one level are contiguous
                }
        CHECK(tree->levels[depth].first == bricks && tree->levels[depth].count == count);
        CHECK(tree->levels[depth].overflow == 0);
        bricks += count;
        free(there);
    }
    CHECK(bricks <= tree->params.bricks);
    free(rest);
    free(moving);
}

static int add_triangle(struct vct_fixture *fixture, struct rng *rng, float part)
{
    vec3s p[3];
    for (int i = 0; i < 3; i++)
        p[i] = vec3_of(11.3f * rng_float(rng), 8.1f * rng_float(rng), 9.7f * rng_float(rng));
    for (int i = 1; i < 3; i++) p[i] = glms_vec3_lerp(p[0], p[i], part);
    vec3s normals[3] = { vec3_of(0, 1, 0), vec3_of(0, 1, 0), vec3_of(0, 1, 0) };
    uint32_t indices[3] = { 0, 1, 2 };
    const int mesh = scene_add_mesh(
        fixture->frame_fixture.scene,
        &(struct mesh){ .name = "triangle",
                        .vertex_count = 3,
                        .index_count = 3,
                        .positions = p,
                        .normals = normals,
                        .indices = indices,
                        .material = fixture_matte(&fixture->frame_fixture, vec3_of(1, 1, 1)) });
    CHECK(mesh >= 0);
    return fixture_instance(&fixture->frame_fixture, mesh, NULL);
}

TEST_GPU(octree_nodes_match_the_twin)
{
    static const char *const options[] = { "storage=svo,resolution=16",
                                           "storage=svo,resolution=48" };
    for (int i = 0; i < 2; i++) {
        struct vct_fixture fixture;
        struct rng rng = rng_for(5, 0, 0);
        vct_fixture_init(&fixture, gpu);
        for (int k = 0; k < 9; k++) add_triangle(&fixture, &rng, k % 3 == 0 ? 0.7f : 0.1f);
        const int moves = add_triangle(&fixture, &rng, 0.2f);
        vct_fixture_open(&fixture, options[i]);
        fixture_render(&fixture.frame_fixture);
        struct svo_tree tree = svo_tree_of(&fixture);
        check_nodes(&fixture, &tree);
        svo_tree_finish(&tree);
        mat4s *world = &fixture.frame_fixture.pose
                            .world_from_node[fixture.frame_fixture.scene->instances[moves].node];
        *world = glms_translate(*world, vec3_of(0.5f, -0.3f, 1));
        fixture_render(&fixture.frame_fixture);
        fixture_render(&fixture.frame_fixture);
        tree = svo_tree_of(&fixture);
        check_nodes(&fixture, &tree);
        svo_tree_finish(&tree);
        vct_fixture_finish(&fixture);
    }
}

TEST_GPU(octree_construction_is_deterministic)
{
    struct vct_fixture fixture;
    struct rng rng = rng_for(6, 0, 0);
    vct_fixture_init(&fixture, gpu);
    for (int k = 0; k < 12; k++) add_triangle(&fixture, &rng, 0.5f);
    vct_fixture_open(&fixture, "storage=svo,resolution=48");
    fixture_render(&fixture.frame_fixture);
    struct svo_tree first = svo_tree_of(&fixture);
    vct_fixture_forget_voxels(&fixture);
    fixture_render(&fixture.frame_fixture);
    struct svo_tree second = svo_tree_of(&fixture);
    const uint32_t leaves = first.params.depths - 1;
    const uint32_t bricks = first.levels[leaves].first + first.levels[leaves].count;
    CHECK(bricks > 100);
    CHECK(memcmp(first.levels, second.levels, (leaves + 1) * sizeof *first.levels) == 0);
    CHECK(memcmp(first.brick_coords, second.brick_coords, bricks * sizeof(uint32_t)) == 0);
    CHECK(memcmp(first.nodes, second.nodes,
                 8 * (first.levels[leaves].first + 1) * sizeof(uint32_t)) == 0);
    svo_tree_finish(&first);
    svo_tree_finish(&second);
    vct_fixture_finish(&fixture);
}

// ---- Capacity

TEST_GPU(nodes_beyond_the_capacity_are_dropped_and_counted)
{
    static const uint32_t room[] = { 0, 1, 5, 100, 300 };
    for (int i = 0; i < 5; i++) {
        struct vct_fixture fixture;
        svo_fixture_room(&fixture, gpu, true);
        vct_fixture_open(&fixture, "storage=svo,resolution=48");
        fixture.vct->svo.params.bricks = room[i];
        fixture_render(&fixture.frame_fixture);
        vct_fixture_forget_voxels(&fixture);
        fixture_render(&fixture.frame_fixture);
        struct svo_tree tree = svo_tree_of(&fixture);
        uint32_t bricks = 0, overflow = 0;
        for (uint32_t depth = 0; depth < tree.params.depths; depth++) {
            const struct vct_svo_level *level = &tree.levels[depth];
            CHECK(level->first == bricks);
            bricks += level->count;
            overflow += level->overflow;
            // At least one group is dispatched, if only to find nothing to do.
            CHECK(level->texel_groups[0] >= 1 && level->side_groups[0] >= 1);
            CHECK(level->texel_groups[0] <= room[i] / 4 + 1);
            CHECK(level->side_groups[0] <= room[i] / 8 + 1);
            CHECK(level->node_groups[0] >= 1 && level->node_groups[0] <= room[i] / 256 + 1);
            CHECK(level->texel_groups[1] == 1 && level->side_groups[2] == 1);
        }
        CHECK(bricks <= room[i]);
        CHECK(overflow > 0);
        float *e = fixture_read(&fixture.frame_fixture, READ_IRRADIANCE);
        for (int k = 0; k < 32 * 32 * 3; k++) CHECK(isfinite(e[k]) && e[k] >= 0.0f);
        free(e);
        svo_tree_finish(&tree);
        vct_fixture_finish(&fixture);
    }
}
