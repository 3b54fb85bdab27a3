#include "techniques/prt/prt_vertex_map.h"

#include "frame/frame.h"
#include "techniques/prt/prt_shared.h"

#include "technique_shaders.h"

#include <stddef.h>
#include <string.h>

void prt_vertex_map_init(struct prt_vertex_map *out, struct host *host, struct gpu *gpu,
                         const struct prt_vertices *vertices)
{
    *out = (struct prt_vertex_map){
        .host = host, .gpu = gpu, .vertices = vertices, .columns = light_map_columns_for(gpu)
    };
}

// ---- objects

#define MEMBER(thing) offsetof(struct prt_vertex_map, thing)

static void list_pipelines(const struct prt_vertex_map *map, size_t base, bool specular,
                           struct gpu_objects *out)
{
    const struct gpu_constant constants[LIGHT_MAP_CONSTANTS] = {
        { LIGHT_MAP_APPLY_WIDTH, map->columns.width },
        { LIGHT_MAP_APPLY_HEIGHT, map->columns.height },
        { LIGHT_MAP_HAS_BACKS, map->vertices->count > map->vertices->front_count },
        { LIGHT_MAP_APPLY_DIELECTRIC, 0 },
        { LIGHT_MAP_APPLY_DIELECTRIC, 1 },
        { LIGHT_MAP_HAS_MOVES, 0 },
        { LIGHT_MAP_APPLY_ROWS, map->columns.rows }
    };
    const uint32_t moved = 7u | 1u << 6 | 1u << PRT_HAS_EMITTED_AT;
    const uint32_t still = moved | 1u << 5;
    const struct gpu_shader *apply =
        specular ? &shader_prt_vertex_apply_specular_comp : &shader_prt_vertex_apply_diffuse_comp;
    memcpy(out->constants, constants, sizeof constants);
    out->constants[PRT_HAS_EMITTED_AT] = (struct gpu_constant){ PRT_HAS_EMITTED, map->emits };
#define PIPELINE(thing) #thing, MEMBER(thing)
    GPU_ADD(out, base,
            { GPU_PIPELINE, PIPELINE(apply[0][0]), .shader = apply, .consts = still | 1u << 3 },
            { GPU_PIPELINE, PIPELINE(apply[0][1]), .shader = apply, .consts = still | 1u << 4 },
            { GPU_PIPELINE, PIPELINE(apply[1][0]), .shader = apply, .consts = moved | 1u << 3 },
            { GPU_PIPELINE, PIPELINE(apply[1][1]), .shader = apply, .consts = moved | 1u << 4 });
}

void prt_vertex_map_list(const struct prt_vertex_map *map, size_t base, bool specular,
                         struct gpu_objects *out)
{
    const size_t parts = map->emits ? PRT_LIGHT_PARTS : 1;
    list_pipelines(map, base, specular, out);
    GPU_ADD(out, base,
            { GPU_IMAGE, "vertex_light", MEMBER(light),
              .image = light_map_table(GPU_RGBA32U, parts * map->vertices->count) });
    // Created by prt_vertex_map_upload.
    GPU_ADD(out, base, { GPU_IMAGE, .member = MEMBER(corners) },
            { GPU_BUFFER, .member = MEMBER(surfaces.first) },
            { GPU_BUFFER, .member = MEMBER(surfaces.triangles) });
}

// ---- tables

// Places in a triangle are the weights of its second and third corner.
static struct light_map_triangle triangle_of(const struct prt_vertices *v, size_t triangle)
{
    const uint32_t *corner = v->corners[triangle];
    struct chart_triangle t = { .place = { { { 0, 0 } }, { { 1, 0 } }, { { 0, 1 } } } };
    for (int k = 0; k < 3; k++) t.corner[k] = v->at[corner[k]].position;
    t.normal = v->face[triangle];
    if (glms_vec3_norm2(t.normal) == 0.0f) return LIGHT_MAP_ABSENT;
    return light_map_triangle_of(&t, v->corners[v->triangle_count + triangle][0] != PRT_NO_VERTEX);
}

static bool upload_surfaces(struct prt_vertex_map *map, uint32_t instances)
{
    const struct prt_vertices *v = map->vertices;
    struct light_map_triangle *triangles =
        host_alloc(map->host, v->triangle_count, sizeof *triangles);
    uint32_t *first = host_alloc(map->host, (size_t)instances + 1, sizeof *first);
    for (size_t t = 0; triangles && t < v->triangle_count; t++) triangles[t] = triangle_of(v, t);
    for (uint32_t i = 0; first && i <= instances; i++) first[i] = (uint32_t)v->triangle_0[i];
    map->surfaces.count = instances;
    const bool ok =
        light_map_buffer_upload(map->host, map->gpu, "triangles", triangles,
                                v->triangle_count * sizeof *triangles, &map->surfaces.triangles);
    return light_map_buffer_upload(map->host, map->gpu, "first_triangles", first,
                                   ((size_t)instances + 1) * sizeof *first, &map->surfaces.first) &&
           ok;
}

static bool upload_corners(struct prt_vertex_map *map, const uint32_t *nearest_valid)
{
    const struct prt_vertices *v = map->vertices;
    const size_t sides = v->count > v->front_count ? 2 : 1, count = sides * v->triangle_count;
    uint32_t(*corners)[4] = host_alloc(map->host, light_map_table_capacity(count), sizeof *corners);
    for (size_t t = 0; corners && t < count; t++)
        for (size_t k = 0; k < 3; k++)
            if (v->corners[t][k] != PRT_NO_VERTEX) corners[t][k] = nearest_valid[v->corners[t][k]];
    return light_map_table_upload(map->host, map->gpu, "corners", GPU_RGBA32U, corners, count,
                                  &map->corners);
}

// Normals, and with emissive surfaces their light by colour: irradiance in w, and the part of the
// vector irradiance that is not along the normal.
static bool upload_vertices(struct prt_vertex_map *map, const float *emitted, gpu_image *table)
{
    const size_t count = map->vertices->count, parts = map->emits ? PRT_VERTEX_PARTS : 1;
    vec4s *out = host_alloc(map->host, light_map_table_capacity(parts * count), sizeof *out);
    for (size_t i = 0; out && i < count; i++) {
        const vec3s n = map->vertices->at[i].normal;
        out[PRT_VERTEX_NORMAL * count + i] = vec4_of(n, 0.0f);
        for (size_t c = 0; c + 1 < parts; c++) {
            const float *e = emitted + 12 * i + 4 * c;
            out[(PRT_VERTEX_EMITTED_0 + c) * count + i] =
                vec4_of(glms_vec3_muladds(n, -e[0], vec3_of(e[1], e[2], e[3])), e[0]);
        }
    }
    return light_map_table_upload(map->host, map->gpu, "vertices", GPU_RGBA32F, out, parts * count,
                                  table);
}

bool prt_vertex_map_upload(struct prt_vertex_map *map, uint32_t instances,
                           const uint32_t *nearest_valid, const float *emitted, gpu_image *table)
{
    for (size_t i = 0; i < 12 * (size_t)map->vertices->count; i++) map->emits |= emitted[i] != 0.0f;
    return upload_surfaces(map, instances) && upload_corners(map, nearest_valid) &&
           upload_vertices(map, emitted, table);
}

// ---- passes

void prt_vertex_map_record_apply(const struct prt_vertex_map *map, struct gpu_cmd *cmd,
                                 const struct frame_view *view)
{
    const gpu_image *layers = view->layers;
    const struct prt_vertex_push push = { 1.0f / (float)view->width, 1.0f / (float)view->height,
                                          map->vertices->count,
                                          (uint32_t)map->vertices->triangle_count,
                                          light_map_instances(&map->surfaces) };
    gpu_scope_begin(cmd, "apply");
    light_map_clear_pixels(cmd, view);
    gpu_dispatch(cmd, map->apply[map->surfaces.moves != NULL][layers[FRAME_DIELECTRIC].id != 0],
                 GPU_BIND(FRAME_SURFACE_BINDINGS(view), { .name = "id", .image = layers[FRAME_ID] },
                          LIGHT_MAP_SURFACE_BINDINGS(&map->surfaces, cmd),
                          { .name = "prt_corners", .image = map->corners },
                          { .name = "vertex_light", .image = map->light },
                          { .name = "irradiance", .image = layers[FRAME_IRRADIANCE] },
                          { .name = "specular", .image = layers[FRAME_SPECULAR] }),
                 &push, sizeof push, gpu_groups(view->width, map->columns.width),
                 gpu_groups(view->height, map->columns.height * map->columns.rows), 1);
    gpu_scope_end(cmd);
}
