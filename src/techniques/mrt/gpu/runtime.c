// Buffers, images and pipelines of a level.
#include "runtime.h"

#include "techniques/common/light_map/table.h"
#include "techniques/common/probes/volume.h"
#include "techniques/mrt/objects/delta.h"
#include "techniques/mrt/gpu/upload.h"

#include "technique_shaders.h"

#include <string.h>

enum { VEC3_BYTES = 12, VECTOR_VALUES = 4 };

static bool make_buffers(struct mrt_runtime *runtime, const struct mrt_operators *o)
{
    const size_t light = (size_t)runtime->level.texels * VEC3_BYTES;
    const size_t quad = 3 * 4 * sizeof(float), all_b = runtime->block_count * mrt_quads(o->k_b);
    return mrt_buffer_of(runtime, "mrt_area_light", NULL,
                         runtime->level.texels * sizeof(struct mrt_gpu_area_light)) &&
           mrt_buffer_of(runtime, "mrt_direct", NULL, light) &&
           mrt_buffer_of(runtime, "mrt_b_direct", NULL, all_b * quad) &&
           mrt_buffer_of(runtime, "mrt_b", NULL, all_b * quad) &&
           mrt_buffer_of(runtime, "mrt_r", NULL,
                         runtime->opening_count * mrt_quads(o->k_r) * quad) &&
           mrt_buffer_of(runtime, "mrt_irradiance", NULL, light) &&
           (!runtime->options.vector ||
            mrt_buffer_of(runtime, "mrt_vector", NULL, VECTOR_VALUES * light));
}

static bool make_image(struct mrt_runtime *runtime, const char *name, uint32_t width,
                       uint32_t height, uint32_t layers, gpu_image *out)
{
    const struct gpu_image_desc desc = { .name = name,
                                         .dimension = GPU_2D_ARRAY,
                                         .format = GPU_RGBA16F,
                                         .width = width,
                                         .height = height,
                                         .depth = layers,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    return mrt_image_of(runtime, &desc, out);
}

static bool make_table(struct mrt_runtime *runtime, const char *name, size_t count, gpu_image *out)
{
    struct gpu_image_desc desc = light_map_table(GPU_RGBA32U, count);
    desc.name = name;
    return mrt_image_of(runtime, &desc, out);
}

static size_t cells_of(const struct mrt_level_params *level)
{
    return (size_t)level->cells_x * (size_t)level->cells_y * (size_t)level->cells_z;
}

static bool make_images(struct mrt_runtime *runtime)
{
    const struct mrt_level_params *level = &runtime->level;
    return mrt_sampler_of(runtime, "linear", &runtime->linear) &&
           make_image(runtime, "light_map", level->map_width, level->map_height,
                      runtime->options.vector ? LIGHT_MAP_LAYERS : 1, &runtime->light_map) &&
           make_table(runtime, "block_rows", runtime->block_count * MRT_BLOCK_ROWS,
                      &runtime->block_rows) &&
           make_table(runtime, "cell_rows", cells_of(level), &runtime->cell_rows);
}

static bool is_affine(const struct mrt_block_map *map)
{
    for (int b = 0; b < map->count; b++)
        if (!mrt_warp_is_affine(map->blocks[b].corner)) return false;
    return true;
}

static bool has_clutter_map(const struct mrt_runtime_input *input)
{
    return input->operators->row_count > 0;
}

// VECTOR is another value of VALUES.
static void fill_constants(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    const struct light_map_columns columns = runtime->columns;
    const uint32_t values[] = {
        [MRT_CONSTANT_HALF] = runtime->options.half,
        [MRT_CONSTANT_QUADS_B] = mrt_quads(input->operators->k_b),
        [MRT_CONSTANT_QUADS_R] = mrt_quads(input->operators->k_r),
        [MRT_CONSTANT_VALUES] = 1,
        [MRT_CONSTANT_PROBES] = runtime->options.clutter,
        [MRT_CONSTANT_AFFINE] = is_affine(input->map),
        [MRT_CONSTANT_TUBES] = mrt_block_is_tube(&input->map->blocks[0]),
        [MRT_CONSTANT_CLUTTER] = input->operators->clutter_count > 0,
        [MRT_CONSTANT_SIGHT] = mrt_sight_voxels(input->operators),
        [MRT_CONSTANT_OUTDOORS] = input->images->outdoors.probes != NULL,
    };
    const bool has_backs = has_clutter_map(input) && charts_sides(&input->clutter->charts) == 2;
    struct gpu_constant *constants = runtime->objects.constants;
    for (uint32_t i = 0; i < MRT_CONSTANT_ROW_VECTOR; i++)
        constants[i] = (struct gpu_constant){ i, values[i] };
    constants[MRT_CONSTANT_ROW_VECTOR] =
        (struct gpu_constant){ MRT_CONSTANT_VALUES, VECTOR_VALUES };
    constants[MRT_CONSTANT_ROW_BACKS] = (struct gpu_constant){ LIGHT_MAP_HAS_BACKS, has_backs };
    const struct gpu_constant size[] = { { LIGHT_MAP_APPLY_WIDTH, columns.width },
                                         { LIGHT_MAP_APPLY_HEIGHT, columns.height },
                                         { LIGHT_MAP_APPLY_ROWS, columns.rows } };
    memcpy(constants + MRT_CONSTANT_ROW_COLUMNS, size, sizeof size);
    runtime->has_lists = values[MRT_CONSTANT_AFFINE] && !values[MRT_CONSTANT_TUBES];
}

enum {
    HALF = 1 << MRT_CONSTANT_HALF,
    QUADS_B = 1 << MRT_CONSTANT_QUADS_B,
    QUADS_R = 1 << MRT_CONSTANT_QUADS_R,
    VALUES = 1 << MRT_CONSTANT_VALUES,
    PROBES = 1 << MRT_CONSTANT_PROBES,
    AFFINE = 1 << MRT_CONSTANT_AFFINE,
    TUBES = 1 << MRT_CONSTANT_TUBES,
    CLUTTER = 1 << MRT_CONSTANT_CLUTTER,
    SIGHT = 1 << MRT_CONSTANT_SIGHT,
    OUTDOORS = 1 << MRT_CONSTANT_OUTDOORS,
    COLUMNS = 7 << MRT_CONSTANT_ROW_COLUMNS,
    BACKS = 1 << MRT_CONSTANT_ROW_BACKS,
    VECTOR = 1 << MRT_CONSTANT_ROW_VECTOR,
    ALL = HALF | QUADS_B | QUADS_R | CLUTTER,
};

static bool make_pipelines(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_runtime_pipelines *p = &runtime->pipelines;
    const bool vector = runtime->options.vector, lists = runtime->has_lists,
               specular = runtime->options.specular;
    const uint32_t at_pixels =
        (vector ? VECTOR : VALUES) | PROBES | AFFINE | TUBES | SIGHT | OUTDOORS;
    const bool clutter = has_clutter_map(input);
#define AT_PIXELS(name)                                                                            \
    (specular ? &shader_mrt_gpu_pixels_##name##_specular_comp                                      \
              : &shader_mrt_gpu_pixels_##name##_diffuse_comp)
    const struct {
        gpu_pipeline *out;
        const char *name;
        const struct gpu_shader *shader;
        uint32_t constants;
    } all[] = {
        { &p->direct, "direct", &shader_mrt_gpu_direct_comp, 0 },
        { &p->bright, "bright", lists ? &shader_mrt_gpu_bright_comp : NULL, HALF | QUADS_B },
        { &p->bright_light, "bright_light", lists ? &shader_mrt_gpu_bright_light_comp : NULL,
          HALF | QUADS_B | (vector ? VECTOR : VALUES) },
        { &p->project, "project", &shader_mrt_gpu_project_comp, HALF | QUADS_B },
        { &p->bounce, "bounce", &shader_mrt_gpu_bounce_comp, QUADS_B | QUADS_R },
        { &p->couple, "couple", &shader_mrt_gpu_couple_comp, HALF | QUADS_B | QUADS_R },
        { &p->reconstruct, "reconstruct", &shader_mrt_gpu_reconstruct_comp, ALL | VALUES },
        { &p->fill, "fill", &shader_mrt_gpu_fill_comp, vector ? VECTOR : VALUES },
        { &p->apply, "apply", AT_PIXELS(apply), at_pixels | COLUMNS },
        { &p->apply_clutter, "apply_clutter", clutter ? AT_PIXELS(apply_clutter) : NULL,
          at_pixels | COLUMNS },
        { &p->clutter, "clutter", clutter ? AT_PIXELS(listed_clutter) : NULL, at_pixels | BACKS },
        { &p->amid, "amid", lists ? AT_PIXELS(listed_amid) : NULL, at_pixels },
        { &p->several, "several", lists ? AT_PIXELS(listed_several) : NULL, at_pixels },
        { &p->rows, "rows", &shader_mrt_gpu_pixels_rows_comp, 0 },
        { &p->debug, "debug", &shader_mrt_gpu_debug_comp, AFFINE | TUBES },
        { &p->reconstruct_vector, "reconstruct_vector",
          vector ? &shader_mrt_gpu_reconstruct_comp : NULL, ALL | VECTOR },
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (!mrt_pipeline_of(runtime, all[i].name, all[i].shader, all[i].constants, all[i].out))
            return false;
    return true;
}

static bool make_all(struct mrt_runtime *out, const struct mrt_runtime_input *input)
{
    fill_constants(out, input);
    return mrt_tables_upload(out, input) && mrt_reflectors_upload(out, input) &&
           mrt_lookup_grid_upload(out, input->map) && mrt_probes_upload(out, input) &&
           mrt_outdoors_upload(out, input) && mrt_operators_upload(out, input) &&
           make_buffers(out, input->operators) && mrt_bright_upload(out, input->operators->k_b) &&
           make_images(out) && make_pipelines(out, input) && mrt_clutter_upload(out, input);
}

bool mrt_runtime_init(struct mrt_runtime *out, struct host *host, struct gpu *gpu,
                      const struct mrt_runtime_input *input,
                      const struct mrt_runtime_options *options)
{
    *out = (struct mrt_runtime){
        .host = host, .gpu = gpu, .options = *options, .columns = light_map_columns_for(gpu)
    };
    return make_all(out, input);
}

bool mrt_runtime_plan(struct mrt_runtime *out, struct mrt_plan *plan,
                      const struct mrt_runtime_input *input,
                      const struct mrt_runtime_options *options)
{
    *out = (struct mrt_runtime){
        .host = plan->host, .plan = plan, .options = *options, .columns = plan->columns
    };
    const bool ok = make_all(out, input);
    out->plan = NULL;
    return ok;
}

bool mrt_runtime_init_empty(struct mrt_runtime *out, struct host *host, struct gpu *gpu,
                            const struct mrt_runtime_options *options)
{
    *out = (struct mrt_runtime){ .host = host, .gpu = gpu, .options = *options };
    return mrt_probes_make_empty(out);
}

void mrt_runtime_finish(struct mrt_runtime *runtime)
{
    if (!runtime->gpu) return;
    gpu_objects_destroy(runtime->gpu, &runtime->objects, runtime);
    *runtime = (struct mrt_runtime){ 0 };
}

// ---- bytes

struct sizes {
    const struct mrt_runtime_size *of;
    uint64_t walls, texels; // of a block
    uint64_t k_b, k_r;      // padded
    uint64_t probes, probe_rows;
    uint64_t number, values; // bytes of a number of an operator; values of a texel
};

static struct sizes sizes_of(const struct mrt_runtime_size *of)
{
    const uint64_t walls = of->tube ? 1 : CUBE_FACES;
    const uint64_t probes = of->options.probes ? (uint64_t)mrt_probes_of_block(of->probes) : 0;
    return (struct sizes){ .of = of,
                           .walls = walls,
                           .texels = walls * (uint64_t)(of->resolution * of->resolution),
                           .k_b = 4 * mrt_quads(of->k_b),
                           .k_r = 4 * mrt_quads(of->k_r),
                           .probes = probes,
                           .probe_rows = MRT_PROBE_VALUES * probes,
                           .number = of->options.half ? 2 : 4,
                           .values = of->options.vector ? 1 + VECTOR_VALUES : 1 };
}

static uint64_t bytes_of_probes(const struct sizes *s)
{
    const uint64_t brick = (uint64_t)mrt_brick_texels(s->of->probes);
    // A grid of the block: places, slabs and depths.
    const uint64_t published =
        s->of->options.publish ? (sizeof(vec4s) + PROBE_VOLUME_BYTES) * s->probes : 0;
    if (!s->of->options.probes) return 8;
    return s->probe_rows * s->number * (s->k_b + CUBE_FACES * s->k_r) +
           (s->probe_rows + s->texels) * VEC3_BYTES + s->probes * sizeof(struct mrt_gpu_probe) +
           brick * (sizeof(uint32_t) + 8 * FRAME_PROBE_SLABS) + published;
}

// A basis and a response of its own, one more opening, T_b→r and T_c→r.
static uint64_t bytes_of_clutter(const struct sizes *s)
{
    const uint64_t edge = s->of->options.probes ? (uint64_t)mrt_sight_edge(s->of->probes) : 0;
    const uint64_t sight = (1 + edge * edge * edge) * sizeof(uint32_t);
    if (!s->of->has_clutter || s->of->tube) return 0;
    return s->number * (s->texels * s->k_b * (1 + s->values) +
                        (s->texels * s->values + s->probe_rows) * s->k_r + s->probe_rows * s->k_b +
                        s->k_b * s->k_r + s->k_r * s->k_r) +
           sizeof(float) * (3 * s->k_b * s->k_r + 5 * 3 * s->k_r) + sight;
}

uint64_t mrt_runtime_bytes(const struct mrt_runtime_size *size)
{
    const struct sizes s = sizes_of(size);
    const uint64_t n = (uint64_t)size->resolution;
    // A tile for each wall, RGBA16F.
    const uint64_t map = s.walls * (n + 2) * (n + 2) * 8;
    const uint64_t cells = MRT_LOOKUP_CELLS * MRT_LOOKUP_CELLS * MRT_LOOKUP_CELLS;
    return cells * 3 * sizeof(uint32_t) + light_map_table_bytes(cells, 16) +
           light_map_table_bytes(MRT_BLOCK_ROWS, 16) +
           s.texels * (sizeof(struct mrt_texel) + sizeof(struct mrt_gpu_area_light) +
                       sizeof(uint32_t) + (1 + s.values) * VEC3_BYTES) +
           s.walls * (4 * n + 4) * sizeof(struct mrt_gpu_border) +
           s.texels * s.k_b * s.number * (1 + s.values) + 3 * s.k_b * s.k_b * sizeof(float) +
           MRT_RESPONSES * s.texels * s.k_r * s.number * s.values +
           map * (size->options.vector ? LIGHT_MAP_LAYERS : 1) + mrt_bright_bytes(s.k_b) +
           bytes_of_probes(&s) + bytes_of_clutter(&s);
}
