// The part of a scene that is baked: instances that are expected to stay where they are. Dynamic
// ones have no texels, and neither occlude nor reflect light in a bake.
#pragma once

#include "core/host.h"
#include "scene/emission_basis.h"
#include "scene/pose.h"

// [instance_count]: instances that are marked movable, and those that an animation of the scene
// moves or deforms, played or not. The caller frees it. NULL without memory.
bool *scene_dynamic_instances(struct host *host, const struct scene *scene);

// A copy of the scene without dynamic instances, and its pose; both share all else with the
// originals, which must outlive them. scene_statics_finish accepts zero.
struct scene_statics {
    struct host *host;
    struct scene scene;
    struct scene_pose pose;         // its bounds are of the whole scene
    struct emission_basis emission; // after scene_statics_free_factors
    struct material *materials;     // owned; NULL: the originals
};
bool scene_statics_init(struct scene_statics *out, struct host *host,
                        const struct scene_pose *pose);
// Replaces factors of materials that are applied at run time by units, of which a bake and its key
// then do not depend. Emission: see emission_basis.h. reflectance: base colour (but for alpha),
// metallic, roughness and specular factors, too.
bool scene_statics_free_factors(struct scene_statics *statics, bool reflectance);
void scene_statics_finish(struct scene_statics *statics);
