// Further views of a renderer.
#include "api/renderer/gbuffer.h"
#include "api/renderer/state.h"

void ag_view_desc_default(struct ag_view_desc *desc)
{
    if (desc) *desc = (struct ag_view_desc){ .width = 1280, .height = 720, .display_layer = true };
}

void ag_view_frame_default(struct ag_view_frame *frame)
{
    if (frame) *frame = (struct ag_view_frame){ .auto_exposure = true };
}

static struct frame_input view_wants(const struct ag_view_desc *desc)
{
    struct frame_input wants =
        renderer_wants(&(struct ag_renderer_desc){ .indirect_layer = desc->indirect_layer,
                                                   .motion_layer = desc->motion_layer,
                                                   .display_layer = desc->display_layer,
                                                   .host_gbuffer = desc->host_gbuffer,
                                                   .gbuffer_layout = desc->gbuffer_layout });
    wants.keep_layers = desc->all_layers;
    return wants;
}

// No larger, and at least two fifths of the size: see gpu_image_desc.alias. Padding may decide.
static bool shares_memory(const struct ag_renderer_desc *renderer, const struct ag_view_desc *view)
{
    const double first = (double)renderer->width * renderer->height;
    const double own = (double)view->width * view->height;
    return view->width <= renderer->width && view->height <= renderer->height && own > 0.45 * first;
}

enum ag_result ag_view_estimate_memory(struct ag_context *context,
                                       const struct ag_renderer_desc *renderer,
                                       const struct ag_view_desc *desc, uint64_t *bytes)
{
    AG_REQUIRE_POINTER(context, bytes);
    *bytes = 0;
    AG_REQUIRE_POINTER(context, context);
    struct ag_renderer_desc renderer_fallback;
    struct ag_view_desc fallback;
    ag_renderer_desc_default(&renderer_fallback);
    ag_view_desc_default(&fallback);
    if (!renderer) renderer = &renderer_fallback;
    if (!desc) desc = &fallback;
    AG_REQUIRE_KNOWN(__func__, context, renderer);
    AG_REQUIRE_KNOWN(__func__, context, desc);
    enum ag_result checked = renderer_size_check(__func__, context, desc->width, desc->height);
    if (checked != AG_OK) return checked;
    struct gi_spec spec = { 0 };
    struct frame_options options;
    const bool ok = renderer_parse_quietly(context, renderer, &spec, &options);
    const uint32_t width = (uint32_t)desc->width, height = (uint32_t)desc->height;
    const bool apart = !shares_memory(renderer, desc);
    const struct frame_input first = renderer_wants(renderer), input = view_wants(desc);
    const uint32_t needs = ok ? gi_spec_needs(&spec) : 0;
    const int64_t more = (int64_t)width * height - (int64_t)renderer->width * renderer->height;
    if (ok)
        *bytes = frame_view_memory_estimate(&options, &input, apart ? NULL : &first, needs, width,
                                            height, more > 0 ? (uint64_t)more : 0) +
                 gi_view_memory_estimate(&spec, width, height, apart);
    gi_spec_finish(&spec);
    return api_done(context, ok);
}

static bool resize(struct ag_view *v, int width, int height)
{
    struct ag_renderer *r = v->renderer;
    v->rendered = 0;
    v->width = width;
    v->height = height;
    renderer_enter(r);
    v->sized = frame_resize(v->frame, (uint32_t)width, (uint32_t)height) &&
               gi_resize_view(r->gi, frame_view_number(v->frame), &r->pose, (uint32_t)width,
                              (uint32_t)height);
    renderer_leave(r);
    return v->sized;
}

static bool create_frame(struct ag_view *v)
{
    renderer_enter(v->renderer);
    v->frame = frame_create_view(v->renderer->main.frame);
    renderer_leave(v->renderer);
    return v->frame;
}

enum ag_result ag_view_create(struct ag_renderer *r, const struct ag_view_desc *desc,
                              struct ag_view **out)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, r, "renderer is NULL");
    struct ag_view_desc fallback;
    ag_view_desc_default(&fallback);
    if (!desc) desc = &fallback;
    AG_REQUIRE_KNOWN(__func__, context, desc);
    enum ag_result checked = renderer_size_check(__func__, context, desc->width, desc->height);
    if (checked == AG_OK)
        checked =
            renderer_layout_check(__func__, context, desc->host_gbuffer, desc->gbuffer_layout);
    if (checked != AG_OK) return checked;

    struct ag_view *v = host_alloc(&context->host, 1, sizeof *v);
    if (!v) return api_done(context, false);
    *v = (struct ag_view){ .renderer = r,
                           .indirect_layer = desc->indirect_layer,
                           .display_layer = desc->display_layer,
                           .motion_layer = desc->motion_layer,
                           .host_gbuffer = desc->host_gbuffer,
                           .has_layout = desc->gbuffer_layout,
                           .all_layers = desc->all_layers,
                           .shown = { .layer = FRAME_COLOR } };
    if (desc->gbuffer_layout) v->layout = *desc->gbuffer_layout;
    lifetime_use(&r->life);
    const bool ok = create_frame(v) && resize(v, desc->width, desc->height);
    const enum ag_result result = api_done(context, ok);
    if (ok)
        *out = v;
    else
        ag_view_destroy(v);
    return result;
}

void ag_view_destroy(struct ag_view *v)
{
    if (!v) return;
    struct ag_renderer *r = v->renderer;
    if (v->frame) gi_resize_view(r->gi, frame_view_number(v->frame), &r->pose, 0, 0);
    frame_destroy(v->frame);
    host_free(renderer_host(r), v);
    renderer_release(r);
}

enum ag_result ag_view_resize(struct ag_view *v, int width, int height)
{
    struct ag_context *context = view_context(v);
    AG_REQUIRE(context, v, "view is NULL");
    enum ag_result checked = renderer_size_check(__func__, context, width, height);
    return checked != AG_OK ? checked : api_done(context, resize(v, width, height));
}

enum ag_result ag_view_read(struct ag_view *v, const char *layer, struct ag_image **out)
{
    struct ag_context *context = view_context(v);
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, v, "view is NULL");
    return view_read(__func__, v, layer, out);
}

enum ag_result ag_view_layer_handle(struct ag_view *v, const char *layer,
                                    struct ag_layer_handle *out)
{
    struct ag_context *context = view_context(v);
    AG_REQUIRE_POINTER(context, out);
    *out = (struct ag_layer_handle){ 0 };
    AG_REQUIRE(context, v, "view is NULL");
    return view_layer_handle(__func__, v, layer, out);
}

enum ag_result ag_view_exposure(struct ag_view *v, float *ev)
{
    struct ag_context *context = view_context(v);
    AG_REQUIRE_POINTER(context, ev);
    *ev = 0.0f;
    AG_REQUIRE(context, v, "view is NULL");
    AG_REQUIRE(context, v->rendered, "no frame has been rendered");
    enum ag_result waited = ag_renderer_wait(v->renderer);
    if (waited != AG_OK) return waited;
    return api_done(context, frame_exposure(v->frame, ev));
}
