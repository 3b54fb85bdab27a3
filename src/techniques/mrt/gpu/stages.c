// The passes of a frame.
#include "techniques/mrt/gpu/upload.h"

#include <stddef.h>

void mrt_record_direct(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                       const struct frame_view *view, bool emitters)
{
    runtime->level.shadow_radius = view->shadow_radius;
    runtime->level.emitters = emitters ? 1.0f : 0.0f;
    mrt_record_reflectors(runtime, cmd, view);
    gpu_scope_begin(cmd, "direct");
    mrt_dispatch(runtime, cmd, runtime->pipelines.direct, GPU_BIND(FRAME_LIGHT_BINDINGS(view)),
                 NULL, 0, gpu_groups(runtime->level.texels, MRT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
    mrt_record_clutter_direct(runtime, cmd, view);
}

static void record_project(struct mrt_runtime *runtime, struct gpu_cmd *cmd, const char *light)
{
    mrt_dispatch(runtime, cmd, runtime->pipelines.project,
                 GPU_BIND({ .name = "mrt_direct", .buffer = mrt_buffer(runtime, light) }), NULL, 0,
                 runtime->block_count, 1, 1);
}

static void record_reflect(struct mrt_runtime *runtime, struct gpu_cmd *cmd, float feedback)
{
    runtime->level.feedback = feedback;
    mrt_dispatch(runtime, cmd, runtime->pipelines.bounce, MRT_NO_BINDINGS, NULL, 0,
                 runtime->block_count, 1, 1);
}

static void record_couple(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    if (runtime->clutter.opening_count > 0)
        mrt_record_clutter_couple(runtime, cmd);
    else
        mrt_dispatch(runtime, cmd, runtime->pipelines.couple, MRT_NO_BINDINGS, NULL, 0,
                     runtime->opening_count, 1, 1);
}

static void record_reconstruct(struct mrt_runtime *runtime, struct gpu_cmd *cmd, bool vector)
{
    const uint32_t texels = runtime->level.texels_of_tile, tiles = runtime->level.tiles;
    const struct mrt_reconstruct irradiance = { false,     "mrt_tiles", "mrt_openings",
                                                "mrt_u_b", "mrt_u_r",   "mrt_irradiance",
                                                texels,    tiles };
    const struct mrt_reconstruct by_normal = {
        true,         "mrt_tiles", "mrt_openings", "mrt_u_b_vector", "mrt_u_r_vector",
        "mrt_vector", texels,      tiles
    };
    mrt_record_reconstruct(runtime, cmd, vector ? &by_normal : &irradiance);
}

void mrt_record_bounces(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                        const struct mrt_bounces *bounces)
{
    gpu_scope_begin(cmd, "b");
    record_project(runtime, cmd, "mrt_direct");
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "bounces");
    for (int i = 0; i < bounces->count; i++) {
        record_reflect(runtime, cmd, mrt_weight_of_bounce(bounces, i));
        record_couple(runtime, cmd);
    }
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "reconstruct");
    record_reconstruct(runtime, cmd, false);
    gpu_scope_end(cmd);
}

void mrt_record_coefficients(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    if (!runtime->options.probes) return;
    gpu_scope_begin(cmd, "b");
    record_project(runtime, cmd, "mrt_radiosity");
    record_reflect(runtime, cmd, 0.0f);
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "r");
    record_couple(runtime, cmd);
    gpu_scope_end(cmd);
}

// Without `vector` no buffer has irradiance by normal, and none is read.
static void record_fill(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    const struct mrt_level_params *level = &runtime->level;
    const char *vector = runtime->options.vector ? "mrt_vector" : "mrt_irradiance";
    mrt_dispatch(runtime, cmd, runtime->pipelines.fill,
                 GPU_BIND({ .name = "mrt_vector", .buffer = mrt_buffer(runtime, vector) },
                          { .name = "light_map", .image = runtime->light_map }),
                 NULL, 0, gpu_groups(level->texels + level->borders, MRT_LOCAL), 1, 1);
}

void mrt_record_light_map(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    gpu_scope_begin(cmd, "light_map");
    if (runtime->options.vector) record_reconstruct(runtime, cmd, true);
    record_fill(runtime, cmd);
    gpu_scope_end(cmd);
    mrt_record_clutter_map(runtime, cmd);
}

// U_bvol b and U_r r, in the frames of the cells.
static void record_probe_light(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    const uint32_t edge = runtime->level.probes, rows = MRT_PROBE_VALUES * edge * edge * edge;
    mrt_record_reconstruct(runtime, cmd,
                           &(struct mrt_reconstruct){
                               false, "mrt_probe_tiles", "mrt_probe_openings", "mrt_u_b_probes",
                               "mrt_u_r_probes", "mrt_probe_light", rows, runtime->block_count });
}

static void record_bricks(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                          const struct frame_view *view)
{
    const struct mrt_runtime_probes *p = &runtime->probes;
    const uint32_t texels = (uint32_t)mrt_brick_texels((int)runtime->level.probes);
    mrt_dispatch(runtime, cmd, p->fill,
                 GPU_BIND(view->constants_binding, { .name = "bricks", .image = p->bricks }), NULL,
                 0, gpu_groups(texels, MRT_LOCAL), runtime->block_count, 1);
}

static void record_volume(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    const struct mrt_runtime_probes *p = &runtime->probes;
    mrt_dispatch(
        runtime, cmd, p->publish,
        GPU_BIND(
            { .name = "bricks", .image = p->bricks, .sampler = runtime->linear },
            { .name = "outdoors", .image = runtime->outdoors.image, .sampler = runtime->linear },
            { .name = "volume", .image = p->volume }),
        &p->grid, sizeof p->grid, gpu_groups(probe_grid_count(p->grid), MRT_LOCAL), 1, 1);
}

void mrt_record_probes(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                       const struct frame_view *view, float gain)
{
    if (!runtime->options.probes) return;
    runtime->level.gain = gain;
    gpu_scope_begin(cmd, "probes");
    record_probe_light(runtime, cmd);
    record_bricks(runtime, cmd, view);
    if (runtime->options.publish) record_volume(runtime, cmd);
    gpu_scope_end(cmd);
}

void mrt_record_outdoors(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                         const struct frame_view *view)
{
    const uint32_t count = probe_grid_count(runtime->level.outdoors);
    if (count == 0) return;
    gpu_scope_begin(cmd, "outdoors");
    mrt_dispatch(
        runtime, cmd, runtime->outdoors.fill,
        GPU_BIND(view->constants_binding, { .name = "outdoors", .image = runtime->outdoors.image }),
        NULL, 0, gpu_groups(count, MRT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

static void record_rows(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    const struct mrt_level_params *level = &runtime->level;
    const struct mrt_rows_push push = {
        runtime->block_count, (uint32_t)(level->cells_x * level->cells_y * level->cells_z)
    };
    if (runtime->has_rows) return;
    runtime->has_rows = true;
    gpu_scope_begin(cmd, "rows");
    mrt_dispatch(runtime, cmd, runtime->pipelines.rows,
                 GPU_BIND({ .name = "block_rows", .image = runtime->block_rows },
                          { .name = "cell_rows", .image = runtime->cell_rows }),
                 &push, sizeof push, gpu_groups(push.blocks + push.cells, MRT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

static void clear_list(struct gpu_cmd *cmd, gpu_buffer list)
{
    const size_t ones = offsetof(struct mrt_list_header, groups[1]);
    gpu_fill_buffer(cmd, list, 0, ones, 0);
    gpu_fill_buffer(cmd, list, ones, sizeof(struct mrt_list_header) - ones, 1);
}

// Bindings of the passes over pixels.
#define PIXEL_BINDINGS(runtime, view)                                                              \
    FRAME_SURFACE_BINDINGS(view),                                                                  \
        { .name = "light_map", .image = (runtime)->light_map, .sampler = (runtime)->linear },      \
        { .name = "bricks", .image = (runtime)->probes.bricks, .sampler = (runtime)->linear },     \
        { .name = "outdoors", .image = (runtime)->outdoors.image, .sampler = (runtime)->linear },  \
        { .name = "block_rows", .image = (runtime)->block_rows },                                  \
        { .name = "cell_rows", .image = (runtime)->cell_rows },                                    \
        { .name = "irradiance", .image = (view)->layers[FRAME_IRRADIANCE] },                       \
    {                                                                                              \
        .name = "specular", .image = (view)->layers[FRAME_SPECULAR]                                \
    }

// A G-buffer of the host without identifiers does not show which pixels are of clutter.
static bool finds_clutter(const struct mrt_runtime *runtime, const struct frame_view *view)
{
    return runtime->clutter.map.tile_count > 0 && view->layers[FRAME_ID].id;
}

static void record_pixels(const struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                          const struct frame_view *view, const struct mrt_pixel_lists *lists)
{
    const struct light_map_columns *columns = &runtime->columns;
    const struct mrt_runtime_pipelines *p = &runtime->pipelines;
    mrt_dispatch(runtime, cmd, finds_clutter(runtime, view) ? p->apply_clutter : p->apply,
                 GPU_BIND(PIXEL_BINDINGS(runtime, view),
                          LIGHT_MAP_SURFACE_BINDINGS(&runtime->clutter.map.surfaces, cmd),
                          { .name = "id", .image = view->layers[FRAME_ID] },
                          { .name = "amid_list", .buffer = lists->amid },
                          { .name = "several_list", .buffer = lists->several },
                          { .name = "clutter_list", .buffer = lists->clutter }),
                 NULL, 0, gpu_groups(view->width, columns->width),
                 gpu_groups(view->height, columns->height * columns->rows), 1);
}

static void record_list(const struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                        const struct frame_view *view, gpu_pipeline pipeline, gpu_buffer list)
{
    mrt_dispatch_indirect(runtime, cmd, pipeline,
                          GPU_BIND(PIXEL_BINDINGS(runtime, view),
                                   LIGHT_MAP_SURFACE_BINDINGS(&runtime->clutter.map.surfaces, cmd),
                                   { .name = "id", .image = view->layers[FRAME_ID] },
                                   { .name = "clutter_map",
                                     .image = runtime->clutter.map.image,
                                     .sampler = runtime->linear },
                                   { .name = "pixel_list", .buffer = list }),
                          list, offsetof(struct mrt_list_header, groups));
}

void mrt_record_apply(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                      const struct frame_view *view, const struct mrt_pixel_lists *lists,
                      float gain)
{
    const struct mrt_runtime_pipelines *p = &runtime->pipelines;
    runtime->level.gain = gain;
    runtime->level.has_dielectric = view->layers[FRAME_DIELECTRIC].id != 0;
    struct light_map_surfaces *clutter = &runtime->clutter.map.surfaces;
    clutter->first = mrt_buffer(runtime, "mrt_clutter_first_triangles");
    clutter->triangles = mrt_buffer(runtime, "mrt_clutter_triangles");
    runtime->level.clutter = light_map_instances(clutter);
    record_rows(runtime, cmd);
    gpu_scope_begin(cmd, "apply");
    light_map_clear_pixels(cmd, view);
    clear_list(cmd, lists->amid);
    clear_list(cmd, lists->several);
    if (finds_clutter(runtime, view)) clear_list(cmd, lists->clutter);
    record_pixels(runtime, cmd, view, lists);
    if (finds_clutter(runtime, view)) record_list(runtime, cmd, view, p->clutter, lists->clutter);
    if (runtime->has_lists) {
        record_list(runtime, cmd, view, p->amid, lists->amid);
        record_list(runtime, cmd, view, p->several, lists->several);
    }
    gpu_scope_end(cmd);
}

void mrt_record_debug(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                      const struct frame_view *view, uint32_t debug_view, gpu_image out)
{
    const struct mrt_view_push push = { debug_view };
    gpu_scope_begin(cmd, "debug");
    mrt_dispatch(runtime, cmd, runtime->pipelines.debug,
                 GPU_BIND(view->constants_binding,
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "scene", .image = view->layers[FRAME_DIRECT] },
                          { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] },
                          { .name = "debug_image", .image = out }),
                 &push, sizeof push, gpu_groups(view->width, MRT_LOCAL_2D),
                 gpu_groups(view->height, MRT_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}
