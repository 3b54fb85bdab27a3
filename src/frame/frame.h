// One frame: G-buffer, shadow maps, reflective shadow maps, direct light, indirect light (by a
// hook), composite. The frame does not know which technique fills the indirect light. The order of
// passes is frame.c.
//
// Contract of light: a source writes irradiance E (lux) without albedo and without 1/π; specular is
// reflected radiance; visibility is 0 (closed) … 1 (open). composite: L = Le + direct +
// albedo·(1−metallic)/π · E · visibility + specular. All GPU values are scaled, see frame_shared.h.
#pragma once

#include "core/option.h"
#include "gpu/gpu.h"
#include "scene/pose.h"

#include "frame/frame_shared.h"

struct frame;
struct scene_gpu;

struct frame_options {
#define OPTION OPTION_FIELD
#include "frame/frame_options.def"
#undef OPTION
};
extern const struct option_table frame_option_table;

// Images of the frame's size that can be read back. The G-buffer's formats are fixed, so that a
// host can bring its own.
enum frame_layer {
    FRAME_DEPTH,    // D32F, reversed Z; 0 where there is nothing
    FRAME_NORMAL,   // RG16F: octahedral shading normal, world space (frame/octahedral.glsl)
    FRAME_ALBEDO,   // RGBA8_SRGB: base colour, alpha 1 where there is a surface
    FRAME_MATERIAL, // RG8: roughness, metallic
    FRAME_EMISSIVE, // RGBA16F: scaled radiance
    FRAME_MOTION, // RGBA16F: screen position now minus last frame's, in units of the screen (0…1),
                  // +y down; distance along the view axis, last frame's over now's, minus 1; 1
                  // where there is a surface
    FRAME_DIRECT,     // RGBA16F: scaled radiance of punctual lights and emission
    FRAME_IRRADIANCE, // RGBA16F: scaled irradiance, indirect
    FRAME_SPECULAR,   // RGBA16F: scaled radiance, indirect
    FRAME_VISIBILITY, // R8
    FRAME_INDIRECT, // RGBA16F: scaled radiance, albedo/π·E·visibility + specular; only when asked
                    // for
    FRAME_COLOR,   // RGBA16F: scaled radiance, the sum
    FRAME_DISPLAY, // RGBA8: exposed, tone mapped, sRGB-encoded
    FRAME_LAYER_COUNT
};

// What a technique sees of a frame, valid while it records. Images are none where nobody asked for
// them.
struct frame_view {
    uint32_t width, height;
    uint64_t index;                          // frames since the last resize or scene change
    const struct frame_constants *constants; // CPU copy of the block
    struct gpu_binding constants_binding;    // named "frame_constants"
    struct gpu_binding lights_binding;       // named "frame_lights"
    const struct frame_light *lights;
    int light_count;
    // Points of emissive surfaces (frame/emitters.h); none where nobody needs them.
    int emitter_count;
    const struct frame_emitter *emitters; // CPU copy
    struct gpu_binding emitters_binding;  // named "frame_emitters"
    vec3s emitted_irradiance; // scaled lux: mean over the scene by emission on its straight way
                              // (emitters_irradiance)
    const struct scene_pose *pose;
    const struct scene_gpu *scene; // triangles and materials on the GPU (frame/scene_gpu.h)
    struct world_camera camera;
    struct box3 bounds; // of the scene, world space; empty for an empty scene
    bool camera_cut, geometry_moved, lights_changed; // since last frame
    gpu_image layers[FRAME_LAYER_COUNT];
    // Reflective shadow maps: arrays of rsm_size² with rsm_face_count layers in use.
    uint32_t rsm_size;
    int rsm_face_count;
    const struct rsm_face *rsm_faces;     // CPU copy
    struct gpu_binding rsm_faces_binding; // named "rsm_faces"
    gpu_image rsm_depth;                  // D32F array, reversed Z; 0 where there is nothing
    gpu_image rsm_normal;                 // RG16F array: octahedral, faces the light
    gpu_image rsm_flux; // RGBA8_SRGB array: reflectance ρ of the texel (albedo × (1−metallic) ×
                        // spot and range fall-off); reflected flux in scaled lumen = ρ × flux
                        // through the texel, see frame/rsm/rsm.glsl
    // Shadow maps of all lights, to be read through frame/shadow/shadow.glsl.
    gpu_image shadow_maps;      // D32F array, reversed Z
    gpu_sampler shadow_sampler; // compares
    uint32_t shadow_size;
    int shadow_radius;                       // of the filter, texels
    struct gpu_binding shadow_faces_binding; // named "shadow_faces"
    int maps_drawn; // layers of shadow maps and reflective shadow maps drawn anew in this frame
};

// What the hook reads and writes; the frame makes and fills only what is needed.
enum frame_need {
    FRAME_NEEDS_RSM = 1,
    FRAME_NEEDS_MOTION = 2,
    FRAME_WRITES_IRRADIANCE = 4,
    FRAME_WRITES_SPECULAR = 8,
    FRAME_WRITES_VISIBILITY = 16,
    FRAME_NEEDS_EMITTERS = 32,
};

struct frame_indirect {
    void (*record)(void *user, struct gpu_cmd *cmd,
                   const struct frame_view *view); // records only; cannot fail
    void *user;
    uint32_t needs; // frame_need bits
};

struct frame_input {
    const struct scene_pose *pose;
    struct world_camera camera;
    const struct world_light *lights; // physical units
    int light_count;                  // ≤ FRAME_MAX_LIGHTS
    vec3s sky;                        // cd/m²
    bool auto_exposure; // from the log-average of direct light and emission (composite/exposure.h)
    float exposure_ev;  // used where auto_exposure is false
    bool camera_cut;    // forget history
    bool want_indirect_layer; // fill FRAME_INDIRECT
    bool want_motion_layer;   // fill FRAME_MOTION, whether the hook needs it or not
    bool want_display;        // fill FRAME_DISPLAY
};

struct frame *frame_create(struct host *host, struct gpu *gpu, const struct frame_options *options);
void frame_destroy(struct frame *frame); // accepts NULL and half-built frames
// Uploads meshes and textures; the scene must outlive the frame or the next frame_set_scene.
bool frame_set_scene(struct frame *frame, const struct scene *scene);
bool frame_resize(struct frame *frame, uint32_t width, uint32_t height); // 1…16384
// Makes what the next frames need; call before recording when lights or needs changed (it may
// allocate).
bool frame_prepare(struct frame *frame, const struct frame_input *input,
                   const struct frame_indirect *indirect);
// Records the whole frame. Nothing here can fail or allocate.
void frame_record(struct frame *frame, struct gpu_cmd *cmd, const struct frame_input *input,
                  const struct frame_indirect *indirect);
gpu_image frame_layer_image(const struct frame *frame,
                            enum frame_layer layer); // none where not made
// Scale of the newest recorded frame: scaled = physical × scale.
float frame_radiance_scale(const struct frame *frame);
// EV of the newest finished frame (call gpu_wait first).
bool frame_exposure(struct frame *frame, float *ev);
// Reads a layer as physical values, `channels` floats a texel (normals and positions decoded, see
// frame_readback.c).
enum frame_readback {
    READ_COLOR,
    READ_DIRECT,
    READ_INDIRECT,
    READ_IRRADIANCE,
    READ_VISIBILITY,
    READ_SPECULAR,
    READ_ALBEDO,
    READ_NORMAL,
    READ_DEPTH,
    READ_POSITION,
    READ_EMISSIVE,
    READ_ROUGHNESS_METALLIC,
    READ_MOTION,
    READ_DISPLAY,
};
// pixels: width × height × channels (3; depth and visibility 1, in metres along the view axis and
// 0…1).
bool frame_read(struct frame *frame, enum frame_readback what, float *pixels, int channels);
// Bytes for these options at this size, before anything is created.
uint64_t frame_memory_estimate(const struct frame_options *options, uint32_t width, uint32_t height,
                               int light_count);
