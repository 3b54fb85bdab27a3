/// Further views of a renderer: other cameras that see the same light in the same frames, for split
/// screen, mirrors, portals. Scene, shadow maps, reflective shadow maps, volumes, voxels and light
/// maps are made once a frame; a view has its own images, exposure and history.
///
/// Views are rendered one after the other, and what only one of them needs at a time shares memory:
/// G-buffer, irradiance, visibility. A view keeps the layers color and display, those that its
/// description names, and those whose handle has been asked for (ag_view_layer_handle); only these
/// can be read. The renderer's own camera is rendered last and keeps all its layers.
///
/// The finer shadow cascades of a sun and the finer grids of lpv:cascades and vct:levels follow the
/// camera of ag_frame_desc. Other views have their light from the coarser ones where they look
/// elsewhere.
#ifndef AFTERGLOW_VIEW_H
#define AFTERGLOW_VIEW_H

#include <afterglow/renderer.h>

AG_BEGIN

/// Members as in ag_renderer_desc.
struct ag_view_desc {
    int width, height;   ///< pixels, 1…16384; default 1280×720
    bool indirect_layer; ///< default false
    bool display_layer;  ///< default true
    bool motion_layer;   ///< default false
    bool host_gbuffer;   ///< default false
    bool all_layers;     ///< keep every layer, in memory of its own; default false
    const struct ag_gbuffer_layout *gbuffer_layout; ///< default NULL
    uint64_t reserved[7];                           ///< 0; see ABI in types.h
};
/// Thread: any.
AG_API void ag_view_desc_default(struct ag_view_desc *desc);
/// Bytes that a view adds to the GPU memory of a renderer, as ag_renderer_estimate_memory counts
/// them. Either description may be NULL: the defaults. Handles that are asked for later add their
/// layers. Thread: the context's.
AG_API enum ag_result ag_view_estimate_memory(struct ag_context *context,
                                              const struct ag_renderer_desc *renderer,
                                              const struct ag_view_desc *desc, uint64_t *bytes);
/// Adds a view; a renderer has at most seven. desc NULL: the defaults. Thread: the context's.
AG_API enum ag_result ag_view_create(struct ag_renderer *renderer, const struct ag_view_desc *desc,
                                     struct ag_view **out);
/// Thread: the context's.
AG_API void ag_view_destroy(struct ag_view *view);
/// As ag_renderer_resize, for this view alone. Thread: the context's.
AG_API enum ag_result ag_view_resize(struct ag_view *view, int width, int height);

/// A view in one frame, for ag_frame_desc.views. A view that a frame leaves out keeps its images
/// and begins its history again later. A camera cut of the frame is one of all views.
struct ag_view_frame {
    struct ag_view *view;
    struct ag_camera camera;
    bool auto_exposure;               ///< as in ag_frame_desc; default true
    float exposure_ev;                ///< likewise
    bool camera_cut;                  ///< of this view; default false
    const struct ag_gbuffer *gbuffer; ///< with host_gbuffer: required; else NULL, the default
    const struct ag_view_matrices *matrices; ///< in place of `camera`; default NULL
    float jitter[2];                         ///< as in ag_frame_desc; default 0, 0
    uint64_t reserved[2];                    ///< 0; see ABI in types.h
};
/// Sets every member except `view` and `camera`. Thread: any.
AG_API void ag_view_frame_default(struct ag_view_frame *frame);

/// As ag_renderer_read, ag_renderer_layer_handle and ag_renderer_exposure, of the newest frame that
/// had the view. There are no layers id and debug. A layer is kept from the next frame on, once its
/// handle has been asked for. Thread: the context's.
AG_API enum ag_result ag_view_read(struct ag_view *view, const char *layer, struct ag_image **out);
/// Likewise. Thread: the context's.
AG_API enum ag_result ag_view_layer_handle(struct ag_view *view, const char *layer,
                                           struct ag_layer_handle *out);
/// Likewise. Thread: the context's.
AG_API enum ag_result ag_view_exposure(struct ag_view *view, float *ev);

AG_END

#endif
