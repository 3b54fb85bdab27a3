// Points of clutter where a frame computes direct light, and their light of emitters and the sky.
#pragma once

#include "techniques/mrt/clutter/clutter.h"
#include "techniques/mrt/level/area_light.h"

// One for each of clutter->texels, in their order. The caller frees it with host_free; NULL without
// memory.
struct mrt_geometry_texel *mrt_clutter_light_create(struct host *host,
                                                    const struct scene_pose *pose,
                                                    const struct mrt_clutter *clutter);
