// State of a frame, private to frame*.c. Passes do not include it.
#pragma once

#include "frame/frame.h"

#include "frame/composite/antialias.h"
#include "frame/composite/composite.h"
#include "frame/composite/display.h"
#include "frame/composite/exposure.h"
#include "frame/direct/direct.h"
#include "frame/emitters.h"
#include "frame/environment_map.h"
#include "frame/gbuffer/convert.h"
#include "frame/gbuffer/gbuffer.h"
#include "frame/rsm/rsm.h"
#include "frame/scene/scene_gpu.h"
#include "frame/shadow/shadow.h"

struct frame_reports {
    struct {
        struct gpu_readback readback; // of struct report_values (frame_report.c)
        struct frame_report report;
        struct frame_pick pick; // number 0: the frame was not asked for one
    } slots[GPU_PENDING_FRAMES];
    struct frame_report newest; // completed; number 0: none
    struct frame_pick newest_pick;
};

// Data that the views of a frame share, owned by the first.
struct frame_common {
    struct frame_options options;
    struct scene_gpu scene;
    struct emitters emitters;
    bool has_scene;
    bool viewed; // further views of the frame being recorded have used shared layers
    struct gbuffer gbuffer;
    struct gbuffer_convert convert;
    struct shadow shadow;
    struct rsm rsm;
    struct direct direct;
    struct composite composite;
    struct display display;
    struct antialias antialias;
    uint64_t revision;    // counts frame_invalidate and changes of options
    gpu_image ggx_albedo; // core/ggx_albedo.h
    struct frame_environment environment;
    struct frame *views[FRAME_MAX_VIEWS]; // [0]: the first; NULL: there is none
};

struct frame {
    struct host *host;
    struct gpu *gpu;
    struct frame_common *common;
    int view_number;        // 0: the first
    uint32_t width, height; // 0 before the first resize

    struct exposure exposure;
    struct antialias_history antialias; // with FRAME_ANTIALIASES
    gpu_image layers[FRAME_LAYER_COUNT];
    uint32_t imported; // bit l: layer l is the caller's, until the frame is recorded
    const struct frame_gbuffer *gbuffer; // the caller's, until the frame is recorded; or NULL
    uint32_t pinned;                     // bit l: layer l, by frame_pin_layer
    uint32_t unwritten; // set by frame_prepare: kept layers that no pass or technique writes
    uint32_t neutral;   // those of them that have their neutral value
    uint32_t own;       // set by frame_prepare: of a further view, what it keeps
    uint32_t aliased;   // bit l: the image of layer l shares memory with other views
    uint32_t kept;      // layers that have their value since the newest recorded frame

    // Set by frame_prepare.
    uint32_t needs;             // frame_need bits
    uint32_t composite_variant; // composite_variant bits
    uint32_t direct_variant;    // of direct_variant()
    bool prepared;

    // State of the newest recorded frame.
    uint64_t index; // of the next frame
    struct frame_constants constants;
    struct frame_light lights[FRAME_MAX_LIGHTS];
    int light_count;
    uint64_t lights_hash, light_hash; // of the physical lights; of struct frame_view
    uint64_t environment_key;
    struct frame_camera camera, unjittered; // camera: with the jitter
    vec2s jitter;
    bool camera_still;        // but for the jitter
    vec3s emitted_irradiance; // scaled lux
    float fallback_luminance; // scaled, see frame_fallback_luminance
    bool camera_cut, lights_changed;
    struct shadow_sun_view sun; // of the only light
    bool has_blocks;            // its maps have blocks
    struct gpu_binding constants_binding, lights_binding, patches_binding;
    struct frame_view view;
    uint64_t number; // see struct frame_report; of a further view: that of the first
    struct frame_reports reports;
};

// frame_layers.c
// Bits of layers: those of the frame's own G-buffer; those of all passes after it; those that a
// further view keeps, if they are written.
enum { FRAME_LEAST_GBUFFER = 1u << FRAME_DEPTH | 1u << FRAME_NORMAL | 1u << FRAME_ALBEDO };
uint32_t frame_gbuffer_layers(uint32_t needs, bool has_dielectrics);
uint32_t frame_image_layers(const struct frame_input *input, uint32_t needs);
uint32_t frame_kept_layers(const struct frame_input *input);
// Bit l: layer l. `written` by passes or techniques; `kept` in any case. Destroys others.
bool frame_make_layers(struct frame *frame, uint32_t written, uint32_t kept);
// Makes a caller's G-buffer the frame's until frame_forget_gbuffer. NULL: none.
void frame_import_gbuffer(struct frame *frame, const struct frame_gbuffer *gbuffer);
void frame_forget_gbuffer(struct frame *frame);
void frame_destroy_layers(struct frame *frame);
void frame_clear_unwritten(struct frame *frame, struct gpu_cmd *cmd);

// frame_prepare.c. Whether the display image is of another layer than the colour.
bool frame_shows_layer(const struct frame_input *input);
bool frame_displays_color(const struct frame_input *input); // there is one, of the colour
// Variants of composite; the second: of the same radiance, without images.
uint32_t frame_composite_variant(const struct frame_options *options,
                                 const struct frame_input *input, uint32_t needs);
uint32_t frame_display_variant(const struct frame *frame);
uint32_t frame_meter_variant(uint32_t variant);

// frame_antialias.c
// frame_need bits that the options add. displays: frame_displays_color.
uint32_t frame_antialias_needs(const struct frame_options *options);
bool frame_prepare_antialias(struct frame *frame, bool displays);
// The jitter of a frame.
vec2s frame_jitter(const struct frame *frame, const struct frame_input *input);
// Finds what of the history holds, before exposure and antialiasing are recorded.
void frame_follow_antialias(struct frame *frame);
// Share of this frame in the mean exposure of a static image: jitter changes what is metered.
float frame_exposure_share(struct frame *frame, bool is_automatic);
// From FRAME_RADIANCE to FRAME_COLOR, and to FRAME_DISPLAY.
void frame_record_antialias(struct frame *frame, struct gpu_cmd *cmd, bool displays);

// frame_report.c
bool reports_init(struct frame *frame);
void reports_finish(struct frame *frame);
// After all passes.
void reports_record(struct frame *frame, struct gpu_cmd *cmd, const struct frame_input *input);

// frame_begin.c: constants, lights and change flags of a new frame.
// Begins a further view: the light and the scale are those of the first.
void frame_begin_view(struct frame *frame, struct gpu_cmd *cmd, const struct frame_input *input);
void frame_begin(struct frame *frame, struct gpu_cmd *cmd, const struct frame_input *input);
