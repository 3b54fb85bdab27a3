// Data of bakes for other programs.
#include "api/bake_state.h"

#include "techniques/registry.h"

enum { LIST_SIZE = 256 };

static bool exports(const struct technique *technique)
{
    return technique->bake_export != NULL;
}

static bool export_to(const struct ag_bake *b, const char *folder)
{
    struct host *host = &b->context->host;
    const struct technique *technique = b->spec.technique[b->term];
    char list[LIST_SIZE];
    technique_list(exports, list, sizeof list);
    if (!exports(technique))
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot export the bake of %s: it has no data for other programs; "
                         "techniques that have: %s",
                         technique->name, list);
    if (!bake_is_complete(b->bake))
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot export the bake of %s: it is incomplete; run or load it first",
                         technique->name);
    return technique->bake_export(host, bake_tensors(b->bake), &b->how, folder);
}

enum ag_result ag_bake_export(const struct ag_bake *b, const char *folder)
{
    struct ag_context *context = b ? b->context : NULL;
    AG_REQUIRE(context, b, "bake is NULL");
    AG_REQUIRE(context, folder && folder[0], "folder is empty");
    AG_REQUIRE(context, !api_bake_is_reference(b), "the bake is of a reference, not a technique");
    AG_REQUIRE(context, b->lightmap_samples == 0,
               "the bake is of a light map: use ag_lightmap_write");
    return api_done(context, export_to(b, folder));
}
