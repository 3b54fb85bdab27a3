// The light map of clutter: tables and passes. Its texels are to reconstruct.comp as those of walls
// by normal, in tiles of MRT_LOCAL.
#include "techniques/mrt/gpu/upload.h"

#include "techniques/mrt/dictionary/rays.h"

#include "technique_shaders.h"

enum { VALUES = MRT_VECTOR_COEFFICIENTS, VEC3_BYTES = 12 };

// ---- tables

static size_t tiles_of(const struct mrt_operators *o)
{
    size_t tiles = 0;
    for (int i = 0; i < o->row_count; i++)
        tiles += mrt_clutter_map_tiles((size_t)o->rows[i].texel_count);
    return tiles;
}

static void fill_tiles(const struct mrt_runtime_input *input, void *items)
{
    const struct mrt_operators *o = input->operators;
    struct mrt_gpu_tile *tile = items;
    uint32_t first = 0;
    for (int i = 0; i < o->row_count; i++) {
        const size_t tiles = mrt_clutter_map_tiles((size_t)o->rows[i].texel_count);
        for (uint32_t k = 0; k < tiles; k++)
            *tile++ = (struct mrt_gpu_tile){ .block = (uint32_t)o->rows[i].block,
                                             .first_texel = first + k * MRT_LOCAL,
                                             .basis_row = first + k * MRT_LOCAL,
                                             .response_row = k * MRT_LOCAL };
        first += (uint32_t)tiles * MRT_LOCAL;
    }
}

// Quads of an opening up to the last coefficient that lights the clutter.
static uint32_t quads_of(const struct matrix_f32 *u_r)
{
    size_t used = 0;
    for (size_t r = 0; r < u_r->rows; r++)
        for (size_t c = u_r->columns; c > used; c--)
            if (u_r->at[r * u_r->stride + c - 1] != 0.0f) used = c;
    return (uint32_t)(used + 3) / 4;
}

// Openings of blocks without clutter stay empty: no tile reads them.
static void fill_openings(const struct mrt_runtime_input *input, void *items)
{
    const struct mrt_operators *o = input->operators;
    struct mrt_gpu_opening *openings = items;
    uint32_t row = 0;
    for (int i = 0; i < o->opening_count; i++) {
        const struct mrt_clutter_rows *rows = mrt_rows_of(o, o->openings[i].block);
        if (!rows) continue;
        openings[i].response = row;
        openings[i].quads = quads_of(&o->openings[i].at_clutter);
        row += (uint32_t)mrt_clutter_map_tiles((size_t)rows->texel_count) * MRT_LOCAL;
    }
}

// Index of the light of a texel of clutter.
static uint32_t light_of(const struct mrt_operators *o, uint32_t texel)
{
    uint32_t first = 0;
    for (int k = 0; k < o->row_count; k++) {
        const struct mrt_clutter_rows *rows = &o->rows[k];
        const uint32_t local = texel - (uint32_t)rows->first_texel;
        if (texel >= (uint32_t)rows->first_texel && local < (uint32_t)rows->texel_count)
            return first + local;
        first += (uint32_t)mrt_clutter_map_tiles((size_t)rows->texel_count) * MRT_LOCAL;
    }
    return CHART_NONE;
}

// Places with light. `out` may be NULL.
static uint32_t list_places(const struct mrt_runtime_input *input,
                            struct mrt_gpu_clutter_place *out)
{
    uint32_t count = 0;
    const struct charts *charts = &input->clutter->charts;
    for (size_t i = 0; i < charts_place_count(charts); i++) {
        const uint32_t texel = input->operators->map_source[i];
        const uint32_t light = texel == CHART_NONE ? CHART_NONE : light_of(input->operators, texel);
        if (light == CHART_NONE) continue;
        if (out)
            out[count] =
                (struct mrt_gpu_clutter_place){ light_map_place_word(charts, i), light, texel };
        count++;
    }
    return count;
}

static void fill_places(const struct mrt_runtime_input *input, void *items)
{
    list_places(input, items);
}

static size_t triangles_of(const struct mrt_clutter *clutter)
{
    return clutter->scene_triangle_0[clutter->walls.scene.instance_count];
}

static void fill_triangles(const struct mrt_runtime_input *input, void *items)
{
    const struct mrt_clutter *clutter = input->clutter;
    light_map_fill_triangles(&clutter->charts, clutter->scene_chart_triangle, triangles_of(clutter),
                             items);
}

bool mrt_clutter_map_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    const struct mrt_clutter *clutter = input->clutter;
    struct mrt_runtime_clutter_map *map = &runtime->clutter.map;
    if (input->operators->row_count == 0) return true;
    const struct gpu_image_desc image =
        light_map_image(&clutter->charts, "clutter_map", LIGHT_MAP_LAYERS);
    const size_t tiles = tiles_of(input->operators),
                 instances = (size_t)clutter->walls.scene.instance_count;
    map->tile_count = (uint32_t)tiles;
    map->surfaces.count = (uint32_t)instances;
    map->fill_push.places = list_places(input, NULL);
    return mrt_table_upload(runtime, input, "mrt_clutter_tiles", tiles, sizeof(struct mrt_gpu_tile),
                            fill_tiles) &&
           mrt_table_upload(runtime, input, "mrt_clutter_map_openings", runtime->opening_count,
                            sizeof(struct mrt_gpu_opening), fill_openings) &&
           mrt_table_upload(runtime, input, "mrt_clutter_places", map->fill_push.places,
                            sizeof(struct mrt_gpu_clutter_place), fill_places) &&
           mrt_buffer_of(runtime, "mrt_clutter_first_triangles", clutter->scene_triangle_0,
                         (instances + 1) * sizeof(uint32_t)) &&
           mrt_table_upload(runtime, input, "mrt_clutter_triangles", triangles_of(clutter),
                            sizeof(struct light_map_triangle), fill_triangles) &&
           mrt_buffer_of(runtime, "mrt_clutter_light", NULL,
                         tiles * MRT_LOCAL * VALUES * VEC3_BYTES) &&
           mrt_image_of(runtime, &image, &map->image) &&
           mrt_pipeline_of(runtime, "clutter_fill", &shader_mrt_gpu_clutter_fill_comp, 0,
                           &map->fill);
}

// ---- passes

void mrt_record_clutter_map(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    struct mrt_runtime_clutter_map *m = &runtime->clutter.map;
    if (m->tile_count == 0) return;
    gpu_scope_begin(cmd, "clutter_map");
    if (!m->is_clear) gpu_clear_image(cmd, m->image, (const float[4]){ 0.0f });
    m->is_clear = true;
    mrt_record_reconstruct(runtime, cmd,
                           &(struct mrt_reconstruct){ true, "mrt_clutter_tiles",
                                                      "mrt_clutter_map_openings", "mrt_clutter_u_b",
                                                      "mrt_clutter_u_r", "mrt_clutter_light",
                                                      MRT_LOCAL, m->tile_count });
    mrt_dispatch(
        runtime, cmd, m->fill,
        GPU_BIND({ .name = "mrt_texels", .buffer = mrt_buffer(runtime, "mrt_clutter_texels") },
                 { .name = "clutter_map", .image = m->image }),
        &m->fill_push, sizeof m->fill_push, gpu_groups(m->fill_push.places, MRT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}
