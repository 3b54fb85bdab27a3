// Table, image and pass of the grid of outdoor probes.
#include "techniques/mrt/gpu/upload.h"

#include "techniques/common/probes/volume.h"

#include "technique_shaders.h"

_Static_assert(sizeof(struct mrt_outdoor_probe) == sizeof(struct mrt_gpu_outdoor_probe),
               "shaders read what the level has");

bool mrt_outdoors_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    const struct mrt_outdoors *from = &input->images->outdoors;
    const struct frame_probes grid = from->probes ? from->grid : probe_grid_of_one();
    const struct gpu_image_desc desc = probe_volume_desc("outdoors", grid, FRAME_PROBE_SLABS);
    if (!mrt_image_of(runtime, &desc, &runtime->outdoors.image)) return false;
    if (!from->probes) return true;
    runtime->level.outdoors = grid;
    return mrt_buffer_of(runtime, "mrt_outdoor_probes", from->probes,
                         probe_grid_count(grid) * sizeof *from->probes) &&
           mrt_pipeline_of(runtime, "outdoors", &shader_mrt_gpu_outdoors_comp, 0,
                           &runtime->outdoors.fill);
}
