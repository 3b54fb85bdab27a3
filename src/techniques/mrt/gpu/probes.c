// Tables, operators, images and passes of volume probes.
//
// U_bvol b and U_r r are computed by the pass for texels: a block's probes are as a tile of 9 p³
// texels without irradiance by normal.
#include "techniques/mrt/gpu/upload.h"

#include "core/sh.h"

#include "techniques/common/probes/volume.h"
#include "techniques/mrt/objects/delta.h"

#include "technique_shaders.h"

#include <math.h>

enum { VALUES = MRT_PROBE_VALUES };

static size_t rows_of_block(const struct mrt_runtime_input *input)
{
    return (size_t)(VALUES * mrt_probes_of_block(input->operators->probes));
}

// ---- tables

static void fill_tiles(const struct mrt_runtime_input *input, void *items)
{
    struct mrt_gpu_tile *tiles = items;
    const uint32_t rows = (uint32_t)rows_of_block(input);
    for (int b = 0; b < input->map->count; b++)
        tiles[b] =
            (struct mrt_gpu_tile){ .block = (uint32_t)b,
                                   .first_texel = (uint32_t)b * rows,
                                   .basis_row =
                                       (uint32_t)input->operators->basis_of_block[b] * rows };
}

static void fill_openings(const struct mrt_runtime_input *input, void *items)
{
    const struct mrt_operators *o = input->operators;
    struct mrt_gpu_opening *openings = items;
    for (int i = 0; i < o->opening_count; i++)
        openings[i] = (struct mrt_gpu_opening){
            .response = (uint32_t)o->openings[i].response * (uint32_t)rows_of_block(input),
            .quads = mrt_used_quads(o, &o->openings[i]),
        };
}

static void fill_sources(const struct mrt_runtime_input *input, void *items)
{
    uint32_t *sources = items;
    const int p = input->operators->probes, texels = mrt_brick_texels(p);
    for (int i = 0; i < input->map->count * texels; i++)
        sources[i] = (uint32_t)mrt_probe_of_brick_texel(input->map, p, i / texels, i % texels);
}

// Row i of the matrix that turns SH is coefficient i of the rotated unit vectors.
static void fill_turn(mat3s to_from, float *out)
{
    for (int k = 0; k < VALUES; k++) {
        float unit[VALUES] = { 0 }, rotated[VALUES];
        unit[k] = 1.0f;
        sh_rotate(3, to_from, unit, rotated);
        for (int i = 0; i < VALUES; i++) out[VALUES * i + k] = rotated[i];
    }
}

static void fill_turns(const struct mrt_runtime_input *input, void *items)
{
    float *turns = items;
    for (int b = 0; b < input->map->count; b++)
        fill_turn(mrt_block_rotation(&input->map->blocks[b]), turns + VALUES * VALUES * b);
}

_Static_assert(sizeof(struct mrt_area_light_probe) == sizeof(struct mrt_gpu_probe),
               "shaders read what the level has");

static bool upload_tables(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    const size_t blocks = (size_t)input->map->count;
    const size_t probes = blocks * (size_t)mrt_probes_of_block(input->operators->probes);
    const size_t texels = blocks * (size_t)mrt_brick_texels(input->operators->probes);
    return mrt_table_upload(runtime, input, "mrt_probe_tiles", blocks, sizeof(struct mrt_gpu_tile),
                            fill_tiles) &&
           mrt_table_upload(runtime, input, "mrt_probe_openings",
                            (size_t)input->operators->opening_count, sizeof(struct mrt_gpu_opening),
                            fill_openings) &&
           mrt_table_upload(runtime, input, "mrt_brick_sources", texels, sizeof(uint32_t),
                            fill_sources) &&
           mrt_table_upload(runtime, input, "mrt_probe_turns", blocks,
                            VALUES * VALUES * sizeof(float), fill_turns) &&
           mrt_buffer_of(runtime, "mrt_probe_area_light", input->images->area_light,
                         probes * sizeof(struct mrt_gpu_probe));
}

// ---- images

static bool make_bricks(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    const int blocks = input->map->count, edge = input->operators->probes + 2;
    const int columns = (int)ceil(sqrt((double)blocks));
    const struct frame_probes bricks = { .count_x = columns * edge,
                                         .count_y = (blocks + columns - 1) / columns * edge,
                                         .slab = edge };
    const struct gpu_image_desc desc = probe_volume_desc("bricks", bricks, FRAME_PROBE_SLABS);
    runtime->level.brick_columns = (uint32_t)columns;
    runtime->level.probes = (uint32_t)input->operators->probes;
    return mrt_image_of(runtime, &desc, &runtime->probes.bricks);
}

_Static_assert(MRT_VOXEL_PROBES == MRT_SIGHT_PROBES && MRT_VOXEL_OPEN == MRT_SIGHT_OPEN &&
                   MRT_VOXEL_SOLID == MRT_SIGHT_SOLID,
               "shaders read what probe_sight.c writes");

uint32_t mrt_sight_voxels(const struct mrt_operators *operators)
{
    return operators->sight ? (uint32_t)mrt_sight_edge(operators->probes) : 0;
}

static bool make_volume(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_runtime_probes *p = &runtime->probes;
    if (!runtime->options.publish) return true;
    p->grid = input->published->grid;
    const struct gpu_image_desc desc =
        probe_volume_desc("probe_volume", p->grid, FRAME_PROBE_SLABS + 1);
    return mrt_image_of(runtime, &desc, &p->volume) &&
           mrt_buffer_of(runtime, "mrt_probe_places", input->published->place,
                         probe_grid_count(p->grid) * sizeof(vec4s)) &&
           mrt_pipeline_of(runtime, "probe_volume", &shader_mrt_gpu_probe_volume_comp,
                           1u << MRT_CONSTANT_TUBES | 1u << MRT_CONSTANT_SIGHT |
                               1u << MRT_CONSTANT_OUTDOORS,
                           &p->publish);
}

bool mrt_probes_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_runtime_probes *p = &runtime->probes;
    const struct mrt_operators *o = input->operators;
    if (!mrt_buffer_of(runtime, "mrt_probe_sight", o->sight, o->sight_count * sizeof *o->sight))
        return false;
    const struct gpu_image_desc none = probe_volume_desc("bricks", probe_grid_of_one(), 1);
    if (!runtime->options.probes) return mrt_image_of(runtime, &none, &p->bricks);
    const size_t rows = (size_t)input->map->count * rows_of_block(input);
    const size_t texels = (size_t)input->atlas->texels, triple = 3 * sizeof(float);
    return upload_tables(runtime, input) &&
           mrt_buffer_of(runtime, "mrt_probe_light", NULL, rows * triple) &&
           mrt_buffer_of(runtime, "mrt_radiosity", NULL, texels * triple) &&
           make_bricks(runtime, input) && make_volume(runtime, input) &&
           mrt_pipeline_of(runtime, "bricks", &shader_mrt_gpu_bricks_comp, 0, &p->fill);
}

bool mrt_probes_make_empty(struct mrt_runtime *runtime)
{
    struct mrt_runtime_probes *p = &runtime->probes;
    p->grid = probe_grid_of_one();
    const struct gpu_image_desc desc =
        probe_volume_desc("probe_volume", p->grid, FRAME_PROBE_SLABS);
    return !runtime->options.publish || mrt_image_of(runtime, &desc, &p->volume);
}
