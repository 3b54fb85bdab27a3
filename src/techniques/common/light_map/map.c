#include "techniques/common/light_map/map.h"

#include "bake/tensors.h"
#include "frame/frame.h"
#include "techniques/common/light_map/tensors.h"
#include "techniques/common/light_map/visible_sky.h"

#include "technique_shaders.h"

#include <stddef.h>
#include <string.h>

void light_map_init(struct light_map *out, struct host *host, struct gpu *gpu,
                    const struct charts *charts, enum light_map_specular specular)
{
    *out = (struct light_map){ .host = host,
                               .gpu = gpu,
                               .charts = charts,
                               .specular = specular,
                               .columns = light_map_columns_for(gpu) };
}

// Whether pixels reflect the map's light, and the visible environment.
static bool has_lobes(const struct light_map *map)
{
    return map->specular == LIGHT_MAP_SPECULAR || map->specular == LIGHT_MAP_BY_FLUENCE;
}

#define MEMBER(thing) offsetof(struct light_map, thing)

static const struct gpu_shader *apply_shader(enum light_map_specular specular)
{
    switch (specular) {
    case LIGHT_MAP_DIFFUSE:
        return &shader_common_light_map_apply_diffuse_comp;
    case LIGHT_MAP_SPECULAR:
        return &shader_common_light_map_apply_specular_comp;
    case LIGHT_MAP_BY_FLUENCE:
        return &shader_common_light_map_apply_fluence_comp;
    case LIGHT_MAP_REFLECTED:
        break;
    }
    return &shader_common_light_map_apply_reflected_comp;
}

static void list_pipelines(const struct light_map *map, size_t base, struct gpu_objects *out)
{
    const struct gpu_constant constants[LIGHT_MAP_CONSTANTS] = {
        { LIGHT_MAP_APPLY_WIDTH, map->columns.width },
        { LIGHT_MAP_APPLY_HEIGHT, map->columns.height },
        { LIGHT_MAP_APPLY_ROWS, map->columns.rows },
        { LIGHT_MAP_HAS_BACKS, charts_sides(map->charts) == 2 },
        { LIGHT_MAP_APPLY_DIELECTRIC, 0 },
        { LIGHT_MAP_APPLY_DIELECTRIC, 1 },
        { LIGHT_MAP_HAS_MOVES, 0 },
        { LIGHT_MAP_APPLY_MIRRORS, 1 }
    };
    const uint32_t moved = 15u, still = moved | 1u << 6, mirrors = moved | 1u << 7;
    const struct gpu_shader *apply = apply_shader(map->specular);
    memcpy(out->constants, constants, sizeof constants);
#define PIPELINE(thing) #thing, MEMBER(thing)
    GPU_ADD(out, base,
            { GPU_PIPELINE, PIPELINE(show), .shader = &shader_common_light_map_show_comp },
            { GPU_PIPELINE, PIPELINE(seams), .shader = &shader_common_light_map_seams_comp },
            { GPU_PIPELINE, PIPELINE(checker), .shader = &shader_common_light_map_checker_comp },
            { GPU_PIPELINE, PIPELINE(apply[0][0]), .shader = apply, .consts = still | 1u << 4 },
            { GPU_PIPELINE, PIPELINE(apply[0][1]), .shader = apply, .consts = still | 1u << 5 },
            { GPU_PIPELINE, PIPELINE(apply[1][0]), .shader = apply, .consts = moved | 1u << 4 },
            { GPU_PIPELINE, PIPELINE(apply[1][1]), .shader = apply, .consts = moved | 1u << 5 });
    if (!has_lobes(map)) return;
    GPU_ADD(out, base,
            { GPU_PIPELINE, PIPELINE(mirror[0]), .shader = apply, .consts = mirrors | 1u << 4 },
            { GPU_PIPELINE, PIPELINE(mirror[1]), .shader = apply, .consts = mirrors | 1u << 5 });
}

void light_map_list(const struct light_map *map, size_t base, struct gpu_objects *out)
{
    GPU_ADD(out, base, { GPU_SAMPLER, "light_map", .member = MEMBER(linear) });
    if (!map->charts || map->charts->side_texel_count == 0) return;
    const struct gpu_image_desc image = light_map_image(map->charts, "light_map", LIGHT_MAP_LAYERS);
    const struct gpu_image_desc reflected = light_map_image(map->charts, "reflected", 1);
    GPU_ADD(out, base, { GPU_IMAGE, "light_map", MEMBER(images[0]), .image = image },
            { GPU_IMAGE, "light_map", MEMBER(images[1]), .image = image });
    if (map->specular == LIGHT_MAP_REFLECTED)
        GPU_ADD(out, base, { GPU_IMAGE, "reflected", MEMBER(reflected), .image = reflected });
    const struct gpu_image_desc fluence = light_map_image(map->charts, "fluence", 1);
    if (map->specular == LIGHT_MAP_BY_FLUENCE)
        GPU_ADD(out, base, { GPU_IMAGE, "fluence", MEMBER(fluence[0]), .image = fluence },
                { GPU_IMAGE, "fluence", MEMBER(fluence[1]), .image = fluence });
    list_pipelines(map, base, out);
    // Created by light_map_upload.
    GPU_ADD(out, base, { GPU_IMAGE, .member = MEMBER(owners) },
            { GPU_IMAGE, .member = MEMBER(seam_places) },
            { GPU_IMAGE, .member = MEMBER(seam_rows) }, { GPU_IMAGE, .member = MEMBER(walls) },
            { GPU_IMAGE, .member = MEMBER(visible_sky) },
            { GPU_BUFFER, .member = MEMBER(surfaces.first) },
            { GPU_BUFFER, .member = MEMBER(surfaces.triangles) });
}

// ---- tables

struct pair {
    uint32_t x, y;
};

// Places that show no texel are not in the table.
static bool upload_owners(struct light_map *map, const uint32_t *nearest_valid)
{
    const size_t places = charts_place_count(map->charts);
    struct pair *owners = host_alloc(map->host, light_map_table_capacity(places), sizeof *owners);
    for (size_t i = 0; owners && i < places; i++) {
        const uint32_t texel = chart_texel_of_place(map->charts, i);
        if (texel == CHART_NONE) continue;
        owners[map->owner_count++] =
            (struct pair){ light_map_place_word(map->charts, i), nearest_valid[texel] };
    }
    return light_map_table_upload(map->host, map->gpu, "owners", GPU_RG32U, owners,
                                  map->owner_count, &map->owners);
}

static bool upload_triangles(struct light_map *map, uint32_t instances)
{
    const struct charts *charts = map->charts;
    const size_t count = charts->triangle_0[instances];
    struct light_map_triangle *triangles = host_alloc(map->host, count, sizeof *triangles);
    uint32_t *first = host_alloc(map->host, (size_t)instances + 1, sizeof *first);
    if (triangles) light_map_fill_triangles(charts, charts->chart_triangle, count, triangles);
    for (uint32_t i = 0; first && i <= instances; i++) first[i] = (uint32_t)charts->triangle_0[i];
    map->surfaces.count = instances;
    const bool ok = light_map_buffer_upload(map->host, map->gpu, "triangles", triangles,
                                            count * sizeof *triangles, &map->surfaces.triangles);
    return light_map_buffer_upload(map->host, map->gpu, "first_triangles", first,
                                   ((size_t)instances + 1) * sizeof *first, &map->surfaces.first) &&
           ok;
}

// Gutters have none: pixels are at places of texels.
static bool upload_walls(struct light_map *map, const struct tensors *bake)
{
    const struct charts *charts = map->charts;
    const size_t places = (size_t)charts->width * charts->height;
    struct gpu_image_desc desc = light_map_image(charts, "walls", 1);
    const struct pair *of_texel = TENSORS_EXPECT(map->host, bake, LIGHT_MAP_WALL, TENSOR_U32,
                                                 light_map_rows(charts->side_texel_count), 2);
    struct pair *walls = of_texel ? host_alloc(map->host, places, sizeof *walls) : NULL;
    desc.format = GPU_RG32U;
    desc.usage = GPU_SAMPLED;
    bool ok = walls && gpu_image_create(map->gpu, &desc, &map->walls);
    for (uint32_t side = 0; ok && side < desc.depth; side++) {
        for (size_t i = 0; i < places; i++) {
            const uint32_t texel = chart_texel_of_place(charts, side * places + i);
            walls[i] = (struct pair){ 0, 0 };
            if (texel == CHART_NONE) continue;
            const struct chart_texel *t = chart_texel_of(charts, texel);
            if (i == (size_t)t->y * charts->width + t->x) walls[i] = of_texel[texel];
        }
        ok = gpu_image_upload(map->gpu, map->walls, 0, side, walls, places * sizeof *walls);
    }
    host_free(map->host, walls);
    return ok;
}

static bool find_rows(const struct light_map *map, const struct tensors *bake, uint32_t places,
                      struct light_map_seam_rows *out)
{
    const uint64_t shape[2] = { light_map_rows(places), CHART_SEAM_ENTRIES };
    out->texel = tensors_expect(map->host, bake, LIGHT_MAP_SEAM_TEXEL, TENSOR_U32, 2, shape);
    out->weight = tensors_expect(map->host, bake, LIGHT_MAP_SEAM_WEIGHT, TENSOR_F32, 2, shape);
    if (!out->texel || !out->weight) return false;
    for (size_t i = 0; i < (size_t)places * CHART_SEAM_ENTRIES; i++)
        if (out->texel[i] >= map->charts->side_texel_count)
            return host_fail(map->host, FAIL_FORMAT, "bake of a light map: texel %u of a seam",
                             out->texel[i]);
    return true;
}

static bool upload_rows(struct light_map *map, const struct light_map_seam_rows *from,
                        const uint32_t *nearest_valid)
{
    const size_t places = map->seam_count, entries = CHART_SEAM_ENTRIES;
    const size_t count = places * entries / LIGHT_MAP_PAIR;
    struct chart_share *rows =
        host_alloc(map->host, light_map_table_capacity(count), LIGHT_MAP_PAIR * sizeof *rows);
    for (size_t i = 0; rows && i < places * entries; i++)
        *light_map_share_at(rows, places, i / entries, i % entries) =
            (struct chart_share){ nearest_valid[from->texel[i]], from->weight[i] };
    return light_map_table_upload(map->host, map->gpu, "seams", GPU_RGBA32U, rows, count,
                                  &map->seam_rows);
}

static bool upload_places(struct light_map *map, const struct chart_seams *seams)
{
    const size_t count = seams->count;
    uint32_t *places = host_alloc(map->host, light_map_table_capacity(count), sizeof *places);
    for (size_t i = 0; places && i < count; i++)
        places[i] = light_map_place_word(map->charts, seams->places[i]);
    map->seam_count = (uint32_t)count;
    return light_map_table_upload(map->host, map->gpu, "places", GPU_R32U, places, count,
                                  &map->seam_places);
}

bool light_map_upload(struct light_map *map, uint32_t instances, const uint32_t *nearest_valid,
                      const float *sky, const struct tensors *bake)
{
    struct chart_seams seams;
    struct light_map_seam_rows rows;
    if (!charts_seams_init(&seams, map->charts, CHART_SEAM_POINTS)) return false;
    const bool ok = find_rows(map, bake, seams.count, &rows) && upload_walls(map, bake) &&
                    upload_owners(map, nearest_valid) && upload_places(map, &seams) &&
                    upload_rows(map, &rows, nearest_valid) && upload_triangles(map, instances) &&
                    (!has_lobes(map) ||
                     light_map_upload_visible_sky(map->host, map->gpu, map->charts, &seams, &rows,
                                                  nearest_valid, sky, &map->visible_sky));
    charts_seams_finish(&seams);
    return ok;
}

// Charts fill the map by two thirds, with a triangle for each texel.
uint64_t light_map_bytes(uint64_t texels)
{
    const uint64_t places = texels * 3 / 2;
    return texels * sizeof(struct light_map_triangle) + light_map_table_bytes(1, 16) +
           light_map_table_bytes(1, 4) + light_map_table_bytes(places, 8) +
           8 * (2 * LIGHT_MAP_LAYERS + 2) * places;
}

// ---- passes

// The light of texels, and the image that it is written to.
struct map_target {
    gpu_image light, image;
    uint32_t layers; // of a side
};

static void record_show(const struct light_map *map, struct gpu_cmd *cmd, struct map_target s,
                        uint32_t first, uint32_t count)
{
    const struct light_map_show_push push = { first, count, map->charts->side_texel_count,
                                              s.layers };
    gpu_dispatch(cmd, map->show,
                 GPU_BIND({ .name = "light_map_owners", .image = map->owners },
                          { .name = "texel_light", .image = s.light },
                          { .name = "light_map", .image = s.image }),
                 &push, sizeof push, gpu_groups(count, LIGHT_MAP_LOCAL), 1, 1);
}

static void record_seams(const struct light_map *map, struct gpu_cmd *cmd, struct map_target s,
                         uint32_t first, uint32_t count)
{
    const struct light_map_seams_push push = { first,
                                               count,
                                               map->seam_count,
                                               CHART_SEAM_ENTRIES / LIGHT_MAP_PAIR,
                                               map->charts->side_texel_count,
                                               s.layers };
    gpu_dispatch(cmd, map->seams,
                 GPU_BIND({ .name = "light_map_seam_places", .image = map->seam_places },
                          { .name = "light_map_seam_rows", .image = map->seam_rows },
                          { .name = "texel_light", .image = s.light },
                          { .name = "light_map", .image = s.image }),
                 &push, sizeof push, gpu_groups(count, LIGHT_MAP_LOCAL), 1, 1);
}

static struct map_target newest(const struct light_map *map, gpu_image light)
{
    return (struct map_target){ light, map->images[1 - map->front], LIGHT_MAP_LAYERS };
}

static struct map_target newest_fluence(const struct light_map *map, gpu_image fluence)
{
    return (struct map_target){ fluence, map->fluence[1 - map->front], 1 };
}

void light_map_record_show(const struct light_map *map, struct gpu_cmd *cmd,
                           struct light_map_tables from, uint32_t first, uint32_t count)
{
    record_show(map, cmd, newest(map, from.light), first, count);
    if (map->specular == LIGHT_MAP_BY_FLUENCE)
        record_show(map, cmd, newest_fluence(map, from.fluence), first, count);
}

void light_map_record_seams(const struct light_map *map, struct gpu_cmd *cmd,
                            struct light_map_tables from, uint32_t first, uint32_t count)
{
    record_seams(map, cmd, newest(map, from.light), first, count);
    if (map->specular == LIGHT_MAP_BY_FLUENCE)
        record_seams(map, cmd, newest_fluence(map, from.fluence), first, count);
}

static void record_whole(const struct light_map *map, struct gpu_cmd *cmd, struct map_target s,
                         bool seams)
{
    record_show(map, cmd, s, 0, map->owner_count);
    if (seams && map->seam_count > 0) record_seams(map, cmd, s, 0, map->seam_count);
}

void light_map_record_all(struct light_map *map, struct gpu_cmd *cmd, gpu_image light, bool seams)
{
    gpu_scope_begin(cmd, "light_map");
    record_whole(map, cmd, newest(map, light), seams);
    map->front = 1 - map->front;
    gpu_scope_end(cmd);
}

void light_map_record_reflected(const struct light_map *map, struct gpu_cmd *cmd, gpu_image light,
                                bool seams)
{
    record_whole(map, cmd, (struct map_target){ light, map->reflected, 1 }, seams);
}

// One variant for all scenes mirrors the environment: few have both its map and moved instances.
static gpu_pipeline apply_of(const struct light_map *map, const struct frame_view *view)
{
    const bool dielectric = view->layers[FRAME_DIELECTRIC].id != 0;
    if (has_lobes(map) && view->constants->environment_scale > 0.0f) return map->mirror[dielectric];
    return map->apply[map->surfaces.moves != NULL][dielectric];
}

void light_map_record_apply(const struct light_map *map, struct gpu_cmd *cmd,
                            const struct frame_view *view)
{
    const gpu_image *layers = view->layers;
    const struct light_map_apply_push push = {
        1.0f / (float)map->charts->width, 1.0f / (float)map->charts->height,
        1.0f / (float)view->width, 1.0f / (float)view->height, light_map_instances(&map->surfaces)
    };
    gpu_scope_begin(cmd, "apply");
    light_map_clear_pixels(cmd, view);
    gpu_dispatch(
        cmd, apply_of(map, view),
        GPU_BIND(
            FRAME_SURFACE_BINDINGS(view), view->environment_binding,
            { .name = "id", .image = layers[FRAME_ID] },
            LIGHT_MAP_SURFACE_BINDINGS(&map->surfaces, cmd),
            { .name = "light_map", .image = map->images[map->front], .sampler = map->linear },
            { .name = "fluence_map", .image = map->fluence[map->front], .sampler = map->linear },
            { .name = "light_map_walls", .image = map->walls },
            { .name = "reflected_map", .image = map->reflected, .sampler = map->linear },
            { .name = "visible_sky", .image = map->visible_sky, .sampler = map->linear },
            { .name = "irradiance", .image = layers[FRAME_IRRADIANCE] },
            { .name = "specular", .image = layers[FRAME_SPECULAR] }),
        &push, sizeof push, gpu_groups(view->width, map->columns.width),
        gpu_groups(view->height, map->columns.height * map->columns.rows), 1);
    gpu_scope_end(cmd);
}

void light_map_record_texels_view(const struct light_map *map, struct gpu_cmd *cmd,
                                  const struct frame_view *view, gpu_image out)
{
    const gpu_image *layers = view->layers;
    const struct light_map_checker_push push = { light_map_instances(&map->surfaces) };
    if (!layers[FRAME_ID].id || !map->charts || map->charts->side_texel_count == 0) {
        gpu_clear_image(cmd, out, (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
        return;
    }
    gpu_scope_begin(cmd, "texels");
    gpu_dispatch(cmd, map->checker,
                 GPU_BIND(view->constants_binding,
                          { .name = "depth", .image = layers[FRAME_DEPTH] },
                          { .name = "normal", .image = layers[FRAME_NORMAL] },
                          { .name = "id", .image = layers[FRAME_ID] },
                          LIGHT_MAP_SURFACE_BINDINGS(&map->surfaces, cmd),
                          { .name = "target", .image = out }),
                 &push, sizeof push, gpu_groups(view->width, LIGHT_MAP_LOCAL_2D),
                 gpu_groups(view->height, LIGHT_MAP_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}
