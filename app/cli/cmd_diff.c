// afterglow diff: how far one image is from another.
#include "commands.h"
#include "interrupt.h"
#include "json.h"
#include "output.h"
#include "values.h"

#include <math.h>
#include <stdio.h>

static bool is_image(const char *path)
{
    return has_extension(path, "png") || has_extension(path, "exr");
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
    if (a->layer && !has_extension(first, "exr"))
        return wrong_usage("cannot use --layer %s: %s has no layers", a->layer, first);
    return DONE;
}

// One channel three times, so that single-channel layers can be compared like any other.
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

static size_t count_not_finite(const struct ag_image *image)
{
    size_t count = 0, channels = (size_t)image->channels;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) {
        bool finite = true;
        for (size_t c = 0; c < channels; c++)
            finite &= isfinite(image->pixels[channels * i + c]) != 0;
        count += !finite;
    }
    return count;
}

// What the files hold is no matter of usage: all failures here are FAILED.
static enum status load(struct session *session, const char *path, struct ag_image **out)
{
    enum ag_result result = ag_image_read(session->context, path, session->arguments->layer, out);
    if (result == AG_OK) result = spread(session->context, out);
    if (result != AG_OK) {
        fail_library(session->context, result);
        return FAILED;
    }
    size_t bad = count_not_finite(*out);
    if (bad) return fail("cannot compare %s: %zu of its pixels are NaN or infinite", path, bad);
    return DONE;
}

static json_t *metrics_json(const struct ag_metrics *m, const struct ag_image *image)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:[fff], s:[fff], s:i, s:i}", "mse", json_double(m->mse),
                     "relmse", json_double(m->relmse), "mae", json_double(m->mae), "psnr",
                     json_double(m->psnr), "mean_a", m->mean_a[0], m->mean_a[1], m->mean_a[2],
                     "mean_b", m->mean_b[0], m->mean_b[1], m->mean_b[2], "width", image->width,
                     "height", image->height);
}

static void print_metrics(const struct ag_metrics *m, const struct ag_image *image)
{
    printf("size    %dx%d\nmse     %.6g\nrelmse  %.6g\nmae     %.6g\npsnr    %.4g dB\n",
           image->width, image->height, m->mse, m->relmse, m->mae, m->psnr);
    printf("mean a  %.6g, %.6g, %.6g\nmean b  %.6g, %.6g, %.6g\n", m->mean_a[0], m->mean_a[1],
           m->mean_a[2], m->mean_b[0], m->mean_b[1], m->mean_b[2]);
}

static enum status write_map(struct session *session, const struct ag_image *a,
                             const struct ag_image *b)
{
    struct ag_image *map = NULL;
    enum ag_result result = ag_image_error_map(session->context, a, b, 0.0f, &map);
    interrupt_hold();
    if (result == AG_OK)
        result = ag_image_write_png(session->context, session->arguments->map, map);
    interrupt_release();
    ag_image_destroy(session->context, map);
    return result == AG_OK ? DONE : fail_library(session->context, result);
}

static enum status compare(struct session *session, const struct ag_image *a,
                           const struct ag_image *b)
{
    const struct arguments *arguments = session->arguments;
    if (a->width != b->width || a->height != b->height)
        return fail("cannot compare %s with %s: %dx%d and %dx%d are not the same size",
                    arguments->positional[0], arguments->positional[1], a->width, a->height,
                    b->width, b->height);
    struct ag_metrics metrics;
    enum ag_result result = ag_image_metrics(session->context, a, b, &metrics);
    if (result != AG_OK) {
        fail_library(session->context, result);
        return FAILED;
    }
    enum status status = arguments->map ? write_map(session, a, b) : DONE;
    if (status != DONE) return status;
    if (arguments->json) return json_print(metrics_json(&metrics, a));
    print_metrics(&metrics, a);
    return DONE;
}

static enum status diff(const struct arguments *arguments)
{
    struct session session = { 0 };
    struct ag_image *a = NULL, *b = NULL;
    enum status status = check_usage(arguments);
    if (status == DONE && arguments->map) status = output_check(arguments->map);
    if (status == DONE) status = session_begin(&session, arguments);
    if (status == DONE) status = load(&session, arguments->positional[0], &a);
    if (status == DONE) status = load(&session, arguments->positional[1], &b);
    if (status == DONE) status = compare(&session, a, b);
    ag_image_destroy(session.context, a);
    ag_image_destroy(session.context, b);
    session_end(&session);
    return status;
}

const struct command command_diff = {
    .name = "diff",
    .bit = DIFF,
    .positional_count = 2,
    .usage = "A B [options]",
    .summary = "how far image A is from image B",
    .text = "Error of A against the reference B, two .exr or two .png files of one size: mean "
            "squared error,\n"
            "the same relative to B, mean absolute error, peak signal-to-noise ratio (for values "
            "in 0 to 1),\n"
            "and the mean colours.\n",
    .examples = "  afterglow diff lpv.exr reference.exr\n"
                "  afterglow diff lpv.exr reference.exr --layer indirect --json\n"
                "  afterglow diff before.png after.png --map error.png\n",
    .run = diff,
};
