// Block maps that are made from scenes without one.
#include "framework/test.h"

#include "techniques/mrt/level/map/make_map.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct made {
    struct scene *scene;
    struct scene_pose pose;
    struct mrt_block_map map;
};

static struct made make_auto(const char *spec)
{
    struct made made = { .scene = scene_load(test_host(), spec) };
    CHECK(made.scene && pose_init(&made.pose, made.scene, -1, 0.0f));
    vec3s seeds[8];
    size_t count = 0;
    for (int i = 0; i < made.scene->camera_count && count < 8; i++)
        seeds[count++] = pose_camera(&made.pose, i).eye;
    CHECK(mrt_map_auto(test_host(), &made.pose, seeds, count, &made.map));
    return made;
}

static void finish(struct made *made)
{
    mrt_block_map_finish(&made->map);
    pose_finish(&made->pose);
    scene_destroy(made->scene);
}

static int connections(const struct mrt_block_map *map)
{
    int count = 0;
    for (int b = 0; b < map->count; b++)
        for (int f = 0; f < CUBE_FACES; f++) count += map->blocks[b].neighbor[f].block >= 0;
    return count / 2;
}

static void print_map(const char *spec, const struct mrt_block_map *map)
{
    print_message("%s: %d blocks, %d connections\n", spec, map->count, connections(map));
    for (int b = 0; b < map->count; b++) {
        vec3s low = map->blocks[b].corner[0], high = map->blocks[b].corner[7];
        print_message("  %6.2f %6.2f %6.2f  to %6.2f %6.2f %6.2f, open %02x\n", (double)low.x,
                      (double)low.y, (double)low.z, (double)high.x, (double)high.y, (double)high.z,
                      map->blocks[b].open);
    }
}

// The surface of a box, as seen from inside or from outside.
static void add_box(struct scene *scene, vec3s low, vec3s high, bool inwards)
{
    static const uint32_t seen_inside[] = { 0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                            2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3 };
    uint32_t indices[36];
    vec3s positions[8], normals[8];
    for (int i = 0; i < 36; i++) indices[i] = seen_inside[inwards ? i : 35 - i];
    for (int i = 0; i < 8; i++) {
        const vec3s corner = vec3_of((float)(i & 1), (float)(i >> 1 & 1), (float)(i >> 2));
        positions[i] = glms_vec3_muladd(corner, glms_vec3_sub(high, low), low);
        normals[i] = vec3_unit(glms_vec3_sub(vec3_of(0.5f, 0.5f, 0.5f), corner));
        if (!inwards) normals[i] = glms_vec3_negate(normals[i]);
    }
    const struct material material = material_default();
    const struct node node = node_default();
    const struct mesh mesh = { .vertex_count = 8,
                               .index_count = 36,
                               .positions = positions,
                               .normals = normals,
                               .indices = indices,
                               .material = scene_add_material(scene, &material) };
    const struct instance it = { .node = scene_add_node(scene, &node),
                                 .mesh = scene_add_mesh(scene, &mesh),
                                 .skin = -1 };
    CHECK(scene_add_instance(scene, &it) >= 0);
}

// The inside of a box around the origin.
static struct scene *make_box(vec3s half)
{
    struct scene *scene = scene_create(test_host(), "box");
    add_box(scene, glms_vec3_negate(half), half, true);
    return scene;
}

// A cube of 3 m in walls of 20 cm, with a wardrobe near a wall, a sofa and a table.
static struct scene *make_furnished_room(void)
{
    static const struct box3 solids[] = {
        { { { -1.7f, -1.7f, -1.7f } }, { { 1.7f, -1.5f, 1.7f } } },
        { { { -1.7f, 1.5f, -1.7f } }, { { 1.7f, 1.7f, 1.7f } } },
        { { { -1.7f, -1.5f, -1.7f } }, { { -1.5f, 1.5f, 1.7f } } },
        { { { 1.5f, -1.5f, -1.7f } }, { { 1.7f, 1.5f, 1.7f } } },
        { { { -1.5f, -1.5f, -1.7f } }, { { 1.5f, 1.5f, -1.5f } } },
        { { { -1.5f, -1.5f, 1.5f } }, { { 1.5f, 1.5f, 1.7f } } },
        { { { -1.45f, -1.5f, -1 } }, { { -0.9f, 0.6f, 0.3f } } },
        { { { 0.7f, -1.4f, -1 } }, { { 1.4f, -1, 1 } } },
        { { { 1.2f, -1, -1 } }, { { 1.4f, -0.6f, 1 } } },
        { { { -0.6f, -0.8f, -0.4f } }, { { 0.5f, -0.75f, 0.4f } } },
    };
    struct scene *scene = scene_create(test_host(), "furnished");
    for (size_t i = 0; i < sizeof solids / sizeof solids[0]; i++)
        add_box(scene, solids[i].min, solids[i].max, false);
    return scene;
}

TEST(a_single_block_is_the_bounding_box)
{
    struct made made = { .scene = scene_load(test_host(), "@atrium") };
    CHECK(made.scene && pose_init(&made.pose, made.scene, -1, 0.0f));
    CHECK(mrt_map_single(test_host(), &made.pose, &made.map));
    CHECK(made.map.count == 1 && made.map.blocks[0].open == 0);
    CHECK(glms_vec3_distance(made.map.blocks[0].corner[0], made.pose.bounds.min) == 0.0f);
    CHECK(glms_vec3_distance(made.map.blocks[0].corner[7], made.pose.bounds.max) == 0.0f);
    finish(&made);
}

TEST(a_room_is_one_block_that_ends_at_its_walls)
{
    struct made made = make_auto("@cornell");
    print_map("@cornell", &made.map);
    CHECK_NEAR(made.map.blocks[0].corner[0].y, 0, 1e-4);
    CHECK(made.map.count == 1);
    finish(&made);
}

// A box hides other points of the floor, whose mean is rounded otherwise.
TEST(a_room_is_the_same_block_wherever_an_object_stands)
{
    const vec3s seed = vec3_of(0, 4, 0);
    struct mrt_block_map first = { 0 };
    for (int i = 0; i < 8; i++) {
        struct made made = { .scene = scene_load(test_host(), "@cornell") };
        CHECK(made.scene && made.scene->instance_count > 5);
        struct node *box = &made.scene->nodes[made.scene->instances[5].node];
        box->translation = vec3_of(0.4f * (float)(i & 3), 0.01f * (float)(i >> 2), 0);
        CHECK(pose_init(&made.pose, made.scene, -1, 0.0f));
        CHECK(mrt_map_auto(test_host(), &made.pose, &seed, 1, &made.map));
        CHECK(made.map.count == 1 && !made.map.is_single);
        if (i == 0) first = made.map;
        for (int c = 0; c < MRT_CORNERS; c++)
            CHECK(glms_vec3_distance(made.map.blocks[0].corner[c], first.blocks[0].corner[c]) == 0);
        if (i == 0) made.map = (struct mrt_block_map){ 0 };
        finish(&made);
    }
    mrt_block_map_finish(&first);
}

// The two sides of each wall, a table and a wardrobe beside a wall have large surfaces.
TEST(a_furnished_room_between_thick_walls_ends_at_them)
{
    const vec3s seed = vec3_of(0, 0.5f, 0.8f);
    struct made made = { .scene = make_furnished_room() };
    CHECK(pose_init(&made.pose, made.scene, -1, 0.0f));
    CHECK(mrt_map_auto(test_host(), &made.pose, &seed, 1, &made.map));
    print_map("furnished", &made.map);
    CHECK(made.map.count == 1);
    for (int a = 0; a < 3; a++) {
        CHECK_NEAR(made.map.blocks[0].corner[0].raw[a], -1.5, 1e-4);
        CHECK_NEAR(made.map.blocks[0].corner[7].raw[a], 1.5, 1e-4);
    }
    finish(&made);
}

TEST(crossing_corridors_are_blocks_about_their_crossing)
{
    struct made made = make_auto("@corridor");
    print_map("@corridor", &made.map);
    CHECK(connections(&made.map) == made.map.count - 1);
    finish(&made);
}

// Blocks of `map` that contain a point.
static int containing(const struct mrt_block_map *map, vec3s p)
{
    int count = 0;
    for (int b = 0; b < map->count; b++) {
        vec3s cell;
        if (!mrt_warp_inverse(map->blocks[b].corner, p, &cell)) continue;
        count += glms_vec3_max(glms_vec3_abs(cell)) <= 0.5f;
    }
    return count;
}

static float volume_of(const struct mrt_block_map *map)
{
    float volume = 0.0f;
    for (int b = 0; b < map->count; b++)
        volume += glms_mat3_det(mrt_warp_jacobian(map->blocks[b].corner, GLMS_VEC3_ZERO));
    return volume;
}

// Cubes in a row may become one block.
TEST(a_maze_is_found_again_from_its_walls)
{
    for (int blocks = 2; blocks <= 20; blocks += 3) {
        char spec[64];
        snprintf(spec, sizeof spec, "@maze:blocks=%d", blocks);
        struct made made = make_auto(spec);
        struct mrt_block_map known;
        CHECK(mrt_block_map_of_scene(test_host(), made.scene, &known));
        print_map(spec, &made.map);
        for (int b = 0; b < known.count; b++)
            CHECK(containing(&made.map, mrt_warp_point(known.blocks[b].corner, GLMS_VEC3_ZERO)) ==
                  1);
        CHECK(connections(&made.map) == made.map.count - 1);
        // Edges are 3 m with the halves of the walls, 2.76 m without.
        CHECK(volume_of(&made.map) > 2.76f * 2.76f * 2.76f * (float)blocks);
        CHECK(volume_of(&made.map) < 3.0f * 2.76f * 3.0f * (float)blocks);
        mrt_block_map_finish(&known);
        finish(&made);
    }
}

TEST(an_atrium_is_a_few_connected_blocks)
{
    struct made made = make_auto("@atrium");
    print_map("@atrium", &made.map);
    CHECK(made.map.count >= 1 && made.map.count <= 100);
    CHECK(connections(&made.map) >= made.map.count - 1);
    finish(&made);
}

static struct made make_from(const char *spec, vec3s seed)
{
    struct made made = { .scene = scene_load(test_host(), spec) };
    CHECK(made.scene && pose_init(&made.pose, made.scene, -1, 0.0f));
    CHECK(mrt_map_auto(test_host(), &made.pose, &seed, 1, &made.map));
    return made;
}

TEST(without_a_seed_in_a_room_the_default_camera_is_one)
{
    struct made made = make_auto("@maze"), far = make_from("@maze", vec3_of(1000, 0, 0));
    CHECK(far.map.count == made.map.count && far.map.count > 1);
    finish(&far);
    finish(&made);
}

// As long as the limits of a scene allow: an int would not count its cubes.
TEST(a_room_longer_than_an_int_of_cubes_is_divided)
{
    const vec3s inside = vec3_of(0, 0, 0);
    struct made made = { .scene = make_box(vec3_of(5e7f, 1e-3f, 1e-3f)) };
    CHECK(pose_init(&made.pose, made.scene, -1, 0.0f));
    CHECK(mrt_map_auto(test_host(), &made.pose, &inside, 1, &made.map));
    print_map("box", &made.map);
    CHECK(made.map.count > 1 && connections(&made.map) == made.map.count - 1);
    finish(&made);
}

TEST(a_scene_without_a_room_is_a_single_block)
{
    struct made made = make_from("@spheres", vec3_of(1000, 0, 0));
    CHECK(made.map.count == 1 && made.map.blocks[0].open == 0);
    CHECK(glms_vec3_distance(made.map.blocks[0].corner[7], made.pose.bounds.max) == 0.0f);
    finish(&made);
}
