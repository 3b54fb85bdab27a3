// afterglow diff: error of an image relative to a reference.
#include "commands.h"
#include "images.h"
#include "cli/files/interrupt.h"
#include "cli/files/json.h"
#include "memory.h"
#include "output.h"
#include "values.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static bool is_image(const char *path)
{
    return has_extension(path, "png") || has_extension(path, "exr");
}

// Options for EXR files only.
static enum status check_png_usage(const struct arguments *a)
{
    if (a->layer)
        return wrong_usage("cannot use --layer %s: %s has no layers", a->layer, a->positional[0]);
    if (a->mask_layer[0])
        return wrong_usage("cannot use --mask %s: %s has no layers", a->mask_layer,
                           a->positional[1]);
    if (a->has_exposure || a->rule)
        return wrong_usage("cannot use --exposure: a .png is already exposed");
    if (a->metric == AG_DIFFERENCE_FLIP_HDR)
        return wrong_usage("cannot use --metric flip_hdr: it needs radiance (.exr files)");
    return DONE;
}

static enum status check_usage(const struct arguments *a)
{
    const char *first = a->positional[0], *second = a->positional[1];
    for (int i = 0; i < 2; i++)
        if (!is_image(a->positional[i]))
            return wrong_usage("cannot compare %s: images are .png or .exr", a->positional[i]);
    if (has_extension(first, "exr") != has_extension(second, "exr"))
        return wrong_usage(
            "cannot compare %s with %s: an .exr holds radiance, a .png exposed display values",
            first, second);
    return has_extension(first, "exr") ? DONE : check_png_usage(a);
}

// Repeats a single channel three times, so that metrics accept it.
static enum ag_result spread(struct ag_context *context, struct ag_image **image)
{
    struct ag_image *one = *image, *three = NULL;
    if (one->channels >= 3) return AG_OK;
    enum ag_result result = ag_image_create(context, one->width, one->height, 3, &three);
    if (result != AG_OK) return result;
    size_t count = (size_t)one->width * (size_t)one->height;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++)
            three->pixels[3 * i + c] = one->pixels[i * (size_t)one->channels];
    ag_image_destroy(context, one);
    *image = three;
    return AG_OK;
}

// A mask: 1 where the layer exceeds the threshold, else 0.
static enum status load_mask(struct session *session, struct ag_image **out)
{
    const struct arguments *arguments = session->arguments;
    struct ag_image *layer = NULL;
    enum status status =
        image_load(session, arguments->positional[1], arguments->mask_layer, &layer);
    if (status != DONE) return status;
    enum ag_result result = ag_image_create(session->context, layer->width, layer->height, 1, out);
    size_t channels = (size_t)layer->channels, pixels = 0;
    if (result == AG_OK) pixels = (size_t)layer->width * (size_t)layer->height;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < channels; c++)
            if ((double)layer->pixels[channels * i + c] > arguments->mask_threshold)
                (*out)->pixels[i] = 1.0f;
    ag_image_destroy(session->context, layer);
    return result == AG_OK ? DONE : fail_library(session->context, result);
}

struct pair {
    struct ag_image *a, *b, *mask; // mask: NULL without --mask
    struct ag_compare_desc desc;
};

static enum status check_sizes(const struct arguments *arguments, const struct pair *pair)
{
    const struct ag_image *a = pair->a, *b = pair->b;
    if (a->width == b->width && a->height == b->height) return DONE;
    return fail("cannot compare %s with %s: %dx%d and %dx%d differ in size",
                arguments->positional[0], arguments->positional[1], a->width, a->height, b->width,
                b->height);
}

// Two images of at most 16 bytes a pixel, tone mapped copies of both, and the planes of ssim and
// flip, which are freed one after the other.
enum { BYTES_PER_PIXEL = 96 };

static enum status check_memory(struct session *session)
{
    const struct arguments *a = session->arguments;
    char what[2 * PATH_SIZE + 64];
    uint64_t pixels = 0;
    for (int i = 0; i < 2; i++) {
        int width = 0, height = 0;
        const enum ag_result result =
            ag_image_read_size(session->context, a->positional[i], &width, &height);
        if (result != AG_OK) {
            fail_library(session->context, result);
            return FAILED;
        }
        if ((uint64_t)width * (uint64_t)height > pixels)
            pixels = (uint64_t)width * (uint64_t)height;
    }
    snprintf(what, sizeof what, "compare %s with %s", a->positional[0], a->positional[1]);
    return memory_check(pixels * BYTES_PER_PIXEL, what, "compare smaller images, or a part");
}

static enum status load_pair(struct session *session, struct pair *pair)
{
    const struct arguments *arguments = session->arguments;
    enum status status = image_load(session, arguments->positional[0], arguments->layer, &pair->a);
    if (status == DONE)
        status = image_load(session, arguments->positional[1], arguments->layer, &pair->b);
    if (status == DONE) status = check_sizes(arguments, pair);
    if (status == DONE && arguments->mask_layer[0]) status = load_mask(session, &pair->mask);
    for (int i = 0; i < 2 && status == DONE; i++)
        status = image_check(session, i ? pair->b : pair->a, pair->mask, arguments->positional[i]);
    if (status != DONE) return status;
    enum ag_result result = spread(session->context, &pair->a);
    if (result == AG_OK) result = spread(session->context, &pair->b);
    if (result != AG_OK) return fail_library(session->context, result);
    ag_compare_desc_default(&pair->desc);
    pair->desc.mask = pair->mask;
    pair->desc.ignore_not_finite = arguments->ignore_nan;
    pair->desc.radiance = has_extension(arguments->positional[1], "exr");
    pair->desc.ev = arguments->has_exposure
                        ? arguments->exposure_ev
                        : ag_image_metered_exposure(pair->b, arguments->metering);
    return DONE;
}

// Keys for EXR files and masks follow the common ones.
static json_t *metrics_json(const struct ag_metrics *m, const struct arguments *arguments,
                            const struct pair *pair)
{
    json_t *document = json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:[fff], s:[fff], s:i, s:i}", "mse", json_double(m->mse),
        "relmse", json_double(m->relmse), "mae", json_double(m->mae), "psnr", json_double(m->psnr),
        "ssim", json_double(m->ssim), "flip", json_double(m->flip), "mean_a", m->mean_a[0],
        m->mean_a[1], m->mean_a[2], "mean_b", m->mean_b[0], m->mean_b[1], m->mean_b[2], "width",
        pair->a->width, "height", pair->a->height);
    bool ok = document != NULL;
    if (ok && pair->desc.radiance)
        ok = json_object_set_new(document, "flip_hdr", json_double(m->flip_hdr)) == 0 &&
             json_object_set_new(document, "exposure_ev", json_float(pair->desc.ev)) == 0;
    if (ok && (pair->mask || arguments->ignore_nan))
        ok = json_object_set_new(document, "pixels", json_integer((json_int_t)m->counted)) == 0;
    if (ok) return document;
    json_decref(document);
    return NULL;
}

static void print_metrics(const struct ag_metrics *m, const struct arguments *arguments,
                          const struct pair *pair)
{
    printf("size    %dx%d\n", pair->a->width, pair->a->height);
    if (pair->mask || arguments->ignore_nan) printf("pixels  %" PRIu64 "\n", m->counted);
    printf("mse     %.6g\nrelmse  %.6g\nmae     %.6g\npsnr    %.4g dB\n", m->mse, m->relmse, m->mae,
           m->psnr);
    printf("ssim    %.6g\nflip    %.6g\n", m->ssim, m->flip);
    if (pair->desc.radiance)
        printf("flip_hdr %.6g\n(ssim and flip are seen at EV %.4g)\n", m->flip_hdr,
               (double)pair->desc.ev);
    printf("mean a  %.6g, %.6g, %.6g\nmean b  %.6g, %.6g, %.6g\n", m->mean_a[0], m->mean_a[1],
           m->mean_a[2], m->mean_b[0], m->mean_b[1], m->mean_b[2]);
}

static enum status write_map(struct session *session, const struct pair *pair)
{
    const struct arguments *arguments = session->arguments;
    struct ag_image *map = NULL;
    enum ag_result result = ag_image_error_map(session->context, pair->a, pair->b, &pair->desc,
                                               arguments->metric, 0.0f, &map);
    interrupt_hold();
    if (result == AG_OK) result = ag_image_write_png(session->context, arguments->map, map);
    interrupt_release();
    ag_image_destroy(session->context, map);
    return result == AG_OK ? DONE : fail_library(session->context, result);
}

static enum status compare(struct session *session, const struct pair *pair)
{
    const struct arguments *arguments = session->arguments;
    struct ag_metrics metrics;
    enum ag_result result =
        ag_image_metrics(session->context, pair->a, pair->b, &pair->desc, &metrics);
    if (result != AG_OK) {
        fail_library(session->context, result);
        return FAILED;
    }
    enum status status = arguments->map ? write_map(session, pair) : DONE;
    if (status != DONE) return status;
    if (arguments->json) return json_print(metrics_json(&metrics, arguments, pair));
    print_metrics(&metrics, arguments, pair);
    return DONE;
}

static enum status diff(const struct arguments *arguments)
{
    struct session session = { 0 };
    struct pair pair = { 0 };
    enum status status = check_usage(arguments);
    if (status == DONE && arguments->map) status = whole_file_check(arguments->map);
    if (status == DONE) status = session_begin(&session, arguments);
    if (status == DONE) status = check_memory(&session);
    if (status == DONE) status = load_pair(&session, &pair);
    if (status == DONE) status = compare(&session, &pair);
    ag_image_destroy(session.context, pair.a);
    ag_image_destroy(session.context, pair.b);
    ag_image_destroy(session.context, pair.mask);
    session_end(&session);
    return status;
}

const struct command command_diff = {
    .name = "diff",
    .bit = DIFF,
    .positional_count = 2,
    .usage = "A B [options]",
    .summary = "measure the difference of image A from reference image B",
    .text = "Measures the error of A against B: two .exr or .png files of equal size.\n"
            "  mse, mae, relmse  mean squared, absolute and relative squared error; 0 is equal\n"
            "  psnr              signal-to-noise ratio in dB, for values of 0 to 1\n"
            "  ssim              structural similarity; 1 is equal\n"
            "  flip              visible difference when flipping between A and B; 0 is equal\n"
            "For ssim and flip, .exr files get the same exposure and tone mapping.\n",
    .examples = "  afterglow diff lpv.exr reference.exr\n"
                "  afterglow diff lpv.exr reference.exr --layer indirect --json\n"
                "  afterglow diff before.png after.png --map error.png --metric flip\n"
                "  afterglow reference house.glb --aov color,depth -o reference.exr\n"
                "  afterglow diff lpv.exr reference.exr --mask depth\n"
                "      only pixels with a surface: B needs the layer, see --aov of reference\n",
    .run = diff,
};
