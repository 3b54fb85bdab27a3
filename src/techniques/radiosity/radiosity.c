// Radiosity: direct-to-indirect transfer of static geometry (Loos 2015, sections 2.5.3 and 3.2.1;
// Giuffrida 2016, section 3.2). Form factors from clusters of surface to the texels of a light map
// are baked; each frame in which a light has changed computes direct light at the texels, all
// bounces between clusters, and the light map. Pixels look it up. Surfaces send diffuse light only.
#include "techniques/radiosity/radiosity.h"

#include "techniques/radiosity/probes/probes_shared.h"
#include "techniques/radiosity/radiosity_state.h"
#include "scene/statics.h"

#include "technique_shaders.h"

#include <stddef.h>

#define OPTION(...) OPTION_ROW(struct radiosity_options, __VA_ARGS__)
static const struct option_row option_rows[] = {
#include "techniques/radiosity/radiosity_options.def"
};
#undef OPTION

static const struct technique_preset presets[] = {
    { "low", "texels=16384,rays=256,sources=24,bounces=8" },
    { "medium", "" },
    { "high", "texels=131072,rays=1024,sources=64,cluster=3" },
    { NULL, NULL },
};

static bool create(void *state, const struct technique_create *how)
{
    struct radiosity *s = state;
    s->host = how->host;
    s->gpu = how->gpu;
    light_map_init(&s->light_map, s->host, s->gpu, &s->map.charts,
                   s->options.specular ? LIGHT_MAP_BY_FLUENCE : LIGHT_MAP_DIFFUSE);
    light_map_paint_init(&s->paint, s->host, s->gpu, &s->map.charts);
    if (!how->pose) return true;
    struct scene_statics statics;
    const bool ok =
        scene_statics_init(&statics, s->host, how->pose) &&
        light_map_followed_init(&s->followed, s->host, "radiosity", how->pose, &statics) &&
        light_map_materials_init(&s->materials, s->host, "radiosity",
                                 LIGHT_MAP_FOLLOWS_EMISSION | LIGHT_MAP_FOLLOWS_REFLECTANCE,
                                 &statics) &&
        radiosity_map_init(&s->map, s->host, &statics.pose, &s->options);
    if (ok) light_map_emission_set(&s->emission, &s->materials.emission, how->pose->scene);
    scene_statics_finish(&statics);
    return ok;
}

#define TABLE(thing)    offsetof(struct radiosity, tables.thing)
#define PIPELINE(thing) #thing, offsetof(struct radiosity, pipelines.thing)
#define PROBES(thing)   offsetof(struct radiosity, probes.thing)

static void list_tables(const struct radiosity *s, struct gpu_objects *out)
{
    const size_t texels = s->map.texel_count, nodes = s->map.tree.count;
    GPU_ADD(
        out, 0, { GPU_IMAGE, "flux", TABLE(flux), .image = light_map_table(GPU_RGBA32F, texels) },
        { GPU_IMAGE, "light", TABLE(light), .image = light_map_table(GPU_RG32U, 3 * texels) },
        { GPU_IMAGE, "smoothed", TABLE(smoothed), .image = light_map_table(GPU_RG32U, 3 * texels) },
        { GPU_IMAGE, "fluence", TABLE(fluence), .image = light_map_table(GPU_RG32U, texels) },
        { GPU_IMAGE, "smoothed_fluence", TABLE(smoothed_fluence),
          .image = light_map_table(GPU_RG32U, texels) },
        { GPU_IMAGE, "sent", TABLE(sent), .image = light_map_table(GPU_RG32U, nodes) },
        { GPU_IMAGE, "radiosity", TABLE(radiosity[0]), .image = light_map_table(GPU_RG32U, nodes) },
        { GPU_IMAGE, "radiosity", TABLE(radiosity[1]), .image = light_map_table(GPU_RG32U, nodes) },
        { GPU_IMAGE, "solution", TABLE(solution), .image = light_map_table(GPU_RG32U, nodes) },
        { GPU_IMAGE, "strata", TABLE(strata),
          .image = light_map_table(GPU_RG32U, s->stratum_count) });
}

static void list_pipelines(const struct radiosity *s, struct gpu_objects *out)
{
    if (s->map.texel_count == 0) return;
    GPU_ADD(out, 0, { GPU_PIPELINE, PIPELINE(direct), .shader = &shader_radiosity_direct_comp },
            { GPU_PIPELINE, PIPELINE(clusters), .shader = &shader_radiosity_clusters_comp },
            { GPU_PIPELINE, PIPELINE(nodes), .shader = &shader_radiosity_nodes_comp },
            { GPU_PIPELINE, PIPELINE(solve), .shader = &shader_radiosity_solve_comp },
            { GPU_PIPELINE, PIPELINE(strata), .shader = &shader_radiosity_strata_comp },
            { GPU_PIPELINE, PIPELINE(gather), .shader = &shader_radiosity_gather_comp },
            { GPU_PIPELINE, PIPELINE(smooth), .shader = &shader_radiosity_smooth_comp },
            { GPU_PIPELINE, PIPELINE(view), .shader = &shader_radiosity_view_comp });
}

static void list_probes(const struct radiosity *s, struct gpu_objects *out)
{
    const struct gpu_image_desc volume =
        probe_volume_desc(NULL, s->probes.volume.grid, FRAME_PROBE_SLABS + 1);
    GPU_ADD(
        out, 0, { GPU_IMAGE, "probe_volume", PROBES(volume.image), .image = volume },
        { GPU_PIPELINE, "probes", PROBES(gather), .shader = &shader_radiosity_probes_gather_comp });
    probe_apply_list(PROBES(apply), s->options.specular, out);
}

// Objects that radiosity_upload and radiosity_probes_upload create.
static void list_uploads(struct gpu_objects *out)
{
#define IMAGE(thing) { GPU_IMAGE, .member = TABLE(thing) }
    GPU_ADD(out, 0, IMAGE(texels), IMAGE(sky), IMAGE(neighbours), IMAGE(clusters), IMAGE(spans),
            IMAGE(members), IMAGE(groups), IMAGE(factors.order), IMAGE(factors.tiles),
            IMAGE(shares.order), IMAGE(shares.tiles), IMAGE(cluster_factors.order),
            IMAGE(cluster_factors.tiles), { GPU_BUFFER, .member = TABLE(labels) },
            { GPU_BUFFER, .member = PROBES(table) }, { GPU_BUFFER, .member = PROBES(emission) },
            { GPU_BUFFER, .member = PROBES(factors) },
            { GPU_IMAGE, .member = PROBES(volume.depth) });
}

static void list(const struct radiosity *s, struct gpu_objects *out)
{
    gpu_objects_clear(out);
    list_tables(s, out);
    list_pipelines(s, out);
    light_map_list(&s->light_map, offsetof(struct radiosity, light_map), out);
    light_map_emission_list(offsetof(struct radiosity, emission), out);
    list_probes(s, out);
    list_uploads(out);
}

static bool load(void *state, const struct tensors *bake)
{
    struct radiosity *s = state;
    struct gpu_objects objects;
    if (!radiosity_upload(s, bake) || !radiosity_probes_upload(s, bake)) return false;
    list(s, &objects);
    return gpu_objects_create(s->gpu, &objects, 0, s);
}

static void invalidate(void *state, uint32_t changes)
{
    struct radiosity *s = state;
    if (changes & (CHANGED_GEOMETRY | CHANGED_OPTIONS)) s->kept.known = false;
}

static void follow(void *state, const struct scene_pose *pose, bool wait)
{
    struct radiosity *s = state;
    (void)wait;
    light_map_followed_update(&s->followed, pose);
    radiosity_follow_materials(s, pose->scene);
    s->light_map.surfaces.moves = s->followed.any_moved ? s->followed.places.moves : NULL;
}

static void gather_probes(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    if (!s->probes.fresh)
        radiosity_probes_record_gather(&s->probes, cmd, view, s->tables.solution,
                                       s->options.emitters ? &s->emission : NULL);
}

static void update(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct radiosity *s = state;
    if (light_map_paint_record(&s->paint, cmd)) s->kept.lit = false;
    if (radiosity_has_new_materials(s)) s->kept.lit = false;
    kept_update(&s->kept, view, view->light_hash);
    s->update.at_once |= !s->kept.follows;
    s->update.changed |= !(view->keep && s->kept.same);
    s->update.other |= !s->kept.same && s->map.texel_count > 0;
    if (radiosity_has_new_materials(s) && (!s->update.running || s->update.at_once))
        radiosity_record_materials(s, cmd);
    if (s->map.texel_count > 0)
        radiosity_record_update(s, cmd, view);
    else if (s->update.changed)
        s->update.changed = s->probes.fresh = false;
    if (s->options.probes) gather_probes(s, cmd, view);
}

// Probes have no light before a view needs it.
static void record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct radiosity *s = state;
    const bool has_map = view->layers[FRAME_ID].id && s->map.texel_count > 0;
    if (has_map) light_map_record_apply(&s->light_map, cmd, view);
    if (has_map && !s->followed.any_lit) return;
    gather_probes(s, cmd, view);
    probe_apply_record(&s->probes.apply, &s->probes.volume, cmd, view, has_map);
}

static gpu_image light_map(void *state)
{
    const struct radiosity *s = state;
    return s->light_map.images[s->light_map.front];
}

static struct light_map_paint *paint(void *state)
{
    struct radiosity *s = state;
    return &s->paint;
}

static bool is_updating(const void *state)
{
    const struct radiosity *s = state;
    return s->update.other || s->update.brings_other;
}

static bool probes(void *state, struct probe_volume *out)
{
    const struct radiosity *s = state;
    if (!s->options.probes) return false;
    *out = s->probes.volume;
    return true;
}

static void debug_view(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                       const char *name, gpu_image out)
{
    struct radiosity *s = state;
    if (view->layers[FRAME_ID].id && s->map.texel_count > 0)
        radiosity_view_record(s, cmd, view, name, out);
    else
        gpu_clear_image(cmd, out, (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
}

static void destroy(void *state)
{
    struct radiosity *s = state;
    if (!s->host) return;
    struct gpu_objects objects;
    list(s, &objects);
    gpu_objects_destroy(s->gpu, &objects, s);
    radiosity_destroy_rows(s, &s->tables.factors);
    radiosity_destroy_rows(s, &s->tables.shares);
    radiosity_destroy_rows(s, &s->tables.cluster_factors);
    light_map_paint_finish(&s->paint);
    light_map_followed_finish(&s->followed);
    light_map_materials_finish(&s->materials);
    radiosity_reflectance_finish(&s->reflectance);
    radiosity_map_finish(&s->map);
}

static uint32_t more_needs(const void *options)
{
    const struct radiosity_options *o = options;
    return o->specular ? FRAME_WRITES_SPECULAR : 0;
}

// Bytes of rows: entries, order and tiles.
static uint64_t rows_bytes(uint64_t rows, uint64_t bytes)
{
    return light_map_table_bytes(rows * bytes / 16, 16) + light_map_table_bytes(rows, 4) +
           light_map_table_bytes(rows / RADIOSITY_TILE, 8);
}

// Assumes a light map with the wanted number of texels, on one side, two thirds of it covered by
// charts, a triangle for each texel, whole blocks, and an emissive material.
static uint64_t memory_estimate(const void *options)
{
    enum { COLUMNS = 1, SH_BYTES = 36, STRATUM_TEXELS = 16 };
    const struct radiosity_options *o = options;
    const uint64_t texels = (uint64_t)o->texels, places = texels * 3 / 2;
    const uint64_t clusters = texels / (uint64_t)(o->cluster * o->cluster) + 1;
    const uint64_t nodes = 2 * clusters, sources = (uint64_t)o->sources;
    const uint64_t of_texels =
        light_map_table_bytes((TEXEL_PARTS + TEXEL_SKY_WORDS) * texels, 16) +
        light_map_table_bytes(2 * COLUMNS * texels, 16) +                   // with their fluence
        rows_bytes(texels, 8 * sources) + rows_bytes(texels, 4 * sources) + // of strata
        light_map_table_bytes(texels * sources / STRATUM_TEXELS, 8 + 4) +
        light_map_table_bytes(
            RADIOSITY_SMOOTH_PASSES * RADIOSITY_NEIGHBOURS / RADIOSITY_PAIR * texels, 16) +
        light_map_table_bytes(texels, 16) + 2 * light_map_table_bytes(4 * texels, 8) +
        2 * 8 * places + // fluence
        places * sizeof(struct radiosity_gpu_label);
    const uint64_t of_clusters =
        rows_bytes(clusters, 8 * sources) + light_map_table_bytes(clusters, 16) +
        light_map_table_bytes(clusters, 8) + light_map_table_bytes(texels, 4) +
        5 * light_map_table_bytes(nodes, 8);
    const uint64_t of_probes =
        radiosity_probes_most(o) * (sizeof(struct radiosity_gpu_probe) + COLUMNS * SH_BYTES +
                                    12 * 2 * sources + PROBE_VOLUME_BYTES);
    return of_texels + of_clusters + light_map_bytes(texels) + of_probes;
}

const struct technique technique_radiosity = {
    .name = "radiosity",
    .title = "baked radiosity of static geometry",
    .paper = "Loos 2015, Modular Radiance Transfer, sec. 2.5.3; Giuffrida 2016, sec. 3.2",
    .role = ROLE_SOURCE,
    .capabilities =
        CAN_MOVE_LIGHTS | NEEDS_BAKE | MAKES_SPECULAR | GATHERS_EMISSION | PUBLISHES_PROBES,
    .needs = FRAME_WRITES_IRRADIANCE | FRAME_NEEDS_ID,
    .bake_version = 20,
    .options = OPTION_TABLE(struct radiosity_options, option_rows, NULL),
    .presets = presets,
    .debug_views = radiosity_views,
    .state_size = sizeof(struct radiosity),
    .more_needs = more_needs,
    .bake = radiosity_bake,
    .create = create,
    .load = load,
    .invalidate = invalidate,
    .follow = follow,
    .update = update,
    .record = record,
    .debug_view = debug_view,
    .charts = radiosity_charts,
    .light_map = light_map,
    .paint = paint,
    .is_updating = is_updating,
    .probes = probes,
    .destroy = destroy,
    .memory_estimate = memory_estimate,
};
