/// Renderers. A renderer has a device, a scene, an image size and a GI spec ("lpv:steps=8+vo"). It
/// renders one frame at a time; its results are named images, called layers.
#ifndef AFTERGLOW_RENDERER_H
#define AFTERGLOW_RENDERER_H

#include <afterglow/bake.h>
#include <afterglow/device.h>
#include <afterglow/image.h>
#include <afterglow/scene.h>

AG_BEGIN

struct ag_renderer;
struct ag_view;
struct ag_view_frame;

/// How a program's own G-buffer is encoded, where ag_gbuffer says something else. Images may be
/// larger than the renderer: it reads the part from the left and the top. Formats, by VkFormat:
///
/// - depth: D16_UNORM, X8_D24_UNORM_PACK32, D24_UNORM_S8_UINT, D32_SFLOAT, D32_SFLOAT_S8_UINT,
///   R32_SFLOAT. Reversed or forward, with or without a far plane: it is the depth of
///   ag_frame_desc.matrices, or without them that of ag_gbuffer
/// - normal, octahedral: R16G16_SFLOAT, R32G32_SFLOAT, R16G16_SNORM, R16G16_UNORM and all of the
///   others; x, y, z: R8G8B8A8_UNORM, R8G8B8A8_SNORM, A2B10G10R10_UNORM_PACK32,
///   R16G16B16A16_UNORM, R16G16B16A16_SNORM, R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT
/// - albedo: R8G8B8A8 and B8G8R8A8, SRGB or UNORM (then linear), A2B10G10R10_UNORM_PACK32,
///   R16G16B16A16_UNORM, R16G16B16A16_SFLOAT, B10G11R11_UFLOAT_PACK32
/// - material: R8G8_UNORM, R8G8B8A8_UNORM, B8G8R8A8_UNORM, R16G16_UNORM, R16G16_SFLOAT,
///   R16G16B16A16_SFLOAT
/// - dielectric: R8G8B8A8_UNORM, R16G16B16A16_UNORM, R16G16B16A16_SFLOAT
/// - emissive: R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT, B10G11R11_UFLOAT_PACK32
/// - motion: R16G16_SFLOAT, R32G32_SFLOAT, R16G16_SNORM, R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT
/// - id: R32G32_UINT, at the renderer's size
struct ag_gbuffer_layout {
    bool normal_octahedral;    ///< two components, as ag_gbuffer; false: x, y, z; default true
    bool normal_in_view_space; ///< of view_from_world; default false: world space
    float normal_scale;        ///< components = sampled value × normal_scale + normal_bias; for
    float normal_bias;         ///< UNORM formats 2 and −1; default 1, 0
    bool albedo_alpha;         ///< as in ag_gbuffer; false: all surfaces are lit; default true
    int roughness_channel;     ///< of material, 0…3; -1: none, roughness 1; default 0
    int metallic_channel;      ///< likewise, none: 0; glTF's textures have 1 and 2; default 1
    /// x and y of the layer motion = sampled value × motion_scale + ag_gbuffer.motion_offset.
    /// Pixels from now to the last frame, +y down: −1/width, −1/height. Default 1, 1.
    float motion_scale[2];
    bool motion_distance; ///< z as in the layer motion; false: surfaces stand still along the axis;
                          ///< default true; false for formats of two components
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// Thread: any.
AG_API void ag_gbuffer_layout_default(struct ag_gbuffer_layout *layout);

struct ag_renderer_desc {
    int width, height; ///< pixels, 1…16384; default 1280×720
    /// GI spec: "source+delta+visibility+reflection"; default "none"; see ag_technique_get. A
    /// visibility or reflection technique alone gets the source "ambient", with a warning.
    const char *gi;
    const char *frame_options; ///< "shadow_size=2048,…" or NULL; see ag_frame_option_get
    bool indirect_layer;       ///< keep the layer "indirect"; default false
    bool display_layer;        ///< keep the layer "display"; default true
    bool motion_layer;         ///< keep the layer "motion"; default false
    /// Complete bakes for the techniques that need one; needed only during the call. Default none.
    const struct ag_bake *const *bakes;
    int bake_count;
    /// Without one in `bakes`: folder with files KEY.safetensors (ag_bake_part.key with seed 0).
    /// Default NULL: none.
    const char *bake_folder;
    bool id_layer; ///< keep the layer "id"; default false
    /// Each frame is given a G-buffer (ag_frame_desc.gbuffer); not with id_layer; default false.
    bool host_gbuffer;
    /// Frames depend on scene and time alone: work that techniques do beside frames, as drt does
    /// after objects moved, is waited for, as with their option "update=wait"; default false.
    bool wait_for_updates;
    /// With host_gbuffer: formats and encodings of the program's own. NULL: those of ag_gbuffer,
    /// which are read in place; others are converted in one pass (frame.gbuffer_convert) into
    /// images of the renderer. Needed only during the call. Default NULL.
    const struct ag_gbuffer_layout *gbuffer_layout;
    /// For estimates of memory alone: the longest side of the scene in metres, on which
    /// vct:levels=0 depends. Default 0: a small scene.
    float scene_size_m;
    uint64_t reserved[5]; ///< 0; see ABI in types.h
};
/// Thread: any.
AG_API void ag_renderer_desc_default(struct ag_renderer_desc *desc);
/// GPU memory of a renderer with these settings: bytes of buffers and texels, without the scene,
/// further views (ag_view_estimate_memory) and what the driver pads. It counts each light as a sun
/// or a point light, whichever takes more, and a material with a specular lobe of its own. Beside
/// that, and what a bake brings, it is exact to 1 %. desc NULL: the defaults.
/// Thread: the context's.
AG_API enum ag_result ag_renderer_estimate_memory(struct ag_context *context,
                                                  const struct ag_renderer_desc *desc,
                                                  int light_count, uint64_t *bytes);
/// Renderers follow changes of their scene between frames. Device and scene may
/// be destroyed before the renderer, which keeps them. desc NULL: the defaults.
/// Thread: the context's.
AG_API enum ag_result ag_renderer_create(struct ag_device *device, struct ag_scene *scene,
                                         const struct ag_renderer_desc *desc,
                                         struct ag_renderer **out);
/// A renderer with views stays, with its GPU memory, until the last of them is destroyed.
/// Thread: the context's.
AG_API void ag_renderer_destroy(struct ag_renderer *renderer);
/// Discards the newest frame and the history of techniques. If it fails, only a successful resize
/// allows further frames. Thread: the context's.
AG_API enum ag_result ag_renderer_resize(struct ag_renderer *renderer, int width, int height);

/// Exchanges the GI spec from the next frame on; options that it does not name have their defaults.
/// Techniques go on if only their options of effect "live" or "invalidate" differ (see
/// ag_option_info): nothing is created. Others are created again beside the old ones, which are
/// destroyed afterwards. The scene, the frame's images and maps stay. `bakes` as in
/// ag_renderer_desc, for techniques created again; dnrt, where objects have come that its bake
/// lacks, is created again with a bake that has them. A debug view ends with its technique. After a
/// failure nothing has changed. Thread: the context's.
AG_API enum ag_result ag_renderer_set_gi(struct ag_renderer *renderer, const char *gi,
                                         const struct ag_bake *const *bakes, int bake_count);
/// Exchanges the frame options likewise. NULL: the defaults. Thread: the context's.
AG_API enum ag_result ag_renderer_set_frame_options(struct ag_renderer *renderer,
                                                    const char *options);

/// A layer as Vulkan objects of the adopted device, owned by the renderer; or a program's own
/// image for struct ag_gbuffer.
struct ag_layer_handle {
    void *vk_image, *vk_image_view;          ///< VkImage; VkImageView: 2D, all of the image
    uint32_t vk_format, vk_usage, vk_layout; ///< VkFormat, VkImageUsageFlags, VkImageLayout
    int width, height;                       ///< pixels
    float scale;
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// A camera by its matrices, as an engine has them. Element [4 × column + row], for column vectors
/// and Vulkan's clip space: x right, y down, depth 0…1. Reversed or forward depth, a far plane or
/// none, sub-pixel jitter and an image off the axis follow from clip_from_view. The image is always
/// rendered with reversed depth, and in a perspective without a far plane: geometry behind it is
/// seen. Screen-space occlusion (vo, ssao, hbao, gtao) expects square pixels.
struct ag_view_matrices {
    float view_from_world[16]; ///< rotation and translation in m; left- or right-handed
    float clip_from_view[16];  ///< perspective or orthographic, without an oblique near plane
    bool y_up;            ///< clip space has +y up: viewports of negative height; default false
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};

/// A program's own G-buffer, in place of the renderer's: the surfaces that the camera sees, at the
/// renderer's size. The members are those of ag_layer_handle without the view; an image that is
/// absent is zeroed. Without ag_renderer_desc.gbuffer_layout, formats, usage (at least SAMPLED) and
/// layout (SHADER_READ_ONLY_OPTIMAL) are those of layer handles, so that handles of another
/// renderer fit.
///
/// The images must live until the GPU has finished the frame. Before the frame's commands the
/// program has written them: in the same or an earlier command buffer of the queue, without a
/// barrier except for the layout; on another queue, with a semaphore. It may write them again after
/// the frame: behind a barrier from ALL_COMMANDS. The library only reads, and keeps the layout.
struct ag_gbuffer {
    /// Required. D32_SFLOAT: near_m of the camera / distance along the view axis, 0: no surface. In
    /// orthographic views (far − distance) / (far − near).
    struct ag_layer_handle depth;
    /// Required. R16G16_SFLOAT: unit shading normal in world space, octahedral
    /// (frame/octahedral.glsl of the installed shader functions, share/afterglow/glsl).
    struct ag_layer_handle normal;
    /// Required. R8G8B8A8_SRGB: base colour; alpha 1: surface, 0.5: unlit, 0: none.
    struct ag_layer_handle albedo;
    struct ag_layer_handle material; ///< R8G8_UNORM: roughness, metallic; absent: 1, 0
    /// R8G8B8A8_UNORM: √F0 of the dielectric specular lobe, F90 in alpha; absent: √0.04, 1.
    struct ag_layer_handle dielectric;
    /// R16G16B16A16_SFLOAT: cd/m² × its scale, also the radiance of unlit surfaces; absent: 0. The
    /// light of emissive surfaces comes from the scene's materials.
    struct ag_layer_handle emissive;
    /// R16G16B16A16_SFLOAT: the layer motion, alpha 1 at surfaces. Required by techniques with a
    /// history (vct:temporal=true …) and by motion_layer.
    struct ag_layer_handle motion;
    /// R32G32_UINT: instance and triangle, each plus 1, 0: no surface; as the layer id. Without it
    /// probes light all surfaces of radiosity and the objects of drt.
    struct ag_layer_handle id;
    /// With a layout: added to motion, in image widths and heights. Where the program's own
    /// excludes the jitter, that of this frame minus that of the last one. Default 0, 0.
    float motion_offset[2];
    uint64_t reserved[7]; ///< 0; see ABI in types.h
};

struct ag_frame_desc {
    struct ag_camera camera;
    double time_s;      ///< animation time
    int animation;      ///< see ag_scene_camera; default 0: the first, if any
    bool auto_exposure; ///< meter the log-average of the frame's radiance; default true
    float exposure_ev;  ///< EV at ISO 100 if auto_exposure is false
    bool camera_cut;    ///< discard history of earlier frames; default false
    /// x and y, from the left and the top, of the pixel that ag_renderer_picked is to tell about;
    /// default NULL: none. Without id_layer, the first such frame of a renderer creates an image
    /// and pipelines; it keeps them.
    const int *pick;
    const struct ag_gbuffer *gbuffer;  ///< with host_gbuffer: required; else NULL, the default
    const struct ag_view_frame *views; ///< further views of this frame, see view.h; default NULL
    int view_count;                    ///< default 0
    const struct ag_view_matrices *matrices; ///< in place of `camera`; NULL, the default: camera
    /// Sub-pixel jitter: a pixel samples its centre plus this offset in pixels, +x right, +y down,
    /// each −0.5…0.5; ag_jitter has a sequence. Jitter of `matrices` stays, this one is added.
    /// Motion vectors exclude it: a static scene has motion 0, whatever the jitter. Those of the
    /// program's own G-buffer, which is rendered with this jitter, exclude it too. Shadow cascades
    /// follow the camera without it. Default 0, 0: the centre.
    float jitter[2];
    uint64_t reserved[2]; ///< 0; see ABI in types.h
};
/// Sets every member except `camera`; ag_scene_default_camera, ag_scene_camera and ag_scene_look_at
/// return one. Thread: any.
AG_API void ag_frame_desc_default(struct ag_frame_desc *desc);
/// Point `index` modulo `count` of the first `count` points of the Halton sequence of bases 2 and
/// 3, moved so that their mean is 0: offsets for ag_frame_desc.jitter. The mean of that many frames
/// is a box-filtered image. count below 2: 0, 0. Thread: any.
AG_API void ag_jitter(int index, int count, float jitter[2]);
/// Renders one frame and submits it. Two frames are in flight: the call waits until the frame
/// before the last is finished. Thread: the context's.
AG_API enum ag_result ag_renderer_render(struct ag_renderer *renderer,
                                         const struct ag_frame_desc *desc);
/// Like ag_renderer_render, but records into the caller's VkCommandBuffer (recording, outside of a
/// rendering); adopted devices only. *frame is the frame's number. Never waits: up to eight
/// recorded frames of a device may be unfinished. Submit command buffers to the adopted queue in
/// the order of recording. Calls that wait for the GPU, and ag_renderer_render, are refused while a
/// recorded frame is unfinished. Thread: the context's; no other uses the pool of the command
/// buffer meanwhile.
AG_API enum ag_result ag_renderer_record(struct ag_renderer *renderer,
                                         const struct ag_frame_desc *desc, void *vk_command_buffer,
                                         uint64_t *frame);
/// Tells that the GPU has executed a recorded frame, and all that the renderer recorded before: the
/// memory that they used may be reused. Thread: the context's.
AG_API enum ag_result ag_renderer_recorded_done(struct ag_renderer *renderer, uint64_t frame);
/// Waits until the GPU has finished all frames. Thread: the context's.
AG_API enum ag_result ag_renderer_wait(struct ag_renderer *renderer);

/// Names of the layers that ag_renderer_read knows; NULL past the end. Thread: any.
AG_API const char *ag_layer_name(int index);
/// A new image with one layer of the newest frame; waits for the GPU. `channels` is 3 unless
/// stated. Without a technique that writes them, indirect light is 0 and visibility 1.
///
/// - color: direct + indirect; cd/m²
/// - direct: emission and sky seen by the camera, and light reflected once from punctual lights;
///   cd/m²
/// - indirect: light added by techniques; cd/m²; requires indirect_layer
/// - irradiance: of that light, without albedo and 1/π; lux
/// - specular: reflected radiance from techniques; cd/m²
/// - visibility: ambient visibility, 0…1; 1 channel
/// - albedo, normal (unit, world space), position (m): 0 where there is no surface
/// - depth: metres along the view axis, 0 where there is no surface; 1 channel
/// - emissive: emitted radiance; cd/m²
/// - motion: position now minus position in the last frame, x and y in image widths and heights (+x
///   right, +y down), z = ratio of the distances along the view axis, then over now, minus 1. 0
///   where there is no surface, in the first frame and after a cut. Requires motion_layer or a
///   technique that needs it.
/// - id: index of the instance (ag_scene_set_instance_transform) and of the triangle in its mesh
///   (three indices each, counted from 0), of the surface that the pixel's centre sees; −1 and −1
///   where there is no surface; 2 channels, exact up to 2^24; requires id_layer
/// - display: exposed and tone mapped, linear, 0…1; requires display_layer; see
///   ag_renderer_set_display
/// - debug: the debug view; requires ag_renderer_set_debug_view
///
/// With host_gbuffer, albedo, normal, position, depth, emissive and motion are the program's own
/// and cannot be read here; there is no layer id, and a frame cannot pick. Thread: the context's.
AG_API enum ag_result ag_renderer_read(struct ag_renderer *renderer, const char *layer,
                                       struct ag_image **out);
/// For programs that share the device; also before the first frame. "position" has no image.
///
/// Lifetime: until the next ag_renderer_resize; "debug": until the debug view is set. The content
/// is that of the newest frame. Where no technique writes a layer, its frames are neutral:
/// visibility 1, irradiance and specular 0.
///
/// Values: radiance and irradiance are physical values × scale (1 for other layers). The scale is a
/// power of two; it follows lights, sky and emission and is that of the newest recorded frame: ask
/// again after each frame. Depth is reversed and as in ag_gbuffer, normals are octahedral
/// (frame/octahedral.glsl, as above), albedo and display are sRGB-encoded; id has integers, each
/// plus 1, 0: no surface.
///
/// Synchronization: before and after each frame the image is in vk_layout, for all queue accesses
/// of the adopted family. The library waits for all that was submitted before its frame. The
/// program waits for the frame: in the same or a later command buffer of the queue by a barrier
/// from ALL_COMMANDS, MEMORY_WRITE; on other queues by a semaphore. A layout that it changes it
/// restores. The first call for a layer submits a command buffer: submit recorded frames before.
/// Thread: the context's.
AG_API enum ag_result ag_renderer_layer_handle(struct ag_renderer *renderer, const char *layer,
                                               struct ag_layer_handle *out);
/// Numbers of the newest frame that the GPU has finished.
struct ag_finished_frame {
    uint64_t frame;       ///< its number: a renderer counts its frames from 1; 0: none is finished
    float exposure_ev;    ///< EV at ISO 100
    float scale;          ///< of its radiance and irradiance layers, see ag_renderer_layer_handle
    uint64_t reserved[6]; ///< 0; see ABI in types.h
};
/// Does not wait. A recorded frame is finished with ag_renderer_recorded_done.
/// Thread: the context's.
AG_API enum ag_result ag_renderer_finished(struct ag_renderer *renderer,
                                           struct ag_finished_frame *out);
/// The surface of a pixel.
struct ag_pick {
    uint64_t frame;         ///< its number; 0: none with `pick` is finished
    int x, y;               ///< the pixel
    int instance, triangle; ///< as in the layer id; -1: no surface
    uint64_t reserved[4];   ///< 0; see ABI in types.h
};
/// The pick of the newest frame with `pick` (ag_frame_desc) that the GPU has finished. Neither
/// waits nor submits. Instances are numbered as at the time of that frame: the index of one that
/// was removed since may belong to another one. Thread: the context's.
AG_API enum ag_result ag_renderer_picked(struct ag_renderer *renderer, struct ag_pick *out);
/// EV of the newest frame; waits for the GPU. Thread: the context's.
AG_API enum ag_result ag_renderer_exposure(struct ag_renderer *renderer, float *ev);
/// Draws a debug view of a technique to the layer "debug" in all further frames; NULL: none.
/// Thread: the context's.
AG_API enum ag_result ag_renderer_set_debug_view(struct ag_renderer *renderer, const char *name);

/// Shows another layer in the layer "display" of all further frames; NULL: color. Requires
/// display_layer, and for indirect indirect_layer; other layers are kept while they are shown.
///
/// - color, direct, indirect, specular, emissive, debug: exposed with the EV of the frame, tone
///   mapped. debug without a debug view: color
/// - irradiance: likewise E/π, the radiance of a white diffuse surface
/// - albedo, visibility: unchanged
/// - normal: (n + 1)/2; depth: 1/(1 + metres); motion: x, y in pixels and z, each as
///   (1 + v/(1 + |v|))/2. Black where there is no surface
/// - id, position and display cannot be shown; with host_gbuffer, nor can emissive
///
/// Thread: the context's.
AG_API enum ag_result ag_renderer_set_display(struct ag_renderer *renderer, const char *layer);

struct ag_timing {
    char name[48]; ///< "technique.stage" or a frame pass; "frame" is the whole frame
    double ms;     ///< GPU time
};
/// GPU times of the newest frame; waits for the GPU. Returns the number of passes and writes at
/// most `capacity`. Thread: the context's.
AG_API int ag_renderer_timings(struct ag_renderer *renderer, struct ag_timing *out, int capacity);

/// The same times of the newest frame that the GPU has finished. Does not wait.
/// Thread: the context's.
AG_API int ag_renderer_finished_timings(struct ag_renderer *renderer, struct ag_timing *out,
                                        int capacity);

/// GPU memory of a renderer by owner, with its copy of the scene; without the transient and staging
/// buffers, which are the device's (ag_device_memory). Does not wait. Returns the number of owners
/// and writes at most `capacity`. Thread: the context's.
AG_API int ag_renderer_memory(struct ag_renderer *renderer, struct ag_memory *out, int capacity);
/// Whether the light of the newest frame is not yet that of the scene which it shows, and comes
/// with further frames: a thread makes it (drt with update=background, after objects moved), or an
/// update is spread over frames (radiosity's option frames). Histories that accumulate over frames
/// do not count. False before the first frame. Does not wait. Thread: the context's.
AG_API bool ag_renderer_is_updating(const struct ag_renderer *renderer);
/// The GI spec with all options; owned by the renderer. Thread: the context's.
AG_API const char *ag_renderer_gi(const struct ag_renderer *renderer);
/// Reloads shaders that changed on disk (AFTERGLOW_SHADER_DIR); returns their number.
/// Thread: the context's.
AG_API int ag_renderer_reload_shaders(struct ag_renderer *renderer);

AG_END

#endif
