/// Preparations: what a renderer needs for another GI spec is compiled on another thread, while
/// frames go on. ag_renderer_set_gi then does not wait for a compiler.
///
///     ag_preparation_create(renderer, "vct+vo", &preparation);       // the renderer's thread
///     ag_preparation_run(preparation, context, NULL, NULL);          // another thread
///     ag_preparation_destroy(preparation);                           // the renderer's thread
///     ag_renderer_set_gi(renderer, "vct+vo", NULL, 0);
///
/// The first frame of the new techniques still has their work on the GPU: voxels, light maps. Bakes
/// are loaded on a thread with a context of its own (ag_bake_load).
#ifndef AFTERGLOW_PREPARATION_H
#define AFTERGLOW_PREPARATION_H

#include <afterglow/renderer.h>

AG_BEGIN

struct ag_preparation;

/// For the GI spec after at least one frame, with the present layers, lights and materials: takes
/// microseconds. The renderer may change meanwhile; what it then needs beyond that is compiled by
/// its next frame. Thread: the renderer's.
AG_API enum ag_result ag_preparation_create(struct ag_renderer *renderer, const char *gi,
                                            struct ag_preparation **out);
/// Compiles. Thread: any, beside frames; context: of that thread, with the `reallocate` and `user`
/// of the renderer's, or NULL on the renderer's thread. `progress` (may be NULL) is called with the
/// part done, 0…1; false cancels (AG_ERROR_CANCELLED), and what is done stays. Vulkan calls on this
/// thread use ag_device_adopt.vk_allocation_callbacks, too.
AG_API enum ag_result ag_preparation_run(struct ag_preparation *preparation,
                                         struct ag_context *context,
                                         bool (*progress)(void *user, double done), void *user);
/// Pipelines compiled so far; those that the renderer has already are among them. Thread: that of
/// ag_preparation_run, or any when it has returned.
AG_API int ag_preparation_pipelines(const struct ag_preparation *preparation);
/// Hands them to the device, for ag_renderer_set_gi and further renderers. Thread: the renderer's,
/// when ag_preparation_run has returned. May come after the renderer's own end.
AG_API void ag_preparation_destroy(struct ag_preparation *preparation);

AG_END

#endif
