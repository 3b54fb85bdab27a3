// Image files of a comparison: rendered, reference and error maps, which share a scale.
#include "compare.h"
#include "cli/files/interrupt.h"
#include "cli/values.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GAP_PX = 4, MAX_WIDTH_PX = 16384 }; // of sheet.png

static const char *const fixed_names[] = {
    "report.json", "report.html",    "reference.png", "reference.exr", "reference-indirect.png",
    "sheet.png",   "direct-flip.png"
};

bool files_are_named(const char *name)
{
    for (size_t i = 0; i < sizeof fixed_names / sizeof fixed_names[0]; i++)
        if (strcmp(name, fixed_names[i]) == 0) return true;
    bool numbered = isdigit((unsigned char)name[0]) != 0;
    return numbered && (has_extension(name, "png") || has_extension(name, "exr"));
}

// Path of "STEM" + ending.
static enum status path_of(const struct comparison *c, const char *stem, const char *ending,
                           char out[PATH_SIZE])
{
    char name[STEM_SIZE + 32];
    snprintf(name, sizeof name, "%s%s", stem, ending);
    return folder_file(&c->folder, name, out)
               ? DONE
               : fail("cannot write %s/%s: the path is too long", c->folder.shown, name);
}

// Takes ownership of `image`, which is NULL if `result` is an error.
static enum status write_png(struct comparison *c, enum ag_result result, struct ag_image *image,
                             const char *stem, const char *ending)
{
    char path[PATH_SIZE];
    enum status status = path_of(c, stem, ending, path);
    interrupt_hold();
    if (result == AG_OK && status == DONE)
        result = ag_image_write_png(c->session.context, path, image);
    interrupt_release();
    ag_image_destroy(c->session.context, image);
    if (result == AG_OK) return status;
    fail_library(c->session.context, result);
    return FAILED;
}

static enum status write_image(struct comparison *c, const struct ag_image *radiance, float ev,
                               const char *stem, const char *ending)
{
    struct ag_image *display = NULL;
    enum ag_result result =
        ag_image_tonemap_curve(c->session.context, radiance, ev, c->arguments->tonemap, &display);
    return write_png(c, result, display, stem, ending);
}

static enum status write_map(struct comparison *c, const struct ag_image *a,
                             const struct ag_image *b, enum ag_difference difference, float full,
                             const char *stem, const char *ending)
{
    struct ag_compare_desc desc;
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    desc.ev = c->exposure_ev;
    desc.ignore_not_finite = c->arguments->ignore_nan;
    struct ag_image *map = NULL;
    enum ag_result result =
        ag_image_error_map(c->session.context, a, b, &desc, difference, full, &map);
    return write_png(c, result, map, stem, ending);
}

static enum status write_method_exr(struct comparison *c, const struct method *m)
{
    char path[PATH_SIZE], exposure[32], version[32], scale[32];
    int v = ag_version();
    snprintf(exposure, sizeof exposure, "%.9g", (double)c->exposure_ev);
    snprintf(scale, sizeof scale, "%.9g", (double)c->arguments->scene_scale);
    snprintf(version, sizeof version, "%d.%d.%d", v / 10000, v / 100 % 100, v % 100);
    const struct ag_image_layer layers[] = { { "color", m->color },
                                             { "indirect", m->indirect },
                                             { "irradiance", m->irradiance } };
    const struct ag_attribute attributes[] = {
        { "afterglow.scene", c->arguments->positional[0] },
        { "afterglow.camera", c->session.camera_name },
        { "afterglow.gi", m->spelled },
        { "afterglow.exposure_ev", exposure },
        { "afterglow.version", version },
        { "afterglow.scene_scale", scale },
    };
    enum status status = path_of(c, m->stem, ".exr", path);
    if (status != DONE) return status;
    interrupt_hold();
    enum ag_result result = ag_image_write_exr(c->session.context, path, layers, 3, attributes, 6);
    interrupt_release();
    return result == AG_OK ? DONE : fail_library(c->session.context, result);
}

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// Error shown white in maps of indirect light: the 95th percentile of the reference over lit
// pixels.
static bool find_full_indirect(struct comparison *c)
{
    const struct ag_image *reference = c->reference.indirect;
    size_t pixels = (size_t)reference->width * (size_t)reference->height, lit = 0;
    float *values = malloc(pixels * sizeof *values);
    if (!values) return false;
    for (size_t i = 0; i < pixels; i++) {
        const float *rgb = &reference->pixels[i * (size_t)reference->channels];
        float mean = (rgb[0] + rgb[1] + rgb[2]) / 3.0f;
        if (mean > 0.0f && isfinite(mean)) values[lit++] = mean;
    }
    qsort(values, lit, sizeof *values, by_value);
    c->full_indirect = lit > 0 ? values[lit - 1 - lit / 20] : 1.0f;
    free(values);
    return true;
}

static enum status write_method(struct comparison *c, const struct method *m)
{
    const struct reference *reference = &c->reference;
    enum status status = write_image(c, m->color, c->exposure_ev, m->stem, ".png");
    if (status == DONE)
        status = write_map(c, m->color, reference->color, AG_DIFFERENCE_FLIP, 0.0f, m->stem,
                           "-flip.png");
    if (status == DONE)
        status = write_image(c, m->indirect, c->indirect_ev, m->stem, "-indirect.png");
    if (status == DONE && reference->indirect)
        status = write_map(c, m->indirect, reference->indirect, AG_DIFFERENCE_ABSOLUTE,
                           c->full_indirect, m->stem, "-indirect-error.png");
    return status == DONE ? write_method_exr(c, m) : status;
}

static enum status write_reference(struct comparison *c)
{
    char path[PATH_SIZE];
    enum status status = write_image(c, c->reference.color, c->exposure_ev, "reference", ".png");
    if (status == DONE && c->reference.indirect)
        status =
            write_image(c, c->reference.indirect, c->indirect_ev, "reference", "-indirect.png");
    if (status == DONE) status = path_of(c, "reference", ".exr", path);
    return status == DONE ? reference_write_exr(c, path) : status;
}

// Appends an image, exposed, on the right.
static enum ag_result append_to_sheet(struct comparison *c, const struct ag_image *radiance,
                                      struct ag_image **sheet)
{
    struct ag_context *context = c->session.context;
    struct ag_image *display = NULL, *both = NULL;
    enum ag_result result =
        ag_image_tonemap_curve(context, radiance, c->exposure_ev, c->arguments->tonemap, &display);
    if (result == AG_OK) result = ag_image_side_by_side(context, *sheet, display, GAP_PX, &both);
    ag_image_destroy(context, display);
    if (result != AG_OK) return result;
    ag_image_destroy(context, *sheet);
    *sheet = both;
    return AG_OK;
}

// The reference and all methods side by side, as many as one image holds.
static enum status write_sheet(struct comparison *c)
{
    struct ag_image *sheet = NULL;
    enum ag_result result = ag_image_tonemap_curve(c->session.context, c->reference.color,
                                                   c->exposure_ev, c->arguments->tonemap, &sheet);
    for (int i = 0; i < c->method_count && result == AG_OK; i++) {
        if (sheet->width + c->reference.color->width + GAP_PX > MAX_WIDTH_PX) break;
        result = append_to_sheet(c, c->methods[i].color, &sheet);
    }
    if (result == AG_OK) return write_png(c, result, sheet, "sheet", ".png");
    ag_image_destroy(c->session.context, sheet);
    fail_library(c->session.context, result);
    return FAILED;
}

enum status files_write(struct comparison *c)
{
    if (c->reference.indirect && !find_full_indirect(c))
        return fail("cannot compare %s: out of memory", c->arguments->positional[0]);
    enum status status = write_reference(c);
    for (int i = 0; i < c->method_count && status == DONE; i++) {
        progress("writing", i, c->method_count);
        status = write_method(c, &c->methods[i]);
    }
    if (status == DONE && c->direct_error_image)
        status = write_map(c, c->direct_error_image, c->reference.color, AG_DIFFERENCE_FLIP, 0.0f,
                           "direct", "-flip.png");
    if (status == DONE) status = write_sheet(c);
    progress_end();
    return status;
}
