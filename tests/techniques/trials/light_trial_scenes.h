// Scenes of the physical trials. Each initializes the fixture, which trial_technique or
// trial_reference opens and fixture_finish ends. Lengths in metres.
#pragma once

#include "frame/frame_fixture.h"

// Two rooms of 4 × 3 × 4, side by side, of slabs 0.05 thick. The left one is open to the sun of
// 1000 lux above, the right one is closed. The camera is in one of them. The scene has a camera in
// each, where mrt begins to find blocks.
void trial_two_rooms(struct frame_fixture *s, struct gpu *gpu, bool camera_in_dark_room);

// Two rooms of 4 × 3 × 4 (albedo 0.7), side by side, of slabs 0.05 thick, joined by a door of
// 1 × 2.1. A point light is in the left one; the camera is in the right one and sees none of its
// direct light: `back` towards the wall with the door, else away from it.
void trial_door(struct frame_fixture *s, struct gpu *gpu, bool back);

// A room of 4 × 2.8 × 4 (albedo 0.7) of walls 0.2 thick on a ground of 40 × 40 (albedo 0.4) in the
// sun of 20000 lux, which comes along the wall with the window of 1.6 × 1.2: all light in the room
// is what ground and reveals reflect. The camera is in the room, towards the wall with the window
// or away from it.
void trial_window(struct frame_fixture *s, struct gpu *gpu, bool towards_window);

// A ground of 40 × 40 in the sun of 20000 lux with a tower of 12 and four houses, small in it:
// walls 0.2 thick, albedo 0.7. A small one, a large one and one of two rooms, of which a door joins
// the back one to the front one, have windows along which the sun comes; one is closed. The camera
// is in a room, and looks away from the window or the door; the scene's own is outdoors.
enum trial_street_room {
    TRIAL_STREET_SMALL,
    TRIAL_STREET_LARGE,
    TRIAL_STREET_DARK,
    TRIAL_STREET_BACK,
    TRIAL_STREET_FRONT,
    TRIAL_STREET_ROOMS
};
extern const struct box3 trial_street_rooms[TRIAL_STREET_ROOMS];
void trial_street(struct frame_fixture *s, struct gpu *gpu, enum trial_street_room room);

// A scene without a room: a box of 2 (albedo 0.7) in a sun of 1000 lux, 45° high, and a sky of
// 100 cd/m², on a ground of 20 × 20 (albedo 0.4), or else below and beside another box. The camera
// sees a lit and a shaded side.
void trial_outdoors(struct frame_fixture *s, struct gpu *gpu, bool two_boxes);

// A square plane of 6 in the sun (1000 lux) or under a uniform sky (1 cd/m²), tilted around z.
struct trial_plane {
    float tilt_rad;
    bool double_sided, sun;
};
void trial_open_plane(struct frame_fixture *s, struct gpu *gpu, const struct trial_plane *plane);

// A black room of 6 × 3 × 3 whose white end wall (albedo 0.8) is lit by a spot on the other one,
// which the camera sees: one bounce across the empty room.
void trial_empty_room(struct frame_fixture *s, struct gpu *gpu);

// A room of 6 × 3 × 4 (albedo 0.7); a spot in the ceiling lights a patch of 0.5 on the floor.
void trial_small_patch(struct frame_fixture *s, struct gpu *gpu);
// A corner of a room of 3 x 2.8 x 5 m, with a lit patch on its floor.
void trial_patch_beside_corner(struct frame_fixture *s, struct gpu *gpu);

// A room of 6 × 3 × 4 (albedo 0.7) with three spheres on its floor, lit by a small bright spot: a
// point light 12 cm below the ceiling, in a far corner.
void trial_bright_spot(struct frame_fixture *s, struct gpu *gpu);

// A grey floor of 6 under one mesh of 12 × 12 emissive strips of 0.4 × 0.02 at a height of 2.5.
void trial_strips(struct frame_fixture *s, struct gpu *gpu);

// A room of 4 × 3 × 4 (albedo 0.7) with an emissive panel of 1 × 0.8 below the ceiling, at which
// the camera looks.
void trial_panel(struct frame_fixture *s, struct gpu *gpu);

// A room of 4 × 3 × 4 (albedo 0.5) with a panel of 1 × 0.8, 2 cm below the ceiling, that emits and
// reflects on both sides: between both it is far brighter than elsewhere. The camera sees walls and
// floor.
void trial_sheet_below_ceiling(struct frame_fixture *s, struct gpu *gpu);

// A room of 6 × 5 × 6 (albedo 0.7) with a black emissive box of 2 × 0.1 × 2, `gap` below the
// ceiling. The camera sees the floor and the walls.
void trial_ceiling_light(struct frame_fixture *s, struct gpu *gpu, float gap);
// A room 3 m high with a box of 1.2 × 0.1 × 1.2, one connected mesh, as lights of files are: vct
// samples it as a small emitter.
void trial_small_ceiling_light(struct frame_fixture *s, struct gpu *gpu, float gap);

// A room of 6 × 2.8 × 6 (albedo 0.7) with a point light, in two views, and
// a wardrobe of 0.6 × 2.1 × 2, 5 cm from a wall, and a table (albedo 0.4),
void trial_wardrobe(struct frame_fixture *s, struct gpu *gpu, bool second_view);
// the light in a shade of 0.6 × 0.3 × 0.6 that is open above and below (albedo 0.4),
void trial_shade(struct frame_fixture *s, struct gpu *gpu, bool second_view);
// a shade of the same size, of double-sided sheets,
void trial_sheet_shade(struct frame_fixture *s, struct gpu *gpu, bool second_view);
// a double-sided curtain of 2 × 2.2, 10 cm from a wall (albedo 0.6),
void trial_curtain(struct frame_fixture *s, struct gpu *gpu, bool second_view);
// or furniture of double-sided sheets (albedo 0.4 and 0.6), some of them 3 to 8 cm from others.
void trial_sheets(struct frame_fixture *s, struct gpu *gpu, bool second_view);

// A room of 5 × 2.6 × 4 in solid walls of 20 cm (albedo 0.7) with a point light: two blocks.
void trial_long_room(struct frame_fixture *s, struct gpu *gpu, bool second_view);
// The same with a spot light over the border of the blocks, and a small box in each (albedo 0.4).
void trial_patch_between_blocks(struct frame_fixture *s, struct gpu *gpu, bool second_view);
// The long room with a wardrobe 5 cm from a wall, a sofa and a table (albedo 0.4).
void trial_thick_walls(struct frame_fixture *s, struct gpu *gpu, bool second_view);

// A room of 6 × 3 × 6 (albedo 0.5, double-sided) with a point light. Walls like these are hidden
// behind it, at a distance of `gap`; 0: none.
void trial_lined_room(struct frame_fixture *s, struct gpu *gpu, float gap);

// A room of 4 × 3 × 4 with a point light; its left wall is white, and green in front of it at a
// distance of `gap`; 0: green alone. The camera sees the floor next to that wall.
void trial_wall_before_slab(struct frame_fixture *s, struct gpu *gpu, float gap);

// A cube in a scene that is not open. Its six faces are the last instances. Returns the first.
int trial_add_movable_box(struct frame_fixture *s, vec3s center, float size, int material);
