// Rays among the static surfaces that a map has the light of.
#pragma once

#include "lightmap/gather.h"
#include "scene/statics.h"

// lightmap_tracing_finish accepts zero.
struct lightmap_tracing {
    struct scene_statics statics;
    struct gather_scene scene;
};
// pose: of all instances; it and the charts outlive it.
bool lightmap_tracing_init(struct lightmap_tracing *out, const struct scene_pose *pose,
                           const struct charts *charts);
void lightmap_tracing_finish(struct lightmap_tracing *tracing);
