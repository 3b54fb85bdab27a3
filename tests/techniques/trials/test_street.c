// Light in houses that are small in their scene.
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#include "techniques/mrt/level/map/make_map.h"

#include <math.h>
#include <stdlib.h>

#define DICTIONARY TRIAL_DICTIONARY(16, 32, 32)

static struct box3 box_of(const struct mrt_block *block)
{
    return (struct box3){ block->corner[0], block->corner[MRT_CORNERS - 1] };
}

static bool contains(struct box3 box, vec3s p)
{
    return box3_intersects(box, (struct box3){ p, p });
}

// The box around all blocks whose middle is in the room.
static struct box3 found_room(const struct mrt_block_map *map, struct box3 room)
{
    struct box3 found = box3_empty();
    for (int b = 0; b < map->count; b++)
        if (contains(room, box3_centre(box_of(&map->blocks[b]))))
            found = box3_union(found, box_of(&map->blocks[b]));
    return found;
}

// Blocks end in the walls, and are nowhere else.
TEST_GPU(blocks_of_houses_are_their_rooms)
{
    struct frame_fixture s;
    struct scene_pose pose;
    struct mrt_block_map map;
    trial_street(&s, gpu, TRIAL_STREET_SMALL);
    const vec3s outdoors =
        pose_init(&pose, s.scene, -1, 0.0f) ? pose_camera(&pose, 0).eye : vec3_of(0, 0, 0);
    assert_true(mrt_map_auto(test_host(), &pose, &outdoors, 1, &map));
    for (int r = 0; r < TRIAL_STREET_ROOMS; r++) {
        const struct box3 room = trial_street_rooms[r], found = found_room(&map, room);
        CHECK(glms_vec3_max(glms_vec3_abs(glms_vec3_sub(found.min, room.min))) < 0.2f);
        CHECK(glms_vec3_max(glms_vec3_abs(glms_vec3_sub(found.max, room.max))) < 0.2f);
    }
    for (int b = 0; b < map.count; b++) {
        int rooms = 0;
        for (int r = 0; r < TRIAL_STREET_ROOMS; r++)
            rooms += contains(trial_street_rooms[r], box3_centre(box_of(&map.blocks[b])));
        CHECK(rooms == 1);
    }
    mrt_block_map_finish(&map);
    pose_finish(&pose);
    fixture_finish(&s);
}

static void check_room(struct gpu *gpu, enum trial_street_room room, const char *gi)
{
    struct frame_fixture s;
    trial_street(&s, gpu, room);
    const double expected = trial_reference(&s, -1, 1024).mean[1];
    fixture_finish(&s);
    trial_street(&s, gpu, room);
    const double found = trial_technique(&s, gi).mean[1];
    fixture_finish(&s);
    print_message("%s: room %d: %.3f of the reference's %.3f lux\n", gi, (int)room,
                  found / expected, expected);
    CHECK(found >= 0.8 * expected && found <= 1.2 * expected);
}

// A fifth, as by the window of a single house.
TEST_GPU(light_of_sunlit_ground_enters_small_houses)
{
    check_room(gpu, TRIAL_STREET_SMALL, "mrt" DICTIONARY);
    check_room(gpu, TRIAL_STREET_LARGE, "mrt" DICTIONARY);
    check_room(gpu, TRIAL_STREET_BACK, "mrt" DICTIONARY);
    check_room(gpu, TRIAL_STREET_FRONT, "drt" DICTIONARY);
}

enum { SIZE = 48, REACH = 9 }; // of pixels of 5 cm

// The side of a wall of the small house, 20 cm thick, that is towards or away from the room: 2.4 m
// of it fill the image.
static void open_wall(struct frame_fixture *s, struct gpu *gpu, bool outer)
{
    const float wall = trial_street_rooms[TRIAL_STREET_SMALL].min.x, way = outer ? -4.0f : 3.4f;
    trial_street(s, gpu, TRIAL_STREET_SMALL);
    s->width = s->height = SIZE;
    fixture_look(s, vec3_of(wall + way, 1.4f, 0), vec3_of(wall, 1.4f, 0));
    s->input.camera.vertical_fov_rad = 2 * atanf(1.2f / 3.4f);
}

// Light changes slowly along the wall opposite to the window.
TEST_GPU(light_of_sunlit_ground_is_even_on_a_wall)
{
    struct frame_fixture s;
    open_wall(&s, gpu, false);
    float *e = trial_pixels(&s, "mrt" DICTIONARY);
    const double mottle = trial_mottle(e, SIZE, REACH);
    print_message("a wall opposite to a window: deviation %.4f\n", mottle);
    CHECK(mottle < 0.02);
    free(e);
    fixture_finish(&s);
}

// Sunlit ground lights it, which the room behind it hardly sees.
TEST_GPU(the_outer_side_of_a_thin_wall_has_light_of_the_outdoors)
{
    struct frame_fixture s;
    open_wall(&s, gpu, true);
    const double expected = trial_reference(&s, -1, 64).mean[1];
    fixture_finish(&s);
    open_wall(&s, gpu, true);
    const double found = trial_technique(&s, "mrt" DICTIONARY).mean[1];
    fixture_finish(&s);
    print_message("the outer side of a wall: %.3f of the reference's %.1f lux\n", found / expected,
                  expected);
    CHECK(found >= 0.8 * expected && found <= 1.2 * expected);
}

// The sun has 20000 lux.
TEST_GPU(a_closed_house_in_the_sun_stays_dark)
{
    struct frame_fixture s;
    trial_street(&s, gpu, TRIAL_STREET_DARK);
    CHECK(trial_technique(&s, "mrt" DICTIONARY).mean[1] < 1e-3);
    fixture_finish(&s);
}
