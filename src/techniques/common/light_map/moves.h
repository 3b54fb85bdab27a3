// Poses of instances when a light map was made. A pixel of a moved instance looks up the light at
// the same point of its surface.
#pragma once

#include "scene/pose.h"

#include "techniques/common/light_map/surface_shared.h"

struct light_map_place {
    int mesh; // −1: none
    bool deformed;
    bool moved;     // it is elsewhere in the newest pose, or gone
    uint64_t added; // of the instance
    mat4s world_from_mesh;
};

struct light_map_places {
    struct light_map_place *at;   // [count]
    struct light_map_move *moves; // [count] of the newest pose
    int count;                    // of instances
};

// Replaces *out, which may be zero, by the places in the pose of a map. false: no memory.
// light_map_places_finish accepts zero.
bool light_map_places_init(struct light_map_places *out, struct host *host,
                           const struct scene_pose *pose);
void light_map_places_finish(struct light_map_places *places, struct host *host);
// Writes the moves of a later pose of the scene; returns whether there are any. The row of an
// instance that was removed or has another mesh is 0.
bool light_map_find_moves(struct light_map_places *places, const struct scene_pose *pose);

// Whether an instance of the map was removed or has another mesh.
static inline bool light_map_is_gone(const struct light_map_places *places, int instance)
{
    return glms_vec3_norm2(places->moves[instance].x) == 0.0f;
}
