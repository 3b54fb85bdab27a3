// Reports of light maps: forwards to lightmap/quality.
#include "api/lightmap_state.h"

bool api_lightmap_write_report(struct ag_lightmap *l)
{
    struct host *host = &l->context->host;
    l->report = report_create(host);
    if (!l->report) return false;
    quality_report(l->report, &l->quality, &l->map, l->scene->scene);
    return report_text(l->report) ||
           host_fail(host, FAIL_MEMORY, "cannot report on a light map: out of memory");
}

#define REQUIRE_REPORT(context, l)                                                                 \
    AG_REQUIRE(context, (l)->report, "the light map has no report: set ag_lightmap_desc.report")

enum ag_result ag_lightmap_report(const struct ag_lightmap *l, const char **json)
{
    struct ag_context *context = api_lightmap_context(l);
    AG_REQUIRE_OUT(context, json);
    AG_REQUIRE(context, l, "lightmap is NULL");
    REQUIRE_REPORT(context, l);
    *json = report_text(l->report);
    return AG_OK;
}

_Static_assert((int)AG_LIGHTMAP_CHART == QUALITY_CHART &&
                   (int)AG_LIGHTMAP_DENSITY == QUALITY_DENSITY &&
                   (int)AG_LIGHTMAP_OPEN == QUALITY_OPEN &&
                   (int)AG_LIGHTMAP_NOISE == QUALITY_NOISE && (int)AG_LIGHTMAP_LEAK == QUALITY_LEAK,
               "layers are passed on");

enum ag_result ag_lightmap_read_layer(const struct ag_lightmap *l, enum ag_lightmap_layer layer,
                                      bool back, struct ag_image **out)
{
    struct ag_context *context = api_lightmap_context(l);
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, l, "lightmap is NULL");
    AG_REQUIRE(context, layer >= AG_LIGHTMAP_CHART && layer <= AG_LIGHTMAP_LEAK,
               "layer %d does not exist", (int)layer);
    AG_REQUIRE(context, !back || l->map.has_back, "no material is double-sided");
    REQUIRE_REPORT(context, l);
    struct image image = { 0 };
    const bool ok = quality_layer(&l->quality, &l->map, (enum quality_layer)layer,
                                  back ? LIGHTMAP_BACK : LIGHTMAP_FRONT, &image);
    return api_give_image(context, ok, &image, out);
}
