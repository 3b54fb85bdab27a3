// The figures are those of ag_lightmap_report and of the bakes.
#include "light_map_report.h"
#include "cli/files/json.h"
#include "cli/page/origin.h"
#include "cli/page/page.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- figures

static json_t *quality_json(const struct light_map_run *run)
{
    const char *text = NULL;
    if (ag_lightmap_report(run->lightmap, &text) != AG_OK) return NULL;
    return json_loads(text, 0, NULL);
}

// Name and seconds of each stage. A bake that was loaded may not know them.
static void add_stages(json_t *stages, const char *technique, const json_t *report)
{
    size_t i;
    const json_t *stage;
    json_array_foreach(json_object_get(report, "stages"), i, stage)
    {
        const json_t *seconds = json_object_get(stage, "seconds");
        if (!json_is_number(seconds) || !(json_number_value(seconds) > 0.0)) continue;
        json_array_append_new(stages,
                              json_pack("{s:s, s:O, s:O}", "bake", technique, "name",
                                        json_object_get(stage, "name"), "seconds", seconds));
    }
}

static enum status add_times(const struct light_map_run *run, json_t *document)
{
    json_t *stages = json_array();
    for (int i = 0; i < run->bake_count; i++) {
        const char *text = NULL;
        struct ag_bake_info info;
        enum ag_result result = ag_bake_get_info(run->bakes[i], &info);
        if (result == AG_OK) result = ag_bake_report(run->bakes[i], &text);
        if (result != AG_OK) {
            json_decref(stages);
            return fail_library(run->session->context, result);
        }
        json_t *report = json_loads(text, 0, NULL);
        add_stages(stages, info.technique, report);
        json_object_set(document, "threads", json_object_get(report, "threads"));
        json_decref(report);
    }
    json_object_set_new(document, "stages", stages);
    json_object_set_new(document, "seconds", json_double(run->seconds));
    return DONE;
}

enum status light_map_report_add(const struct light_map_run *run, json_t *document)
{
    json_t *quality = quality_json(run);
    if (!quality || json_object_set_new(document, "quality", quality) != 0)
        return fail_library(run->session->context, AG_ERROR_MEMORY);
    json_object_set_new(document, "scene", json_text(run->session->name));
    json_object_set_new(document, "gi", json_text(run->gi));
    json_object_set_new(document, "light", json_text(run->session->light));
    report_add_origin(document, "bake", run->session->arguments);
    return add_times(run, document);
}

// ---- the page

static bool has_noise(const json_t *document)
{
    return json_object_get(json_object_get(document, "quality"), "noise") != NULL;
}

enum status light_map_page_write(const struct light_map_run *run, const json_t *document,
                                 const struct folder *folder)
{
    char path[PATH_SIZE];
    if (!folder_file(folder, LIGHT_MAP_PAGE, path))
        return fail("cannot write %s/" LIGHT_MAP_PAGE ": the path is too long", folder->shown);
    json_t *data = json_pack("{s:O, s:o}", "report", document, "colours", light_map_colours());
    if (!data) return fail("cannot write " LIGHT_MAP_PAGE ": out of memory");
    struct page page = { .template = "lightmap.html", .folder = folder->beside.path, .data = data };
    enum status status = light_map_images_write(run, has_noise(document), folder, &page);
    if (status == DONE) status = page_write(&page, path);
    light_map_images_remove(&page, folder);
    page_finish(&page);
    json_decref(data);
    return status;
}
