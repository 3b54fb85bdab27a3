// Output of compare: report.json, a table, exceeded bounds.
#include "compare.h"
#include "cli/files/json.h"
#include "cli/page/origin.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- report.json

static json_t *file_name(const char *stem, const char *ending)
{
    return json_sprintf("%s%s", stem, ending);
}

static json_t *method_images(const struct comparison *c, const struct method *m)
{
    json_t *images =
        json_pack("{s:o, s:o, s:o}", "picture", file_name(m->stem, ".png"), "error",
                  file_name(m->stem, "-flip.png"), "indirect", file_name(m->stem, "-indirect.png"));
    if (images && c->reference.indirect)
        json_object_set_new(images, "indirect_error", file_name(m->stem, "-indirect-error.png"));
    return images;
}

// layer: NULL if the reference lacks it.
static json_t *error_json(const struct ag_image *layer, const struct measured *error)
{
    if (!layer) return json_null();
    return json_pack("{s:o, s:o, s:o}", "relmse", json_double(error->metrics.relmse), "mae",
                     json_double(error->metrics.mae), "energy", json_double(error->energy));
}

// The value of an option as --gi takes it. out: at least 64 bytes.
static const char *default_text(const struct ag_option_info *o, char out[64])
{
    const char *choice = o->unit;
    snprintf(out, 64, "%g", o->initial);
    if (strcmp(o->type, "bool") == 0) return o->initial != 0.0 ? "true" : "false";
    if (strcmp(o->type, "text") == 0) return "";
    if (strcmp(o->type, "choice") != 0) return out;
    for (int i = 0; i < (int)o->initial; i++) choice += strcspn(choice, "|") + 1;
    snprintf(out, 64, "%.*s", (int)strcspn(choice, "|"), choice);
    return out;
}

static bool is_default(const json_t *value, const struct ag_option_info *o)
{
    char text[64];
    if (json_is_string(value)) return strcmp(json_string_value(value), default_text(o, text)) == 0;
    if (json_is_boolean(value)) return json_is_true(value) == (o->initial != 0.0);
    return fabs(json_number_value(value) - o->initial) <= 1e-6 * fabs(o->initial);
}

// The options of one technique that differ from their defaults.
static json_t *changes_of(const char *technique, const json_t *options)
{
    struct ag_technique_info t;
    struct ag_option_info o;
    json_t *changes = json_object();
    for (int i = 0; changes && ag_technique_get(i, &t); i++) {
        if (strcmp(t.name, technique) != 0) continue;
        for (int k = 0; ag_technique_option_get(i, k, &o); k++) {
            json_t *value = json_object_get(options, o.name);
            if (value && !is_default(value, &o)) json_object_set(changes, o.name, value);
        }
    }
    return changes;
}

static json_t *changed_options(const json_t *options)
{
    const char *technique;
    json_t *values;
    json_t *changed = json_object();
    json_object_foreach((json_t *)options, technique, values)
        json_object_set_new(changed, technique, changes_of(technique, values));
    return changed;
}

static json_t *method_json(const struct comparison *c, const struct method *m)
{
    const struct ag_metrics *p = &m->image_error.metrics;
    json_t *object =
        json_pack("{s:o, s:O, s:o, s:o, s:o, s:o, s:o, s:o, s:O, s:O, s:O, s:o, s:o}", "gi",
                  json_text(m->gi), "options", m->options, "relmse", json_double(p->relmse), "flip",
                  json_double(p->flip), "mae", json_double(p->mae), "ssim", json_double(p->ssim),
                  "energy", json_double(m->image_error.energy), "indirect",
                  error_json(c->reference.indirect, &m->indirect_error),

                  "frame_ms", m->frame_ms, "passes", m->passes, "memory_bytes", m->memory,
                  "flip_hdr", json_double(p->flip_hdr), "images", method_images(c, m));
    if (object && c->reference.irradiance)
        json_object_set_new(object, "irradiance",
                            error_json(c->reference.irradiance, &m->irradiance_error));
    if (object) json_object_set_new(object, "changed", changed_options(m->options));
    if (object && m->bake) json_object_set(object, "bake", m->bake);
    if (object && c->arguments->ignore_nan)
        json_object_set_new(object, "pixels", json_integer((json_int_t)p->counted));
    return object;
}

static json_t *methods_json(const struct comparison *c)
{
    json_t *array = json_array();
    for (int i = 0; array && i < c->method_count; i++) {
        if (json_array_append_new(array, method_json(c, &c->methods[i])) == 0) continue;
        json_decref(array);
        return NULL;
    }
    return array;
}

static json_t *whole_or_null(double value)
{
    return isfinite(value) ? json_integer((json_int_t)value) : json_null();
}

// bounces: null if unlimited, absent if unknown.
static json_t *reference_json(const struct reference *t)
{
    json_t *images = json_pack("{s:s}", "picture", "reference.png");
    if (images && t->indirect)
        json_object_set_new(images, "indirect", json_string("reference-indirect.png"));
    json_t *object = json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:b, s:o}", "spp",
                               t->spp > 0 ? json_integer(t->spp) : json_null(), "bounces",
                               t->bounces >= 0 ? json_integer(t->bounces) : json_null(), "seconds",
                               json_double(t->seconds), "noise", json_double(t->noise),
                               "noise_relmse", json_double(t->noise_relmse), "rays",
                               whole_or_null(t->rays), "cached", t->cached, "images", images);
    if (object && t->bounces == NOT_KNOWN) json_object_del(object, "bounces");
    return object;
}

static void add_origin(json_t *report, const struct comparison *c)
{
    report_add_origin(report, "compare", c->arguments);
    json_object_set_new(report, "light", json_text(c->session.light));
    json_object_set_new(report, "light_is_default", json_boolean(c->session.made_up_light));
    json_object_set_new(report, "camera_is_default", json_boolean(c->session.made_up));
}

static json_t *direct_json(const struct comparison *c)
{
    const struct ag_metrics *m = &c->direct_error.metrics;
    return json_pack("{s:o, s:o, s:o, s:{s:s}}", "relmse", json_double(m->relmse), "flip",
                     json_double(m->flip), "mae", json_double(m->mae), "images", "error",
                     "direct-flip.png");
}

json_t *report_json(const struct comparison *c)
{
    const struct arguments *a = c->arguments;
    struct ag_device_info device;
    ag_device_get_info(c->device, &device);
    json_t *report =
        json_pack("{s:o, s:o, s:[ii], s:o, s:o, s:o, s:o, s:o, s:i}", "scene",
                  json_text(a->positional[0]), "camera", json_text(c->session.camera_name), "size",
                  a->width, a->height, "exposure_ev", json_float(c->exposure_ev), "reference",
                  reference_json(&c->reference), "methods", methods_json(c), "device",
                  json_text(device.name), "driver", json_text(device.driver), "frames", a->frames);
    if (!report) return NULL;
    json_object_set_new(report, "scene_scale", json_float(a->scene_scale));
    json_object_set_new(report, "indirect_exposure_ev", json_float(c->indirect_ev));
    if (c->direct_error_image) json_object_set_new(report, "direct", direct_json(c));
    add_origin(report, c);
    return report;
}

// ---- the table

static double number_in(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : (double)NAN;
}

static double sum_of(json_t *object)
{
    const char *key;
    json_t *value;
    double sum = 0.0;
    json_object_foreach(object, key, value) sum += json_number_value(value);
    return sum;
}

// A number, or a dash if it is not finite.
static void print_cell(int width, int digits, double value)
{
    if (isfinite(value))
        printf("  %*.*f", width, digits, value);
    else
        printf("  %*s", width, "-");
}

// Four significant digits.
static void print_any(int width, double value)
{
    char text[32];
    snprintf(text, sizeof text, fabs(value) >= 1000.0 ? "%.0f" : "%.4g", value);
    printf("  %*s", width, isfinite(value) ? text : "-");
}

static void print_head(const struct comparison *c)
{
    const struct arguments *a = c->arguments;
    const struct reference *t = &c->reference;
    struct ag_device_info device;
    ag_device_get_info(c->device, &device);
    printf("%s, camera %s, %dx%d, EV %.3f, %d frames on %s\n", printable(a->positional[0]).s,
           c->session.camera_name, a->width, a->height, (double)c->exposure_ev, a->frames,
           device.name);
    printf("reference: ");
    if (a->reference) printf("%s, ", printable(a->reference).s);
    if (t->spp > 0) printf("%d samples", t->spp);
    if (isfinite(t->noise))
        printf(", noise %.2g %% (relmse %.2g)", 100.0 * t->noise, t->noise_relmse);
    if (isfinite(t->seconds)) printf(", %.1f s%s", t->seconds, t->cached ? " (cached)" : "");
    printf("\n\n");
}

static int widest_name(const struct comparison *c)
{
    int widest = 6; // "method"
    for (int i = 0; i < c->method_count; i++) {
        int length = (int)strlen(c->methods[i].gi);
        if (length > widest) widest = length;
    }
    return widest;
}

static void print_row(const struct comparison *c, const struct method *m, int width)
{
    double nothing = c->reference.indirect ? 0.0 : (double)NAN;
    printf("%-*s", width, m->gi);
    print_any(8, m->indirect_error.metrics.relmse + nothing);
    print_any(8, m->indirect_error.metrics.mae + nothing);
    print_cell(6, 3, m->indirect_error.energy + nothing);
    print_any(8, m->image_error.metrics.relmse);
    print_cell(6, 4, m->image_error.metrics.flip);
    print_cell(7, 4, m->image_error.metrics.ssim);
    print_cell(6, 3, m->image_error.energy);
    print_cell(9, 3, number_in(m->frame_ms, "median"));
    print_cell(9, 3, number_in(m->frame_ms, "p95"));
    print_cell(8, 1, sum_of(m->memory) / (1 << 20));
    putchar('\n');
}

// Noise of a quarter of the least relmse. Pixels where it darkens the reference then weigh most:
// relmse prefers images that are too dark (docs/metrics.md).
static const double NOISE_SHARE_WARNED = 0.25, NOISE_SHARE_WANTED = 0.1;

static void print_noise_share(const struct comparison *c)
{
    const struct reference *t = &c->reference;
    double least = INFINITY;
    for (int i = 0; i < c->method_count; i++)
        least = fmin(least, c->methods[i].image_error.metrics.relmse);
    double share = t->noise_relmse / least;
    if (t->spp < 1 || least <= 0.0 || !(share > NOISE_SHARE_WARNED)) return;
    printf("\nthe reference's noise makes at least %.0f %% of the least relmse, which prefers dark "
           "images then",
           100.0 * fmin(share, 1.0));
    // With more samples relmse nears the error itself, and noise falls as their number grows. Of
    // few samples the noise is underestimated: pixels that it darkens show little of it.
    double error = fmax(least - t->noise_relmse, 0.1 * least);
    double spp =
        t->spp * t->noise_relmse * (1.0 - NOISE_SHARE_WANTED) / (error * NOISE_SHARE_WANTED);
    if (!c->arguments->reference) printf(": --spp %.0f or more", exp2(ceil(log2(spp))));
    putchar('\n');
}

void report_print(const struct comparison *c)
{
    int width = widest_name(c);
    print_head(c);
    printf("%-*s  %26s  %33s  %20s  %8s\n", width, "", "indirect light", "image", "frame, ms",
           "memory");
    printf("%-*s  %8s  %8s  %6s  %8s  %6s  %7s  %6s  %9s  %9s  %8s\n", width, "method", "relmse",
           "mae", "energy", "relmse", "flip", "ssim", "energy", "median", "p95", "MiB");
    for (int i = 0; i < c->method_count; i++) print_row(c, &c->methods[i], width);
    if (c->direct_error_image)
        printf("\ndirect light alone, the same for all: relmse %.4g, flip %.4f of the image\n",
               c->direct_error.metrics.relmse, c->direct_error.metrics.flip);
    print_noise_share(c);
}

// ---- bounds

// A negative bound is none. A value that was not measured exceeds every bound.
static bool breaks(const char *gi, const char *what, double value, double bound)
{
    if (bound < 0.0 || value <= bound) return false;
    if (isfinite(value))
        fail("%s of %s: %.6g exceeds --max-%s %.6g", what, gi, value, what, bound);
    else
        fail("%s of %s: not measured, and --max-%s is %.6g", what, gi, what, bound);
    return true;
}

enum status report_gates(const struct comparison *c)
{
    const struct arguments *a = c->arguments;
    bool broken = false;
    for (int i = 0; i < c->method_count; i++) {
        const struct method *m = &c->methods[i];
        broken |= breaks(m->gi, "flip", m->image_error.metrics.flip, a->max_flip);
        broken |= breaks(m->gi, "relmse", m->image_error.metrics.relmse, a->max_relmse);
        broken |= breaks(m->gi, "ms", number_in(m->frame_ms, "median"), a->max_ms);
    }
    return broken ? FAILED : DONE;
}
