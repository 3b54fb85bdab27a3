// Images, files and metrics: forwards to image/.
#include "api/objects.h"

#include "core/files/file.h"
#include "image/exr.h"
#include "image/flip.h"
#include "image/image.h"
#include "image/metrics.h"
#include "image/png_file.h"
#include "image/exposure.h"
#include "image/tonemap.h"

#include <stdio.h>
#include <string.h>

enum { MAX_LAYERS = 256, MAX_ATTRIBUTES = 256 };

_Static_assert((int)AG_TONEMAP_LINEAR == (int)TONEMAP_LINEAR, "one order in both");
_Static_assert(IMAGE_MAX_SIZE == 16384, "afterglow/image.h promises it");

// The module's view of the same pixels.
static struct image view_of(const struct ag_image *image)
{
    return (struct image){ image->width, image->height, image->channels, image->pixels };
}

static bool is_whole(const struct ag_image *image)
{
    return image && image->pixels && image->width >= 1 && image->width <= IMAGE_MAX_SIZE &&
           image->height >= 1 && image->height <= IMAGE_MAX_SIZE && image->channels >= 1 &&
           image->channels <= 4;
}

// An image keeps its context, which its memory comes from.
struct owned_image {
    struct ag_image image; // first: programs have its address
    struct ag_context *context;
};

enum ag_result api_give_image(struct ag_context *context, bool ok, struct image *image,
                              struct ag_image **out)
{
    struct owned_image *given = ok ? host_alloc(&context->host, 1, sizeof *given) : NULL;
    if (!given) {
        image_finish(image, &context->host);
        return api_done(context, false);
    }
    *given = (struct owned_image){ { image->width, image->height, image->channels, image->pixels },
                                   context };
    api_context_use(context);
    *out = &given->image;
    return api_done(context, true);
}

enum ag_result ag_image_create(struct ag_context *context, int width, int height, int channels,
                               struct ag_image **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, width >= 1 && width <= IMAGE_MAX_SIZE, "width %d is not 1 to %d", width,
               IMAGE_MAX_SIZE);
    AG_REQUIRE(context, height >= 1 && height <= IMAGE_MAX_SIZE, "height %d is not 1 to %d", height,
               IMAGE_MAX_SIZE);
    AG_REQUIRE(context, channels >= 1 && channels <= 4, "channels %d is not 1 to 4", channels);
    struct image image = { 0 };
    bool ok = image_init(&image, &context->host, width, height, channels);
    return api_give_image(context, ok, &image, out);
}

void ag_image_destroy(struct ag_context *context, struct ag_image *image)
{
    (void)context; // may be destroyed
    if (!image) return;
    struct owned_image *own = (struct owned_image *)image;
    struct ag_context *owner = own->context;
    host_free(&owner->host, image->pixels);
    host_free(&owner->host, own);
    api_context_release(owner);
}

static bool layers_are_whole(const struct ag_image_layer *layers, int count)
{
    for (int i = 0; i < count; i++)
        if (!layers[i].name || !layers[i].name[0] || !is_whole(layers[i].image)) return false;
    return true;
}

static bool attributes_are_whole(const struct ag_attribute *attributes, int count)
{
    for (int i = 0; i < count; i++)
        if (!attributes[i].name || !attributes[i].name[0] || !attributes[i].value) return false;
    return true;
}

enum ag_result ag_image_write_exr(struct ag_context *context, const char *path,
                                  const struct ag_image_layer *layers, int layer_count,
                                  const struct ag_attribute *attributes, int attribute_count)
{
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, path && path[0], "path is empty");
    AG_REQUIRE(context, layers && layer_count >= 1 && layer_count <= MAX_LAYERS,
               "layer_count %d is not 1 to %d", layer_count, MAX_LAYERS);
    AG_REQUIRE(context, layers_are_whole(layers, layer_count),
               "a layer has no name or no valid image");
    AG_REQUIRE(context, attribute_count >= 0 && attribute_count <= MAX_ATTRIBUTES,
               "attribute_count %d is not 0 to %d", attribute_count, MAX_ATTRIBUTES);
    AG_REQUIRE(context, attribute_count == 0 || attributes, "attributes is NULL");
    AG_REQUIRE(context, attributes_are_whole(attributes, attribute_count),
               "an attribute has no name or no value");

    struct image images[MAX_LAYERS];
    struct exr_layer exr_layers[MAX_LAYERS];
    struct exr_attribute exr_attributes[MAX_ATTRIBUTES];
    for (int i = 0; i < layer_count; i++) {
        images[i] = view_of(layers[i].image);
        exr_layers[i] = (struct exr_layer){ layers[i].name, &images[i] };
    }
    for (int i = 0; i < attribute_count; i++)
        exr_attributes[i] = (struct exr_attribute){ attributes[i].name, attributes[i].value };
    return api_done(context, exr_write(&context->host, path, exr_layers, layer_count,
                                       exr_attributes, attribute_count));
}

enum ag_result ag_image_write_png(struct ag_context *context, const char *path,
                                  const struct ag_image *image)
{
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, path && path[0], "path is empty");
    AG_REQUIRE(context, is_whole(image), "image is NULL or not valid");
    AG_REQUIRE(context, image->channels != 2, "a PNG has 1, 3 or 4 channels, not 2");
    struct image view = view_of(image);
    return api_done(context, png_write(&context->host, path, &view));
}

enum ag_result ag_image_read(struct ag_context *context, const char *path, const char *layer,
                             struct ag_image **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, path && path[0], "path is empty");
    char extension[16];
    file_extension(path, extension);
    struct host *host = &context->host;
    struct image image = { 0 };
    bool ok;
    if (strcmp(extension, "exr") == 0)
        ok = api_read_layer(context, path, layer, &image);
    else if (strcmp(extension, "png") != 0)
        ok = host_fail(host, FAIL_UNSUPPORTED, "cannot read %s: images are .exr or .png", path);
    else if (layer)
        ok = host_fail(host, FAIL_ARGUMENT, "cannot read layer %s of %s: a PNG has no layers",
                       layer, path);
    else
        ok = png_read(host, path, &image);
    return api_give_image(context, ok, &image, out);
}

enum ag_result ag_image_read_size(struct ag_context *context, const char *path, int *width,
                                  int *height)
{
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, path && path[0], "path is empty");
    AG_REQUIRE(context, width && height, "width or height is NULL");
    char extension[16];
    file_extension(path, extension);
    struct host *host = &context->host;
    *width = *height = 0;
    if (strcmp(extension, "exr") == 0)
        return api_done(context, exr_read_size(host, path, width, height));
    if (strcmp(extension, "png") == 0)
        return api_done(context, png_read_size(host, path, width, height));
    return api_done(context, host_fail(host, FAIL_UNSUPPORTED,
                                       "cannot read %s: images are .exr or .png", path));
}

enum ag_result ag_image_read_attribute(struct ag_context *context, const char *path,
                                       const char *name, char *out, size_t size)
{
    AG_REQUIRE(context, out && size > 0, "out is NULL or size is 0");
    out[0] = 0;
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, path && path[0], "path is empty");
    AG_REQUIRE(context, name && name[0], "name is empty");
    struct host *host = &context->host;
    host->failure = FAIL_NONE; // NULL without a failure: the file has no such attribute
    char *value = exr_attribute_value(host, path, name);
    if (value) snprintf(out, size, "%s", value);
    host_free(host, value);
    return api_done(context, host->failure == FAIL_NONE);
}

enum ag_result ag_image_tonemap_curve(struct ag_context *context, const struct ag_image *radiance,
                                      float ev, enum ag_tonemap curve, struct ag_image **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, is_whole(radiance) && radiance->channels >= 3,
               "radiance is NULL or has not 3 channels");
    AG_REQUIRE(context, isfinite(ev), "ev is not finite");
    AG_REQUIRE(context, (int)curve >= 0 && (int)curve < TONEMAP_COUNT,
               "curve is none of enum ag_tonemap");
    struct image view = view_of(radiance), image = { 0 };
    bool ok = image_tonemap(&image, &context->host, &view, ev, (enum tonemap_curve)curve);
    return api_give_image(context, ok, &image, out);
}

enum ag_result ag_image_tonemap(struct ag_context *context, const struct ag_image *radiance,
                                float ev, struct ag_image **out)
{
    return ag_image_tonemap_curve(context, radiance, ev, AG_TONEMAP_NEUTRAL, out);
}

float ag_image_auto_exposure(const struct ag_image *radiance)
{
    return ag_image_metered_exposure(radiance, AG_METERING_MEAN);
}

float ag_image_metered_exposure(const struct ag_image *radiance, enum ag_metering metering)
{
    if (!is_whole(radiance) || radiance->channels < 3) return 0.0f;
    struct image view = view_of(radiance);
    return auto_exposure(&view, (enum exposure_metering)metering);
}

enum ag_result ag_image_side_by_side(struct ag_context *context, const struct ag_image *a,
                                     const struct ag_image *b, int gap, struct ag_image **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, is_whole(a) && is_whole(b), "an image is NULL or not valid");
    AG_REQUIRE(context, a->height == b->height && a->channels == b->channels,
               "heights %d and %d, channels %d and %d are not equal", a->height, b->height,
               a->channels, b->channels);
    AG_REQUIRE(context,
               gap >= 0 && gap <= IMAGE_MAX_SIZE - a->width &&
                   gap <= IMAGE_MAX_SIZE - a->width - b->width,
               "%d + %d + %d columns are more than %d", a->width, gap, b->width, IMAGE_MAX_SIZE);
    struct image view_a = view_of(a), view_b = view_of(b), image = { 0 };
    bool ok = image_side_by_side(&image, &context->host, &view_a, &view_b, gap);
    return api_give_image(context, ok, &image, out);
}

void ag_compare_desc_default(struct ag_compare_desc *desc)
{
    if (!desc) return;
    *desc = (struct ag_compare_desc){ .pixels_per_degree = FLIP_PIXELS_PER_DEGREE };
}

// Converts a description; `mask` stores the view of its mask.
static bool options_of(struct ag_context *context, const struct ag_compare_desc *desc,
                       struct image *mask, struct metrics_options *out)
{
    struct ag_compare_desc defaults;
    ag_compare_desc_default(&defaults);
    if (!desc) desc = &defaults;
    if (!api_zero(desc->reserved, sizeof desc->reserved / sizeof *desc->reserved))
        return host_fail(&context->host, FAIL_ARGUMENT,
                         "cannot compare images: " API_UNKNOWN_MEMBERS);
    if (desc->mask && !is_whole(desc->mask))
        return host_fail(&context->host, FAIL_ARGUMENT,
                         "cannot compare images: the mask is not valid");
    if (!isfinite(desc->ev))
        return host_fail(&context->host, FAIL_ARGUMENT, "cannot compare images: ev is not finite");
    if (desc->mask) *mask = view_of(desc->mask);
    *out = (struct metrics_options){ .radiance = desc->radiance,
                                     .ev = desc->ev,
                                     .mask = desc->mask ? mask : NULL,
                                     .ignore_not_finite = desc->ignore_not_finite,
                                     .pixels_per_degree = desc->pixels_per_degree };
    return true;
}

enum ag_result ag_image_metrics(struct ag_context *context, const struct ag_image *a,
                                const struct ag_image *b, const struct ag_compare_desc *desc,
                                struct ag_metrics *out)
{
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE_POINTER(context, out);
    AG_REQUIRE(context, is_whole(a) && is_whole(b), "an image is NULL or not valid");
    struct image view_a = view_of(a), view_b = view_of(b), mask;
    struct metrics_options options;
    struct metrics m = { 0 };
    bool ok = options_of(context, desc, &mask, &options) &&
              metrics_compute(&context->host, &view_a, &view_b, &options, &m);
    *out = (struct ag_metrics){ .mse = m.mse,
                                .mae = m.mae,
                                .relmse = m.relmse,
                                .psnr = m.psnr,
                                .ssim = m.ssim,
                                .flip = m.flip,
                                .flip_hdr = m.flip_hdr,
                                .counted = m.counted,
                                .ignored = m.ignored };
    memcpy(out->mean_a, m.mean_a, sizeof out->mean_a);
    memcpy(out->mean_b, m.mean_b, sizeof out->mean_b);
    return api_done(context, ok);
}

_Static_assert((int)AG_DIFFERENCE_FLIP_HDR == (int)METRICS_FLIP_HDR, "one order in both");

enum ag_result ag_image_error_map(struct ag_context *context, const struct ag_image *a,
                                  const struct ag_image *b, const struct ag_compare_desc *desc,
                                  enum ag_difference difference, float full, struct ag_image **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE(context, is_whole(a) && is_whole(b), "an image is NULL or not valid");
    AG_REQUIRE(context,
               difference >= AG_DIFFERENCE_ABSOLUTE && difference <= AG_DIFFERENCE_FLIP_HDR,
               "difference %d is not one of its names", (int)difference);
    AG_REQUIRE(context, isfinite(full), "full is not finite");
    struct image view_a = view_of(a), view_b = view_of(b), mask, image = { 0 };
    struct metrics_options options;
    bool ok = options_of(context, desc, &mask, &options) &&
              metrics_error_map(&context->host, &view_a, &view_b, &options,
                                (enum metrics_error)difference, full, &image);
    return api_give_image(context, ok, &image, out);
}
