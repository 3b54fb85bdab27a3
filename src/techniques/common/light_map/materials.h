// Materials of static surfaces that change at run time: those that a bake's light follows are
// reported, of the others it warns once.
#pragma once

#include "scene/statics.h"

// Parts of a material that change, and that a technique follows.
enum {
    LIGHT_MAP_FOLLOWS_EMISSION = 1,    // of materials that emit in the bake
    LIGHT_MAP_FOLLOWS_REFLECTANCE = 2, // by factors
};

struct light_map_materials {
    struct host *host;
    const char *technique; // in messages
    unsigned follows;      // LIGHT_MAP_… bits
    int count;
    struct material *known; // [count] the newest ones
    struct material *baked; // [count] those at the start
    int *of_instance;       // [instances] −1: not static
    bool *used;             // [count] by a static instance
    struct emission_basis emission;
    uint64_t revision; // of the scene's materials
    bool warned_emission, warned_reflectance, warned_surface;
};

// statics: of the pose at the start. light_map_materials_finish accepts zero.
bool light_map_materials_init(struct light_map_materials *out, struct host *host,
                              const char *technique, unsigned follows,
                              const struct scene_statics *statics);
void light_map_materials_finish(struct light_map_materials *materials);
// Takes over the materials of the scene, of which static surfaces keep those they had. Returns what
// has changed since the last call, of that which the technique follows.
unsigned light_map_materials_update(struct light_map_materials *materials,
                                    const struct scene *scene);
