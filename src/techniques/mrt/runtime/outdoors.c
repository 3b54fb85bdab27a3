// Table, image and pass of the grid of outdoor probes.
#include "outdoors.h"

#include "techniques/mrt/runtime/objects.h"
#include "techniques/mrt/runtime/tables.h"

#include "technique_shaders.h"

#include <string.h>

static bool make_image(struct mrt_runtime *runtime, const int count[3], gpu_image *out)
{
    const struct gpu_image_desc desc = { .name = "outdoors",
                                         .dimension = GPU_3D,
                                         .format = GPU_RGBA16F,
                                         .width = (uint32_t)count[0],
                                         .height = (uint32_t)count[1],
                                         .depth = FRAME_PROBE_SLABS * (uint32_t)count[2],
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    return mrt_image_of(runtime, &desc, out);
}

static bool upload_table(struct mrt_runtime *runtime, const struct mrt_outdoors *outdoors)
{
    const int *points = outdoors->grid.count;
    const size_t count = (size_t)(points[0] * points[1] * points[2]);
    struct mrt_gpu_outdoor_probe *items = host_alloc(runtime->host, count, sizeof *items);
    if (!items) return false;
    for (size_t i = 0; i < count; i++) {
        const struct mrt_outdoor_probe *from = &outdoors->probes[i];
        memcpy(items[i].light.emitted, from->light.emitted, sizeof items[i].light.emitted);
        memcpy(items[i].light.sky, from->light.sky, sizeof items[i].light.sky);
        items[i].open = from->open;
    }
    const bool ok = mrt_buffer_of(runtime, "outdoor_probes", items, count * sizeof *items,
                                  &runtime->outdoors.probes);
    host_free(runtime->host, items);
    return ok;
}

bool mrt_outdoors_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    const struct mrt_outdoors *outdoors = &input->images->outdoors;
    const int none[3] = { 1, 1, 1 };
    if (!outdoors->probes) return make_image(runtime, none, &runtime->outdoors.image);
    runtime->level.outdoors_m = outdoors->grid.first_m;
    runtime->level.outdoors_spacing_m = outdoors->grid.spacing_m;
    runtime->level.outdoors_x = outdoors->grid.count[0];
    runtime->level.outdoors_y = outdoors->grid.count[1];
    runtime->level.outdoors_z = outdoors->grid.count[2];
    return make_image(runtime, outdoors->grid.count, &runtime->outdoors.image) &&
           upload_table(runtime, outdoors) &&
           mrt_pipeline_of(runtime, "outdoors", &shader_mrt_runtime_outdoors_comp, NULL, 0,
                           &runtime->outdoors.fill);
}

void mrt_outdoors_end(struct mrt_runtime *runtime)
{
    gpu_buffer_destroy(runtime->gpu, &runtime->outdoors.probes);
    gpu_image_destroy(runtime->gpu, &runtime->outdoors.image);
    gpu_pipeline_destroy(runtime->gpu, &runtime->outdoors.fill);
}
