// The light map of clutter: tables and passes. Its texels are to reconstruct.comp as those of walls
// by normal, in tiles of MRT_LOCAL.
#include "techniques/mrt/runtime/clutter/clutter.h"

#include "techniques/mrt/runtime/objects.h"
#include "techniques/mrt/runtime/operators.h"
#include "techniques/mrt/runtime/tables.h"

#include "techniques/mrt/dictionary/rays.h"

#include "technique_shaders.h"

#include <stdlib.h>
#include <string.h>

enum { VALUES = MRT_VECTOR_COEFFICIENTS, VEC3_BYTES = 12 };

// ---- tables

static size_t tiles_of(const struct mrt_clutter_atlas_input *map)
{
    size_t tiles = 0;
    for (int i = 0; i < map->count; i++)
        tiles += mrt_clutter_map_tiles((size_t)map->rows[i].texel_count);
    return tiles;
}

static void fill_tiles(const struct mrt_runtime_input *input, void *items)
{
    const struct mrt_clutter_atlas_input *map = &input->clutter->map;
    struct mrt_gpu_tile *tile = items;
    uint32_t first = 0;
    for (int i = 0; i < map->count; i++) {
        const size_t tiles = mrt_clutter_map_tiles((size_t)map->rows[i].texel_count);
        for (uint32_t k = 0; k < tiles; k++)
            *tile++ = (struct mrt_gpu_tile){ .block = (uint32_t)map->rows[i].block,
                                             .first_texel = first + k * MRT_LOCAL,
                                             .basis_row = first + k * MRT_LOCAL,
                                             .response_row = k * MRT_LOCAL };
        first += (uint32_t)tiles * MRT_LOCAL;
    }
}

// Of an opening, up to the last coefficient that lights the clutter.
static uint32_t quads_of(const struct matrix_f32 *u_r)
{
    size_t used = 0;
    for (size_t r = 0; r < u_r->rows; r++)
        for (size_t c = u_r->columns; c > used; c--)
            if (u_r->at[r * u_r->stride + c - 1] != 0.0f) used = c;
    return (uint32_t)(used + 3) / 4;
}

// Of blocks without clutter no tile reads them.
static void fill_openings(const struct mrt_runtime_input *input, void *items)
{
    const struct mrt_clutter_atlas_input *map = &input->clutter->map;
    struct mrt_gpu_opening *openings = items;
    uint32_t row = 0;
    for (int i = 0, rows = 0, first = 0; i < input->opening_count; i++) {
        while (rows < map->count && map->rows[rows].block < input->openings[i].block) rows++;
        if (rows == map->count || map->rows[rows].block != input->openings[i].block) continue;
        if (input->openings[first].block != input->openings[i].block) first = i;
        openings[i].response = row;
        openings[i].quads = quads_of(&map->rows[rows].u_r[i - first]);
        row += (uint32_t)mrt_clutter_map_tiles((size_t)map->rows[rows].texel_count) * MRT_LOCAL;
    }
}

// Where the light of a texel of the clutter is.
static uint32_t light_of(const struct mrt_clutter_atlas_input *map, uint32_t texel)
{
    uint32_t first = 0;
    for (int k = 0; k < map->count; k++) {
        const struct mrt_clutter_rows_input *rows = &map->rows[k];
        const uint32_t local = texel - (uint32_t)rows->first_texel;
        if (texel >= (uint32_t)rows->first_texel && local < (uint32_t)rows->texel_count)
            return first + local;
        first += (uint32_t)mrt_clutter_map_tiles((size_t)rows->texel_count) * MRT_LOCAL;
    }
    return CHART_NONE;
}

// A lookup reads the texels that the surface touches and the eight around each.
static bool is_read(const struct charts *charts, uint32_t place)
{
    const uint32_t owner = charts->owner[place];
    if (owner == CHART_NONE) return false;
    const int x = (int)(place % charts->width) - (int)charts->texels[owner].x;
    const int y = (int)(place / charts->width) - (int)charts->texels[owner].y;
    return abs(x) <= 1 && abs(y) <= 1;
}

// Texels of the atlas that lookups read. `out` may be NULL.
static uint32_t list_places(const struct mrt_clutter_atlas_input *map,
                            struct mrt_gpu_clutter_place *out)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < map->width * map->height; i++) {
        const uint32_t texel = map->source[i];
        const bool read = texel != CHART_NONE && is_read(&map->clutter->charts, i);
        const uint32_t light = read ? light_of(map, texel) : CHART_NONE;
        if (light == CHART_NONE) continue;
        if (out)
            out[count] =
                (struct mrt_gpu_clutter_place){ i % map->width, i / map->width, light, texel };
        count++;
    }
    return count;
}

static void fill_places(const struct mrt_runtime_input *input, void *items)
{
    list_places(&input->clutter->map, items);
}

// Triangles of the scene, instance after instance.
static void fill_instances(const struct mrt_runtime_input *input, void *items)
{
    const struct scene *scene = &input->clutter->map.clutter->walls.scene;
    const struct mrt_clutter *clutter = input->clutter->map.clutter;
    struct mrt_gpu_clutter_instance *instances = items;
    uint32_t next = 0;
    for (int i = 0; i < scene->instance_count; i++) {
        const uint32_t count = clutter->triangles_of_instance[i];
        instances[i] = (struct mrt_gpu_clutter_instance){ next, count };
        next += count;
    }
}

static void fill_numbers(const struct mrt_runtime_input *input, void *items)
{
    const struct mrt_clutter *clutter = input->clutter->map.clutter;
    uint32_t *numbers = items;
    for (size_t i = 0; i < clutter->scene_triangles; i++)
        numbers[i] = clutter->number[i] == CHART_NONE ? CHART_NONE
                                                      : clutter->chart_triangle[clutter->number[i]];
}

static struct mrt_gpu_clutter_triangle triangle_of(const struct chart_triangle *from)
{
    const vec3s e = glms_vec3_sub(from->corner[1], from->corner[0]);
    const vec3s f = glms_vec3_sub(from->corner[2], from->corner[0]), n = glms_vec3_cross(e, f);
    const float n2 = glms_vec3_norm2(n);
    const vec3s by_e = glms_vec3_divs(glms_vec3_cross(f, n), n2);
    const vec3s by_f = glms_vec3_divs(glms_vec3_cross(n, e), n2);
    const vec2s u = glms_vec2_sub(from->place[1], from->place[0]);
    const vec2s v = glms_vec2_sub(from->place[2], from->place[0]);
    struct mrt_gpu_clutter_triangle to = { .normal = from->normal };
    to.u_axis = glms_vec3_add(glms_vec3_scale(by_e, u.x), glms_vec3_scale(by_f, v.x));
    to.v_axis = glms_vec3_add(glms_vec3_scale(by_e, u.y), glms_vec3_scale(by_f, v.y));
    to.offset.x = from->place[0].x - glms_vec3_dot(to.u_axis, from->corner[0]);
    to.offset.y = from->place[0].y - glms_vec3_dot(to.v_axis, from->corner[0]);
    to.low = glms_vec2_minv(from->place[0], glms_vec2_minv(from->place[1], from->place[2]));
    to.high = glms_vec2_maxv(from->place[0], glms_vec2_maxv(from->place[1], from->place[2]));
    return to;
}

static void fill_triangles(const struct mrt_runtime_input *input, void *items)
{
    const struct charts *charts = &input->clutter->map.clutter->charts;
    struct mrt_gpu_clutter_triangle *to = items;
    for (uint32_t i = 0; i < charts->triangle_count; i++)
        to[i] = triangle_of(&charts->triangles[i]);
}

static bool make_image(struct mrt_runtime *runtime)
{
    const struct mrt_runtime_clutter_map *map = &runtime->clutter.map;
    const struct gpu_image_desc desc = { .name = "clutter_map",
                                         .dimension = GPU_2D_ARRAY,
                                         .format = GPU_RGBA16F,
                                         .width = map->width,
                                         .height = map->height,
                                         .depth = 3,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    return mrt_image_of(runtime, &desc, &runtime->clutter.map.image);
}

bool mrt_clutter_map_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    const struct mrt_clutter_atlas_input *from = &input->clutter->map;
    struct mrt_runtime_clutter_map *map = &runtime->clutter.map;
    if (from->count == 0) return true;
    const size_t tiles = tiles_of(from),
                 instances = (size_t)from->clutter->walls.scene.instance_count;
    map->tile_count = (uint32_t)tiles;
    map->width = from->width;
    map->height = from->height;
    map->instance_count = (uint32_t)instances;
    map->fill_push.places = list_places(from, NULL);
    return mrt_table_upload(runtime, input, "clutter_tiles", tiles, sizeof(struct mrt_gpu_tile),
                            fill_tiles, &map->tiles) &&
           mrt_table_upload(runtime, input, "clutter_map_openings", (size_t)input->opening_count,
                            sizeof(struct mrt_gpu_opening), fill_openings, &map->openings) &&
           mrt_table_upload(runtime, input, "clutter_places", map->fill_push.places,
                            sizeof(struct mrt_gpu_clutter_place), fill_places, &map->places) &&
           mrt_table_upload(runtime, input, "clutter_instances", instances,
                            sizeof(struct mrt_gpu_clutter_instance), fill_instances,
                            &map->instances) &&
           mrt_table_upload(runtime, input, "clutter_numbers", from->clutter->scene_triangles,
                            sizeof(uint32_t), fill_numbers, &map->numbers) &&
           mrt_table_upload(
               runtime, input, "clutter_triangles", from->clutter->charts.triangle_count,
               sizeof(struct mrt_gpu_clutter_triangle), fill_triangles, &map->triangles) &&
           mrt_buffer_of(runtime, "clutter_light", NULL, tiles * MRT_LOCAL * VALUES * VEC3_BYTES,
                         &map->light) &&
           make_image(runtime) &&
           mrt_pipeline_of(runtime, "clutter_fill", &shader_mrt_runtime_clutter_fill_comp, NULL, 0,
                           &map->fill) &&
           mrt_pipeline_of(runtime, "clutter_apply", &shader_mrt_runtime_clutter_apply_comp, NULL,
                           0, &map->apply);
}

void mrt_clutter_map_end(struct mrt_runtime *runtime)
{
    struct mrt_runtime_clutter_map *m = &runtime->clutter.map;
    gpu_buffer *const buffers[] = { &m->tiles,  &m->openings,  &m->u_b,     &m->u_r,      &m->light,
                                    &m->places, &m->instances, &m->numbers, &m->triangles };
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        gpu_buffer_destroy(runtime->gpu, buffers[i]);
    gpu_image_destroy(runtime->gpu, &m->image);
    gpu_pipeline_destroy(runtime->gpu, &m->fill);
    gpu_pipeline_destroy(runtime->gpu, &m->apply);
}

// ---- passes

void mrt_record_clutter_map(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    struct mrt_runtime_clutter_map *m = &runtime->clutter.map;
    if (m->tile_count == 0) return;
    struct mrt_level_params level = runtime->level;
    level.texels_of_tile = MRT_LOCAL;
    gpu_scope_begin(cmd, "clutter_map");
    if (!m->is_clear) gpu_clear_image(cmd, m->image, (const float[4]){ 0.0f });
    m->is_clear = true;
    gpu_dispatch(cmd, runtime->pipelines.reconstruct_vector,
                 GPU_BIND(gpu_transient(cmd, "mrt_level", &level, sizeof level),
                          { .name = "mrt_tiles", .buffer = m->tiles },
                          { .name = "mrt_blocks", .buffer = runtime->buffers.blocks },
                          { .name = "mrt_openings", .buffer = m->openings },
                          { .name = "mrt_b", .buffer = runtime->buffers.b },
                          { .name = "mrt_r", .buffer = runtime->buffers.r },
                          { .name = "mrt_u_b", .buffer = m->u_b },
                          { .name = "mrt_u_r", .buffer = m->u_r },
                          { .name = "mrt_irradiance", .buffer = m->light }),
                 NULL, 0, 1, m->tile_count, 1);
    gpu_dispatch(cmd, m->fill,
                 GPU_BIND({ .name = "mrt_clutter_places", .buffer = m->places },
                          { .name = "mrt_clutter_light", .buffer = m->light },
                          { .name = "mrt_texels", .buffer = runtime->clutter.texels },
                          { .name = "clutter_map", .image = m->image }),
                 &m->fill_push, sizeof m->fill_push, gpu_groups(m->fill_push.places, MRT_LOCAL), 1,
                 1);
    gpu_scope_end(cmd);
}

// A G-buffer of the host without identifiers leaves these pixels to `apply`.
bool mrt_record_clutter_pixels(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                               const struct frame_view *view)
{
    const struct mrt_runtime_clutter_map *m = &runtime->clutter.map;
    const struct mrt_clutter_apply_push push = { m->instance_count,
                                                 m->moves ? m->instance_count : 0 };
    if (m->tile_count == 0 || !view->layers[FRAME_ID].id) return false;
    gpu_dispatch(cmd, m->apply,
                 GPU_BIND(gpu_transient(cmd, "mrt_level", &runtime->level, sizeof runtime->level),
                          view->constants_binding,
                          { .name = "mrt_clutter_instances", .buffer = m->instances },
                          gpu_transient(cmd, "mrt_clutter_moves", m->moves,
                                        m->moves ? m->instance_count * sizeof *m->moves : 0),
                          { .name = "mrt_clutter_numbers", .buffer = m->numbers },
                          { .name = "mrt_clutter_triangles", .buffer = m->triangles },
                          { .name = "clutter_map", .image = m->image, .sampler = runtime->linear },
                          { .name = "id", .image = view->layers[FRAME_ID] },
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] }),
                 &push, sizeof push, gpu_groups(view->width, MRT_LOCAL_2D),
                 gpu_groups(view->height, MRT_LOCAL_2D), 1);
    return true;
}
