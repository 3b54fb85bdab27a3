// The page of compare: its template is page/report.html.
#include "report_page.h"
#include "cli/files/whole_file.h"
#include "cli/page/page.h"
#include "shell/srgb.h"

#include <afterglow/image.h>

// ---- images of the report

// `owner`: the reference or a method.
static enum status collect_images(struct page *page, const json_t *owner)
{
    const char *role;
    json_t *value;
    json_t *images = json_object_get(owner, "images");
    json_object_foreach(images, role, value)
    {
        const enum status status = page_add_image(page, json_string_value(value));
        if (status != DONE) return status;
    }
    return DONE;
}

static enum status find_images(struct page *page, const json_t *report)
{
    size_t i;
    json_t *method;
    enum status status = collect_images(page, json_object_get(report, "reference"));
    if (status == DONE) status = collect_images(page, json_object_get(report, "direct"));
    json_array_foreach(json_object_get(report, "methods"), i, method)
    {
        if (status == DONE) status = collect_images(page, method);
    }
    return status;
}

// ---- colours of error maps

enum { SCALE_COLOURS = 33 };

static json_t *colour_json(const float *linear)
{
    return json_sprintf("#%02x%02x%02x", srgb_byte(linear[0]), srgb_byte(linear[1]),
                        srgb_byte(linear[2]));
}

// The error map of a ramp against black contains all colours.
static enum ag_result map_ramp(struct ag_context *context, struct ag_image **map)
{
    struct ag_image *ramp = NULL, *black = NULL;
    enum ag_result result = ag_image_create(context, SCALE_COLOURS, 1, 3, &ramp);
    if (result == AG_OK) result = ag_image_create(context, SCALE_COLOURS, 1, 3, &black);
    for (int i = 0; result == AG_OK && i < 3 * SCALE_COLOURS; i++)
        ramp->pixels[i] = (float)(i / 3) / (float)(SCALE_COLOURS - 1);
    if (result == AG_OK)
        result = ag_image_error_map(context, ramp, black, NULL, AG_DIFFERENCE_ABSOLUTE, 1.0f, map);
    ag_image_destroy(context, ramp);
    ag_image_destroy(context, black);
    return result;
}

// From no error to the largest.
static enum status find_scale(json_t *data)
{
    struct ag_context *context = NULL;
    struct ag_image *map = NULL;
    json_t *colours = json_array();
    enum ag_result result = ag_context_create(NULL, &context);
    if (result != AG_OK) return fail("cannot write report.html: %s", ag_result_string(result));
    result = map_ramp(context, &map);
    for (int i = 0; result == AG_OK && i < SCALE_COLOURS; i++)
        json_array_append_new(colours, colour_json(map->pixels + 3 * i));
    enum status status = result == AG_OK ? DONE : fail_library(context, result);
    ag_image_destroy(context, map);
    ag_context_destroy(context);
    if (json_object_set_new(data, "scale", colours) != 0)
        return fail("cannot write report.html: out of memory");
    return status == DONE ? DONE : FAILED;
}

enum status report_page_write(const char *folder, const json_t *report)
{
    json_t *data = json_pack("{s:O}", "report", report);
    struct page page = { .template = "report.html", .folder = folder, .data = data };
    char path[PATH_SIZE];
    if (!data) return fail("cannot write report.html: out of memory");
    enum status status = snprintf(path, sizeof path, "%s/report.html", folder) < PATH_SIZE
                             ? find_images(&page, report)
                             : fail("cannot write %s/report.html: the path is too long", folder);
    if (status == DONE) status = find_scale(data);
    if (status == DONE) status = page_write(&page, path);
    page_finish(&page);
    json_decref(data);
    return status;
}
