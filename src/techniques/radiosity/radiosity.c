// Radiosity: direct-to-indirect transfer of static geometry (Loos 2015, sections 2.5.3 and 3.2.1;
// Giuffrida 2016, section 3.2). Form factors from clusters of surface to the texels of a light map
// are baked; each frame in which a light has changed computes direct light at the texels, all
// bounces between clusters, and the light map. Pixels look it up. Surfaces send diffuse light only.
#include "techniques/radiosity/radiosity.h"

#include "techniques/radiosity/radiosity_state.h"
#include "scene/statics.h"

#include "technique_shaders.h"

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
    s->options = *(const struct radiosity_options *)how->options;
    if (!how->pose) return true;
    s->instances = (uint32_t)how->pose->scene->instance_count;
    struct scene_statics statics;
    const bool ok = scene_statics_init(&statics, s->host, how->pose) &&
                    radiosity_followed_init(&s->followed, s->host, how->pose, &statics) &&
                    radiosity_map_init(&s->map, s->host, &statics.pose, &s->options);
    scene_statics_finish(&statics);
    return ok;
}

// What shaders write.
static bool make_tables(struct radiosity *s)
{
    struct radiosity_tables *t = &s->tables;
    const size_t texels = s->map.texel_count, nodes = s->map.tree.count;
    const struct {
        const char *name;
        enum gpu_format format;
        size_t count;
        gpu_image *out;
    } rows[] = {
        { "flux", GPU_RGBA32F, texels, &t->flux },
        { "light", GPU_RG32U, 3 * texels, &t->light },
        { "smoothed", GPU_RG32U, 3 * texels, &t->smoothed },
        { "sent", GPU_RG32U, nodes, &t->sent },
        { "radiosity", GPU_RG32U, nodes, &t->radiosity[0] },
        { "radiosity", GPU_RG32U, nodes, &t->radiosity[1] },
        { "solution", GPU_RG32U, nodes, &t->solution },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!radiosity_table_create(s->host, s->gpu, rows[i].name, rows[i].format, rows[i].count,
                                    rows[i].out))
            return false;
    return true;
}

static bool make_light_maps(struct radiosity *s)
{
    const struct gpu_image_desc desc = light_map_image(&s->map.charts, "light_map");
    const struct gpu_sampler_desc linear = { .name = "light_map",
                                             .filter = GPU_LINEAR,
                                             .mip_filter = GPU_NEAREST,
                                             .wrap_u = GPU_CLAMP,
                                             .wrap_v = GPU_CLAMP,
                                             .wrap_w = GPU_CLAMP };
    return gpu_image_create(s->gpu, &desc, &s->tables.light_maps[0]) &&
           gpu_image_create(s->gpu, &desc, &s->tables.light_maps[1]) &&
           gpu_sampler_get(s->gpu, &linear, &s->linear);
}

// Rows of pixels suit the caches of a processor, squares those of a GPU.
static bool make_lookups(struct radiosity *s)
{
    struct radiosity_pipelines *p = &s->pipelines;
    const bool rows = gpu_info(s->gpu)->type == GPU_CPU;
    p->apply_width = rows ? 64 : RADIOSITY_LOCAL_2D;
    p->apply_height = rows ? 1 : RADIOSITY_LOCAL_2D;
    for (uint32_t dielectric = 0; dielectric < 2; dielectric++) {
        const struct gpu_constant constants[] = { { RADIOSITY_APPLY_WIDTH, p->apply_width },
                                                  { RADIOSITY_APPLY_HEIGHT, p->apply_height },
                                                  { RADIOSITY_APPLY_DIELECTRIC, dielectric },
                                                  { LIGHT_MAP_HAS_BACKS,
                                                    light_map_sides(&s->map.charts) == 2 } };
        if (!gpu_compute_pipeline_create(s->gpu, "apply",
                                         s->options.specular ? &shader_radiosity_apply_specular_comp
                                                             : &shader_radiosity_apply_diffuse_comp,
                                         constants, 4, &p->apply[dielectric]))
            return false;
    }
    return true;
}

static bool make_pipelines(struct radiosity *s)
{
    struct radiosity_pipelines *p = &s->pipelines;
    const struct {
        const char *name;
        const struct gpu_shader *shader;
        gpu_pipeline *out;
    } rows[] = {
        { "direct", &shader_radiosity_direct_comp, &p->direct },
        { "clusters", &shader_radiosity_clusters_comp, &p->clusters },
        { "nodes", &shader_radiosity_nodes_comp, &p->nodes },
        { "solve", &shader_radiosity_solve_comp, &p->solve },
        { "gather", &shader_radiosity_gather_comp, &p->gather },
        { "smooth", &shader_radiosity_smooth_comp, &p->smooth },
        { "map", &shader_radiosity_map_comp, &p->map },
        { "seams", &shader_radiosity_seams_comp, &p->seams },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!gpu_compute_pipeline_create(s->gpu, rows[i].name, rows[i].shader, NULL, 0,
                                         rows[i].out))
            return false;
    return make_lookups(s);
}

static bool load(void *state, const struct tensors *bake)
{
    struct radiosity *s = state;
    const struct radiosity_probes_create how = { s->host, s->gpu, &s->map, &s->options };
    return radiosity_upload(s, bake) && make_tables(s) &&
           radiosity_probes_init(&s->probes, &how, bake) &&
           (s->map.texel_count == 0 || (make_light_maps(s) && make_pipelines(s)));
}

static void set_options(void *state, const void *options)
{
    struct radiosity *s = state;
    option_copy_live(&technique_radiosity.options, options, &s->options);
    s->kept.known = false;
}

static void invalidate(void *state, uint32_t changes)
{
    struct radiosity *s = state;
    if (changes & (CHANGED_GEOMETRY | CHANGED_MATERIAL | CHANGED_OPTIONS)) s->kept.known = false;
}

static void follow(void *state, const struct scene_pose *pose, bool wait)
{
    struct radiosity *s = state;
    (void)wait;
    radiosity_followed_update(&s->followed, pose);
    s->tables.surfaces.moves = s->followed.any_moved ? s->followed.places.moves : NULL;
}

static void gather_probes(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    if (!s->probes.fresh)
        radiosity_probes_record_gather(&s->probes, cmd, view, s->tables.solution,
                                       s->options.emitters);
}

static void update(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct radiosity *s = state;
    kept_update(&s->kept, view, view->light_hash);
    s->update.at_once |= !s->kept.follows;
    s->update.changed |= !(view->keep && s->kept.same);
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
    const bool mapped = view->layers[FRAME_ID].id && s->map.texel_count > 0;
    if (mapped) radiosity_record_apply(s, cmd, view);
    if (mapped && !s->followed.any_lit) return;
    const struct radiosity_lit lit = { mapped ? s->followed.lit : NULL, s->followed.count };
    gather_probes(s, cmd, view);
    radiosity_probes_record_apply(&s->probes, cmd, view, lit);
}

static bool charts(const struct scene_pose *statics, const void *options, struct host *host,
                   struct charts *out)
{
    return radiosity_charts_init(out, host, statics, options);
}

static gpu_image light_map(void *state)
{
    const struct radiosity *s = state;
    return s->tables.light_maps[s->shown_map];
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

static void destroy_tables(struct radiosity *s)
{
    struct radiosity_tables *t = &s->tables;
    gpu_image *const images[] = { &t->texels,   &t->neighbours,    &t->clusters,
                                  &t->spans,    &t->members,       &t->groups,
                                  &t->owners,   &t->places,        &t->seams,
                                  &t->flux,     &t->light,         &t->smoothed,
                                  &t->sent,     &t->radiosity[0],  &t->radiosity[1],
                                  &t->solution, &t->light_maps[0], &t->light_maps[1] };
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        gpu_image_destroy(s->gpu, images[i]);
    gpu_buffer_destroy(s->gpu, &t->surfaces.first);
    gpu_buffer_destroy(s->gpu, &t->surfaces.triangles);
    gpu_buffer_destroy(s->gpu, &t->labels);
    gpu_buffer_destroy(s->gpu, &t->owner_of_place);
    radiosity_destroy_rows(s, &t->factors);
    radiosity_destroy_rows(s, &t->cluster_factors);
}

static void destroy(void *state)
{
    struct radiosity *s = state;
    if (!s->host) return;
    struct radiosity_pipelines *p = &s->pipelines;
    gpu_pipeline *const pipelines[] = { &p->direct,   &p->clusters, &p->nodes, &p->solve,
                                        &p->gather,   &p->smooth,   &p->map,   &p->seams,
                                        &p->apply[0], &p->apply[1], &p->view };
    for (size_t i = 0; i < sizeof pipelines / sizeof *pipelines; i++)
        gpu_pipeline_destroy(s->gpu, pipelines[i]);
    destroy_tables(s);
    radiosity_probes_finish(&s->probes, s->gpu);
    radiosity_followed_finish(&s->followed);
    radiosity_map_finish(&s->map);
}

static uint32_t more_needs(const void *options)
{
    const struct radiosity_options *o = options;
    return o->specular ? FRAME_WRITES_SPECULAR : 0;
}

static uint64_t table_bytes(uint64_t entries, uint64_t bytes)
{
    return radiosity_table_room((size_t)entries) * bytes;
}

// Of rows: entries, order and tiles.
static uint64_t rows_bytes(uint64_t rows, uint64_t bytes)
{
    return table_bytes(rows * bytes / 16, 16) + table_bytes(rows, 4) +
           table_bytes(rows / RADIOSITY_TILE, 8);
}

// Of a light map with the texels wanted, on one side, that charts fill by two thirds, with a
// triangle for each texel.
static uint64_t memory_estimate(const void *options)
{
    const struct radiosity_options *o = options;
    const uint64_t texels = (uint64_t)o->texels, places = texels * 3 / 2;
    const uint64_t clusters = texels / (uint64_t)(o->cluster * o->cluster) + 1;
    const uint64_t nodes = 2 * clusters, sources = (uint64_t)o->sources;
    const uint64_t of_texels =
        table_bytes(RADIOSITY_TEXEL_PARTS * texels, 16) + rows_bytes(texels, 8 * sources) +
        table_bytes(RADIOSITY_NEIGHBOURS / RADIOSITY_PAIR * texels, 16) + table_bytes(texels, 16) +
        2 * table_bytes(3 * texels, 8) + texels * sizeof(struct radiosity_gpu_label);
    const uint64_t of_clusters = rows_bytes(clusters, 8 * sources) + table_bytes(clusters, 16) +
                                 table_bytes(clusters, 8) + table_bytes(texels, 4) +
                                 5 * table_bytes(nodes, 8);
    const uint64_t of_scene =
        texels * sizeof(struct light_map_triangle) + table_bytes(1, 16) + table_bytes(1, 4);
    const uint64_t of_map = table_bytes(places, 8) + 2 * 8 * LIGHT_MAP_LAYERS * places;
    return of_texels + of_clusters + of_scene + of_map + radiosity_probes_memory(o);
}

const struct technique technique_radiosity = {
    .name = "radiosity",
    .title = "baked radiosity of static geometry",
    .paper = "Loos 2015, Modular Radiance Transfer, sec. 2.5.3; Giuffrida 2016, sec. 3.2",
    .role = ROLE_SOURCE,
    .capabilities =
        CAN_MOVE_LIGHTS | NEEDS_BAKE | MAKES_SPECULAR | GATHERS_EMISSION | PUBLISHES_PROBES,
    .needs = FRAME_WRITES_IRRADIANCE | FRAME_NEEDS_ID,
    .bake_version = 12,
    .options = OPTION_TABLE(struct radiosity_options, option_rows, NULL),
    .presets = presets,
    .debug_views = radiosity_views,
    .state_size = sizeof(struct radiosity),
    .more_needs = more_needs,
    .bake = radiosity_bake,
    .create = create,
    .load = load,
    .set_options = set_options,
    .invalidate = invalidate,
    .follow = follow,
    .update = update,
    .record = record,
    .debug_view = debug_view,
    .charts = charts,
    .light_map = light_map,
    .probes = probes,
    .destroy = destroy,
    .memory_estimate = memory_estimate,
};
