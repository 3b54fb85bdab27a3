/// The path-traced reference: the same scene, materials, lights, camera and units as a renderer,
/// computed on the CPU. Unidirectional path tracing with next-event estimation, multiple importance
/// sampling (Veach 1997, ch. 9) and Russian roulette; unbiased, progressive and readable at any
/// time.
#ifndef AFTERGLOW_REFERENCE_H
#define AFTERGLOW_REFERENCE_H

#include <afterglow/bake.h>
#include <afterglow/image.h>
#include <afterglow/scene.h>

AG_BEGIN

struct ag_reference;

struct ag_reference_desc {
    int width, height;       ///< pixels, 1…16384; default 1280×720
    struct ag_camera camera; ///< see ag_frame_desc
    double time_s;           ///< animation time
    int animation;           ///< see ag_scene_camera; default 0
    int bounces; ///< of indirect light: 0 direct only, 1 one bounce, …; default -1: unlimited
    bool direct_only;   ///< color holds direct light only; default false
    bool indirect_only; ///< color holds indirect light only; default false
    bool guiding;       ///< learn where light comes from, for less noise; default true
    bool antialias;     ///< sample the whole pixel; default false: its centre, as a renderer does
    float obscurance_radius_m;   ///< of the layers obscurance and ambient_occlusion; default 0.5
    float occlusion_decay_per_m; ///< k: an occluder at distance r counts 1/(1 + k·r) in
                                 ///< ambient_occlusion; default 0: fully
    bool obscurance_sphere; ///< obscurance of the whole sphere instead of the hemisphere above the
                            ///< surface; default false
    uint64_t seed;          ///< of all random numbers; default 0
    uint64_t reserved[8];   ///< 0; see ABI in types.h
};
/// Sets every member except `camera`. Thread: any.
AG_API void ag_reference_desc_default(struct ag_reference_desc *desc);

/// Copies what it needs of the scene at that moment; later changes have no effect. The scene may be
/// destroyed before the reference. Thread: the context's.
AG_API enum ag_result ag_reference_create(struct ag_scene *scene,
                                          const struct ag_reference_desc *desc,
                                          struct ag_reference **out);
/// The `samples` ≥ 1 of every pixel of a reference as the tasks of a bake, so that several
/// processes share them (ag_bake_run_team), or machines by shards, and a checkpoint keeps them. Of
/// `desc` (NULL: the defaults) the members threads, shard, shard_count, checkpoint_every_s and
/// max_memory_bytes count; the seed is that of the reference. As for ag_bake_create.
/// Thread: the context's.
AG_API enum ag_result ag_bake_create_reference(struct ag_scene *scene,
                                               const struct ag_reference_desc *of, int samples,
                                               const struct ag_bake_desc *desc,
                                               struct ag_bake **out);
/// A reference with the samples of a complete bake: its layers are those of ag_reference_render, to
/// the bit, and it takes more samples. AG_ERROR_FORMAT: the bake was loaded from a file with values
/// that are not finite. The bake may be destroyed before. Thread: the context's.
AG_API enum ag_result ag_reference_from_bake(const struct ag_bake *bake, struct ag_reference **out);
/// Accepts NULL. Thread: the context's.
AG_API void ag_reference_destroy(struct ag_reference *reference);

/// Adds `samples` ≥ 1 to every pixel, on all cores, and returns when they are done. The image
/// depends neither on the number of cores nor on how samples are spread over calls. `progress` (may
/// be NULL) is called on this thread with the share done, 0…1; if it returns false, the call ends
/// with AG_ERROR_CANCELLED. Samples taken until then are kept, and later calls add to them.
/// Thread: the context's.
AG_API enum ag_result ag_reference_render(struct ag_reference *reference, int samples,
                                          bool (*progress)(void *user, double done), void *user);

/// Names of the layers that ag_reference_read knows; NULL past the end. Thread: any.
AG_API const char *ag_reference_layer_name(int index);
/// A new image with one layer. `channels` is 3 unless stated.
///
/// Mean of all samples:
/// - color: direct + indirect, exactly; cd/m²
/// - direct: emission and sky seen by the camera, and light reflected once from lights, emitters
///   and the sky; cd/m²
/// - indirect: all further bounces; cd/m²
/// - irradiance: of indirect light, without albedo and 1/π; lux
/// - indirect_emitters_sky, irradiance_emitters_sky: the same plus light reflected once from
///   emitters and the sky. Compare them with a renderer's layers indirect and irradiance. With
///   direct_only they hold the emitters' and sky's part alone, with indirect_only the other.
/// - error: standard error of color, cd/m²; infinite for fewer than 2 samples
/// - samples: number of samples of each pixel; 1 channel
///
/// At the pixel's centre; 0 where there is no surface, unless stated:
/// - albedo, normal (unit, world space), position (m): 3 channels
/// - depth: metres along the view axis; 1 channel
/// - obscurance: unoccluded share of the volume within obscurance_radius_m; 1 channel; 1 is open,
///   as without a surface
/// - ambient_occlusion: unoccluded cosine-weighted share of the hemisphere within
///   obscurance_radius_m; 1 channel; 1 is open, as without a surface
///
/// Thread: the context's.
AG_API enum ag_result ag_reference_read(struct ag_reference *reference, const char *layer,
                                        struct ag_image **out);

struct ag_reference_info {
    int samples;   ///< of every pixel, at least
    uint64_t rays; ///< traced by this object
    double mean;   ///< mean luminance of color, cd/m²
    double error; ///< standard error of color's luminance, root mean square over the pixels, cd/m²;
                  ///< infinite for fewer than 2 samples
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_reference_get_info(const struct ag_reference *reference,
                                            struct ag_reference_info *out);

/// Name of the EXR attribute that marks a checkpoint. A checkpoint file has this attribute with the
/// value ag_reference_checkpoint() and the layers direct, indirect, indirect_emitters_sky,
/// irradiance, irradiance_emitters_sky, error and samples.
#define AG_REFERENCE_CHECKPOINT "afterglow.checkpoint"
/// Identifies scene, lights, camera, size and options; owned by the reference.
/// Thread: the context's.
AG_API const char *ag_reference_checkpoint(const struct ag_reference *reference);
/// Replaces the samples by those of a checkpoint file; untrusted input. AG_ERROR_ARGUMENT if the
/// file's scene, lights, camera, size or options differ. Files hold 32-bit floats, so further
/// samples give the image of an uninterrupted run up to rounding. Thread: the context's.
AG_API enum ag_result ag_reference_resume(struct ag_reference *reference, const char *path);

AG_END

#endif
