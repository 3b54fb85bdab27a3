// Light of b and r at texels: of walls, of clutter, of probes.
#include "techniques/mrt/gpu/upload.h"

void mrt_record_reconstruct(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                            const struct mrt_reconstruct *what)
{
    const struct mrt_runtime_pipelines *p = &runtime->pipelines;
    struct mrt_level_params level = runtime->level;
    level.texels_of_tile = what->texels_of_tile;
    mrt_dispatch(
        runtime, cmd, what->vector ? p->reconstruct_vector : p->reconstruct,
        GPU_BIND(gpu_transient(cmd, "mrt_level", &level, sizeof level),
                 { .name = "mrt_tiles", .buffer = mrt_buffer(runtime, what->tiles) },
                 { .name = "mrt_openings", .buffer = mrt_buffer(runtime, what->openings) },
                 { .name = "mrt_u_b", .buffer = mrt_buffer(runtime, what->u_b) },
                 { .name = "mrt_u_r", .buffer = mrt_buffer(runtime, what->u_r) },
                 { .name = "mrt_irradiance", .buffer = mrt_buffer(runtime, what->irradiance) }),
        NULL, 0, gpu_groups(level.texels_of_tile, MRT_LOCAL), what->tile_count, 1);
}
