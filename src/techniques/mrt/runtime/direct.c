// Direct light of texels of walls and of clutter.
#include "runtime.h"

void mrt_record_direct_of(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                          const struct frame_view *view, const struct mrt_direct_texels *texels)
{
    gpu_dispatch(
        cmd, runtime->pipelines.direct,
        GPU_BIND(
            view->constants_binding, view->lights_binding, view->shadow_faces_binding,
            { .name = "shadow_maps", .image = view->shadow_maps, .sampler = view->shadow_sampler },
            { .name = "shadow_sun_maps",
              .image = view->shadow_sun_maps,
              .sampler = view->shadow_sampler },
            gpu_transient(cmd, "mrt_level", texels->level, sizeof *texels->level),
            { .name = "mrt_texels", .buffer = texels->texels },
            { .name = "mrt_unbounced", .buffer = texels->unbounced },
            { .name = "mrt_direct", .buffer = texels->radiosity }),
        NULL, 0, gpu_groups(texels->level->texels, MRT_LOCAL), 1, 1);
}
