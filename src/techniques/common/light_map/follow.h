// Which instances are those that were baked, and where.
#pragma once

#include "scene/statics.h"

#include "techniques/common/light_map/moves.h"

struct light_map_followed {
    struct host *host;
    const char *technique;          // in messages
    struct light_map_places places; // at the start, of static ones
    uint64_t *deformed;             // [instances] hashes of their vertices where these are deformed
    bool any_moved;                 // of those that are
    bool any_lit;                   // one that is not in the light map
    uint64_t started;               // revisions of the scene
    uint64_t revision;
    bool warned_moved, warned_added;
};

// statics: of the same pose. light_map_followed_finish accepts zero.
bool light_map_followed_init(struct light_map_followed *out, struct host *host,
                             const char *technique, const struct scene_pose *pose,
                             const struct scene_statics *statics);
void light_map_followed_finish(struct light_map_followed *followed);
// Compares with a later pose of the scene; warns once for each kind of change that a bake cannot
// follow.
void light_map_followed_update(struct light_map_followed *followed, const struct scene_pose *pose);
