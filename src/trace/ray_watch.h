// Whether rays meet boxes: of a part of a scene that differs from another scene. Paths whose rays
// meet none are equal in both.
#pragma once

#include "core/vec.h"

#include <stdint.h>

struct ray_watch {
    const struct box3 *boxes;
    uint32_t count;
    bool met; // set by the first ray that meets one
};

// far: in lengths of the direction. Boxes count a little larger than they are.
void ray_watch_segment(struct ray_watch *watch, vec3s origin, vec3s direction, float far);
