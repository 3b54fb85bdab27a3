// One frame: frame_record_light and frame_record_view are the order of passes. Each pass has its
// own folder and gets the results of earlier passes as arguments.
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
    const int n = GGX_ALBEDO_SIZE;
    const struct gpu_image_desc desc = { .name = "frame.ggx_albedo",
                                         .format = GPU_RGBA32U,
                                         .width = GGX_ALBEDO_SIZE,
                                         .height = GGX_ALBEDO_SIZE,
                                         .usage = GPU_STORAGE };
    struct ggx_albedo_texel *texels = host_alloc(f->host, (size_t)n * n, sizeof *texels);
    for (int i = 0; texels && i < n * n; i++) texels[i] = ggx_albedo_texel(i % n, i / n);
    const bool ok = texels && gpu_image_create(f->gpu, &desc, &f->common->ggx_albedo) &&
                    gpu_image_upload(f->gpu, f->common->ggx_albedo, 0, 0, texels,
                                     (size_t)n * n * sizeof *texels);
    host_free(f->host, texels);
    return ok;
}

static struct gpu_binding ggx_albedo_binding(const struct frame *f)
{
    return (struct gpu_binding){ "ggx_albedo", .image = f->common->ggx_albedo };
}

static struct gpu_binding environment_binding(const struct frame *f)
{
    const struct frame_environment *e = &f->common->environment;
    return (struct gpu_binding){ "environment_map", .image = e->cube, .sampler = e->sampler };
}

static bool init_common(struct frame *f, const struct frame_options *options)
{
    struct frame_common *c = f->common;
    c->options = *options;
    c->views[0] = f;
    return shadow_init(&c->shadow, f->host, f->gpu, (uint32_t)options->shadow_size,
                       (uint32_t)options->cascades) &&
           rsm_init(&c->rsm, f->host, f->gpu, (uint32_t)options->rsm_size) &&
           direct_init(&c->direct, f->gpu, (uint32_t)options->cascades) &&
           composite_init(&c->composite, f->gpu) && create_ggx_albedo(f) &&
           frame_environment_init(&c->environment, f->host, f->gpu);
}

static void finish_common(struct frame *f)
{
    struct frame_common *c = f->common;
    frame_environment_finish(&c->environment);
    gpu_image_destroy(f->gpu, &c->ggx_albedo);
    antialias_finish(&c->antialias);
    display_finish(&c->display);
    composite_finish(&c->composite);
    direct_finish(&c->direct);
    rsm_finish(&c->rsm);
    shadow_finish(&c->shadow);
    gbuffer_convert_finish(&c->convert);
    gbuffer_finish(&c->gbuffer);
    emitters_finish(&c->emitters);
    scene_gpu_finish(&c->scene);
    host_free(f->host, c);
}

struct frame *frame_create(struct host *host, struct gpu *gpu, const struct frame_options *options)
{
    struct frame *f = host_alloc(host, 1, sizeof *f);
    if (!f) return NULL;
    f->host = host;
    f->gpu = gpu;
    f->common = host_alloc(host, 1, sizeof *f->common);
    if (f->common && init_common(f, options) && exposure_init(&f->exposure, gpu) && reports_init(f))
        return f;
    frame_destroy(f);
    return NULL;
}

static int free_view_number(const struct frame_common *c)
{
    for (int i = 1; i < FRAME_MAX_VIEWS; i++)
        if (!c->views[i]) return i;
    return -1;
}

struct frame *frame_create_view(struct frame *first)
{
    const int number = free_view_number(first->common);
    if (number < 0) {
        host_fail(first->host, FAIL_ARGUMENT, "frame: there are %d views, at most %d",
                  FRAME_MAX_VIEWS, FRAME_MAX_VIEWS);
        return NULL;
    }
    struct frame *f = host_alloc(first->host, 1, sizeof *f);
    if (!f) return NULL;
    f->host = first->host;
    f->gpu = first->gpu;
    f->common = first->common;
    f->view_number = number;
    f->common->views[number] = f;
    if (exposure_init(&f->exposure, f->gpu)) return f;
    frame_destroy(f);
    return NULL;
}

int frame_view_number(const struct frame *f)
{
    return f->view_number;
}

void frame_destroy(struct frame *f)
{
    if (!f) return;
    frame_destroy_layers(f);
    reports_finish(f);
    exposure_finish(&f->exposure);
    if (f->view_number > 0)
        f->common->views[f->view_number] = NULL;
    else if (f->common)
        finish_common(f);
    host_free(f->host, f);
}

bool frame_set_options(struct frame *f, const struct frame_options *options)
{
    struct shadow shadow = { 0 };
    struct direct direct = { 0 };
    struct rsm rsm = { 0 };
    const bool sized = options->shadow_size != f->common->options.shadow_size ||
                       options->cascades != f->common->options.cascades;
    const bool rsm_sized = options->rsm_size != f->common->options.rsm_size;
    const uint32_t cascades = (uint32_t)options->cascades;
    // Finishes those of before, or after a failure the new ones.
    bool ok = !sized ||
              (shadow_init(&shadow, f->host, f->gpu, (uint32_t)options->shadow_size, cascades) &&
               direct_init(&direct, f->gpu, cascades));
    ok = ok && (!rsm_sized || rsm_init(&rsm, f->host, f->gpu, (uint32_t)options->rsm_size));
    if (ok && sized) {
        SWAP(struct shadow, shadow, f->common->shadow);
        SWAP(struct direct, direct, f->common->direct);
    }
    if (ok && rsm_sized) SWAP(struct rsm, rsm, f->common->rsm);
    direct_finish(&direct);
    shadow_finish(&shadow);
    rsm_finish(&rsm);
    if (ok) f->common->options = *options;
    if (ok) f->common->revision++;
    return ok;
}

void frame_invalidate(struct frame *f)
{
    f->common->revision++;
}

bool frame_set_scene(struct frame *f, const struct scene *scene)
{
    const uint64_t updates = f->common->scene.updates;
    emitters_finish(&f->common->emitters);
    scene_gpu_finish(&f->common->scene);
    f->common->has_scene = false;
    for (int i = 0; i < FRAME_MAX_VIEWS; i++) {
        struct frame *view = f->common->views[i];
        if (!view) continue;
        view->prepared = false;
        view->index = 0;
    }
    if (!scene_gpu_init(&f->common->scene, f->host, f->gpu, scene) ||
        !emitters_init(&f->common->emitters, f->host, scene)) {
        emitters_finish(&f->common->emitters);
        scene_gpu_finish(&f->common->scene);
        return false;
    }
    f->common->scene.updates = updates + 1; // invalidates cached maps of the previous scene
    f->common->has_scene = true;
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

// ---- Passes -------------------------------------------------------------------------------------

static void convert_gbuffer(struct frame *f, struct gpu_cmd *cmd,
                            const struct gbuffer_targets *targets)
{
    const gpu_image *from = f->gbuffer->layers;
    const struct gbuffer_sources sources = {
        .depth = from[FRAME_DEPTH],
        .normal = from[FRAME_NORMAL],
        .albedo = from[FRAME_ALBEDO],
        .material = from[FRAME_MATERIAL],
        .emissive = from[FRAME_EMISSIVE],
        .motion = from[FRAME_MOTION],
        .dielectric = from[FRAME_DIELECTRIC],
    };
    struct gbuffer_targets own = *targets;
    own.id = (gpu_image){ 0 };
    gbuffer_convert_record(&f->common->convert, cmd, &sources, f->gbuffer->encoding, &own,
                           f->constants_binding);
}

static void record_gbuffer(struct frame *f, struct gpu_cmd *cmd)
{
    if (f->gbuffer && !f->gbuffer->encoding) return;
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
    if (f->gbuffer)
        convert_gbuffer(f, cmd, &targets);
    else
        gbuffer_record(&f->common->gbuffer, cmd, &f->common->scene, &targets,
                       f->constants.clip_from_world, f->constants_binding);
}

// The maps of the only sun as this view sees them. Whether it can use their blocks.
static bool place_sun(struct frame *f)
{
    const int count = (int)f->common->shadow.cascades;
    f->sun = shadow_view_of_sun(f->common->shadow.faces, count, f->camera.eye);
    return direct_variant_of_blocks(f->direct_variant) != 0 &&
           shadow_view_is_precise(&f->sun, f->common->shadow.faces, count);
}

// Records shadow blocks of the only sun, if the direct pass has a variant for them.
static void record_blocks(struct frame *f, struct gpu_cmd *cmd)
{
    f->has_blocks = place_sun(f) && shadow_record_blocks(&f->common->shadow, cmd, &f->lights[0]);
}

static void record_shadows(struct frame *f, struct gpu_cmd *cmd)
{
    struct frame_view *view = &f->view;
    // A storage block is never empty.
    size_t faces = f->common->shadow.face_count ? (size_t)f->common->shadow.face_count : 1;
    view->shadow_maps = f->common->shadow.maps;
    view->shadow_sun_maps = f->common->shadow.sun_maps;
    view->shadow_sampler = f->common->shadow.sampler;
    view->shadow_size = f->common->shadow.sun_size;
    view->shadow_radius = f->common->options.shadow_filter;
    view->shadow_faces_binding = gpu_transient(cmd, "shadow_faces", f->common->shadow.faces,
                                               faces * sizeof *f->common->shadow.faces);
    shadow_record(&f->common->shadow, cmd, &f->common->scene, f->lights, f->light_count,
                  f->common->options.keep_maps);
    view->maps_drawn = f->common->shadow.drawn;
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
        .shadow_maps = f->common->shadow.maps,
        .shadow_sun_maps = f->common->shadow.sun_maps,
        .shadow_blocks = f->common->shadow.sun_blocks,
        .shadow_sampler = f->common->shadow.sampler,
        .shadow_radius = f->common->options.shadow_filter,
        .constants = f->constants_binding,
        .lights = f->lights_binding,
        .shadow_faces = f->view.shadow_faces_binding,
        .ggx_albedo = ggx_albedo_binding(f),
        .environment_map = environment_binding(f),
        .variant = f->has_blocks ? blocks : f->direct_variant,
        .width = f->width,
        .height = f->height,
    };
    direct_record(&f->common->direct, cmd, &in, f->layers[FRAME_DIRECT],
                  f->layers[FRAME_DIRECT_IRRADIANCE]);
}

static void record_rsm(struct frame *f, struct gpu_cmd *cmd)
{
    struct frame_view *view = &f->view;
    view->rsm_size = f->common->rsm.size;
    view->rsm_face_count = f->common->rsm.face_count;
    if (f->common->rsm.face_count == 0) return;
    view->rsm_faces = f->common->rsm.faces;
    view->rsm_depth = f->common->rsm.depth;
    view->rsm_normal = f->common->rsm.normal;
    view->rsm_flux = f->common->rsm.flux;
    view->rsm_faces_binding =
        gpu_transient(cmd, "rsm_faces", f->common->rsm.faces,
                      (size_t)f->common->rsm.face_count * sizeof *f->common->rsm.faces);
    const struct gpu_binding bindings[3] = { f->constants_binding, f->lights_binding,
                                             view->rsm_faces_binding };
    rsm_record(&f->common->rsm, cmd, &f->common->scene, f->lights, bindings,
               f->common->options.keep_maps);
    view->maps_drawn += f->common->rsm.drawn;
}

static void record_emitters(struct frame *f, struct gpu_cmd *cmd)
{
    struct frame_view *view = &f->view;
    if (!(f->needs & FRAME_NEEDS_EMITTERS)) return;
    emitters_scale(&f->common->emitters, f->constants.radiance_scale);
    size_t count =
        f->common->emitters.count ? (size_t)f->common->emitters.count : 1; // never an empty block
    view->emitter_count = f->common->emitters.count;
    view->emitters = f->common->emitters.scaled;
    view->emitter_origins = f->common->emitters.origins;
    view->emitters_binding = gpu_transient(cmd, "frame_emitters", f->common->emitters.scaled,
                                           count * sizeof *f->common->emitters.scaled);
    view->emitted_irradiance = f->emitted_irradiance;
}

// Fills the members of this view alone.
static void complete_view(struct frame *f)
{
    struct frame_view *view = &f->view;
    view->number = f->view_number;
    view->width = f->width;
    view->height = f->height;
    view->index = f->index;
    view->constants = &f->constants;
    view->constants_binding = f->constants_binding;
    view->camera = f->camera;
    view->camera_cut = f->camera_cut;
    for (int l = 0; l < FRAME_LAYER_COUNT; l++) view->layers[l] = f->layers[l];
}

static void record_light(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input,
                         const struct frame_indirect *indirect)
{
    struct frame_view *view = &f->view;
    complete_view(f);
    view->keep = f->common->options.keep_maps;
    view->lights_binding = f->lights_binding;
    view->ggx_albedo_binding = ggx_albedo_binding(f);
    view->environment_binding = environment_binding(f);
    view->lights = f->lights;
    view->light_count = f->light_count;
    view->pose = input->pose;
    view->environment = &input->environment;
    view->environment_patches_binding = f->patches_binding;
    view->scene = &f->common->scene;
    view->bounds = input->pose->bounds;
    view->geometry_moved = f->common->scene.moved;
    view->lights_changed = f->lights_changed;
    view->light_hash = f->light_hash;
    view->environment_key = f->common->views[0]->environment_key;
    if (indirect && indirect->update) indirect->update(indirect->user, cmd, view);
}

static void composite(struct frame *f, struct gpu_cmd *cmd, uint32_t variant)
{
    struct composite_images images = {
        .direct = f->layers[FRAME_DIRECT],
        .albedo = f->layers[FRAME_ALBEDO],
        .irradiance = f->layers[FRAME_IRRADIANCE],
        .specular = f->layers[FRAME_SPECULAR],
        .visibility = f->layers[FRAME_VISIBILITY],
        .color = f->layers[f->needs & FRAME_ANTIALIASES ? FRAME_RADIANCE : FRAME_COLOR],
        .indirect = f->layers[FRAME_INDIRECT],
        .display = f->layers[FRAME_DISPLAY],
    };
    const struct gpu_binding bindings[3] = {
        f->constants_binding,
        { "exposure_state", .buffer = f->exposure.state },
        { "exposure_histogram", .buffer = f->exposure.histogram },
    };
    composite_record(&f->common->composite, cmd, variant, &images, bindings, f->width, f->height);
}

static void record_exposure(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input)
{
    const struct exposure_push push = {
        .fallback = f->fallback_luminance,
        .share = frame_exposure_share(f, input->auto_exposure),
        .metering = (uint32_t)f->common->options.metering,
    };
    gpu_scope_begin(cmd, "exposure");
    if (input->auto_exposure) {
        exposure_record_clear(&f->exposure, cmd);
        composite(f, cmd, frame_meter_variant(f->composite_variant));
        exposure_record_auto(&f->exposure, cmd, f->constants_binding, &push);
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
    case FRAME_DIRECT_IRRADIANCE:
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
    if (!frame_shows_layer(input)) return;
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
    display_record(&f->common->display, cmd, frame_display_variant(f), display_kind(shown), &images,
                   bindings, f->width, f->height);
    gpu_scope_end(cmd);
}

// From the G-buffer and the light on.
static void record_image(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input,
                         const struct frame_indirect *indirect)
{
    if (indirect && indirect->record) indirect->record(indirect->user, cmd, &f->view);
    frame_follow_antialias(f);
    record_exposure(f, cmd, input);
    record_composite(f, cmd);
    frame_record_antialias(f, cmd, frame_displays_color(input));
    record_display(f, cmd, input);
    frame_forget_gbuffer(f);
    f->index++;
}

void frame_record_light(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input,
                        const struct frame_indirect *indirect)
{
    if (!f->prepared) return;
    f->common->viewed = false;
    f->view = (struct frame_view){ 0 };
    emitters_update(&f->common->emitters, input->pose);
    frame_begin(f, cmd, input);
    f->common->scene.leaves_dynamic = f->needs & FRAME_LEAVES_DYNAMIC;
    scene_gpu_update(&f->common->scene, cmd, input->pose, f->camera_cut);
    if (f->needs & FRAME_UPDATE_NEEDS_GBUFFER) record_gbuffer(f, cmd);
    record_shadows(f, cmd);
    record_rsm(f, cmd);
    record_emitters(f, cmd);
    record_light(f, cmd, input, indirect);
    f->number++;
}

static void begin_further(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input)
{
    const struct frame *first = f->common->views[0];
    f->view = first->view;
    frame_begin_view(f, cmd, input);
    f->has_blocks = place_sun(f) && first->has_blocks;
    complete_view(f);
    f->number = first->number;
    f->common->viewed = true;
}

// The first view has it already if light needed it and no other view has overwritten it.
static bool needs_gbuffer(const struct frame *f)
{
    return f->view_number > 0 || !(f->needs & FRAME_UPDATE_NEEDS_GBUFFER) || f->common->viewed;
}

void frame_record_view(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input,
                       const struct frame_indirect *indirect)
{
    if (!f->prepared) return;
    const bool is_first = f->view_number == 0;
    if (!is_first) begin_further(f, cmd, input);
    frame_clear_unwritten(f, cmd);
    if (needs_gbuffer(f)) record_gbuffer(f, cmd);
    record_direct(f, cmd);
    record_image(f, cmd, input, indirect);
    f->kept = f->own;
    if (is_first) reports_record(f, cmd, input);
}

float frame_radiance_scale(const struct frame *f)
{
    return f->index ? f->constants.radiance_scale : 1.0f;
}

bool frame_exposure(struct frame *f, float *ev)
{
    return exposure_read(&f->exposure, ev);
}
