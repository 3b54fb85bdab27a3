// The reference of a comparison: a given file, or cached samples plus missing ones.
#include "cli/cache/cache.h"
#include "compare.h"
#include "cli/images.h"
#include "cli/files/interrupt.h"
#include "cli/values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double KEEP_EVERY_S = 30.0;                                      // while sampling
static const char SECONDS[] = "afterglow.seconds", RAYS[] = "afterglow.rays"; // of a cached file

// Counterpart of the frame's layer indirect, which includes light from emitters and sky.
static const char INDIRECT[] = "indirect_emitters_sky";
static const char IRRADIANCE[] = "irradiance_emitters_sky";

// Standard error of luminance (root mean square) over mean luminance, as printed by reference.
static double relative_noise(const struct ag_image *color, const struct ag_image *error)
{
    double mean = 0.0, variance = 0.0;
    size_t count = (size_t)color->width * (size_t)color->height;
    for (size_t i = 0; i < count; i++) {
        double deviation = image_luminance(&error->pixels[i * (size_t)error->channels]);
        mean += image_luminance(&color->pixels[i * (size_t)color->channels]);
        variance += deviation * deviation;
    }
    return sqrt(variance / (double)count) / (mean / (double)count);
}

// Expected relmse of a perfect image: that of the reference plus its standard error.
static enum ag_result find_noise_relmse(struct comparison *c, const struct ag_image *error)
{
    const struct ag_image *color = c->reference.color;
    struct ag_compare_desc desc;
    struct ag_metrics metrics;
    struct ag_image *off = NULL;
    ag_compare_desc_default(&desc);
    desc.ignore_not_finite = c->arguments->ignore_nan;
    enum ag_result result =
        ag_image_create(c->session.context, color->width, color->height, 3, &off);
    if (result != AG_OK) return result;
    size_t count = (size_t)color->width * (size_t)color->height;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3; k++)
            off->pixels[3 * i + k] = color->pixels[i * (size_t)color->channels + k] +
                                     error->pixels[i * (size_t)error->channels + k];
    result = ag_image_metrics(c->session.context, off, color, &desc, &metrics);
    if (result == AG_OK) c->reference.noise_relmse = metrics.relmse;
    ag_image_destroy(c->session.context, off);
    return result;
}

// With one sample the error is infinite and the noise unknown.
static enum ag_result find_noise(struct comparison *c, const struct ag_image *error)
{
    struct reference *reference = &c->reference;
    reference->noise = relative_noise(reference->color, error);
    reference->noise_relmse = (double)NAN;
    return isfinite(reference->noise) ? find_noise_relmse(c, error) : AG_OK;
}

// ---- given file

// An attribute of the file; "" if absent.
static enum status read_attribute(struct comparison *c, const char *name, char *out, size_t size)
{
    const char *path = c->arguments->reference;
    enum ag_result result = ag_image_read_attribute(c->session.context, path, name, out, size);
    if (result == AG_OK) return DONE;
    fail_library(c->session.context, result);
    return FAILED;
}

static enum status check_size(const struct comparison *c)
{
    const struct arguments *a = c->arguments;
    const struct ag_image *image = c->reference.color;
    if (image->width != a->width || image->height != a->height)
        return fail("cannot compare with %s: it is %dx%d, not %dx%d (see --size)", a->reference,
                    image->width, image->height, a->width, a->height);
    if (image->channels < 3)
        return fail("cannot compare with %s: its color has %d channels, not 3", a->reference,
                    image->channels);
    return DONE;
}

// Checkpoints end with a hash of the image; the number before it is that of the sampling, which
// may differ.
static bool same_image(const char *a, const char *b)
{
    const char *hash_a = strrchr(a, ' '), *hash_b = strrchr(b, ' ');
    return hash_a && hash_b && strcmp(hash_a, hash_b) == 0;
}

// Without the attribute only the size can be checked.
static enum status check_same_image(struct comparison *c)
{
    const char *path = c->arguments->reference;
    char checkpoint[256];
    enum status status = read_attribute(c, AG_REFERENCE_CHECKPOINT, checkpoint, sizeof checkpoint);
    if (status != DONE) return status;
    if (!checkpoint[0])
        note("%s has no checkpoint attribute: only its size can be checked", path);
    else if (!same_image(checkpoint, ag_reference_checkpoint(c->reference.tracing.reference)))
        return fail("cannot compare with %s: its scene, light, camera, size or options differ "
                    "(--bounces, --seed)",
                    path);
    return DONE;
}

// An optional layer; NULL if absent or of another size.
static struct ag_image *load_if_there(struct comparison *c, const char *layer, int channels)
{
    const struct arguments *a = c->arguments;
    struct ag_image *image = NULL;
    if (ag_image_read(c->session.context, a->reference, layer, &image) != AG_OK) return NULL;
    if (image->width == a->width && image->height == a->height && image->channels >= channels)
        return image;
    ag_image_destroy(c->session.context, image);
    return NULL;
}

static int least_of(const struct ag_image *samples)
{
    float least = INFINITY;
    size_t count = (size_t)samples->width * (size_t)samples->height;
    for (size_t i = 0; i < count; i++)
        least = fminf(least, samples->pixels[i * (size_t)samples->channels]);
    return least >= 1.0f && least < 0x1p24f ? (int)least : 0;
}

static enum status read_bounces(struct comparison *c)
{
    char text[32];
    long bounces = -1;
    enum status status = read_attribute(c, "afterglow.bounces", text, sizeof text);
    if (status == DONE && value_int(text, 0, INT32_MAX, &bounces))
        c->reference.bounces = (int)bounces;
    return status;
}

static enum status take_given(struct comparison *c)
{
    struct reference *reference = &c->reference;
    reference->bounces = NOT_KNOWN;
    reference->seconds = reference->rays = reference->noise = reference->noise_relmse = (double)NAN;
    enum status status = image_load(&c->session, c->arguments->reference, NULL, &reference->color);
    if (status == DONE) status = check_size(c);
    if (status == DONE) status = check_same_image(c);
    if (status == DONE) status = read_bounces(c);
    if (status != DONE) return status;
    reference->indirect = load_if_there(c, INDIRECT, 3);
    reference->irradiance = load_if_there(c, IRRADIANCE, 3);
    struct ag_image *error = load_if_there(c, "error", 3),
                    *samples = load_if_there(c, "samples", 1);
    enum ag_result result = error ? find_noise(c, error) : AG_OK;
    if (samples) reference->spp = least_of(samples);
    ag_image_destroy(c->session.context, error);
    ag_image_destroy(c->session.context, samples);
    if (!reference->indirect)
        note("%s has no layer %s of the size of color: indirect light is not measured",
             c->arguments->reference, INDIRECT);
    return result == AG_OK ? DONE : fail_library(c->session.context, result);
}

// ---- cached samples

static double cached_number(struct comparison *c, const char *name)
{
    char text[64];
    double value = 0.0;
    enum ag_result result = ag_image_read_attribute(c->session.context, c->reference.cache_path,
                                                    name, text, sizeof text);
    return result == AG_OK && value_number(text, &value) ? value : (double)NAN;
}

// An unusable cached file is not an error.
static void take_cached(struct comparison *c)
{
    struct reference *reference = &c->reference;
    char why[CACHE_WHY_SIZE];
    if (!cache_file(CACHE_REFERENCE, ag_reference_checkpoint(reference->tracing.reference),
                    reference->cache_path, why)) {
        note("warning: the reference is not kept for the next run: no cache: %s; use --reference "
             "FILE.exr, or " CACHE_REMEDY,
             why);
        return;
    }
    if (access(reference->cache_path, F_OK) != 0) return;
    if (tracing_resume(&reference->tracing, reference->cache_path) != AG_OK) {
        note("warning: the reference is traced again: %s",
             ag_context_last_error(c->session.context));
        return;
    }
    reference->seconds = cached_number(c, SECONDS);
    reference->rays = cached_number(c, RAYS);
    detail("cache: %d samples in %s", reference->tracing.done, reference->cache_path);
    cache_touch(reference->cache_path);
}

static enum status plan_kept(struct comparison *c)
{
    return output_plan(c->arguments, "kept.exr", ag_reference_layer_name, tracing_kept_layers,
                       &c->reference.kept);
}

enum status reference_begin(struct comparison *c)
{
    const struct arguments *a = c->arguments;
    enum status status = plan_kept(c);
    if (status == DONE)
        status = tracing_begin(&c->reference.tracing, &c->session, &c->camera, a->spp);
    if (status != DONE) return status;
    if (a->reference) return take_given(c);
    if (!a->no_cache) take_cached(c);
    return DONE;
}

// ---- missing samples

static double rays_so_far(const struct reference *reference)
{
    struct ag_reference_info info = { 0 };
    ag_reference_get_info(reference->tracing.reference, &info);
    return reference->rays + (double)info.rays;
}

static enum status keep(void *user)
{
    struct comparison *c = user;
    struct reference *reference = &c->reference;
    if (!reference->cache_path[0]) return DONE;
    char seconds[32], rays[32];
    snprintf(seconds, sizeof seconds, "%.17g", reference->seconds + reference->tracing.seconds);
    snprintf(rays, sizeof rays, "%.17g", rays_so_far(reference));
    const struct ag_attribute more[] = { { SECONDS, seconds }, { RAYS, rays } };
    enum ag_result result =
        tracing_write_exr(&reference->tracing, &reference->kept, reference->cache_path, more, 2);
    if (result == AG_OK) {
        cache_trim(reference->cache_path);
    } else {
        note("warning: the reference is not cached: %s", ag_context_last_error(c->session.context));
        reference->cache_path[0] = 0;
    }
    return DONE;
}

static enum status interrupted(const struct comparison *c)
{
    const struct tracing *t = &c->reference.tracing;
    return fail("comparison of %s: interrupted after %d of %d samples of the reference; %s",
                c->arguments->positional[0], t->done, t->wanted,
                c->reference.cache_path[0] ? "the same command continues with them"
                                           : "without a cache they are lost");
}

static enum status trace(struct comparison *c)
{
    struct tracing *t = &c->reference.tracing;
    // The first write is early, so that cache problems show before hours of work.
    const struct tracing_keeper keeper = { keep, c, KEEP_EVERY_S, true };
    c->reference.cached = t->done >= t->wanted;
    if (c->reference.cached) return DONE;
    if (t->done > 0) note("continuing with %d samples of an earlier run", t->done);
    enum status status = tracing_converge(t, &keeper);
    bool stopped = interrupt_let_go() || t->done < t->wanted;
    return status == DONE && stopped ? interrupted(c) : status;
}

static enum status take_traced(struct comparison *c)
{
    struct reference *reference = &c->reference;
    struct ag_reference *tracer = reference->tracing.reference;
    struct ag_image *error = NULL;
    enum ag_result result = ag_reference_read(tracer, "color", &reference->color);
    if (result == AG_OK) result = ag_reference_read(tracer, INDIRECT, &reference->indirect);
    if (result == AG_OK) result = ag_reference_read(tracer, IRRADIANCE, &reference->irradiance);
    if (result == AG_OK) result = ag_reference_read(tracer, "error", &error);
    if (result == AG_OK) result = find_noise(c, error);
    ag_image_destroy(c->session.context, error);
    if (result != AG_OK) return fail_library(c->session.context, result);
    reference->spp = reference->tracing.done;
    reference->bounces = c->arguments->bounces;
    reference->seconds += reference->tracing.seconds;
    reference->rays = rays_so_far(reference);
    return DONE;
}

enum status reference_complete(struct comparison *c)
{
    if (c->arguments->reference) return DONE;
    enum status status = trace(c);
    return status == DONE ? take_traced(c) : status;
}

// ---- exposure

static bool is_black(const struct ag_image *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++)
        if (image_luminance(&image->pixels[i * (size_t)image->channels]) > 0.0) return false;
    return true;
}

// Indirect light that would be almost black at the exposure of the image has one of its own.
static enum ag_result expose_indirect(struct comparison *c)
{
    static const float DIM_EV = 2.0f; // a quarter of the image's light
    float ev = c->exposure_ev;
    c->indirect_ev = c->exposure_ev;
    if (!c->reference.indirect || is_black(c->reference.indirect)) return AG_OK;
    const enum ag_result result = image_exposure(&c->session, c->reference.indirect, c->depth, &ev);
    if (result == AG_OK && ev <= c->exposure_ev - DIM_EV) c->indirect_ev = ev;
    return result;
}

enum status reference_expose(struct comparison *c)
{
    c->exposure_ev = c->indirect_ev = c->arguments->exposure_ev;
    if (c->arguments->has_exposure) return DONE;
    enum ag_result result =
        image_exposure(&c->session, c->reference.color, c->depth, &c->exposure_ev);
    if (result == AG_OK) result = expose_indirect(c);
    return result == AG_OK ? DONE : fail_library(c->session.context, result);
}

// ---- reference.exr

enum status reference_write_exr(struct comparison *c, const char *path)
{
    char exposure[32];
    if (c->arguments->reference) return folder_copy(c->arguments->reference, path);
    snprintf(exposure, sizeof exposure, "%.9g", (double)c->exposure_ev);
    const struct ag_attribute more = { "afterglow.exposure_ev", exposure };
    enum ag_result result =
        tracing_write_exr(&c->reference.tracing, &c->reference.kept, path, &more, 1);
    return result == AG_OK ? DONE : fail_library(c->session.context, result);
}

void reference_finish(struct comparison *c)
{
    ag_image_destroy(c->session.context, c->reference.color);
    ag_image_destroy(c->session.context, c->reference.indirect);
    ag_image_destroy(c->session.context, c->reference.irradiance);
    tracing_end(&c->reference.tracing);
}
