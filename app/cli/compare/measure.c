// Errors of images and of indirect light.
#include "compare.h"
#include "cli/images.h"

#include <math.h>
#include <stdio.h>

static double energy_of(const struct ag_metrics *m)
{
    const double weights[3] = { 0.2126, 0.7152, 0.0722 };
    double a = 0.0, b = 0.0;
    for (int i = 0; i < 3; i++) {
        a += weights[i] * m->mean_a[i];
        b += weights[i] * m->mean_b[i];
    }
    return b > 0.0 ? a / b : (double)NAN;
}

static enum status measure(struct comparison *c, const struct ag_image *image,
                           const struct ag_image *reference, const struct ag_compare_desc *desc,
                           struct measured *out)
{
    enum ag_result result =
        ag_image_metrics(c->session.context, image, reference, desc, &out->metrics);
    if (result != AG_OK) {
        fail_library(c->session.context, result);
        return FAILED;
    }
    out->energy = energy_of(&out->metrics);
    return DONE;
}

static enum status measure_method(struct comparison *c, struct method *m)
{
    char name[STEM_SIZE + 32];
    struct ag_compare_desc desc;
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    desc.ev = c->exposure_ev;
    desc.ignore_not_finite = c->arguments->ignore_nan;
    snprintf(name, sizeof name, "%s", m->gi);
    enum status status = image_check(&c->session, m->color, NULL, name);
    if (status == DONE) status = measure(c, m->color, c->reference.color, &desc, &m->image_error);
    if (status != DONE || !c->reference.indirect) return status;
    desc.radiance = false; // only relmse, mae and energy are reported, which ignore it
    snprintf(name, sizeof name, "the indirect light of %s", m->gi);
    status = image_check(&c->session, m->indirect, NULL, name);
    if (status == DONE)
        status = measure(c, m->indirect, c->reference.indirect, &desc, &m->indirect_error);
    if (status != DONE || !c->reference.irradiance) return status;
    return measure(c, m->irradiance, c->reference.irradiance, &desc, &m->irradiance_error);
}

static size_t pixel_count(const struct ag_image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

// The frame's direct light plus the reference's indirect light with that of emissive surfaces and
// sky, which techniques add: an image that differs from the reference in direct light alone.
static void complete_direct(const struct comparison *c, struct ag_image *out)
{
    const struct ag_image *color = c->reference.color, *indirect = c->reference.indirect;
    for (size_t i = 0; i < pixel_count(color); i++)
        for (size_t k = 0; k < 3; k++)
            out->pixels[3 * i + k] = c->direct->pixels[i * (size_t)c->direct->channels + k] +
                                     indirect->pixels[i * (size_t)indirect->channels + k];
}

static enum status measure_direct(struct comparison *c)
{
    const struct ag_image *color = c->reference.color;
    struct ag_compare_desc desc;
    if (!c->reference.indirect || !c->direct) return DONE;
    enum ag_result result =
        ag_image_create(c->session.context, color->width, color->height, 3, &c->direct_error_image);
    if (result != AG_OK) return fail_library(c->session.context, result);
    complete_direct(c, c->direct_error_image);
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    desc.ev = c->exposure_ev;
    desc.ignore_not_finite = c->arguments->ignore_nan;
    enum status status = image_check(&c->session, c->direct, NULL, "the direct light");
    return status == DONE ? measure(c, c->direct_error_image, color, &desc, &c->direct_error)
                          : status;
}

enum status methods_measure(struct comparison *c)
{
    enum status status = image_check(&c->session, c->reference.color, NULL, "the reference");
    if (status == DONE && c->reference.indirect)
        status =
            image_check(&c->session, c->reference.indirect, NULL, "the reference's indirect light");
    if (status == DONE) status = measure_direct(c);
    for (int i = 0; i < c->method_count && status == DONE; i++) {
        progress("measuring", i, c->method_count);
        status = measure_method(c, &c->methods[i]);
    }
    progress_end();
    return status;
}
