// One frame: frame_record is the order of passes. Each pass has its own folder and gets the results
// of earlier passes as arguments.
#include "frame/frame_state.h"

#include "core/ggx_albedo.h"

static const struct option_row option_rows[] = {
#define OPTION(...) OPTION_ROW(struct frame_options, __VA_ARGS__)
#include "frame/frame_options.def"
#undef OPTION
};
const struct option_table frame_option_table =
    OPTION_TABLE(struct frame_options, option_rows, NULL);

static const uint32_t MAX_SIZE = 16384;

#define SWAP(type, a, b)                                                                           \
    do {                                                                                           \
        const type swapped = (a);                                                                  \
        (a) = (b);                                                                                 \
        (b) = swapped;                                                                             \
    } while (0)

static bool create_ggx_albedo(struct frame *f)
{
    struct gpu_buffer_desc desc = { "frame.ggx_albedo", sizeof ggx_albedo_table,
                                    GPU_BUFFER_STORAGE };
    return gpu_buffer_create(f->gpu, &desc, &f->ggx_albedo) &&
           gpu_buffer_upload(f->gpu, f->ggx_albedo, 0, ggx_albedo_table, sizeof ggx_albedo_table);
}

static struct gpu_binding ggx_albedo_binding(const struct frame *f)
{
    return (struct gpu_binding){ "ggx_albedo", .buffer = f->ggx_albedo };
}

struct frame *frame_create(struct host *host, struct gpu *gpu, const struct frame_options *options)
{
    struct frame *f = host_alloc(host, 1, sizeof *f);
    if (!f) return NULL;
    f->host = host;
    f->gpu = gpu;
    f->options = *options;
    if (shadow_init(&f->shadow, host, gpu, (uint32_t)options->shadow_size,
                    (uint32_t)options->cascades) &&
        rsm_init(&f->rsm, host, gpu, (uint32_t)options->rsm_size) &&
        direct_init(&f->direct, gpu, (uint32_t)options->cascades) &&
        exposure_init(&f->exposure, gpu) && composite_init(&f->composite, gpu) &&
        create_ggx_albedo(f) && reports_init(f)) {
        return f;
    }
    frame_destroy(f);
    return NULL;
}

void frame_destroy(struct frame *f)
{
    if (!f) return;
    frame_destroy_layers(f);
    reports_finish(f);
    gpu_buffer_destroy(f->gpu, &f->ggx_albedo);
    display_finish(&f->display);
    composite_finish(&f->composite);
    exposure_finish(&f->exposure);
    direct_finish(&f->direct);
    rsm_finish(&f->rsm);
    shadow_finish(&f->shadow);
    gbuffer_finish(&f->gbuffer);
    emitters_finish(&f->emitters);
    scene_gpu_finish(&f->scene);
    host_free(f->host, f);
}

bool frame_set_options(struct frame *f, const struct frame_options *options)
{
    struct shadow shadow = { 0 };
    struct direct direct = { 0 };
    struct rsm rsm = { 0 };
    const bool sized =
        options->shadow_size != f->options.shadow_size || options->cascades != f->options.cascades;
    const bool rsm_sized = options->rsm_size != f->options.rsm_size;
    const uint32_t cascades = (uint32_t)options->cascades;
    // Finishes those of before, or after a failure the new ones.
    bool ok = !sized ||
              (shadow_init(&shadow, f->host, f->gpu, (uint32_t)options->shadow_size, cascades) &&
               direct_init(&direct, f->gpu, cascades));
    ok = ok && (!rsm_sized || rsm_init(&rsm, f->host, f->gpu, (uint32_t)options->rsm_size));
    if (ok && sized) {
        SWAP(struct shadow, shadow, f->shadow);
        SWAP(struct direct, direct, f->direct);
    }
    if (ok && rsm_sized) SWAP(struct rsm, rsm, f->rsm);
    direct_finish(&direct);
    shadow_finish(&shadow);
    rsm_finish(&rsm);
    if (ok) f->options = *options;
    return ok;
}

bool frame_set_scene(struct frame *f, const struct scene *scene)
{
    const uint64_t updates = f->scene.updates;
    emitters_finish(&f->emitters);
    scene_gpu_finish(&f->scene);
    f->has_scene = f->prepared = false;
    f->index = 0;
    if (!scene_gpu_init(&f->scene, f->host, f->gpu, scene) ||
        !emitters_init(&f->emitters, f->host, scene)) {
        emitters_finish(&f->emitters);
        scene_gpu_finish(&f->scene);
        return false;
    }
    f->scene.updates = updates + 1; // invalidates cached maps of the previous scene
    f->has_scene = true;
    return true;
}

bool frame_resize(struct frame *f, uint32_t width, uint32_t height)
{
    if (width < 1 || height < 1 || width > MAX_SIZE || height > MAX_SIZE) {
        return host_fail(f->host, FAIL_ARGUMENT, "frame size %ux%u: must be 1x1 to %ux%u", width,
                         height, MAX_SIZE, MAX_SIZE);
    }
    frame_destroy_layers(f);
    f->width = width;
    f->height = height;
    f->index = 0;
    f->prepared = false;
    return true;
}

// ---- Preparation --------------------------------------------------------------------------------

static const uint32_t LEAST_GBUFFER = 1u << FRAME_DEPTH | 1u << FRAME_NORMAL | 1u << FRAME_ALBEDO;

// Of the frame's own G-buffer.
static uint32_t gbuffer_layers(uint32_t needs, bool has_dielectrics)
{
    return LEAST_GBUFFER | 1u << FRAME_MATERIAL | 1u << FRAME_EMISSIVE |
           (needs & FRAME_NEEDS_MOTION ? 1u << FRAME_MOTION : 0) |
           (needs & FRAME_NEEDS_ID ? 1u << FRAME_ID : 0) |
           (has_dielectrics ? 1u << FRAME_DIELECTRIC : 0);
}

static bool check_gbuffer(struct frame *f)
{
    const uint32_t needed =
        LEAST_GBUFFER | (f->needs & FRAME_NEEDS_MOTION ? 1u << FRAME_MOTION : 0);
    const uint32_t missing = needed & ~f->imported;
    if (!missing) return true;
    return host_fail(f->host, FAIL_ARGUMENT, "gbuffer has no image of the layer %s%s",
                     missing >> FRAME_DEPTH & 1u    ? "depth"
                     : missing >> FRAME_NORMAL & 1u ? "normal"
                     : missing >> FRAME_ALBEDO & 1u ? "albedo"
                                                    : "motion",
                     missing & LEAST_GBUFFER ? "" : ", which a technique or motion_layer needs");
}

// Of all passes after the G-buffer.
static uint32_t wanted_layers(const struct frame_input *input, uint32_t needs)
{
    uint32_t wanted = 1u << FRAME_DIRECT | 1u << FRAME_COLOR;
    if (needs & FRAME_WRITES_IRRADIANCE) wanted |= 1u << FRAME_IRRADIANCE;
    if (needs & FRAME_WRITES_SPECULAR) wanted |= 1u << FRAME_SPECULAR;
    if (needs & FRAME_WRITES_VISIBILITY) wanted |= 1u << FRAME_VISIBILITY;
    if (input->want_indirect_layer) wanted |= 1u << FRAME_INDIRECT;
    if (input->want_display) wanted |= 1u << FRAME_DISPLAY;
    return wanted;
}

// Whether the display image is of another layer than the colour.
static bool shows_layer(const struct frame_input *input)
{
    const struct frame_shown *shown = input->shown;
    return input->want_display && shown && (shown->image.id || shown->layer != FRAME_COLOR);
}

// Layers that exist even if no technique writes them.
static uint32_t kept_layers(const struct frame *f, const struct frame_input *input)
{
    const bool by_layer = shows_layer(input) && !input->shown->image.id;
    return f->pinned | (by_layer ? 1u << input->shown->layer : 0);
}

static uint32_t composite_variant_of(const struct frame_input *input, uint32_t needs)
{
    return (needs & FRAME_WRITES_IRRADIANCE ? COMPOSITE_IRRADIANCE : 0) |
           (needs & FRAME_WRITES_SPECULAR ? COMPOSITE_SPECULAR : 0) |
           (needs & FRAME_WRITES_VISIBILITY ? COMPOSITE_VISIBILITY : 0) |
           (input->want_indirect_layer ? COMPOSITE_INDIRECT : 0) |
           (input->want_display && !shows_layer(input) ? COMPOSITE_DISPLAY : 0);
}

// The same radiance, without images.
static uint32_t meter_variant_of(uint32_t variant)
{
    const uint32_t outputs = COMPOSITE_INDIRECT | COMPOSITE_DISPLAY;
    return (variant & ~outputs) | COMPOSITE_METER;
}

static bool prepare_composite(struct frame *f, const struct frame_input *input)
{
    f->composite_variant = composite_variant_of(input, f->needs);
    return composite_prepare(&f->composite, f->composite_variant) &&
           (!shows_layer(input) || display_prepare(&f->display, f->gpu)) &&
           (!input->auto_exposure ||
            composite_prepare(&f->composite, meter_variant_of(f->composite_variant)));
}

static uint32_t direct_features(const struct frame *f)
{
    const bool emission = f->imported ? f->imported >> FRAME_EMISSIVE & 1u
                                      : f->scene.max_emissive > 0 || f->scene.has_unlit;
    return (f->layers[FRAME_DIELECTRIC].id ? DIRECT_DIELECTRIC : 0) |
           (f->options.shadow_filter > 0 ? DIRECT_FILTERED : 0) | (emission ? DIRECT_EMISSION : 0);
}

static bool prepare_lights(struct frame *f, const struct frame_input *input)
{
    static const uint32_t types[] = { FRAME_LIGHT_SUN, FRAME_LIGHT_POINT, FRAME_LIGHT_SPOT };
    int suns = 0, sun_faces = 0, shadow_faces = 0, rsm_faces = 0;
    for (int i = 0; i < input->light_count; i++) {
        const bool sun = input->lights[i].type == LIGHT_SUN;
        suns += sun;
        *(sun ? &sun_faces : &shadow_faces) +=
            shadow_faces_of(&f->shadow, types[input->lights[i].type]);
        rsm_faces += rsm_faces_of(types[input->lights[i].type]);
    }
    if (!(f->needs & FRAME_NEEDS_RSM)) rsm_faces = 0;
    f->direct_variant = direct_variant(suns, input->light_count - suns, direct_features(f));
    return shadow_prepare(&f->shadow, sun_faces, shadow_faces) &&
           direct_prepare(&f->direct, f->direct_variant, f->width, f->height) &&
           rsm_prepare(&f->rsm, rsm_faces, f->scene.variants_used);
}

// The images of the frame, and the pipelines of its own G-buffer.
static bool prepare_layers(struct frame *f, const struct frame_input *input, uint32_t kept)
{
    const bool dielectrics = f->scene.has_dielectrics;
    const uint32_t optional = (f->needs & FRAME_NEEDS_MOTION ? GBUFFER_MOTION : 0) |
                              (f->needs & FRAME_NEEDS_ID ? GBUFFER_ID : 0) |
                              (dielectrics ? GBUFFER_DIELECTRIC : 0);
    const uint32_t written = wanted_layers(input, f->needs);
    frame_import_gbuffer(f, input->gbuffer);
    if (input->gbuffer)
        return check_gbuffer(f) &&
               frame_make_layers(f, written | f->imported, kept | 1u << FRAME_MATERIAL);
    return frame_make_layers(f, written | gbuffer_layers(f->needs, dielectrics), kept) &&
           gbuffer_prepare(&f->gbuffer, f->gpu, f->scene.variants_used, optional);
}

bool frame_prepare(struct frame *f, const struct frame_input *input,
                   const struct frame_indirect *indirect)
{
    f->prepared = false;
    if (!f->has_scene || f->width == 0) {
        return host_fail(f->host, FAIL_ARGUMENT, "frame: no %s was set",
                         f->has_scene ? "size" : "scene");
    }
    if (input->light_count < 0 || input->light_count > FRAME_MAX_LIGHTS) {
        return host_fail(f->host, FAIL_ARGUMENT, "frame: %d lights, at most %d", input->light_count,
                         FRAME_MAX_LIGHTS);
    }
    if (input->pose->scene != f->scene.scene)
        return host_fail(f->host, FAIL_ARGUMENT, "frame: the pose belongs to another scene");
    if (!scene_gpu_follow(&f->scene) || !emitters_follow(&f->emitters)) return false;
    if (input->pick) f->pinned |= 1u << FRAME_ID; // only the first pick creates the image
    const uint32_t kept = kept_layers(f, input);
    f->needs = (indirect ? indirect->needs : 0) |
               (input->want_motion_layer || kept >> FRAME_MOTION & 1u ? FRAME_NEEDS_MOTION : 0) |
               (input->want_id_layer || input->pick ? FRAME_NEEDS_ID : 0);
    f->prepared =
        prepare_layers(f, input, kept) && prepare_lights(f, input) && prepare_composite(f, input);
    return f->prepared;
}

// ---- Passes -------------------------------------------------------------------------------------

static void record_gbuffer(struct frame *f, struct gpu_cmd *cmd)
{
    if (f->imported) return;
    struct gbuffer_targets targets = {
        .depth = f->layers[FRAME_DEPTH],
        .normal = f->layers[FRAME_NORMAL],
        .albedo = f->layers[FRAME_ALBEDO],
        .material = f->layers[FRAME_MATERIAL],
        .emissive = f->layers[FRAME_EMISSIVE],
        .motion = f->layers[FRAME_MOTION],
        .dielectric = f->layers[FRAME_DIELECTRIC],
        .id = f->needs & FRAME_NEEDS_ID ? f->layers[FRAME_ID] : (gpu_image){ 0 },
        .width = f->width,
        .height = f->height,
    };
    gbuffer_record(&f->gbuffer, cmd, &f->scene, &targets, f->constants.clip_from_world,
                   f->constants_binding);
}

// Of the only sun, if the direct pass has a variant for them.
static void record_blocks(struct frame *f, struct gpu_cmd *cmd)
{
    const int count = (int)f->shadow.cascades;
    f->sun = shadow_view_of_sun(f->shadow.faces, count, f->camera.eye);
    f->has_blocks = direct_variant_of_blocks(f->direct_variant) != 0 &&
                    shadow_view_is_precise(&f->sun, f->shadow.faces, count) &&
                    shadow_record_blocks(&f->shadow, cmd, &f->lights[0]);
}

static void record_shadows(struct frame *f, struct gpu_cmd *cmd)
{
    struct frame_view *view = &f->view;
    // A storage block is never empty.
    size_t faces = f->shadow.face_count ? (size_t)f->shadow.face_count : 1;
    view->shadow_maps = f->shadow.maps;
    view->shadow_sun_maps = f->shadow.sun_maps;
    view->shadow_sampler = f->shadow.sampler;
    view->shadow_size = f->shadow.sun_size;
    view->shadow_radius = f->options.shadow_filter;
    view->shadow_faces_binding =
        gpu_transient(cmd, "shadow_faces", f->shadow.faces, faces * sizeof *f->shadow.faces);
    shadow_record(&f->shadow, cmd, &f->scene, f->lights, f->light_count, f->options.keep_maps);
    view->maps_drawn = f->shadow.drawn;
    record_blocks(f, cmd);
}

static void record_direct(struct frame *f, struct gpu_cmd *cmd)
{
    const uint32_t blocks = direct_variant_of_blocks(f->direct_variant);
    struct direct_input in = {
        .shadow_sun = gpu_transient(cmd, "shadow_sun", &f->sun, sizeof f->sun),
        .depth = f->layers[FRAME_DEPTH],
        .normal = f->layers[FRAME_NORMAL],
        .albedo = f->layers[FRAME_ALBEDO],
        .material = f->layers[FRAME_MATERIAL],
        .dielectric = f->layers[FRAME_DIELECTRIC],
        .emissive = f->layers[FRAME_EMISSIVE],
        .shadow_maps = f->shadow.maps,
        .shadow_sun_maps = f->shadow.sun_maps,
        .shadow_blocks = f->shadow.sun_blocks,
        .shadow_sampler = f->shadow.sampler,
        .shadow_radius = f->options.shadow_filter,
        .constants = f->constants_binding,
        .lights = f->lights_binding,
        .shadow_faces = f->view.shadow_faces_binding,
        .ggx_albedo = ggx_albedo_binding(f),
        .variant = f->has_blocks ? blocks : f->direct_variant,
        .width = f->width,
        .height = f->height,
    };
    direct_record(&f->direct, cmd, &in, f->layers[FRAME_DIRECT]);
}

static void record_rsm(struct frame *f, struct gpu_cmd *cmd)
{
    struct frame_view *view = &f->view;
    view->rsm_size = f->rsm.size;
    view->rsm_face_count = f->rsm.face_count;
    if (f->rsm.face_count == 0) return;
    view->rsm_faces = f->rsm.faces;
    view->rsm_depth = f->rsm.depth;
    view->rsm_normal = f->rsm.normal;
    view->rsm_flux = f->rsm.flux;
    view->rsm_faces_binding = gpu_transient(cmd, "rsm_faces", f->rsm.faces,
                                            (size_t)f->rsm.face_count * sizeof *f->rsm.faces);
    const struct gpu_binding bindings[3] = { f->constants_binding, f->lights_binding,
                                             view->rsm_faces_binding };
    rsm_record(&f->rsm, cmd, &f->scene, f->lights, bindings, f->options.keep_maps);
    view->maps_drawn += f->rsm.drawn;
}

static void record_emitters(struct frame *f, struct gpu_cmd *cmd)
{
    struct frame_view *view = &f->view;
    if (!(f->needs & FRAME_NEEDS_EMITTERS)) return;
    emitters_scale(&f->emitters, f->constants.radiance_scale);
    size_t count = f->emitters.count ? (size_t)f->emitters.count : 1; // never an empty block
    view->emitter_count = f->emitters.count;
    view->emitters = f->emitters.scaled;
    view->emitter_origins = f->emitters.origins;
    view->emitters_binding = gpu_transient(cmd, "frame_emitters", f->emitters.scaled,
                                           count * sizeof *f->emitters.scaled);
    view->emitted_irradiance = f->emitted_irradiance;
}

static void record_indirect(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input,
                            const struct frame_indirect *indirect)
{
    struct frame_view *view = &f->view;
    view->width = f->width;
    view->height = f->height;
    view->index = f->index;
    view->keep = f->options.keep_maps;
    view->constants = &f->constants;
    view->constants_binding = f->constants_binding;
    view->lights_binding = f->lights_binding;
    view->ggx_albedo_binding = ggx_albedo_binding(f);
    view->lights = f->lights;
    view->light_count = f->light_count;
    view->pose = input->pose;
    view->scene = &f->scene;
    view->camera = input->camera;
    view->bounds = input->pose->bounds;
    view->camera_cut = f->camera_cut;
    view->geometry_moved = f->scene.moved;
    view->lights_changed = f->lights_changed;
    for (int l = 0; l < FRAME_LAYER_COUNT; l++) view->layers[l] = f->layers[l];
    if (indirect && indirect->update) indirect->update(indirect->user, cmd, view);
    if (indirect && indirect->record) indirect->record(indirect->user, cmd, view);
}

static void composite(struct frame *f, struct gpu_cmd *cmd, uint32_t variant)
{
    struct composite_images images = {
        .direct = f->layers[FRAME_DIRECT],
        .albedo = f->layers[FRAME_ALBEDO],
        .irradiance = f->layers[FRAME_IRRADIANCE],
        .specular = f->layers[FRAME_SPECULAR],
        .visibility = f->layers[FRAME_VISIBILITY],
        .color = f->layers[FRAME_COLOR],
        .indirect = f->layers[FRAME_INDIRECT],
        .display = f->layers[FRAME_DISPLAY],
    };
    const struct gpu_binding bindings[3] = {
        f->constants_binding,
        { "exposure_state", .buffer = f->exposure.state },
        { "exposure_histogram", .buffer = f->exposure.histogram },
    };
    composite_record(&f->composite, cmd, variant, &images, bindings, f->width, f->height);
}

static void record_exposure(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input)
{
    gpu_scope_begin(cmd, "exposure");
    if (input->auto_exposure) {
        exposure_record_clear(&f->exposure, cmd);
        composite(f, cmd, meter_variant_of(f->composite_variant));
        exposure_record_auto(&f->exposure, cmd, f->constants_binding, f->fallback_luminance);
    } else {
        exposure_record_fixed(&f->exposure, cmd, input->exposure_ev);
    }
    gpu_scope_end(cmd);
}

static void record_composite(struct frame *f, struct gpu_cmd *cmd)
{
    gpu_scope_begin(cmd, "composite");
    composite(f, cmd, f->composite_variant);
    gpu_scope_end(cmd);
}

static uint32_t display_kind(const struct frame_shown *shown)
{
    if (shown->image.id) return DISPLAY_RADIANCE;
    switch (shown->layer) {
    case FRAME_IRRADIANCE:
        return DISPLAY_IRRADIANCE;
    case FRAME_ALBEDO:
    case FRAME_MATERIAL:
    case FRAME_DIELECTRIC:
        return DISPLAY_COLOR;
    case FRAME_VISIBILITY:
        return DISPLAY_GREY;
    case FRAME_NORMAL:
        return DISPLAY_NORMAL;
    case FRAME_DEPTH:
        return DISPLAY_DEPTH;
    case FRAME_MOTION:
        return DISPLAY_MOTION;
    default:
        return DISPLAY_RADIANCE;
    }
}

static void record_display(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input)
{
    const struct frame_shown *shown = input->shown;
    if (!shows_layer(input)) return;
    const struct display_images images = {
        .shown = shown->image.id ? shown->image : f->layers[shown->layer],
        .albedo = f->layers[FRAME_ALBEDO],
        .display = f->layers[FRAME_DISPLAY],
    };
    const struct gpu_binding bindings[2] = {
        f->constants_binding,
        { "exposure_state", .buffer = f->exposure.state },
    };
    gpu_scope_begin(cmd, "display");
    display_record(&f->display, cmd, display_kind(shown), &images, bindings, f->width, f->height);
    gpu_scope_end(cmd);
}

void frame_record(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input,
                  const struct frame_indirect *indirect)
{
    if (!f->prepared) return;
    f->view = (struct frame_view){ 0 };
    emitters_update(&f->emitters, input->pose);
    frame_begin(f, cmd, input);
    scene_gpu_update(&f->scene, cmd, input->pose, f->camera_cut);
    frame_clear_unwritten(f, cmd);
    record_gbuffer(f, cmd);
    record_shadows(f, cmd);
    record_direct(f, cmd);
    record_rsm(f, cmd);
    record_emitters(f, cmd);
    record_indirect(f, cmd, input, indirect);
    record_exposure(f, cmd, input);
    record_composite(f, cmd);
    record_display(f, cmd, input);
    frame_forget_gbuffer(f);
    f->index++;
    f->number++;
    reports_record(f, cmd, input);
}

float frame_radiance_scale(const struct frame *f)
{
    return f->index ? f->constants.radiance_scale : 1.0f;
}

bool frame_exposure(struct frame *f, float *ev)
{
    return exposure_read(&f->exposure, ev);
}
