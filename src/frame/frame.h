// One frame: G-buffer, shadow maps, reflective shadow maps, direct light, indirect light (recorded
// by a callback), composite. The frame does not know the techniques. The order of passes is in
// frame.c.
//
// Contract of light: a source writes irradiance E (lux) without albedo and without 1/π; specular is
// reflected radiance; visibility is 0 (closed) … 1 (open). composite: L = Le + direct +
// albedo·(1−metallic)/π · (1−E_d) · E · visibility + specular, with E_d the directional albedo of
// the dielectric specular lobe (brdf.glsl). All GPU values are scaled, see frame_shared.h.
#pragma once

#include "core/option.h"
#include "gpu/gpu.h"
#include "scene/pose.h"

#include "frame/frame_camera.h"
#include "frame/frame_shared.h"
#include "frame/gbuffer/gbuffer_encoding.h"

struct frame;
struct scene_gpu;

// The origin of a virtual point light of the frame.
struct frame_emitter_origin {
    int instance;        // of the scene
    bool back;           // of a double-sided surface: the point is on its back
    float area_m2;       // of the surface that it stands for
    float part_extent_m; // diagonal of the bounds of the connected part (scene/mesh_parts.h)
};

struct frame_options {
#define OPTION OPTION_FIELD
#include "frame/frame_options.def"
#undef OPTION
};
extern const struct option_table frame_option_table;

// Images of the frame's size. G-buffer formats are fixed, so that a host application can provide
// its own G-buffer.
enum frame_layer {
    FRAME_DEPTH,    // D32F, reversed Z; 0: no surface
    FRAME_NORMAL,   // RG16F: octahedral shading normal, world space (frame/octahedral.glsl)
    FRAME_ALBEDO,   // RGBA8_SRGB: base colour; alpha 1: surface, ½: unlit, 0: none
    FRAME_MATERIAL, // RG8: roughness, metallic
    // RGBA8: √F0 of the dielectric specular lobe in rgb, F90 in a. Only in scenes with other values
    // than √0.04 and 1.
    FRAME_DIELECTRIC,
    FRAME_EMISSIVE, // RGBA16F: scaled radiance
    // RGBA16F. xy: screen position minus previous screen position, in 0…1 units, +y down, without
    // the jitter of both frames (frame_constants.jitter_step); z: previous over current distance
    // along the view axis, minus 1; w: 1 where there is a surface.
    FRAME_MOTION,
    // RG32U: instance of the scene and triangle of its mesh, each plus 1; 0: no surface. Optional.
    FRAME_ID,
    // RGBA16F: scaled radiance of punctual lights and emission. Alpha: the diffuse lobe over
    // albedo/π, 1−E_d for dielectrics, 0 for unlit materials and without a surface.
    FRAME_DIRECT,
    // RGBA16F: scaled irradiance of punctual lights with their shadows at the shading normal, which
    // the diffuse lobe of FRAME_DIRECT reflects; alpha 1. 0 without a surface and for unlit
    // materials. At most 65504. With FRAME_NEEDS_DIRECT_IRRADIANCE only.
    FRAME_DIRECT_IRRADIANCE,
    FRAME_IRRADIANCE, // RGBA16F: scaled irradiance, indirect
    FRAME_SPECULAR,   // RGBA16F: scaled radiance, indirect
    FRAME_VISIBILITY, // R8
    FRAME_INDIRECT, // RGBA16F: scaled radiance, albedo/π·(1−E_d)·E·visibility + specular; optional
    FRAME_RADIANCE, // RGBA16F: FRAME_COLOR before antialiasing; with that only
    FRAME_COLOR,    // RGBA16F: scaled radiance, direct + indirect
    FRAME_DISPLAY,  // RGBA8: exposed, tone mapped, sRGB-encoded
    FRAME_LAYER_COUNT
};

// The frame as techniques see it; valid while they record. Layers that were not requested are empty
// handles.
struct frame_view {
    int number; // of the view: 0 is the renderer's camera, others share its light
    uint32_t width, height;
    uint64_t index;                          // frames since the last resize or scene change
    const struct frame_constants *constants; // CPU copy of the block
    struct gpu_binding constants_binding;    // named "frame_constants"
    struct gpu_binding lights_binding;       // named "frame_lights"
    struct gpu_binding ggx_albedo_binding;   // named "ggx_albedo": core/ggx_albedo.glsl
    struct gpu_binding environment_binding;  // named "environment_map": environment_map.glsl
    // Named "frame_environment_patches": vec4 of scaled radiance by patch (scene/environment.h).
    struct gpu_binding environment_patches_binding;
    const struct frame_light *lights;
    int light_count;
    // Virtual point lights on emissive surfaces (frame/emitters.h), with FRAME_NEEDS_EMITTERS only.
    int emitter_count;
    const struct frame_emitter *emitters; // CPU copy
    const struct frame_emitter_origin *emitter_origins;
    struct gpu_binding emitters_binding; // named "frame_emitters"
    vec3s emitted_irradiance; // scaled lux: mean over the scene, unoccluded (emitters_irradiance)
    const struct scene_pose *pose;
    const struct environment *environment; // physical units
    const struct scene_gpu *scene; // triangles and materials on the GPU (frame/scene/scene_gpu.h)
    // With the jitter of this frame.
    struct frame_camera camera;
    struct box3 bounds; // of the scene, world space; empty for an empty scene
    bool camera_cut, geometry_moved, lights_changed; // since the previous frame
    uint64_t environment_key; // of the environment in this moment (scene/environment.h)
    // Hash of lights, environment and shadow filter, in the units of the frame: equal in frames
    // whose direct light on still geometry is equal.
    uint64_t light_hash;
    gpu_image layers[FRAME_LAYER_COUNT];
    // Reflective shadow maps: arrays of rsm_size² with rsm_face_count layers in use.
    uint32_t rsm_size;
    int rsm_face_count;
    const struct rsm_face *rsm_faces;     // CPU copy
    struct gpu_binding rsm_faces_binding; // named "rsm_faces"
    gpu_image rsm_depth;                  // D32F array, reversed Z; 0: no surface
    gpu_image rsm_normal;                 // RG16F array: octahedral, on the light's side
    // RGBA8_SRGB array: reflectance ρ of the texel (brdf_bounce_reflectance × spot and range
    // falloff). Reflected flux in scaled lumen = ρ × flux through the texel, see
    // frame/rsm/rsm.glsl.
    gpu_image rsm_flux;
    // Shadow maps of all lights, sampled by frame/shadow/shadow.glsl.
    gpu_image shadow_maps;                   // D32F array, reversed Z: of points and spots
    gpu_image shadow_sun_maps;               // D32F array, reversed Z
    gpu_sampler shadow_sampler;              // comparison sampler
    uint32_t shadow_size;                    // texels, of suns
    int shadow_radius;                       // filter radius, texels
    struct gpu_binding shadow_faces_binding; // named "shadow_faces"
    bool keep;      // results of earlier frames that did not change (option keep_maps)
    int maps_drawn; // layers of shadow maps and reflective shadow maps rendered in this frame
};

// In GPU_BIND: what shaders that include frame/shadow/shadow.glsl and evaluate lights bind.
#define FRAME_LIGHT_BINDINGS(view)                                                                 \
    (view)->constants_binding, (view)->lights_binding, (view)->shadow_faces_binding,               \
        { .name = "shadow_maps",                                                                   \
          .image = (view)->shadow_maps,                                                            \
          .sampler = (view)->shadow_sampler },                                                     \
    {                                                                                              \
        .name = "shadow_sun_maps", .image = (view)->shadow_sun_maps,                               \
        .sampler = (view)->shadow_sampler                                                          \
    }

// In GPU_BIND: the surface of each pixel, with "ggx_albedo" for its BRDF. Without FRAME_DIELECTRIC
// the material stands in its place, and shaders are told so.
#define FRAME_SURFACE_BINDINGS(view)                                                               \
    (view)->constants_binding, (view)->ggx_albedo_binding,                                         \
        { .name = "depth", .image = (view)->layers[FRAME_DEPTH] },                                 \
        { .name = "normal", .image = (view)->layers[FRAME_NORMAL] },                               \
        { .name = "albedo", .image = (view)->layers[FRAME_ALBEDO] },                               \
        { .name = "material", .image = (view)->layers[FRAME_MATERIAL] },                           \
    {                                                                                              \
        .name = "dielectric",                                                                      \
        .image =                                                                                   \
            (view)                                                                                 \
                ->layers[(view)->layers[FRAME_DIELECTRIC].id ? FRAME_DIELECTRIC : FRAME_MATERIAL]  \
    }

// Inputs and outputs of the indirect light; the frame creates and fills only these.
enum frame_need {
    FRAME_NEEDS_RSM = 1,
    FRAME_NEEDS_MOTION = 2,
    FRAME_WRITES_IRRADIANCE = 4,
    FRAME_WRITES_SPECULAR = 8,
    FRAME_WRITES_VISIBILITY = 16,
    FRAME_NEEDS_EMITTERS = 32,
    FRAME_NEEDS_ID = 64,              // a program's G-buffer may be without it
    FRAME_UPDATE_NEEDS_GBUFFER = 128, // `update` reads depth and normals of the first view
    // Dynamic instances neither send nor occlude a source's light: a delta adds what they do.
    FRAME_LEAVES_DYNAMIC = 256,
    // `record` reads E_direct, FRAME_DIRECT_IRRADIANCE. A source that replaces the diffuse
    // reflection of direct light, as subsurface scattering does, writes E − E_direct in place of E:
    //     L = direct + albedo·(1−metallic)/π · (1−E_d) · (E − E_direct) + specular.
    // The difference and FRAME_INDIRECT may be negative: composite, exposure and read-back clamp
    // neither. With E ≥ 0, FRAME_COLOR is at least −2⁻¹⁰ of direct, which is rounding. Visibility
    // below 1 scales the difference, and so keeps a share of the reflection.
    FRAME_NEEDS_DIRECT_IRRADIANCE = 512,
    // As FRAME_WRITES_SPECULAR while the environment has a map, and nothing without one.
    FRAME_WRITES_SPECULAR_OF_MAP = 1024,
    FRAME_ANTIALIASES = 2048, // by the option antialias, not by techniques
    // Light of a static scene may change for some frames: bounces, histories, work beside frames.
    FRAME_LIGHT_EVOLVES = 4096,
};

struct frame_indirect {
    // Both record only and cannot fail. `update`: once a frame, with its first view, of whose
    // layers it may read what FRAME_UPDATE_NEEDS_GBUFFER names; may be NULL. `record`: each view.
    void (*update)(void *user, struct gpu_cmd *cmd, const struct frame_view *view);
    void (*record)(void *user, struct gpu_cmd *cmd, const struct frame_view *view);
    void *user;
    uint32_t needs; // frame_need bits
};

// The layer or image that the display image shows, needed until the frame is recorded.
struct frame_shown {
    enum frame_layer layer;
    gpu_image image; // not empty: shown instead; RGBA16F of the frame's size, scaled radiance
};

// A G-buffer in place of the frame's own: images that live until the frame is recorded. Depth,
// normal and albedo are required, motion if a technique or the caller needs it. Without the others:
// roughness 1, metallic 0, the default dielectric, no emission.
struct frame_gbuffer {
    gpu_image layers[FRAME_LAYER_COUNT]; // others than those of the G-buffer are ignored
    float emissive_scale;                // values = cd/m² × emissive_scale
    // In other formats, encodings or sizes: converted into the frame's own G-buffer, but for
    // FRAME_ID. NULL: as in enum frame_layer.
    const struct gbuffer_encoding *encoding;
};

struct frame_input {
    const struct scene_pose *pose;
    struct world_camera camera;
    const struct frame_camera *projected; // in place of `camera`; NULL: its perspective
    // From the centres of pixels, in pixels, +y down. 0, 0 with the option antialias, and without a
    // caller's G-buffer: the frame has a sequence of its own.
    vec2s jitter;
    const struct world_light *lights; // physical units
    int light_count;                  // ≤ FRAME_MAX_LIGHTS
    struct environment environment;   // of the scene
    float painted;                    // largest painted irradiance, lux
    bool auto_exposure;               // from the frame's radiance, see image/exposure.h
    float exposure_ev;                // used if auto_exposure is false
    bool camera_cut;                  // invalidate history
    bool want_indirect_layer;         // fill FRAME_INDIRECT
    bool want_motion_layer;           // fill FRAME_MOTION even without FRAME_NEEDS_MOTION
    bool want_id_layer;               // fill FRAME_ID
    bool keep_layers;                 // of a further view, also those that nothing else asks for
    bool pick;                        // report the FRAME_ID of a pixel, below the size
    uint32_t pick_x, pick_y;
    bool want_display;                   // fill FRAME_DISPLAY
    const struct frame_shown *shown;     // by FRAME_DISPLAY; NULL: FRAME_COLOR
    const struct frame_gbuffer *gbuffer; // NULL: the frame renders its own
};

struct frame *frame_create(struct host *host, struct gpu *gpu, const struct frame_options *options);
// A further view of a frame: its own size, images, exposure and history, and the scene, maps and
// light of the frame. It goes through frame_resize, frame_prepare after the frame itself, and
// frame_record_view in the same command buffer and with the same pose and lights; a frame may leave
// it out. Shadow cascades fit the frame's own camera.
//
// Layers that a further view does not keep share memory with those of the other views, and have no
// value after the frame. It keeps FRAME_COLOR, what its input wants, and pinned layers.
struct frame *frame_create_view(struct frame *frame);
int frame_view_number(const struct frame *frame); // 0: not a further view
// Accepts NULL. Views first.
void frame_destroy(struct frame *frame);
// From the next frame on; creates only what the changed options size.
bool frame_set_options(struct frame *frame, const struct frame_options *options);
// Techniques or painted light are others from the next frame on: antialiasing follows. The frame
// finds other changes itself.
void frame_invalidate(struct frame *frame);
// Uploads meshes and textures; the scene must outlive the frame or the next frame_set_scene.
bool frame_set_scene(struct frame *frame, const struct scene *scene);
bool frame_resize(struct frame *frame, uint32_t width, uint32_t height); // 1…16384
// Adapts to changes of the scene; creates images and pipelines for the next frames. May allocate;
// call before recording when scene, lights or needs changed.
bool frame_prepare(struct frame *frame, const struct frame_input *input,
                   const struct frame_indirect *indirect);
// These cannot fail and do not allocate. What all views share; `frame` is the first.
void frame_record_light(struct frame *frame, struct gpu_cmd *cmd, const struct frame_input *input,
                        const struct frame_indirect *indirect);
// Records one view: call it for the further views of the frame, then the first, whose layers last.
void frame_record_view(struct frame *frame, struct gpu_cmd *cmd, const struct frame_input *input,
                       const struct frame_indirect *indirect);
// Whether the layer has its value after the newest recorded frame.
bool frame_keeps_layer(const struct frame *frame, enum frame_layer layer);
// Keeps a layer, and creates it if there is a size, whether or not a technique writes it: without
// one, frames clear it to a neutral value (visibility 1, else 0). Until the next resize its image
// stays the same.
bool frame_pin_layer(struct frame *frame, enum frame_layer layer);
// Its format, and whether the G-buffer pass writes it.
enum gpu_format frame_layer_format(enum frame_layer layer);
bool frame_layer_is_gbuffer(enum frame_layer layer);
// Empty handle if the layer was not requested.
gpu_image frame_layer_image(const struct frame *frame, enum frame_layer layer);
// Scale of the newest recorded frame: scaled = physical × scale.
float frame_radiance_scale(const struct frame *frame);
// EV of the newest completed frame (call gpu_wait first).
bool frame_exposure(struct frame *frame, float *ev);
// Numbers of a frame, known once the GPU has completed it.
struct frame_report {
    uint64_t number; // frames recorded since frame_create, from 1
    float exposure_ev;
    float radiance_scale;
};
// The FRAME_ID of a pixel that a frame was asked for.
struct frame_pick {
    uint64_t number; // of the frame; 0: none
    uint32_t x, y;
    uint32_t instance, triangle; // each plus 1; 0: no surface
};
// The pick of the newest completed frame that was asked for one. Does not wait. false: none yet.
bool frame_newest_pick(struct frame *frame, struct frame_pick *out);
// The report of the newest completed frame. Does not wait. false: there is none yet.
bool frame_newest_report(struct frame *frame, struct frame_report *out);
// Number of the newest recorded frame; 0: none.
uint64_t frame_number(const struct frame *frame);
// Layers as physical values; units and encodings: frame_readback.c.
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
    READ_ID,
    READ_DISPLAY,
};
// pixels: width × height × channels floats. Channels: 3, but 1 for depth and visibility, 2 for ids.
bool frame_read(struct frame *frame, enum frame_readback what, float *pixels, int channels);
// Bytes of buffers and texels at this size, without the scene, for an input whose `want` members,
// light_count and gbuffer (NULL or not) count, and frame_need bits. Each light is a sun or a point
// light, whichever takes more, a single one has a sun's list; there are dielectrics of an own
// specular.
uint64_t frame_memory_estimate(const struct frame_options *options, const struct frame_input *input,
                               uint32_t needs, uint32_t width, uint32_t height);
// Bytes that a further view adds. It shares layers of the first one if that is not smaller:
// `first`; NULL: it is. more_pixels: than the largest view before.
uint64_t frame_view_memory_estimate(const struct frame_options *options,
                                    const struct frame_input *input,
                                    const struct frame_input *first, uint32_t needs, uint32_t width,
                                    uint32_t height, uint64_t more_pixels);

// frame_compile.c. The pipelines that a frame will need with other techniques, for another thread
// to compile.
struct frame_pipelines {
    uint32_t scene_variants;         // of the scene's materials
    uint32_t gbuffer_layers;         // gbuffer_layers
    bool own_gbuffer, converts, rsm; // converts: a caller's G-buffer
    uint32_t convert_layers;         // gbuffer_layers, as in the last frame but for motion
    uint32_t composite[2];           // variants: of the image, and of the exposure meter
    uint32_t direct, cascades;       // direct: 0, the frame has not been prepared
};

// On the frame's thread. wants: as for the last frame; needs: of the techniques to come.
struct frame_pipelines frame_pipelines_of(const struct frame *frame,
                                          const struct frame_input *wants, uint32_t needs);
bool frame_pipelines_compile(const struct frame_pipelines *pipelines, struct gpu *compiler);
