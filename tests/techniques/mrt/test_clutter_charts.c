// Charts of clutter in many small parts, as the leaves of plants.
#include "framework/test.h"

#include "techniques/mrt/objects/clutter.h"

#include "core/rng.h"

static const float ROOM_M = 4.0f, TEXELS_PER_EDGE = 10.0f;

static vec3s random_point(struct rng *rng, float size)
{
    return vec3_of(size * (rng_float(rng) - 0.5f), size * (rng_float(rng) - 0.5f),
                   size * (rng_float(rng) - 0.5f));
}

// Triangles of `size`, turned at random, all over the middle of a room.
static struct scene *leaves_of(int count, float size)
{
    struct rng rng = rng_for(7, 0, 0);
    const size_t corners = 3 * (size_t)count;
    vec3s *positions = host_alloc(test_host(), corners, sizeof *positions);
    uint32_t *indices = host_alloc(test_host(), corners, sizeof *indices);
    vec3s leaf = { 0 };
    for (size_t i = 0; i < corners; i++) {
        if (i % 3 == 0) leaf = random_point(&rng, 0.6f * ROOM_M);
        positions[i] = glms_vec3_add(leaf, random_point(&rng, size));
        indices[i] = (uint32_t)i;
    }
    const struct mesh mesh = { .positions = positions,
                               .vertex_count = (uint32_t)corners,
                               .indices = indices,
                               .index_count = (uint32_t)corners };
    struct scene *scene = scene_create(test_host(), "leaves");
    CHECK(scene && scene_add_mesh(scene, &mesh) == 0);
    const struct node node = node_default();
    const struct instance instance = { .node = scene_add_node(scene, &node), .skin = -1 };
    CHECK(scene_add_instance(scene, &instance) == 0);
    host_free(test_host(), positions);
    host_free(test_host(), indices);
    return scene;
}

static void find_leaves(int count, float size, struct mrt_clutter *out)
{
    const struct mrt_clutter_options options = { TEXELS_PER_EDGE, 32 };
    struct scene *scene = leaves_of(count, size);
    struct scene_pose pose;
    struct mrt_block_map map;
    assert_true(pose_init(&pose, scene, -1, 0.0f));
    assert_true(mrt_block_map_init(test_host(), "test", 1, &map));
    mrt_block_init(&map.blocks[0], "room", MRT_BLOCK_CUBE);
    const vec3s half = vec3_of(ROOM_M / 2, ROOM_M / 2, ROOM_M / 2);
    mrt_block_set_box(&map.blocks[0], (struct box3){ glms_vec3_negate(half), half });
    assert_true(mrt_clutter_init(out, test_host(), &pose, &map, &options));
    print_message("%d triangles: %u charts, %u texels, %u × %u, %d faces\n", count,
                  out->charts.count, out->charts.texel_count, out->charts.width, out->charts.height,
                  out->face_count);
    mrt_block_map_finish(&map);
    pose_finish(&pose);
    scene_destroy(scene);
}

static bool each_triangle_has_a_face(const struct mrt_clutter *clutter, int count)
{
    struct trace_hit hit = { .u = 0.3f, .v = 0.3f };
    for (hit.triangle = 0; hit.triangle < (uint32_t)count; hit.triangle++)
        if (mrt_face_of_hit(clutter, 0, &hit) < 0 || mrt_face_at(clutter, &hit) < 0) return false;
    return true;
}

TEST(many_small_parts_fit)
{
    struct mrt_clutter clutter;
    enum { COUNT = 8000 };
    find_leaves(COUNT, 0.05f, &clutter);
    CHECK(clutter.triangles == COUNT && !clutter.is_too_fine);
    CHECK(clutter.face_count == 32 && each_triangle_has_a_face(&clutter, COUNT));
    mrt_clutter_finish(&clutter);
}

// As many as a density gives, for a block alone.
TEST(large_parts_keep_the_density_of_walls)
{
    struct mrt_clutter clutter;
    find_leaves(4, 1.5f, &clutter);
    CHECK_NEAR(clutter.charts.texels_per_m, TEXELS_PER_EDGE / ROOM_M, 1e-4);
    mrt_clutter_finish(&clutter);
}

TEST(parts_without_end_have_no_light_map)
{
    struct mrt_clutter clutter;
    enum { COUNT = 50000 };
    find_leaves(COUNT, 0.3f, &clutter);
    CHECK(clutter.triangles == COUNT && clutter.is_too_fine);
    CHECK(clutter.face_count == 32 && each_triangle_has_a_face(&clutter, COUNT));
    mrt_clutter_finish(&clutter);
}
