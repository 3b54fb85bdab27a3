// Groups of virtual point lights for sampling. Pure CPU.
#pragma once

#include "core/vec.h"

struct vct_light {
    vec3s position;
    vec3s key;   // lights of one key stay together
    double flux; // > 0, up to a factor
    int index;   // of the caller
};

struct vct_emitter_group {
    int first, count;
};

enum { VCT_LIGHT_SIDES = 6 };
// The axis that a normal is nearest to: +x −x +y −y +z −z.
int vct_light_side(vec3s normal);

// Divides the lights into at most `most` groups, as near to each other as possible, and sorts them:
// the lights of a group are consecutive, near ones next to each other. Returns the number of
// groups.
int vct_group_lights(struct vct_light *lights, int count, int most,
                     struct vct_emitter_group *groups);
