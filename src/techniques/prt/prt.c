// Precomputed radiance transfer (Sloan, Kautz & Snyder 2002): diffuse transfer at the texels of a
// light map, or at vertices. The bake has for each of these receivers the vector T by which its
// irradiance follows from the coefficients L of distant light, E = Σ T_i L_i, with shadows and all
// bounces in it; a frame in which the light has changed computes that sum at all receivers.
#include "techniques/prt/prt.h"

#include "techniques/prt/prt_state.h"
#include "bake/report.h"
#include "scene/scene.h"
#include "scene/statics.h"

#include "technique_shaders.h"

#include <stddef.h>

#define OPTION(...) OPTION_ROW(struct prt_options, __VA_ARGS__)
static const struct option_row option_rows[] = {
#include "techniques/prt/prt_options.def"
};
#undef OPTION

static const struct technique_preset presets[] = {
    { "low", "texels=16384,coefficients=4,rays=256" },
    { "medium", "" },
    { "high", "texels=131072,coefficients=16,rays=1024" },
    { NULL, NULL },
};

static enum light_map_specular specular_of(const struct prt_options *o)
{
    if (!o->specular) return LIGHT_MAP_DIFFUSE;
    return o->glossy ? LIGHT_MAP_REFLECTED : LIGHT_MAP_SPECULAR;
}

static bool create(void *state, const struct technique_create *how)
{
    struct prt *s = state;
    s->host = how->host;
    s->gpu = how->gpu;
    light_map_init(&s->light_map, s->host, s->gpu, &s->charts, specular_of(&s->options));
    prt_vertex_map_init(&s->vertex_map, s->host, s->gpu, &s->receivers.vertices);
    if (!how->pose) return true;
    struct scene_statics statics;
    const bool ok =
        scene_statics_init(&statics, s->host, how->pose) &&
        light_map_followed_init(&s->followed, s->host, "prt", how->pose, &statics) &&
        light_map_materials_init(&s->materials, s->host, "prt", 0, &statics) &&
        prt_receivers_init(&s->receivers, &s->charts, s->host, &statics.pose, &s->options);
    scene_statics_finish(&statics);
    return ok;
}

static const struct technique_debug_view views[] = {
    { LIGHT_MAP_TEXELS_VIEW, LIGHT_MAP_TEXELS_VIEW_HELP, NULL },
    { PROBES_VIEW, PROBES_VIEW_HELP, NULL },
    { NULL, NULL, NULL },
};

#define TABLE(thing)    offsetof(struct prt, tables.thing)
#define PIPELINE(thing) #thing, offsetof(struct prt, pipelines.thing)

// transfer, clusters and weights are created by prt_upload.
static void list_tables(size_t base, uint32_t rows, struct gpu_objects *out)
{
#define MEMBER(thing) offsetof(struct prt_tables, thing)
    if (rows > 0)
        GPU_ADD(out, base,
                { GPU_IMAGE, "row_light", MEMBER(row_light),
                  .image = light_map_table(GPU_RGBA32F, rows) });
    GPU_ADD(out, base, { GPU_IMAGE, .member = MEMBER(transfer) },
            { GPU_IMAGE, .member = MEMBER(clusters) }, { GPU_IMAGE, .member = MEMBER(weights) });
#undef MEMBER
}

static void list_constants(const struct prt_options *o, struct gpu_constant *out)
{
    out[0] = (struct gpu_constant){ PRT_COEFFICIENTS, prt_coefficients(o) };
    out[1] = (struct gpu_constant){ PRT_BOUNCES, prt_has_bounces(o) };
    out[2] = (struct gpu_constant){ PRT_VECTORS, prt_vectors(o) };
}

static const struct gpu_shader *light_shader(const struct prt *s)
{
    const bool compressed = prt_codebook_rows(&s->options) > 0;
    if (s->receivers.at_vertices)
        return compressed ? &shader_prt_vertex_light_clusters_comp
                          : &shader_prt_vertex_light_vectors_comp;
    return compressed ? &shader_prt_light_clusters_comp : &shader_prt_light_vectors_comp;
}

static void list_pipelines(const struct prt *s, struct gpu_objects *out)
{
    const uint32_t first = LIGHT_MAP_CONSTANTS, of_vectors = 3u << first, of_weights = 4u << first;
    const bool compressed = prt_codebook_rows(&s->options) > 0;
    const uint32_t constants = compressed ? of_weights : of_vectors;
    if (compressed)
        GPU_ADD(out, 0,
                { GPU_PIPELINE, PIPELINE(rows), .shader = &shader_prt_rows_comp,
                  .consts = of_vectors });
    GPU_ADD(
        out, 0,
        { GPU_PIPELINE, PIPELINE(light), .shader = light_shader(s),
          .consts = s->receivers.at_vertices ? constants | 1u << PRT_HAS_EMITTED_AT : constants });
    if (prt_is_glossy(&s->options))
        GPU_ADD(out, 0,
                { GPU_PIPELINE, PIPELINE(reflect),
                  .shader = compressed ? &shader_prt_reflect_clusters_comp
                                       : &shader_prt_reflect_vectors_comp,
                  .consts = constants });
}

// Objects of the map in which pixels look up the light of receivers.
static void list_lookup(const struct prt *s, struct gpu_objects *out)
{
    if (s->receivers.at_vertices) {
        if (s->receivers.count > 0)
            prt_vertex_map_list(&s->vertex_map, offsetof(struct prt, vertex_map),
                                s->options.specular, out);
        return;
    }
    light_map_list(&s->light_map, offsetof(struct prt, light_map), out);
    if (s->receivers.count > 0)
        GPU_ADD(out, 0,
                { GPU_IMAGE, "texel_light", TABLE(texel_light),
                  .image = light_map_table(GPU_RG32U, 3 * (size_t)s->receivers.count) });
}

static void list(const struct prt *s, struct gpu_objects *out)
{
    const uint32_t rows = prt_codebook_rows(&s->options);
    gpu_objects_clear(out);
    list_lookup(s, out);
    list_constants(&s->options, out->constants + LIGHT_MAP_CONSTANTS);
    prt_probes_list(&s->probes, offsetof(struct prt, probes), &s->options,
                    3u << LIGHT_MAP_CONSTANTS, out);
    if (s->receivers.count == 0) return;
    list_pipelines(s, out);
    GPU_ADD(out, 0, { GPU_IMAGE, .member = TABLE(texels) });
    list_tables(TABLE(vectors), rows, out);
    if (!prt_is_glossy(&s->options)) return;
    GPU_ADD(out, 0,
            { GPU_IMAGE, "texel_radiance", TABLE(texel_radiance),
              .image = light_map_table(GPU_RG32U, s->receivers.count) });
    list_tables(TABLE(matrices), PRT_OUTGOING * rows, out);
}

// Bytes of vectors, or of matrices, before and after compression, and its squared error over their
// variance.
static void report_compression(struct report *report, const struct technique_bake *how,
                               const struct tensor *cluster, const struct tensor *error,
                               const char *const names[3], double numbers)
{
    const struct prt_options *o = how->options;
    if (!cluster || !error) return;
    const double points = (double)cluster->shape[0], vectors = (double)prt_vectors(o);
    const float *squares = error->data;
    report_number(report, names[0], 2.0 * numbers * points);
    report_number(report, names[1],
                  (2.0 + 2.0 * vectors) * points + 2.0 * numbers * (double)prt_codebook_rows(o));
    report_number(report, names[2],
                  squares[1] > 0.0f ? (double)squares[0] / (double)squares[1] : 0.0);
}

static bool bake_report(struct report *report, struct bake *bake, const struct technique_bake *how)
{
    static const char *const VECTORS[3] = { "vector_bytes", "compressed_bytes", "squared_error" };
    static const char *const MATRICES[3] = { "matrix_bytes", "compressed_matrix_bytes",
                                             "matrix_squared_error" };
    const struct tensors *tensors = bake_tensors(bake);
    const double numbers = prt_dimension(how->options);
    report_compression(report, how, tensors_find(tensors, PRT_CLUSTER),
                       tensors_find(tensors, PRT_ERROR), VECTORS, numbers);
    report_compression(report, how, tensors_find(tensors, PRT_GLOSSY_CLUSTER),
                       tensors_find(tensors, PRT_GLOSSY_ERROR), MATRICES, PRT_OUTGOING * numbers);
    return true;
}

static bool load(void *state, const struct tensors *bake)
{
    struct prt *s = state;
    struct gpu_objects objects;
    if (!prt_upload(s, bake)) return false;
    list(s, &objects);
    return gpu_objects_create(s->gpu, &objects, 0, s);
}

static void invalidate(void *state, uint32_t changes)
{
    struct prt *s = state;
    if (changes & (CHANGED_GEOMETRY | CHANGED_MATERIAL | CHANGED_OPTIONS)) s->kept.known = false;
}

// Light of points and spots is not distant.
static void warn_of_lights(struct prt *s, const struct scene *scene)
{
    int near = 0;
    for (int i = 0; i < scene->light_count; i++) near += scene->lights[i].type != LIGHT_SUN;
    if (near == 0 || s->warned_lights) return;
    s->warned_lights = true;
    host_log(
        s->host, LOG_WARNING,
        "prt: %d point or spot light%s no indirect light: prt transfers light of suns, the "
        "environment and emissive surfaces alone; --gi radiosity and --gi ort have all bounces",
        near, near == 1 ? " gives" : "s give");
}

static void follow(void *state, const struct scene_pose *pose, bool wait)
{
    struct prt *s = state;
    (void)wait;
    warn_of_lights(s, pose->scene);
    light_map_followed_update(&s->followed, pose);
    light_map_materials_update(&s->materials, pose->scene);
    s->light_map.surfaces.moves = s->vertex_map.surfaces.moves =
        s->followed.any_moved ? s->followed.places.moves : NULL;
}

static void update(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct prt *s = state;
    kept_update(&s->kept, view, view->light_hash);
    if (!(view->keep && s->kept.same)) {
        prt_project(&s->options, view, &s->light);
        s->probes.fresh = false;
        if (s->receivers.count > 0) prt_record_update(s, cmd, view);
    }
    if (s->options.probes) prt_record_probes(s, cmd, view);
}

// Probes have no light before a view needs it.
static void record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct prt *s = state;
    const bool has_map = view->layers[FRAME_ID].id && s->receivers.count > 0;
    if (has_map && prt_is_glossy(&s->options) && view->layers[FRAME_SPECULAR].id)
        prt_record_reflect(s, cmd, view);
    if (has_map && s->receivers.at_vertices)
        prt_vertex_map_record_apply(&s->vertex_map, cmd, view);
    else if (has_map)
        light_map_record_apply(&s->light_map, cmd, view);
    if (has_map && !s->followed.any_lit) return;
    prt_record_probes(s, cmd, view);
    probe_apply_record(&s->probes.apply, &s->probes.volume, cmd, view, has_map);
}

// Black where transfer is at vertices.
static void debug_view(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                       const char *name, gpu_image out)
{
    const struct prt *s = state;
    (void)name;
    light_map_record_texels_view(&s->light_map, cmd, view, out);
}

static bool probes(void *state, struct probe_volume *out)
{
    const struct prt *s = state;
    if (!s->options.probes) return false;
    *out = s->probes.volume;
    return true;
}

static bool has_light_map(const void *options)
{
    const struct prt_options *o = options;
    return o->at == PRT_AT_TEXEL;
}

static gpu_image light_map(void *state)
{
    const struct prt *s = state;
    return s->light_map.images[s->light_map.front];
}

static void destroy(void *state)
{
    struct prt *s = state;
    if (!s->host) return;
    struct gpu_objects objects;
    list(s, &objects);
    gpu_objects_destroy(s->gpu, &objects, s);
    light_map_followed_finish(&s->followed);
    light_map_materials_finish(&s->materials);
    prt_receivers_finish(&s->receivers);
}

static uint32_t more_needs(const void *options)
{
    const struct prt_options *o = options;
    return o->specular ? FRAME_WRITES_SPECULAR : 0;
}

// Bytes of vectors, or of matrices with as many rows.
static uint64_t tables_bytes(const struct prt_options *o, uint64_t rows_of_one)
{
    const uint64_t texels = (uint64_t)o->texels, rows = rows_of_one * prt_codebook_rows(o);
    if (rows == 0) return light_map_table_bytes(prt_row_entries(o) * rows_of_one * texels, 16);
    return light_map_table_bytes(prt_row_entries(o) * rows, 16) + light_map_table_bytes(texels, 4) +
           light_map_table_bytes(prt_weight_entries(o) * texels, 8) +
           light_map_table_bytes(rows, 16);
}

static uint64_t probes_bytes(const struct prt_options *o)
{
    const uint64_t probes = prt_probes_most(o), rows = prt_probe_rows(o);
    return light_map_table_bytes(prt_row_entries(o) * rows * probes, 16) +
           light_map_table_bytes((1 + rows) * probes, 16) +
           light_map_table_bytes(rows * probes, 8) + probes * PROBE_VOLUME_BYTES;
}

// The number of vertices is known with the scene alone: the estimate is that of the texels.
static uint64_t memory_estimate(const void *options)
{
    const struct prt_options *o = options;
    const uint64_t texels = (uint64_t)o->texels;
    uint64_t bytes = light_map_table_bytes(TEXEL_PARTS * texels, 16) + tables_bytes(o, 1) +
                     light_map_table_bytes(3 * texels, 8) + light_map_bytes(texels);
    if (prt_is_glossy(o))
        bytes += tables_bytes(o, PRT_OUTGOING) + light_map_table_bytes(texels, 8) +
                 light_map_bytes(texels) / (2 * LIGHT_MAP_LAYERS);
    return bytes + probes_bytes(o);
}

const struct technique technique_prt = {
    .name = "prt",
    .title =
        "precomputed radiance transfer of static geometry; no bounces of point and spot lights",
    .paper = "Sloan, Kautz & Snyder 2002, Precomputed Radiance Transfer for Real-Time Rendering "
             "in Dynamic, Low-Frequency Lighting Environments",
    .role = ROLE_SOURCE,
    .capabilities =
        CAN_MOVE_LIGHTS | NEEDS_BAKE | MAKES_SPECULAR | GATHERS_EMISSION | PUBLISHES_PROBES,
    .needs = FRAME_WRITES_IRRADIANCE | FRAME_NEEDS_ID,
    .bake_version = 7,
    .options = OPTION_TABLE(struct prt_options, option_rows, NULL),
    .presets = presets,
    .debug_views = views,
    .state_size = sizeof(struct prt),
    .more_needs = more_needs,
    .bake = prt_bake,
    .bake_report = bake_report,
    .create = create,
    .load = load,
    .invalidate = invalidate,
    .follow = follow,
    .update = update,
    .record = record,
    .debug_view = debug_view,
    .has_light_map = has_light_map,
    .charts = prt_charts,
    .light_map = light_map,
    .probes = probes,
    .destroy = destroy,
    .memory_estimate = memory_estimate,
};
