// State of a renderer, shared by renderer.c (creation, frames), layers.c and probes.c (read-back).
#pragma once

#include "api/objects.h"

#include "frame/frame.h"
#include "techniques/gi.h"

struct ag_renderer {
    struct ag_device *device;
    struct ag_scene *scene;
    struct frame_options options;
    struct gi_spec spec;
    char *gi_text; // GI spec with all options
    struct scene_pose pose;
    uint64_t pose_version;
    struct frame *frame;
    struct gi *gi;
    struct world_light lights[FRAME_MAX_LIGHTS];
    struct gpu_cmd *recorded; // in a caller's command buffer, until ag_renderer_recorded_done
    bool indirect_layer, display_layer, motion_layer, debug_view;
    bool sized;        // the last resize succeeded
    bool said_limit;   // the warning about too many lights was logged
    uint64_t rendered; // frames since the last resize
};

static inline struct ag_context *renderer_context(const struct ag_renderer *renderer)
{
    return renderer ? renderer->device->context : NULL;
}
