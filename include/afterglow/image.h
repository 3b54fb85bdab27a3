/// Images in memory and in files, tone mapping and error metrics.
#ifndef AFTERGLOW_IMAGE_H
#define AFTERGLOW_IMAGE_H

#include <afterglow/context.h>

AG_BEGIN

/// 32-bit floats, interleaved, top row first, linear Rec. 709. The library creates and destroys
/// images; the program may change the pixels.
struct ag_image {
    int width, height, channels;
    float *pixels; ///< [height][width][channels]
};

/// A black image. width and height 1…16384, channels 1…4. Thread: the context's.
AG_API enum ag_result ag_image_create(struct ag_context *context, int width, int height,
                                      int channels, struct ag_image **out);
/// context: that of the image; it may be destroyed already, and NULL. Thread: the context's.
AG_API void ag_image_destroy(struct ag_context *context, struct ag_image *image);

struct ag_image_layer {
    const char *name;
    const struct ag_image *image;
};
struct ag_attribute {
    const char *name, *value;
};

/// Writes a multi-layer OpenEXR file of 32-bit floats. All layers have the same size. A failed
/// write leaves no file and keeps an existing one. Thread: the context's.
AG_API enum ag_result ag_image_write_exr(struct ag_context *context, const char *path,
                                         const struct ag_image_layer *layers, int layer_count,
                                         const struct ag_attribute *attributes,
                                         int attribute_count);
/// Writes an 8-bit sRGB PNG of a linear display image (see ag_image_tonemap); values are clamped to
/// 0…1. Thread: the context's.
AG_API enum ag_result ag_image_write_png(struct ag_context *context, const char *path,
                                         const struct ag_image *image);
/// Reads an .exr (layer NULL: "color") or .png (decoded to linear) file, by its extension.
/// Untrusted input. Former names of reference layers are accepted with a warning.
/// Thread: the context's.
AG_API enum ag_result ag_image_read(struct ag_context *context, const char *path, const char *layer,
                                    struct ag_image **out);
/// Width and height of such a file, without reading its pixels: to estimate the memory that
/// ag_image_read takes, which is 16 bytes a pixel and twice the file. Thread: the context's.
AG_API enum ag_result ag_image_read_size(struct ag_context *context, const char *path, int *width,
                                         int *height);
/// Copies the text attribute `name` of an EXR file to `out`, truncated to `size` bytes; "" if
/// absent. Thread: the context's.
AG_API enum ag_result ag_image_read_attribute(struct ag_context *context, const char *path,
                                              const char *name, char *out, size_t size);

/// Tone curves from exposed radiance to linear display values 0…1.
enum ag_tonemap {
    AG_TONEMAP_NEUTRAL, ///< Khronos 2024, "PBR Neutral Tone Mapper Specification": keeps hue
    AG_TONEMAP_AGX,     ///< AgX as in Blender 4 (Sobotka; Chow): bright colours go to white
    AG_TONEMAP_LINEAR,  ///< values above 1 are cut off
};

/// Converts radiance (cd/m²) to linear display values 0…1: exposure for `ev` at ISO 100, then the
/// tone curve. *out is the caller's: ag_image_destroy. Thread: the context's.
AG_API enum ag_result ag_image_tonemap_curve(struct ag_context *context,
                                             const struct ag_image *radiance, float ev,
                                             enum ag_tonemap curve, struct ag_image **out);
/// The same with AG_TONEMAP_NEUTRAL. Thread: the context's.
AG_API enum ag_result ag_image_tonemap(struct ag_context *context, const struct ag_image *radiance,
                                       float ev, struct ag_image **out);
/// EV that maps the log-average luminance of a radiance image, clamped to its 10th and 90th
/// percentile, to middle grey. A fourth channel is alpha; pixels with alpha 0 are ignored.
/// Thread: any.
AG_API float ag_image_auto_exposure(const struct ag_image *radiance);
/// Rules of automatic exposure, docs/units.md.
enum ag_metering {
    AG_METERING_MEAN, ///< as ag_image_auto_exposure
    /// Likewise, but as much darker, at most 3 EV, as exposes the 98th percentile of lit pixels
    /// to 1: sunlit floors and the surroundings of lights keep their texture.
    AG_METERING_HIGHLIGHTS,
};
/// The EV of a radiance image by a rule; of none of them: AG_METERING_MEAN. Thread: any.
AG_API float ag_image_metered_exposure(const struct ag_image *radiance, enum ag_metering metering);
/// Places two images of equal height side by side, with `gap` black columns between them.
/// Thread: the context's.
AG_API enum ag_result ag_image_side_by_side(struct ag_context *context, const struct ag_image *a,
                                            const struct ag_image *b, int gap,
                                            struct ag_image **out);

/// Kind of values in two images, and the pixels that count.
struct ag_compare_desc {
    bool radiance; ///< values are cd/m²; else linear display values, 0…1
    float ev;      ///< of radiance: exposure of both images before tone mapping for ssim and flip
    const struct ag_image *mask; ///< NULL, or of equal size; pixels with a channel above 0 count
    bool ignore_not_finite;      ///< ignore NaN and infinite pixels; else they are an error
    float pixels_per_degree;     ///< of the viewing condition of flip, 1…1000
    uint64_t reserved[4];        ///< 0; see ABI in types.h
};
/// Display values, all pixels, 67 pixels per degree. Thread: any.
AG_API void ag_compare_desc_default(struct ag_compare_desc *desc);

/// Metrics over all counted pixels and three colour channels; docs/metrics.md explains them.
struct ag_metrics {
    double mse, mae, relmse;
    double psnr;     ///< dB, for values in 0…1; infinite for equal images
    double ssim;     ///< structural similarity (Wang et al. 2004), 1 for equal images
    double flip;     ///< LDR-FLIP (Andersson et al. 2020), 0 for equal images … 1
    double flip_hdr; ///< HDR-FLIP (Andersson et al. 2021), likewise; NaN unless desc->radiance
    double mean_a[3], mean_b[3];
    uint64_t counted;     ///< number of pixels measured
    uint64_t ignored;     ///< pixels in the mask that are NaN or infinite in either image
    uint64_t reserved[8]; ///< 0; see ABI in types.h
};
/// Error of `a` relative to the reference `b`: equal sizes, at least 3 channels. desc NULL: the
/// defaults. Thread: the context's.
AG_API enum ag_result ag_image_metrics(struct ag_context *context, const struct ag_image *a,
                                       const struct ag_image *b, const struct ag_compare_desc *desc,
                                       struct ag_metrics *out);

enum ag_difference {
    AG_DIFFERENCE_ABSOLUTE, ///< |a − b|, mean of the channels
    AG_DIFFERENCE_SQUARED,
    AG_DIFFERENCE_RELATIVE, ///< relative squared error, whose mean is relmse
    AG_DIFFERENCE_SSIM,     ///< 1 − ssim
    AG_DIFFERENCE_FLIP,
    AG_DIFFERENCE_FLIP_HDR, ///< radiance only
};
/// Display image of the difference at each pixel, from dark to bright; white at `full` (≤ 0: at 1
/// for ssim and flip, else at the 99th percentile), black where pixels do not count. desc NULL: the
/// defaults. Thread: the context's.
AG_API enum ag_result ag_image_error_map(struct ag_context *context, const struct ag_image *a,
                                         const struct ag_image *b,
                                         const struct ag_compare_desc *desc,
                                         enum ag_difference difference, float full,
                                         struct ag_image **out);

AG_END

#endif
