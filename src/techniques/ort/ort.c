// Offset radiance transfer maps: light transfer between the texels of a light map, by offset in
// texture space (Sunshine-Hill & Faloutsos 2006). For each of a few hundred offsets a map has the
// share of the light of the texel an offset away that arrives; a frame in which a light has changed
// computes first-order light at the texels and one gather over all maps.
#include "techniques/ort/ort.h"

#include "techniques/ort/export.h"
#include "techniques/ort/ort_state.h"
#include "bake/report.h"
#include "scene/statics.h"

#include "technique_shaders.h"

#include <stddef.h>

#define OPTION(...) OPTION_ROW(struct ort_options, __VA_ARGS__)
static const struct option_row option_rows[] = {
#include "techniques/ort/ort_options.def"
};
#undef OPTION

static const struct technique_preset presets[] = {
    { "low", "texels=16384,offsets=100,precision=byte" },
    { "medium", "" },
    { "high", "texels=131072,offsets=400,rays=512" },
    { NULL, NULL },
};

static const struct technique_debug_view debug_views[] = {
    { LIGHT_MAP_TEXELS_VIEW, LIGHT_MAP_TEXELS_VIEW_HELP, NULL },
    { NULL, NULL, NULL },
};

// Light that has scattered leaves the surface: no lobe reflects it.
static bool has_specular(const struct ort_options *options)
{
    return options->specular && options->transfer == ORT_RADIOSITY;
}

static bool create(void *state, const struct technique_create *how)
{
    struct ort *s = state;
    s->host = how->host;
    s->gpu = how->gpu;
    // A processor has eight lanes, each of a row; a piece seldom ends inside of them.
    s->rows = gpu_info(s->gpu)->type == GPU_CPU ? 8 : ORT_LOCAL;
    light_map_init(&s->light_map, s->host, s->gpu, &s->map.charts, has_specular(&s->options));
    light_map_paint_init(&s->paint, s->host, s->gpu, &s->map.charts);
    if (!how->pose) return true;
    struct scene_statics statics;
    const bool ok = scene_statics_init(&statics, s->host, how->pose) &&
                    light_map_followed_init(&s->followed, s->host, "ort", how->pose, &statics) &&
                    light_map_materials_init(&s->materials, s->host, "ort",
                                             LIGHT_MAP_FOLLOWS_EMISSION, &statics) &&
                    ort_map_init(&s->map, s->host, &statics.pose, &s->options);
    if (ok) light_map_emission_set(&s->emission, &s->materials.emission, how->pose->scene);
    scene_statics_finish(&statics);
    return ok;
}

#define TABLE(thing)    offsetof(struct ort, tables.thing)
#define PIPELINE(thing) #thing, offsetof(struct ort, pipelines.thing)

static void list_tables(const struct ort *s, struct gpu_objects *out)
{
    const struct ort_map *map = &s->map;
    const size_t texels = map->texel_count, height = map->height;
    const struct gpu_image_desc first_order = { .format = GPU_RGBA16F,
                                                .width = map->width,
                                                .height = map->height,
                                                .usage = GPU_SAMPLED | GPU_STORAGE };
    const struct gpu_image_desc light = { .dimension = GPU_2D_ARRAY,
                                          .format = GPU_RGBA32U,
                                          .width = map->height,
                                          .height = map->width + 2 * ORT_MARGIN,
                                          .depth = s->levels,
                                          .usage = GPU_STORAGE };
    const struct gpu_image_desc filtered = {
        .format = GPU_RGBA16F, .width = map->height, .height = map->width, .usage = GPU_STORAGE
    };
    if (texels == 0) return;
    GPU_ADD(out, 0, { GPU_IMAGE, "first_order", TABLE(first_order), .image = first_order },
            { GPU_IMAGE, "light", TABLE(light), .image = light },
            { GPU_IMAGE, "sums", TABLE(sums),
              .image = light_map_table(GPU_RGBA32F, 6 * height * ort_columns(map)) },
            { GPU_IMAGE, "texel_light", TABLE(texel_light),
              .image = light_map_table(GPU_RG32U, 3 * texels) });
    if (s->levels > 1)
        GPU_ADD(out, 0, { GPU_IMAGE, "filtered", TABLE(filtered), .image = filtered });
}

static void list_pipelines(const struct ort *s, struct gpu_objects *out)
{
    if (s->map.texel_count == 0) return;
    const uint32_t first = LIGHT_MAP_CONSTANTS;
    const struct gpu_shader *gather = s->options.precision == ORT_BYTE
                                          ? &shader_ort_gather_byte_comp
                                          : &shader_ort_gather_half_comp;
    out->constants[first] = (struct gpu_constant){ ORT_GATHER_ROWS, s->rows };
    out->constants[first + 1] =
        (struct gpu_constant){ ORT_GATHER_SLICES, s->options.order == ORT_SLICES };
    out->constants[first + 2] =
        (struct gpu_constant){ ORT_FINISH_SCATTERS, s->options.transfer != ORT_RADIOSITY };
    GPU_ADD(out, 0, { GPU_PIPELINE, PIPELINE(direct), .shader = &shader_ort_direct_comp },
            { GPU_PIPELINE, PIPELINE(spread), .shader = &shader_ort_spread_comp },
            { GPU_PIPELINE, PIPELINE(gather), .shader = gather, .consts = 3u << first },
            { GPU_PIPELINE, PIPELINE(finish), .shader = &shader_ort_finish_comp,
              .consts = 4u << first });
    if (s->levels > 1)
        GPU_ADD(out, 0,
                { GPU_PIPELINE, PIPELINE(prefilter_x), .shader = &shader_ort_prefilter_x_comp },
                { GPU_PIPELINE, PIPELINE(prefilter_y), .shader = &shader_ort_prefilter_y_comp });
    if (s->options.transfer != ORT_RADIOSITY)
        GPU_ADD(out, 0, { GPU_PIPELINE, PIPELINE(replace), .shader = &shader_ort_replace_comp });
}

// Objects that ort_upload creates.
static void list_uploads(struct gpu_objects *out)
{
#define IMAGE(thing) { GPU_IMAGE, .member = TABLE(thing) }
    GPU_ADD(out, 0, IMAGE(texels), IMAGE(sky), IMAGE(places), IMAGE(lists), IMAGE(entries),
            IMAGE(bins), IMAGE(steps));
}

static void list(const struct ort *s, struct gpu_objects *out)
{
    gpu_objects_clear(out);
    list_tables(s, out);
    list_pipelines(s, out);
    light_map_list(&s->light_map, offsetof(struct ort, light_map), out);
    light_map_emission_list(offsetof(struct ort, emission), out);
    list_uploads(out);
}

static bool bake_report(struct report *report, struct bake *bake, const struct technique_bake *how)
{
    const struct tensor *energy = tensors_find(bake_tensors(bake), ORT_ENERGY);
    const struct tensor *offsets = tensors_find(bake_tensors(bake), ORT_OFFSETS);
    (void)how;
    if (!energy || !offsets) return true;
    report_number(report, "offsets", (double)offsets->shape[0]);
    report_number(report, "energy_ratio", (double)ort_energy_ratio(energy->data));
    return true;
}

static bool load(void *state, const struct tensors *bake)
{
    struct ort *s = state;
    struct gpu_objects objects;
    if (!ort_upload(s, bake)) return false;
    list(s, &objects);
    return gpu_objects_create(s->gpu, &objects, 0, s);
}

static void invalidate(void *state, uint32_t changes)
{
    struct ort *s = state;
    if (changes & (CHANGED_GEOMETRY | CHANGED_OPTIONS)) s->kept.known = false;
}

static void follow(void *state, const struct scene_pose *pose, bool wait)
{
    struct ort *s = state;
    (void)wait;
    light_map_followed_update(&s->followed, pose);
    if (light_map_materials_update(&s->materials, pose->scene))
        light_map_emission_set(&s->emission, &s->materials.emission, pose->scene);
    s->light_map.surfaces.moves = s->followed.any_moved ? s->followed.places.moves : NULL;
}

static void update(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct ort *s = state;
    if (light_map_paint_record(&s->paint, cmd)) s->kept.lit = false;
    if (s->map.texel_count > 0 && light_map_emission_record(&s->emission, cmd, s->tables.texels))
        s->kept.lit = false;
    kept_update(&s->kept, view, view->light_hash);
    if (s->map.texel_count > 0 && !(view->keep && s->kept.same)) ort_record_update(s, cmd, view);
}

static void record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct ort *s = state;
    if (view->layers[FRAME_ID].id && s->map.texel_count > 0) ort_record_apply(s, cmd, view);
}

// The only view is that of texels.
static void debug_view(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                       const char *name, gpu_image out)
{
    const struct ort *s = state;
    (void)name;
    light_map_record_texels_view(&s->light_map, cmd, view, out);
}

static gpu_image light_map(void *state)
{
    const struct ort *s = state;
    return s->light_map.images[s->light_map.front];
}

static struct light_map_paint *paint(void *state)
{
    struct ort *s = state;
    return &s->paint;
}

static void destroy(void *state)
{
    struct ort *s = state;
    if (!s->host) return;
    struct gpu_objects objects;
    list(s, &objects);
    gpu_objects_destroy(s->gpu, &objects, s);
    light_map_paint_finish(&s->paint);
    light_map_followed_finish(&s->followed);
    light_map_materials_finish(&s->materials);
    ort_map_finish(&s->map);
}

static uint32_t more_needs(const void *options)
{
    const struct ort_options *o = options;
    return (has_specular(o) ? FRAME_WRITES_SPECULAR : 0) |
           (o->transfer != ORT_RADIOSITY ? FRAME_NEEDS_DIRECT_IRRADIANCE : 0);
}

// The estimate is for a square light map that texels fill by two thirds. Pieces of maps cover a
// third of it in the mean, measured.
static uint64_t memory_estimate(const void *options)
{
    const struct ort_options *o = options;
    const uint64_t texels = (uint64_t)o->texels, places = texels * 3 / 2;
    const uint64_t weight = o->precision == ORT_BYTE ? 3 : 6;
    const uint64_t bins = (places / 3 * (uint64_t)o->offsets) / (ORT_BIN_SIDE * ORT_BIN_SIDE) + 1;
    // Levels of light; steps, and light along rows.
    const uint64_t light = o->prefilter ? (16 * ORT_LEVELS + 4 + 8) * places : 16 * places;
    return light_map_table_bytes((TEXEL_PARTS + TEXEL_SKY_WORDS) * texels, 16) +
           light_map_table_bytes(texels, 16) + // of an emissive material
           light_map_table_bytes(texels, 4) + light_map_bytes(texels) +
           bins * ORT_BIN_SIDE * ORT_BIN_SIDE * weight + light +
           light_map_table_bytes(6 * places / ORT_RUN, 16) + light_map_table_bytes(3 * texels, 8) +
           places * 8;
}

const struct technique technique_ort = {
    .name = "ort",
    .title = "offset radiance transfer maps of static geometry",
    .paper = "Sunshine-Hill & Faloutsos 2006, Photorealistic Lighting with Offset Radiance "
             "Transfer Mapping",
    .role = ROLE_SOURCE,
    .capabilities = CAN_MOVE_LIGHTS | NEEDS_BAKE | MAKES_SPECULAR | GATHERS_EMISSION,
    .needs = FRAME_WRITES_IRRADIANCE | FRAME_NEEDS_ID,
    .bake_version = 10,
    .options = OPTION_TABLE(struct ort_options, option_rows, NULL),
    .presets = presets,
    .debug_views = debug_views,
    .state_size = sizeof(struct ort),
    .more_needs = more_needs,
    .bake = ort_bake,
    .bake_report = bake_report,
    .bake_export = ort_bake_export,
    .create = create,
    .load = load,
    .invalidate = invalidate,
    .follow = follow,
    .update = update,
    .record = record,
    .debug_view = debug_view,
    .charts = ort_charts,
    .light_map = light_map,
    .paint = paint,
    .destroy = destroy,
    .memory_estimate = memory_estimate,
};
