// Holes in walls between blocks: where they are, their files, and what passes them.
#include "framework/test.h"
#include "techniques/mrt/mrt_map_fixture.h"

#include "techniques/mrt/level/map/make_map.h"

#include <stdio.h>
#include <string.h>

static struct mrt_holes numbered(void)
{
    struct mrt_holes holes;
    for (int p = 0; p < MRT_HOLE_PARTS; p++) holes.share[p] = (float)(p + 1) / MRT_HOLE_PARTS;
    return holes;
}

static vec3s middle_of_part(const struct mrt_block *block, int face, int part)
{
    const float s = ((float)(part % MRT_HOLES) + 0.5f) / MRT_HOLES;
    const float t = ((float)(part / MRT_HOLES) + 0.5f) / MRT_HOLES;
    return mrt_warp_point(block->corner, cube_face_point(face, s, t));
}

static float share_at(const struct mrt_block *block, int face, vec3s world)
{
    vec3s cell;
    CHECK(mrt_warp_inverse(block->corner, world, &cell));
    const vec3s at = glms_mat3_mulv(glms_mat3_transpose(cube_from_face(face)), cell);
    return mrt_block_hole_at(block, face, at.x + 0.5f, at.y + 0.5f);
}

TEST(both_blocks_have_the_same_holes_however_they_are_turned)
{
    const struct mrt_holes holes = numbered();
    for (int turn = 0; turn < MRT_ORIENTATIONS; turn++) {
        struct mrt_block_map map;
        assert_true(mrt_block_map_init(test_host(), "test", 2, &map));
        struct mrt_block *a = &map.blocks[0], *b = &map.blocks[1];
        mrt_block_init(a, "a", MRT_BLOCK_CUBE);
        mrt_block_init(b, "b", MRT_BLOCK_CUBE);
        mrt_block_set_box(a, (struct box3){ vec3_of(0, 0, 0), vec3_of(1, 1, 1) });
        mrt_block_set_box(b, (struct box3){ vec3_of(1, 0, 0), vec3_of(2, 1, 1) });
        mrt_turn_block(b, turn);
        const int other = mrt_meeting_face(a, CUBE_RIGHT, b);
        assert_true(other >= 0 &&
                    mrt_connect_by_holes("test", &map, 0, CUBE_RIGHT, 1, other, &holes));
        CHECK(mrt_block_has_holes(a, CUBE_RIGHT) && mrt_block_has_holes(b, other));
        CHECK(mrt_block_beyond(a, CUBE_RIGHT) < 0 && a->open == 0 && b->open == 0);
        for (int p = 0; p < MRT_HOLE_PARTS; p++)
            CHECK(share_at(b, other, middle_of_part(a, CUBE_RIGHT, p)) == holes.share[p]);
        mrt_disconnect(&map, 1, other);
        CHECK(!mrt_block_has_holes(a, CUBE_RIGHT) && !mrt_block_has_holes(b, other));
        CHECK(mrt_block_hole_at(a, CUBE_RIGHT, 0.9f, 0.9f) == 0.0f);
        mrt_block_map_finish(&map);
    }
}

// ---- files

static bool parse(const char *holes, const char *holes_of_b, struct mrt_block_map *map)
{
    char text[1024];
    const int length = snprintf(
        text, sizeof text,
        "{\"afterglow_block_map\":1,\"blocks\":[{\"name\":\"a\",\"box\":[[0,0,0],[1,1,1]],"
        "\"neighbors\":{\"+x\":\"b\"},\"holes\":%s},{\"name\":\"b\",\"box\":[[1,0,0],[2,1,1]],"
        "\"neighbors\":{\"-x\":\"a\"},\"holes\":%s}]}",
        holes, holes_of_b);
    test_forget_messages();
    return mrt_block_map_parse(test_host(), "test", text, (size_t)length, map);
}

#define QUARTER "[0,0.5,0,0,0,0.5,0,0,0,0.25,0,0,0,0,0,0]"

TEST(holes_are_written_as_they_are_read)
{
    struct mrt_block_map map, again;
    assert_true(parse("{\"+x\":" QUARTER "}", "{}", &map));
    CHECK(map.blocks[0].holes[CUBE_RIGHT].share[9] == 0.25f);
    char *text = mrt_block_map_json(test_host(), &map);
    assert_true(text && mrt_block_map_parse(test_host(), "again", text, strlen(text), &again));
    for (int b = 0; b < 2; b++)
        CHECK(memcmp(map.blocks[b].holes, again.blocks[b].holes, sizeof map.blocks[b].holes) == 0);
    CHECK(again.blocks[0].open == 0 && again.blocks[1].open == 0);
    host_free(test_host(), text);
    mrt_block_map_finish(&again);
    mrt_block_map_finish(&map);
}

TEST(wrong_holes_are_refused)
{
    static const struct {
        const char *holes, *holes_of_b, *message;
    } cases[] = {
        { "[]", "{}", "holes is not an object" },
        { "{\"+x\":[1,1]}", "{}", "16 numbers from 0 to 1" },
        { "{\"+x\":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]}", "{}", "some above 0" },
        { "{\"+x\":[2,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]}", "{}", "16 numbers from 0 to 1" },
        { "{\"+x\":[\"1\",0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]}", "{}", "16 numbers from 0 to 1" },
        { "{\"-x\":" QUARTER "}", "{}", "holes of a face without neighbor" },
        { "{\"+x\":" QUARTER "}", "{\"-x\":" QUARTER "}", "differ from those of block a" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct mrt_block_map map;
        CHECK(!parse(cases[i].holes, cases[i].holes_of_b, &map));
        if (!strstr(test_last_message(), cases[i].message)) print_message("%s\n", cases[i].holes);
        CHECK(strstr(test_last_message(), cases[i].message));
    }
}

// ---- maps that are found

static void add_box(struct scene *scene, vec3s low, vec3s high)
{
    static const uint32_t faces[] = { 0, 3, 1, 0, 2, 3, 4, 7, 6, 4, 5, 7, 0, 5, 4, 0, 1, 5,
                                      2, 7, 3, 2, 6, 7, 0, 6, 2, 0, 4, 6, 1, 7, 5, 1, 3, 7 };
    uint32_t indices[36];
    vec3s positions[8];
    memcpy(indices, faces, sizeof faces);
    for (int i = 0; i < 8; i++)
        positions[i] =
            vec3_of(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    const struct node node = node_default();
    const struct mesh mesh = {
        .vertex_count = 8, .index_count = 36, .positions = positions, .indices = indices
    };
    const struct instance it = { .node = scene_add_node(scene, &node),
                                 .mesh = scene_add_mesh(scene, &mesh),
                                 .skin = -1 };
    CHECK(scene_add_instance(scene, &it) >= 0);
}

// Two rooms of 4 × 3 × 4, less half of the wall between them, which has a door.
struct door {
    float width, height, thickness;
};

static struct scene *two_rooms(struct door door)
{
    const float t = 0.1f, w = door.width / 2, h = door.thickness / 2, height = door.height;
    struct scene *scene = scene_create(test_host(), "rooms");
    const struct material material = material_default();
    CHECK(scene_add_material(scene, &material) == 0);
    add_box(scene, vec3_of(-4 - t, -t, -2 - t), vec3_of(4 + t, 0, 2 + t));
    add_box(scene, vec3_of(-4 - t, 3, -2 - t), vec3_of(4 + t, 3 + t, 2 + t));
    add_box(scene, vec3_of(-4 - t, 0, -2 - t), vec3_of(-4, 3, 2 + t));
    add_box(scene, vec3_of(4, 0, -2 - t), vec3_of(4 + t, 3, 2 + t));
    add_box(scene, vec3_of(-4, 0, -2 - t), vec3_of(4, 3, -2));
    add_box(scene, vec3_of(-4, 0, 2), vec3_of(4, 3, 2 + t));
    add_box(scene, vec3_of(-h, 0, -2), vec3_of(h, 3, -w));
    add_box(scene, vec3_of(-h, 0, w), vec3_of(h, 3, 2));
    if (height < 3) add_box(scene, vec3_of(-h, height, -w), vec3_of(h, 3, w));
    return scene;
}

// The open share of the wall between the two blocks; 0: not connected, 1: a whole opening.
static float open_share(struct door door)
{
    struct scene *scene = two_rooms(door);
    struct scene_pose pose;
    struct mrt_block_map map;
    const vec3s seed = vec3_of(-2, 1.5f, 0);
    float share = 0.0f;
    assert_true(pose_init(&pose, scene, -1, 0.0f));
    assert_true(mrt_map_auto(test_host(), &pose, &seed, 1, &map));
    for (int f = 0; f < CUBE_FACES; f++) {
        const struct mrt_block *block = &map.blocks[0];
        if (mrt_block_beyond(block, f) >= 0) share = 1.0f;
        for (int p = 0; p < MRT_HOLE_PARTS && mrt_block_has_holes(block, f); p++)
            share += block->holes[f].share[p] / MRT_HOLE_PARTS;
    }
    print_message("door of %g × %g m in a wall of %g: %d blocks, %.3f open\n", (double)door.width,
                  (double)door.height, (double)door.thickness, map.count, (double)share);
    CHECK(map.count == (share > 0.0f ? 2 : 1));
    mrt_block_map_finish(&map);
    pose_finish(&pose);
    scene_destroy(scene);
    return share;
}

TEST(a_door_is_a_hole_of_its_size)
{
    CHECK_NEAR(open_share((struct door){ 1, 2.1f, 0.1f }), 2.1 / 12, 0.01);
    CHECK_NEAR(open_share((struct door){ 2.4f, 2.2f, 0.1f }), 5.28 / 12, 0.01);
    CHECK(open_share((struct door){ 3, 2.8f, 0.1f }) == 1.0f);
    CHECK(open_share((struct door){ 0.05f, 2, 0.1f }) == 0.0f);
}

// Its two sides are planes of their own.
TEST(a_door_in_a_thick_wall_joins_its_rooms)
{
    CHECK_NEAR(open_share((struct door){ 1, 2.1f, 0.3f }), 2.1 / 12, 0.01);
    CHECK_NEAR(open_share((struct door){ 1, 2.1f, 0.6f }), 2.1 / 12, 0.01);
}
