/// A renderer: a device, a scene, a size and a sum of techniques ("lpv:steps=8"); it renders one
/// frame at a time and hands out named images.
#ifndef AFTERGLOW_RENDERER_H
#define AFTERGLOW_RENDERER_H

#include <afterglow/device.h>
#include <afterglow/image.h>
#include <afterglow/scene.h>

AG_BEGIN

struct ag_renderer;

struct ag_renderer_desc {
    int width, height;         ///< pixels, 1…16384; default 1280×720
    const char *gi;            ///< "source+delta+visibility", default "none"; see ag_technique_get
    const char *frame_options; ///< "shadow_size=2048,…" or NULL; see ag_frame_option_get
    bool indirect_layer;       ///< keep indirect radiance as a layer; default false
    bool display_layer;        ///< keep the tone-mapped picture as a layer; default true
    bool motion_layer;         ///< keep motion since the last frame as a layer; default false
};
AG_API void ag_renderer_desc_default(struct ag_renderer_desc *desc);
/// Bytes of GPU memory that these settings take at most, before anything is created (scene
/// excluded).
AG_API enum ag_result ag_renderer_estimate_memory(struct ag_context *context,
                                                  const struct ag_renderer_desc *desc,
                                                  int light_count, uint64_t *bytes);
/// The scene must outlive the renderer; while it lives, only the scene's lights and sky may change.
/// desc may be NULL.
AG_API enum ag_result ag_renderer_create(struct ag_device *device, struct ag_scene *scene,
                                         const struct ag_renderer_desc *desc,
                                         struct ag_renderer **out);
AG_API void ag_renderer_destroy(struct ag_renderer *renderer);
AG_API enum ag_result ag_renderer_resize(struct ag_renderer *renderer, int width, int height);

struct ag_frame_desc {
    struct ag_camera camera;
    double time_s;      ///< animation time
    int animation;      ///< see ag_scene_camera; default 0: the first, if there is one
    bool auto_exposure; ///< from the log-average of direct light and of what emission lights;
                        ///< default true
    float exposure_ev;  ///< used where auto_exposure is false
    bool camera_cut;    ///< forget history; default false
};
/// Everything but the camera, which comes from ag_scene_default_camera, ag_scene_camera or
/// ag_scene_look_at.
AG_API void ag_frame_desc_default(struct ag_frame_desc *desc);
/// Renders one frame and submits it; does not wait for the GPU.
AG_API enum ag_result ag_renderer_render(struct ag_renderer *renderer,
                                         const struct ag_frame_desc *desc);
/// As ag_renderer_render, but records into a caller's VkCommandBuffer (adopted devices). When the
/// GPU has finished it, call ag_renderer_recorded_done before the next frame.
AG_API enum ag_result ag_renderer_record(struct ag_renderer *renderer,
                                         const struct ag_frame_desc *desc, void *vk_command_buffer);
AG_API enum ag_result ag_renderer_recorded_done(struct ag_renderer *renderer);
/// Waits until the GPU has finished all frames.
AG_API enum ag_result ag_renderer_wait(struct ag_renderer *renderer);

/// Names of the readable layers: color direct indirect irradiance visibility specular albedo normal
/// depth position emissive motion display debug. NULL past the end.
AG_API const char *ag_layer_name(int index);
/// Reads a layer of the newest frame in physical units (cd/m², lux, metres): 3 channels, depth and
/// visibility 1. Waits for the GPU. "indirect" needs indirect_layer, "display" display_layer,
/// "debug" a debug view, "motion" motion_layer or a technique that asks for it. What no technique
/// writes is neutral: no indirect light, visibility 1. Where there is no surface, normals,
/// positions, depths and motions are 0. Motion is where a surface's point is now minus where it was
/// in the last frame, as x and y in widths and heights of the picture, +x right, +y down; z is its
/// distance along the view axis, then over now, minus 1. It is 0 in the first frame and after a
/// cut.
AG_API enum ag_result ag_renderer_read(struct ag_renderer *renderer, const char *layer,
                                       struct ag_image **out);
/// The VkImage of a layer and its VkImageLayout, for programs that share the device. Radiance and
/// irradiance on the GPU are physical × *scale, 1 for other layers: depth is reversed (near plane
/// over distance), normals are octahedral, albedo and display sRGB-encoded. "position" has none.
AG_API enum ag_result ag_renderer_layer_handle(struct ag_renderer *renderer, const char *layer,
                                               void **vk_image, uint32_t *vk_layout, float *scale);
/// EV used for the newest frame. Waits for the GPU.
AG_API enum ag_result ag_renderer_exposure(struct ag_renderer *renderer, float *ev);
/// Shows a technique's debug view in the layer "debug" from the next frame on; NULL switches it
/// off.
AG_API enum ag_result ag_renderer_set_debug_view(struct ag_renderer *renderer, const char *name);

struct ag_timing {
    char name[48]; ///< "technique.stage" or a frame pass; "frame" is the whole frame
    double ms;     ///< GPU time
};
/// GPU times of the newest frame. Waits for the GPU. Returns the number of passes; at most
/// `capacity` are written.
AG_API int ag_renderer_timings(struct ag_renderer *renderer, struct ag_timing *out, int capacity);

struct ag_memory {
    char owner[32];
    uint64_t bytes;
};
/// GPU memory by owner. Returns the number of owners; at most `capacity` are written.
AG_API int ag_renderer_memory(struct ag_renderer *renderer, struct ag_memory *out, int capacity);
/// The sum with every option written out, owned by the renderer.
AG_API const char *ag_renderer_gi(const struct ag_renderer *renderer);
/// Rebuilds shaders that changed on disk (AFTERGLOW_SHADER_DIR). Returns how many.
AG_API int ag_renderer_reload_shaders(struct ag_renderer *renderer);

AG_END

#endif
