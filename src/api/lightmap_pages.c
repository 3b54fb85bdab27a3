// Pages of light maps: forwards to scene/charts.
#include "api/lightmap_state.h"

#include "techniques/gi_bake.h"

int api_lightmap_term(const struct gi_spec *spec)
{
    for (int i = 0; i < spec->count; i++)
        if (technique_has_light_map(spec->technique[i], spec->options[i])) return i;
    return -1;
}

enum ag_result api_lightmap_check_page(const char *function, struct ag_context *context, int page)
{
    AG_REQUIRE_FOR(function, context,
                   page >= CHART_LEAST_PAGE && page <= CHART_MAX_SIDE &&
                       page % CHART_SIDE_MULTIPLE == 0,
                   "page %d must be %d to %d and a multiple of %d", page, CHART_LEAST_PAGE,
                   CHART_MAX_SIDE, CHART_SIDE_MULTIPLE);
    return AG_OK;
}

static bool count_pages(struct host *host, const struct scene_pose *pose,
                        const struct gi_spec *spec, int term, int page, int *count)
{
    struct scene_statics statics;
    struct charts charts = { 0 };
    if (!gi_bake_resolve(host, spec->technique[term], pose, spec->options[term]) ||
        !scene_statics_init(&statics, host, pose))
        return false;
    const bool ok =
        spec->technique[term]->charts(&statics.pose, spec->options[term], host, NULL, &charts) &&
        charts_set_pages(&charts, pose->scene, (uint32_t)page);
    *count = ok ? (int)charts_page_count(&charts) : 0;
    charts_finish(&charts);
    scene_statics_finish(&statics);
    return ok;
}

enum ag_result ag_lightmap_count_pages(struct ag_scene *scene, const char *gi, int page, int *count)
{
    struct ag_context *context = scene ? scene->context : NULL;
    AG_REQUIRE(context, scene, "scene is NULL");
    AG_REQUIRE_POINTER(context, gi);
    AG_REQUIRE_POINTER(context, count);
    *count = 0;
    const enum ag_result checked = api_lightmap_check_page(__func__, context, page);
    if (checked != AG_OK) return checked;
    struct host *host = &context->host;
    struct gi_spec spec;
    struct scene_pose pose = { 0 };
    bool ok = gi_spec_parse(&spec, host, gi);
    const int term = ok ? api_lightmap_term(&spec) : -1;
    if (ok && term < 0)
        ok = host_fail(host, FAIL_ARGUMENT, "cannot count pages of %s: it has no light map", gi);
    ok = ok && api_pose_at(scene, &pose, 0, 0.0) &&
         count_pages(host, &pose, &spec, term, page, count);
    pose_finish(&pose);
    gi_spec_finish(&spec);
    return api_done(context, ok);
}

enum ag_result ag_lightmap_get_page(const struct ag_lightmap *l, int page,
                                    struct ag_lightmap_page *out)
{
    struct ag_context *context = api_lightmap_context(l);
    AG_REQUIRE(context, l, "lightmap is NULL");
    AG_REQUIRE_POINTER(context, out);
    const struct charts *charts = &l->map.charts;
    AG_REQUIRE(context, page >= 0 && (uint32_t)page < charts_page_count(charts),
               "page %d does not exist", page);
    const struct chart_page at = charts_page(charts, (uint32_t)page);
    *out = (struct ag_lightmap_page){
        .x = (int)at.x, .y = (int)at.y, .width = (int)at.width, .height = (int)at.height
    };
    return AG_OK;
}
