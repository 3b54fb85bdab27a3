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
    return ok;
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

// ---- Preparation --------------------------------------------------------------------------------

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
                     missing & FRAME_LEAST_GBUFFER  ? ""
                     : missing >> FRAME_MOTION & 1u ? ", which a technique or motion_layer needs"
                                                    : ", which a technique needs");
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

uint32_t frame_composite_variant(const struct frame_input *input, uint32_t needs)
{
    return (needs & FRAME_WRITES_IRRADIANCE ? COMPOSITE_IRRADIANCE : 0) |
           (needs & FRAME_WRITES_SPECULAR ? COMPOSITE_SPECULAR : 0) |
           (needs & FRAME_WRITES_VISIBILITY ? COMPOSITE_VISIBILITY : 0) |
           (input->want_indirect_layer ? COMPOSITE_INDIRECT : 0) |
           (input->want_display && !shows_layer(input) ? COMPOSITE_DISPLAY : 0);
}

uint32_t frame_meter_variant(uint32_t variant)
{
    const uint32_t outputs = COMPOSITE_INDIRECT | COMPOSITE_DISPLAY;
    return (variant & ~outputs) | COMPOSITE_METER;
}

static bool prepare_composite(struct frame *f, const struct frame_input *input)
{
    f->composite_variant = frame_composite_variant(input, f->needs);
    return composite_prepare(&f->common->composite, f->composite_variant) &&
           (!shows_layer(input) || display_prepare(&f->common->display, f->gpu)) &&
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
    return needs | (mirrors ? FRAME_WRITES_SPECULAR : 0);
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
                  prepare_direct(f, input) && prepare_composite(f, input);
    return f->prepared;
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
        .color = f->layers[FRAME_COLOR],
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
    gpu_scope_begin(cmd, "exposure");
    if (input->auto_exposure) {
        exposure_record_clear(&f->exposure, cmd);
        composite(f, cmd, frame_meter_variant(f->composite_variant));
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
    display_record(&f->common->display, cmd, display_kind(shown), &images, bindings, f->width,
                   f->height);
    gpu_scope_end(cmd);
}

// From the G-buffer and the light on.
static void record_image(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input,
                         const struct frame_indirect *indirect)
{
    if (indirect && indirect->record) indirect->record(indirect->user, cmd, &f->view);
    record_exposure(f, cmd, input);
    record_composite(f, cmd);
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
