// Which surfaces the scene's punctual lights light directly, by shadow rays.
#pragma once

#include "scene/view/raycast.h"

enum { DIRECT_LIGHTS_MAX = 16 };

struct direct_light {
    const struct raycast *raycast;
    struct world_light lights[DIRECT_LIGHTS_MAX]; // the first of the scene
    int count;
    float offset; // of shadow rays along the normal, against self-intersection
};

void direct_light_init(struct direct_light *direct, const struct scene_pose *pose,
                       const struct raycast *raycast, float offset);

// Hits of the rays of a view.
struct lit_count {
    int hits, lit;
};
// Adds the hit of a ray.
void direct_light_count(const struct direct_light *direct, vec3s origin, vec3s direction,
                        struct lit_count *count);
// lit / hits; 0 without hits.
float lit_share(const struct lit_count *count);
