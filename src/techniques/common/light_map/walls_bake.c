// The stage that finds lookups beside walls.
#include "techniques/common/light_map/tensors.h"

#include "bake/plan.h"
#include "techniques/common/light_map/map_shared.h"
#include "trace/texels/close.h"
#include "trace/texels/walls.h"

#include <math.h>

// RAYS_PER_TEXEL: short rays of a texel, a few of which are beside walls.
enum { TEXELS_PER_TASK = 512, RAYS_PER_TEXEL = 32 };

static uint32_t snorm(float value, float steps)
{
    return (uint32_t)(int32_t)lrintf(fminf(fmaxf(value, -1.0f), 1.0f) * steps);
}

static void pack(const struct texel_wall *wall, uint32_t out[2])
{
    out[0] = (snorm(wall->normal[0], 127.0f) & 0xffu) |
             (snorm(wall->normal[1], 127.0f) & 0xffu) << 8 | snorm(wall->offset, 32767.0f) << 16;
    out[1] = 0;
    for (int side = 0; side < WALL_SIDES; side++)
        for (int quarter = 0; quarter < WALL_QUARTERS; quarter++) {
            const uint8_t *lookup = wall->lookup[side][quarter];
            const uint32_t code = (uint32_t)lookup[0] | (uint32_t)lookup[1] << 2;
            out[1] |= code << (LIGHT_MAP_WALL_SIDE * side + LIGHT_MAP_WALL_QUARTER * quarter);
        }
}

static bool run_walls(const struct bake_task *task)
{
    const struct seam_closing *closing = task->argument;
    const struct tensor *points = bake_task_input(task, LIGHT_MAP_POINT);
    uint64_t count, first = bake_task_rows(task, 0, &count);
    if (!points) return false;
    for (uint64_t i = 0; i < count && first + i < closing->charts->side_texel_count; i++) {
        if (bake_task_cancelled(task)) return false;
        const struct texel_wall wall =
            texel_find_wall(closing->trace, closing->charts, points->data, (uint32_t)(first + i));
        pack(&wall, bake_row(task, 0, i));
    }
    return true;
}

bool light_map_add_walls(struct bake_plan *plan, const struct seam_closing *closing,
                         const struct charts *charts)
{
    const uint64_t rows = light_map_rows(charts->side_texel_count);
    const size_t tasks = (size_t)((rows + TEXELS_PER_TASK - 1) / TEXELS_PER_TASK);
    const struct bake_output out[] = {
        { LIGHT_MAP_WALL, TENSOR_U32, 2, { rows, 2 }, BAKE_ROWS, BAKE_SAVED }
    };
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = "walls",
                                    .wave = 1,
                                    .task_count = tasks,
                                    .run = run_walls,
                                    .argument = closing,
                                    .outputs = out,
                                    .output_count = 1,
                                    .rays = (double)rows * RAYS_PER_TEXEL / (double)tasks });
}
