/// The path-traced reference: the picture that a renderer approximates, computed on the CPU with
/// the same materials, lights, camera and units. It converges sample by sample and can be read at
/// any time.
#ifndef AFTERGLOW_REFERENCE_H
#define AFTERGLOW_REFERENCE_H

#include <afterglow/image.h>
#include <afterglow/scene.h>

AG_BEGIN

struct ag_reference;

struct ag_reference_desc {
    int width, height;       ///< pixels, 1…16384; default 1280×720
    struct ag_camera camera; ///< see ag_frame_desc
    double time_s;           ///< animation time
    int animation;           ///< see ag_scene_camera; default 0
    int bounces; ///< of indirect light: 0 direct light alone, 1 one bounce, …; default -1: no limit
    bool direct_only;   ///< color holds direct light alone; default false
    bool indirect_only; ///< color holds indirect light alone; default false
    bool antialias; ///< samples all over each pixel; default false: at its centre, as a renderer's
    float obscurance_radius_m;   ///< of the layers obscurance and ambient_occlusion; default 0.5
    float occlusion_decay_per_m; ///< ambient_occlusion: what is met at the distance r hides 1/(1 +
                                 ///< this · r); default 0: all
    bool obscurance_sphere; ///< obscurance of the whole sphere, not of the hemisphere above the
                            ///< surface; default false
    uint64_t seed;          ///< default 0
};
/// Everything but the camera.
AG_API void ag_reference_desc_default(struct ag_reference_desc *desc);

/// Takes the scene as it is now, at that moment; later changes are not seen. The scene must outlive
/// the reference.
AG_API enum ag_result ag_reference_create(struct ag_scene *scene,
                                          const struct ag_reference_desc *desc,
                                          struct ag_reference **out);
AG_API void ag_reference_destroy(struct ag_reference *reference);

/// Adds samples to every pixel, on all cores; returns when they are there. The picture depends
/// neither on the number of cores nor on how samples are spread over calls. `progress` (may be
/// NULL) is called on this thread with the share that is done, 0…1; when it returns false the call
/// ends with AG_ERROR_CANCELLED, and what is there stays and can be added to.
AG_API enum ag_result ag_reference_render(struct ag_reference *reference, int samples,
                                          bool (*progress)(void *user, double done), void *user);

/// Names of the layers: color direct indirect gathered irradiance gathered_irradiance albedo normal
/// depth position error samples obscurance ambient_occlusion. NULL past the end.
AG_API const char *ag_reference_layer_name(int index);
/// A layer in physical units (cd/m², lux, metres): 3 channels, depth, samples, obscurance and
/// ambient_occlusion 1. color = direct + indirect, to the bit.
/// direct is what comes straight from a light, a surface that glows or the sky, and these
/// themselves; indirect the rest; irradiance that of the indirect light. gathered and
/// gathered_irradiance are the same with what surfaces that glow and the sky throw straight on the
/// surface seen: what techniques add to a frame's direct light, to be compared with its layers
/// indirect and irradiance. With direct_only they hold the straight part alone, with indirect_only
/// the other. error is the standard error of color (infinite for less than 2 samples), samples how
/// many each pixel has. obscurance is the open share of the volume round the surface up to the
/// radius, ambient_occlusion the share of the sky above it that is open so far, weighted with the
/// cosine; 1 is open, and where there is no surface. The others are those of the pixel's centre, 0
/// where there is no surface.
AG_API enum ag_result ag_reference_read(struct ag_reference *reference, const char *layer,
                                        struct ag_image **out);

struct ag_reference_info {
    int samples;   ///< of every pixel, at least
    uint64_t rays; ///< traced by this object
    double mean;   ///< mean luminance of color, cd/m²
    double error;  ///< root mean square over the pixels of the luminance's standard error, cd/m²;
                   ///< infinite for less than 2 samples
};
AG_API enum ag_result ag_reference_get_info(const struct ag_reference *reference,
                                            struct ag_reference_info *out);

/// The attribute that makes an EXR of the layers direct, indirect, gathered, irradiance,
/// gathered_irradiance, error and samples one to go on from; its value is ag_reference_checkpoint,
/// a string that belongs to the reference.
#define AG_REFERENCE_CHECKPOINT "afterglow.checkpoint"
AG_API const char *ag_reference_checkpoint(const struct ag_reference *reference);
/// Replaces the samples by those of such a file. It must be of the same scene, light, camera, size
/// and options (AG_ERROR_ARGUMENT else); an untrusted file. The file's 32-bit values are where sums
/// go on from, so the result is that of an uninterrupted run but for rounding.
AG_API enum ag_result ag_reference_resume(struct ag_reference *reference, const char *path);

AG_END

#endif
