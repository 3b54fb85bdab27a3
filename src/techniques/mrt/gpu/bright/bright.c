// The first bounce of bright texels by form factors, where all blocks are affine cubes.
#include "techniques/mrt/gpu/upload.h"

bool mrt_bright_upload(struct mrt_runtime *runtime, int k_b)
{
    const size_t blocks = runtime->block_count;
    return mrt_buffer_of(runtime, "mrt_bright_counts", NULL, blocks * sizeof(uint32_t)) &&
           mrt_buffer_of(runtime, "mrt_bright_texels", NULL,
                         blocks * MRT_BRIGHT_TEXELS * sizeof(struct mrt_gpu_bright_texel)) &&
           mrt_buffer_of(runtime, "mrt_b_bright", NULL,
                         blocks * mrt_quads(k_b) * 3 * 4 * sizeof(float));
}

uint64_t mrt_bright_bytes(uint64_t k_b)
{
    return sizeof(uint32_t) + MRT_BRIGHT_TEXELS * sizeof(struct mrt_gpu_bright_texel) +
           3 * k_b * sizeof(float);
}

void mrt_record_bright(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    const struct mrt_level_params *level = &runtime->level;
    const char *vector = runtime->options.vector ? "mrt_u_b_vector" : "mrt_u_b";
    if (!runtime->has_lists) return;
    gpu_scope_begin(cmd, "bright");
    mrt_dispatch(runtime, cmd, runtime->pipelines.bright, MRT_NO_BINDINGS, NULL, 0,
                 runtime->block_count, 1, 1);
    mrt_dispatch(runtime, cmd, runtime->pipelines.bright_light,
                 GPU_BIND({ .name = "mrt_u_b_vector", .buffer = mrt_buffer(runtime, vector) }),
                 NULL, 0, gpu_groups(level->texels_of_tile, MRT_LOCAL), level->tiles, 1);
    gpu_scope_end(cmd);
}
