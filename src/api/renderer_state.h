// What a public renderer holds, shared by renderer.c (its life and frames) and layers.c (what is
// read from it).
#pragma once

#include "api/objects.h"

#include "frame/frame.h"
#include "techniques/gi.h"

struct ag_renderer {
    struct ag_device *device;
    struct ag_scene *scene;
    struct frame_options options;
    struct gi_spec spec;
    char *gi_text; // the spec with every option written out
    struct scene_pose pose;
    uint64_t pose_version;
    struct frame *frame;
    struct gi *gi;
    struct world_light lights[FRAME_MAX_LIGHTS];
    struct gpu_cmd *recorded; // in a caller's command buffer, and not yet reported done
    bool indirect_layer, display_layer, motion_layer, debug_view;
    bool sized;        // the last resize succeeded
    bool said_limit;   // that there are more lights than are used
    uint64_t rendered; // frames since the last resize
};

static inline struct ag_context *renderer_context(const struct ag_renderer *renderer)
{
    return renderer ? renderer->device->context : NULL;
}
