// State of a renderer, shared by renderer*.c, layers.c and probes.c.
#pragma once

#include "api/objects.h"

#include "frame/frame.h"
#include "gpu/gpu.h"
#include "techniques/gi.h"

// In a caller's command buffer, until ag_renderer_recorded_done.
struct recorded_frame {
    struct gpu_cmd *cmd;
    uint64_t number;
};

// One camera's images. The first one is the renderer's own.
struct ag_view {
    struct ag_renderer *renderer;
    struct frame *frame;
    bool indirect_layer, display_layer, motion_layer, id_layer, host_gbuffer;
    struct ag_gbuffer_layout layout; // of the program's G-buffer
    bool has_layout;
    bool all_layers;          // of a further view: keeps what nothing else asks for
    struct frame_shown shown; // by the layer "display"; its image is set for each frame
    bool shows_debug;         // the debug view, if one is set
    int width, height;        // of the last resize
    bool sized;               // it succeeded
    uint64_t rendered;        // frames since the last resize
};

struct ag_renderer {
    struct ag_device *device;
    struct ag_scene *scene;
    struct frame_options options;
    struct gi_spec spec;
    char *gi_text;     // GI spec with all options
    char *bake_folder; // NULL: none
    struct scene_pose pose;
    struct scene_revisions seen; // of the scene, in the newest frame
    struct ag_view main;
    struct gi *gi;
    struct world_light lights[FRAME_MAX_LIGHTS];
    struct recorded_frame recorded[GPU_ADOPTED_FRAMES]; // oldest first
    int recorded_count;
    uint32_t client;           // of the device: gpu_client_add
    uint64_t created_surfaces; // hash of the surfaces that techniques were created with
    bool wait_for_updates;     // as in ag_renderer_desc
    bool said_limit;           // the warning about too many lights was logged
    struct lifetime life;      // its users are the further views
};

static inline struct ag_context *renderer_context(const struct ag_renderer *renderer)
{
    return renderer ? renderer->device->context : NULL;
}

static inline struct host *renderer_host(const struct ag_renderer *renderer)
{
    return &renderer->device->context->host;
}

// Techniques are created with the surfaces of the current pose.
static inline void renderer_keep_surfaces(struct ag_renderer *renderer)
{
    if (renderer->scene->scene->animation_count > 0)
        renderer->created_surfaces = pose_surfaces_hash(&renderer->pose);
}

static inline struct ag_context *view_context(const struct ag_view *view)
{
    return view ? view->renderer->device->context : NULL;
}

// Around all that creates objects or records: memory and times count for the renderer.
static inline void renderer_enter(const struct ag_renderer *renderer)
{
    gpu_client_set(renderer->device->gpu, renderer->client);
}

static inline void renderer_leave(const struct ag_renderer *renderer)
{
    gpu_client_set(renderer->device->gpu, 0);
}

// renderer.c
void renderer_release(struct ag_renderer *renderer);              // a view of it has gone
void renderer_warn_of_source(const struct ag_renderer *renderer); // that was added to the spec
void renderer_warn_of_darkness(const struct ag_renderer *renderer);
// "" and NULL: the defaults.
bool renderer_parse_frame_options(struct host *host, const char *text, struct frame_options *out);

// Both texts of a description, without warnings. Finish *spec in any case.
bool renderer_parse_quietly(struct ag_context *context, const struct ag_renderer_desc *desc,
                            struct gi_spec *spec, struct frame_options *options);

// The layers of a description, for estimates of memory.
struct frame_input renderer_wants(const struct ag_renderer_desc *desc);

// layers.c. The layers of a view, for public functions of that name.
enum ag_result view_read(const char *function, struct ag_view *view, const char *layer,
                         struct ag_image **out);
enum ag_result view_layer_handle(const char *function, struct ag_view *view, const char *layer,
                                 struct ag_layer_handle *out);

// renderer.c
enum ag_result renderer_size_check(const char *function, struct ag_context *context, int width,
                                   int height);

// renderer_frames.c. The GPU has completed the recorded frames up to this number.
void renderer_recordings_done(struct ag_renderer *renderer, uint64_t number);
