// Changes of a running renderer: GI spec, frame options, debug view.
#include "api/renderer/bakes.h"
#include "api/renderer/state.h"

static bool set_gi(struct ag_renderer *r, const struct ag_renderer_desc *desc)
{
    struct host *host = renderer_host(r);
    struct gi_spec spec = { 0 };
    struct renderer_bakes bakes = { 0 };
    char *text = NULL;
    bool ok = gi_spec_parse(&spec, host, desc->gi) && (text = gi_spec_print(&spec)) &&
              renderer_bakes_find(&bakes, host, desc, &spec, r->gi, &r->pose) &&
              gi_change(r->gi, &spec, &bakes.found, &r->pose);
    renderer_bakes_finish(&bakes);
    if (ok) {
        gi_spec_finish(&r->spec);
        r->spec = spec;
        host_free(host, r->gi_text);
        r->gi_text = text;
        renderer_keep_surfaces(r);
        frame_invalidate(r->main.frame);
        renderer_warn_of_source(r);
        renderer_warn_of_darkness(r);
    } else {
        gi_spec_finish(&spec);
        host_free(host, text);
    }
    return ok;
}

enum ag_result ag_renderer_set_gi(struct ag_renderer *r, const char *gi,
                                  const struct ag_bake *const *bakes, int bake_count)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    AG_REQUIRE_POINTER(context, gi);
    enum ag_result checked = renderer_bakes_check(__func__, context, bakes, bake_count);
    if (checked != AG_OK) return checked;
    const struct ag_renderer_desc desc = {
        .gi = gi, .bakes = bakes, .bake_count = bake_count, .bake_folder = r->bake_folder
    };
    renderer_enter(r);
    bool ok = set_gi(r, &desc);
    renderer_leave(r);
    return api_done(context, ok);
}

enum ag_result ag_renderer_set_frame_options(struct ag_renderer *r, const char *options)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    struct frame_options parsed;
    bool ok = renderer_parse_frame_options(&context->host, options, &parsed);
    if (!ok || option_difference(&frame_option_table, &parsed, &r->options) < 0)
        return api_done(context, ok);
    renderer_enter(r);
    ok = frame_set_options(r->main.frame, &parsed);
    renderer_leave(r);
    gi_invalidate(r->gi, CHANGED_OPTIONS); // kept light is from the maps of before
    if (ok) r->options = parsed;
    return api_done(context, ok);
}

enum ag_result ag_renderer_set_debug_view(struct ag_renderer *r, const char *name)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    renderer_enter(r);
    bool ok = gi_set_debug_view(r->gi, name);
    renderer_leave(r);
    return api_done(context, ok);
}
