// Layers of the newest frame: downloaded, or passed on as Vulkan images.
#include "api/renderer/state.h"

#include "image/image.h"

#include <string.h>

enum { NO_IMAGE = -1, NO_READBACK = -1 };

struct layer {
    const char *name;
    int read;     // enum frame_readback; NO_READBACK: the debug image of the GI stack
    int image;    // enum frame_layer; NO_IMAGE: computed while reading
    int channels; // when read
    bool scaled;  // radiance or irradiance
};

static const struct layer layers[] = {
    { "color", READ_COLOR, FRAME_COLOR, 3, true },
    { "direct", READ_DIRECT, FRAME_DIRECT, 3, true },
    { "indirect", READ_INDIRECT, FRAME_INDIRECT, 3, true },
    { "irradiance", READ_IRRADIANCE, FRAME_IRRADIANCE, 3, true },
    { "visibility", READ_VISIBILITY, FRAME_VISIBILITY, 1, false },
    { "specular", READ_SPECULAR, FRAME_SPECULAR, 3, true },
    { "albedo", READ_ALBEDO, FRAME_ALBEDO, 3, false },
    { "normal", READ_NORMAL, FRAME_NORMAL, 3, false },
    { "depth", READ_DEPTH, FRAME_DEPTH, 1, false },
    { "position", READ_POSITION, NO_IMAGE, 3, false },
    { "emissive", READ_EMISSIVE, FRAME_EMISSIVE, 3, true },
    { "motion", READ_MOTION, FRAME_MOTION, 3, false },
    { "id", READ_ID, FRAME_ID, 2, false },
    { "display", READ_DISPLAY, FRAME_DISPLAY, 3, false },
    { "debug", NO_READBACK, NO_IMAGE, 3, true },
};
enum { LAYER_COUNT = sizeof layers / sizeof layers[0] };

const char *ag_layer_name(int index)
{
    return index >= 0 && index < LAYER_COUNT ? layers[index].name : NULL;
}

static const struct layer *layer_find(const char *name)
{
    for (int i = 0; i < LAYER_COUNT; i++)
        if (strcmp(layers[i].name, name) == 0) return &layers[i];
    return NULL;
}

static bool fail_unknown(struct host *host, const char *name)
{
    const char *names[LAYER_COUNT];
    for (int i = 0; i < LAYER_COUNT; i++) names[i] = layers[i].name;
    const char *nearest = nearest_name(name, names, LAYER_COUNT);
    if (nearest)
        return host_fail(host, FAIL_ARGUMENT, "unknown layer %s: did you mean %s?", name, nearest);
    return host_fail(host, FAIL_ARGUMENT, "unknown layer %s: see ag_layer_name", name);
}

// With host_gbuffer the program has the image.
static bool is_hosts(const struct ag_view *v, const struct layer *layer)
{
    return v->host_gbuffer &&
           (layer->read == READ_POSITION ||
            (layer->image != NO_IMAGE && frame_layer_is_gbuffer((enum frame_layer)layer->image)));
}

static gpu_image layer_image(const struct ag_view *v, const struct layer *layer)
{
    if (layer->read == NO_READBACK) return gi_debug_image(v->renderer->gi);
    return frame_layer_image(v->frame, (enum frame_layer)layer->image);
}

// The layer of that name, or NULL and a failure if the renderer does not keep it.
static const struct layer *layer_kept(const struct ag_view *v, const char *name)
{
    struct host *host = &v->renderer->device->context->host;
    const struct layer *layer = layer_find(name);
    const char *need = NULL;
    if (!layer)
        fail_unknown(host, name);
    else if (is_hosts(v, layer))
        need = "it is of the program's own G-buffer";
    else if (layer->image == FRAME_INDIRECT && !v->indirect_layer)
        need = "create the renderer with indirect_layer";
    else if (layer->image == FRAME_DISPLAY && !v->display_layer)
        need = "create the renderer with display_layer";
    else if (layer->image == FRAME_ID && !v->id_layer)
        need = "create the renderer with id_layer";
    else if (layer->read == NO_READBACK && v != &v->renderer->main)
        need = "debug views are of the renderer's own camera";
    else if (layer->read == NO_READBACK && !gi_has_debug_view(v->renderer->gi))
        need = "no debug view is set";
    else if (layer->image == FRAME_MOTION && !v->motion_layer &&
             !(gi_hook(v->renderer->gi).needs & FRAME_NEEDS_MOTION))
        need = "create the renderer with motion_layer, or use a technique that needs it";
    if (need) host_fail(host, FAIL_ARGUMENT, "cannot read layer %s: %s", name, need);
    return layer && !need ? layer : NULL;
}

static bool keeps(const struct ag_view *v, const struct layer *layer)
{
    if (v == &v->renderer->main || v->all_layers) return true;
    switch (layer->read) {
    case READ_POSITION:
        return frame_keeps_layer(v->frame, FRAME_DEPTH);
    case READ_NORMAL: // the albedo's alpha tells where there is a surface
        return frame_keeps_layer(v->frame, FRAME_NORMAL) &&
               frame_keeps_layer(v->frame, FRAME_ALBEDO);
    default:
        return frame_keeps_layer(v->frame, (enum frame_layer)layer->image);
    }
}

static bool fail_not_kept(const struct ag_view *v, const struct layer *layer)
{
    return host_fail(renderer_host(v->renderer), FAIL_ARGUMENT,
                     "cannot read layer %s: the view did not keep it; create the view with "
                     "all_layers, or ask for its handle%s before the frame",
                     layer->name,
                     layer->read == READ_NORMAL     ? " and that of albedo"
                     : layer->read == READ_POSITION ? " of depth"
                                                    : "");
}

static bool read_debug(struct ag_view *v, struct image *image)
{
    struct gpu *gpu = v->renderer->device->gpu;
    gpu_image debug = gi_debug_image(v->renderer->gi);
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    float scale = frame_radiance_scale(v->frame);
    if (!gpu_image_download_float(gpu, debug, 0, 0, image->pixels, image->channels, count))
        return false;
    for (size_t i = 0; i < count; i++) image->pixels[i] /= scale;
    return true;
}

static bool read_layer(struct ag_view *v, const struct layer *layer, struct image *image)
{
    if (layer->read == NO_READBACK) return read_debug(v, image);
    return frame_read(v->frame, (enum frame_readback)layer->read, image->pixels, image->channels);
}

enum ag_result view_read(const char *function, struct ag_view *v, const char *name,
                         struct ag_image **out)
{
    struct ag_context *context = view_context(v);
    AG_REQUIRE_FOR(function, context, out, "out is NULL");
    *out = NULL;
    AG_REQUIRE_FOR(function, context, name, "layer is NULL");
    AG_REQUIRE_FOR(function, context, v->rendered, "no frame has been rendered");
    const struct layer *layer = layer_kept(v, name);
    if (!layer) return api_done(context, false);
    if (!keeps(v, layer)) return api_done(context, fail_not_kept(v, layer));
    enum ag_result result = ag_renderer_wait(v->renderer);
    if (result != AG_OK) return result;
    const struct gpu_image_desc *size =
        gpu_image_info(v->renderer->device->gpu, frame_layer_image(v->frame, FRAME_COLOR));
    struct ag_image *image = NULL;
    result = ag_image_create(context, (int)size->width, (int)size->height, layer->channels, &image);
    if (result != AG_OK) return result;
    struct image view = { image->width, image->height, image->channels, image->pixels };
    result = api_done(context, read_layer(v, layer, &view));
    if (result == AG_OK)
        *out = image;
    else
        ag_image_destroy(context, image);
    return result;
}

enum ag_result ag_renderer_read(struct ag_renderer *r, const char *name, struct ag_image **out)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, r, "renderer is NULL");
    return view_read(__func__, &r->main, name, out);
}

static const char *shown_need(const struct ag_view *v, const struct layer *layer)
{
    if (v->host_gbuffer && layer->image == FRAME_EMISSIVE)
        return "it is of the program's own G-buffer";
    if (!v->display_layer) return "create the renderer with display_layer";
    if (layer->image == FRAME_INDIRECT && !v->indirect_layer)
        return "create the renderer with indirect_layer";
    if (layer->image == FRAME_DISPLAY || layer->image == FRAME_ID ||
        (layer->image == NO_IMAGE && layer->read != NO_READBACK))
        return "it has no values to show";
    return NULL;
}

enum ag_result ag_renderer_set_display(struct ag_renderer *r, const char *name)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    const struct layer *layer = layer_find(name ? name : "color");
    if (!layer) return api_done(context, fail_unknown(&context->host, name));
    const char *need = shown_need(&r->main, layer);
    if (need)
        return api_done(context, host_fail(&context->host, FAIL_ARGUMENT,
                                           "cannot display layer %s: %s", layer->name, need));
    r->main.shows_debug = layer->read == NO_READBACK;
    r->main.shown.layer = r->main.shows_debug ? FRAME_COLOR : (enum frame_layer)layer->image;
    return api_done(context, true);
}

// The image of a layer, pinned so that it lasts and has a value whatever techniques run.
static bool share(struct ag_view *v, const struct layer *layer, struct gpu_image_handles *out)
{
    const bool debug = layer->read == NO_READBACK;
    if (layer->image == NO_IMAGE && !debug)
        return host_fail(renderer_host(v->renderer), FAIL_UNSUPPORTED,
                         "cannot return layer %s: it has no Vulkan image", layer->name);
    if (!debug && !frame_pin_layer(v->frame, (enum frame_layer)layer->image)) return false;
    return gpu_image_share(v->renderer->device->gpu, layer_image(v, layer), out);
}

enum ag_result view_layer_handle(const char *function, struct ag_view *v, const char *name,
                                 struct ag_layer_handle *out)
{
    struct ag_context *context = view_context(v);
    AG_REQUIRE_FOR(function, context, out, "out is NULL");
    *out = (struct ag_layer_handle){ 0 };
    AG_REQUIRE_FOR(function, context, name, "layer is NULL");
    AG_REQUIRE_FOR(function, context, v->sized, "the last resize failed");
    const struct layer *layer = layer_kept(v, name);
    if (!layer) return api_done(context, false);
    struct gpu_image_handles handles;
    renderer_enter(v->renderer);
    const bool ok = share(v, layer, &handles);
    renderer_leave(v->renderer);
    if (!ok) return api_done(context, false);
    *out = (struct ag_layer_handle){
        .vk_image = handles.image,
        .vk_image_view = handles.view,
        .vk_format = handles.format,
        .vk_usage = handles.usage,
        .vk_layout = handles.layout,
        .width = v->width,
        .height = v->height,
        .scale = layer->scaled ? frame_radiance_scale(v->frame) : 1.0f,
    };
    return api_done(context, true);
}

enum ag_result ag_renderer_layer_handle(struct ag_renderer *r, const char *name,
                                        struct ag_layer_handle *out)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_POINTER(context, out);
    *out = (struct ag_layer_handle){ 0 };
    AG_REQUIRE(context, r, "renderer is NULL");
    return view_layer_handle(__func__, &r->main, name, out);
}
