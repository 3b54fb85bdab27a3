/// Images in memory and in files, tone mapping and error metrics.
#ifndef AFTERGLOW_IMAGE_H
#define AFTERGLOW_IMAGE_H

#include <afterglow/context.h>

AG_BEGIN

/// 32-bit floats, interleaved, top row first, linear Rec. 709. Created and destroyed by the
/// library; the pixels may be changed freely.
struct ag_image {
    int width, height, channels;
    float *pixels; ///< [height][width][channels]
};

/// 1 ≤ width, height ≤ 16384, 1 ≤ channels ≤ 4; pixels are zero.
AG_API enum ag_result ag_image_create(struct ag_context *context, int width, int height,
                                      int channels, struct ag_image **out);
AG_API void ag_image_destroy(struct ag_context *context, struct ag_image *image);

struct ag_image_layer {
    const char *name;
    const struct ag_image *image;
};
struct ag_attribute {
    const char *name, *value;
};

/// Multi-layer OpenEXR, 32-bit float. All layers have one size. The file appears whole or not at
/// all.
AG_API enum ag_result ag_image_write_exr(struct ag_context *context, const char *path,
                                         const struct ag_image_layer *layers, int layer_count,
                                         const struct ag_attribute *attributes,
                                         int attribute_count);
/// 8-bit sRGB PNG of a display-linear image (see ag_image_tonemap).
AG_API enum ag_result ag_image_write_png(struct ag_context *context, const char *path,
                                         const struct ag_image *image);
/// Reads .exr (layer NULL: "color") or .png (decoded to linear), by the file's extension.
AG_API enum ag_result ag_image_read(struct ag_context *context, const char *path, const char *layer,
                                    struct ag_image **out);
/// The text attribute `name` of an EXR file in `size` bytes, cut where it is longer; "" where the
/// file has none.
AG_API enum ag_result ag_image_read_attribute(struct ag_context *context, const char *path,
                                              const char *name, char *out, size_t size);

/// Radiance (cd/m²) to display values 0…1: exposure for `ev` at ISO 100, then the Khronos PBR
/// Neutral tone mapper.
AG_API enum ag_result ag_image_tonemap(struct ag_context *context, const struct ag_image *radiance,
                                       float ev, struct ag_image **out);
/// EV that puts the log-average luminance of a radiance image at middle grey. Of 4 channels the
/// last is alpha: pixels where it is 0 do not count.
AG_API float ag_image_auto_exposure(const struct ag_image *radiance);
/// Two images of equal height next to each other, `gap` black columns between.
AG_API enum ag_result ag_image_side_by_side(struct ag_context *context, const struct ag_image *a,
                                            const struct ag_image *b, int gap,
                                            struct ag_image **out);

/// What two images hold, and which of their pixels count.
struct ag_compare_desc {
    bool radiance; ///< cd/m²; else display-linear values, 0…1
    float ev; ///< of radiance: for ssim and flip both images are exposed with it and tone-mapped
    const struct ag_image
        *mask; ///< NULL, or of the same size: a pixel counts where any channel is above 0
    bool ignore_not_finite;  ///< leave NaN and infinite pixels out; else they are an error
    float pixels_per_degree; ///< of the screen that flip imagines, 1…1000
};
/// Display values, every pixel, 67 pixels per degree.
AG_API void ag_compare_desc_default(struct ag_compare_desc *desc);

/// Over the pixels that count and the three colour channels. docs/metrics.md says how to read them.
struct ag_metrics {
    double mse, mae, relmse;
    double psnr;     ///< dB, for values in 0…1; infinite for equal images
    double ssim;     ///< structural similarity (Wang et al. 2004), 1 for equal images
    double flip;     ///< LDR-FLIP (Andersson et al. 2020), 0 for equal images … 1
    double flip_hdr; ///< HDR-FLIP (Andersson et al. 2021), likewise; NaN unless desc->radiance
    double mean_a[3], mean_b[3];
    uint64_t counted; ///< pixels
    uint64_t ignored; ///< pixels in the mask that are NaN or infinite in either image
};
/// Error of `a` against the reference `b`: equal sizes, at least 3 channels. desc NULL: the
/// default.
AG_API enum ag_result ag_image_metrics(struct ag_context *context, const struct ag_image *a,
                                       const struct ag_image *b, const struct ag_compare_desc *desc,
                                       struct ag_metrics *out);

enum ag_difference {
    AG_DIFFERENCE_ABSOLUTE, ///< |a − b|, mean of the channels
    AG_DIFFERENCE_SQUARED,
    AG_DIFFERENCE_RELATIVE, ///< what relmse is the mean of
    AG_DIFFERENCE_SSIM,     ///< 1 − ssim
    AG_DIFFERENCE_FLIP,
    AG_DIFFERENCE_FLIP_HDR, ///< of radiance only
};
/// The difference at each pixel through a dark-to-bright scale that saturates at `full` (≤ 0: 1 for
/// ssim and flip, else the 99th percentile); black where pixels do not count. desc NULL: the
/// default.
AG_API enum ag_result ag_image_error_map(struct ag_context *context, const struct ag_image *a,
                                         const struct ag_image *b,
                                         const struct ag_compare_desc *desc,
                                         enum ag_difference difference, float full,
                                         struct ag_image **out);

AG_END

#endif
