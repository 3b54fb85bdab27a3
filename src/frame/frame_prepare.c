// Preparation of a frame: what may allocate, before it is recorded.
#include "frame/frame_state.h"

#include "image/tonemap.h"

static bool check_gbuffer(struct frame *f)
{
    const uint32_t needed =
        FRAME_LEAST_GBUFFER | (f->needs & FRAME_NEEDS_MOTION ? 1u << FRAME_MOTION : 0);
    uint32_t missing = 0;
    for (int l = 0; l < FRAME_LAYER_COUNT; l++)
        if (needed >> l & 1u && !f->gbuffer->layers[l].id) missing |= 1u << l;
    if (!missing) return true;
    return host_fail(f->host, FAIL_ARGUMENT, "gbuffer has no image of the layer %s%s",
                     missing >> FRAME_DEPTH & 1u    ? "depth"
                     : missing >> FRAME_NORMAL & 1u ? "normal"
                     : missing >> FRAME_ALBEDO & 1u ? "albedo"
                                                    : "motion",
                     missing & FRAME_LEAST_GBUFFER ? ""
                     : missing >> FRAME_MOTION & 1u
                         ? ", which a technique, antialias or motion_layer needs"
                         : ", which a technique needs");
}

// Whether the display image is of another layer than the colour.
bool frame_shows_layer(const struct frame_input *input)
{
    const struct frame_shown *shown = input->shown;
    return input->want_display && shown && (shown->image.id || shown->layer != FRAME_COLOR);
}

bool frame_displays_color(const struct frame_input *input)
{
    return input->want_display && !frame_shows_layer(input);
}

// Layers that exist even if no technique writes them.
static uint32_t kept_layers(const struct frame *f, const struct frame_input *input)
{
    const bool by_layer = frame_shows_layer(input) && !input->shown->image.id;
    return f->pinned | (by_layer ? 1u << input->shown->layer : 0);
}

uint32_t frame_composite_variant(const struct frame_options *options,
                                 const struct frame_input *input, uint32_t needs)
{
    static const uint32_t curves[TONEMAP_COUNT] = { 0, COMPOSITE_AGX, COMPOSITE_LINEAR };
    const bool displays = frame_displays_color(input) && !(needs & FRAME_ANTIALIASES);
    return (needs & FRAME_WRITES_IRRADIANCE ? COMPOSITE_IRRADIANCE : 0) |
           (needs & FRAME_WRITES_SPECULAR ? COMPOSITE_SPECULAR : 0) |
           (needs & FRAME_WRITES_VISIBILITY ? COMPOSITE_VISIBILITY : 0) |
           (input->want_indirect_layer ? COMPOSITE_INDIRECT : 0) |
           (displays ? COMPOSITE_DISPLAY | curves[options->tonemap] : 0);
}

uint32_t frame_display_variant(const struct frame *f)
{
    static const uint32_t curves[TONEMAP_COUNT] = { 0, DISPLAY_AGX, DISPLAY_LINEAR };
    return curves[f->common->options.tonemap];
}

uint32_t frame_meter_variant(uint32_t variant)
{
    const uint32_t outputs =
        COMPOSITE_INDIRECT | COMPOSITE_DISPLAY | COMPOSITE_AGX | COMPOSITE_LINEAR;
    return (variant & ~outputs) | COMPOSITE_METER;
}

static bool prepare_composite(struct frame *f, const struct frame_input *input)
{
    f->composite_variant = frame_composite_variant(&f->common->options, input, f->needs);
    return composite_prepare(&f->common->composite, f->composite_variant) &&
           (!frame_shows_layer(input) ||
            display_prepare(&f->common->display, f->gpu, frame_display_variant(f))) &&
           (!input->auto_exposure ||
            composite_prepare(&f->common->composite, frame_meter_variant(f->composite_variant)));
}

static uint32_t direct_features(const struct frame *f)
{
    const bool emission = f->gbuffer
                              ? f->gbuffer->layers[FRAME_EMISSIVE].id != 0
                              : f->common->scene.max_emissive > 0 || f->common->scene.has_unlit;
    return (f->layers[FRAME_DIELECTRIC].id ? DIRECT_DIELECTRIC : 0) |
           (f->common->options.shadow_filter > 0 ? DIRECT_FILTERED : 0) |
           (emission ? DIRECT_EMISSION : 0) | (f->common->environment.map ? DIRECT_MAP : 0) |
           (f->needs & FRAME_NEEDS_DIRECT_IRRADIANCE ? DIRECT_IRRADIANCE : 0);
}

static size_t most_pixels(const struct frame_common *common)
{
    size_t most = 1;
    for (int i = 0; i < FRAME_MAX_VIEWS; i++) {
        const struct frame *view = common->views[i];
        const size_t pixels = view ? (size_t)view->width * view->height : 0;
        if (pixels > most) most = pixels;
    }
    return most;
}

static bool prepare_direct(struct frame *f, const struct frame_input *input)
{
    int suns = 0;
    for (int i = 0; i < input->light_count; i++) suns += input->lights[i].type == LIGHT_SUN;
    f->direct_variant = direct_variant(suns, input->light_count - suns, direct_features(f));
    // The variant of one sun takes all sight lines to begin at the camera.
    if (input->projected && input->projected->orthographic)
        f->direct_variant &= ~(1u << DIRECT_CONSTANT_ONE_SUN);
    return direct_prepare(&f->common->direct, f->direct_variant, most_pixels(f->common));
}

// Shadow maps and reflective shadow maps, and what the scene has become.
static bool prepare_maps(struct frame *f, const struct frame_input *input)
{
    static const uint32_t types[] = { FRAME_LIGHT_SUN, FRAME_LIGHT_POINT, FRAME_LIGHT_SPOT };
    struct frame_common *c = f->common;
    int sun_faces = 0, shadow_faces = 0, rsm_faces = 0;
    for (int i = 0; i < input->light_count; i++) {
        const uint32_t type = types[input->lights[i].type];
        *(type == FRAME_LIGHT_SUN ? &sun_faces : &shadow_faces) +=
            shadow_faces_of(&c->shadow, type);
        rsm_faces += rsm_faces_of(type);
    }
    if (!(f->needs & FRAME_NEEDS_RSM)) rsm_faces = 0;
    return shadow_prepare(&c->shadow, sun_faces, shadow_faces) &&
           rsm_prepare(&c->rsm, rsm_faces, c->scene.variants_used);
}

// The images that a caller's G-buffer is converted into, and a pipeline for that.
static bool prepare_conversion(struct frame *f, uint32_t written, uint32_t kept)
{
    const bool dielectrics = f->gbuffer->layers[FRAME_DIELECTRIC].id;
    const uint32_t own = frame_gbuffer_layers(f->needs & ~(uint32_t)FRAME_NEEDS_ID, dielectrics);
    const uint32_t optional = (f->needs & FRAME_NEEDS_MOTION ? GBUFFER_MOTION : 0) |
                              (dielectrics ? GBUFFER_DIELECTRIC : 0);
    return frame_make_layers(f, written | own | f->imported, kept) &&
           gbuffer_convert_prepare(&f->common->convert, f->gpu, optional);
}

// The images of the frame, and the pipelines of its own G-buffer.
static bool prepare_layers(struct frame *f, const struct frame_input *input, uint32_t kept)
{
    const bool dielectrics = f->common->scene.has_dielectrics;
    const uint32_t optional = (f->needs & FRAME_NEEDS_MOTION ? GBUFFER_MOTION : 0) |
                              (f->needs & FRAME_NEEDS_ID ? GBUFFER_ID : 0) |
                              (dielectrics ? GBUFFER_DIELECTRIC : 0);
    const uint32_t written = frame_image_layers(input, f->needs);
    frame_import_gbuffer(f, input->gbuffer);
    if (input->gbuffer && !check_gbuffer(f)) return false;
    if (input->gbuffer && input->gbuffer->encoding) return prepare_conversion(f, written, kept);
    if (input->gbuffer)
        return frame_make_layers(f, written | f->imported, kept | 1u << FRAME_MATERIAL);
    return frame_make_layers(f, written | frame_gbuffer_layers(f->needs, dielectrics), kept) &&
           gbuffer_prepare(&f->common->gbuffer, f->gpu, f->common->scene.variants_used, optional);
}

static uint32_t needs_of(const struct frame *f, const struct frame_indirect *indirect)
{
    const uint32_t needs = indirect ? indirect->needs : 0;
    const bool mirrors = needs & FRAME_WRITES_SPECULAR_OF_MAP && f->common->environment.map;
    return needs | (mirrors ? FRAME_WRITES_SPECULAR : 0) |
           (needs & FRAME_NEEDS_MOTION ? FRAME_LIGHT_EVOLVES : 0) |
           frame_antialias_needs(&f->common->options);
}

bool frame_prepare(struct frame *f, const struct frame_input *input,
                   const struct frame_indirect *indirect)
{
    f->prepared = false;
    if (!f->common->has_scene || f->width == 0) {
        return host_fail(f->host, FAIL_ARGUMENT, "frame: no %s was set",
                         f->common->has_scene ? "size" : "scene");
    }
    if (input->light_count < 0 || input->light_count > FRAME_MAX_LIGHTS) {
        return host_fail(f->host, FAIL_ARGUMENT, "frame: %d lights, at most %d", input->light_count,
                         FRAME_MAX_LIGHTS);
    }
    if (input->pose->scene != f->common->scene.scene)
        return host_fail(f->host, FAIL_ARGUMENT, "frame: the pose belongs to another scene");
    const bool is_first = f->view_number == 0;
    if (is_first &&
        !(scene_gpu_follow(&f->common->scene) && emitters_follow(&f->common->emitters) &&
          frame_environment_prepare(&f->common->environment, &input->environment)))
        return false;
    if (input->pick) f->pinned |= 1u << FRAME_ID; // only the first pick creates the image
    const uint32_t kept = kept_layers(f, input);
    f->needs = needs_of(f, indirect) |
               (input->want_motion_layer || kept >> FRAME_MOTION & 1u ? FRAME_NEEDS_MOTION : 0) |
               (input->want_id_layer || input->pick ? FRAME_NEEDS_ID : 0);
    f->own = f->view_number ? kept | frame_kept_layers(input) : ~0u;
    f->prepared = prepare_layers(f, input, kept) && (!is_first || prepare_maps(f, input)) &&
                  prepare_direct(f, input) && prepare_composite(f, input) &&
                  frame_prepare_antialias(f, frame_displays_color(input));
    return f->prepared;
}
