// Host code of the exposure passes.
#include "frame/composite/exposure.h"

#include "frame/composite/exposure_shared.h"

#include "frame_shaders.h"

#include <stddef.h>
#include <string.h>

bool exposure_init(struct exposure *e, struct gpu *gpu)
{
    *e = (struct exposure){ .gpu = gpu };
    struct gpu_buffer_desc state = { "frame.exposure", sizeof(struct exposure_values),
                                     GPU_BUFFER_STORAGE };
    struct gpu_buffer_desc histogram = { "frame.exposure_histogram", sizeof(struct exposure_counts),
                                         GPU_BUFFER_STORAGE };
    return gpu_buffer_create(gpu, &state, &e->state) &&
           gpu_buffer_create(gpu, &histogram, &e->histogram) &&
           gpu_compute_pipeline_create(gpu, "frame.exposure_finish",
                                       &shader_composite_exposure_finish_comp, NULL, 0, &e->finish);
}

void exposure_finish(struct exposure *e)
{
    if (!e->gpu) return;
    gpu_buffer_destroy(e->gpu, &e->state);
    gpu_buffer_destroy(e->gpu, &e->histogram);
    gpu_pipeline_destroy(e->gpu, &e->finish);
    *e = (struct exposure){ 0 };
}

void exposure_record_fixed(const struct exposure *e, struct gpu_cmd *cmd, float ev)
{
    uint32_t word;
    memcpy(&word, &ev, sizeof word);
    gpu_fill_buffer(cmd, e->state, offsetof(struct exposure_values, ev), sizeof word, word);
}

void exposure_record_clear(const struct exposure *e, struct gpu_cmd *cmd)
{
    gpu_fill_buffer(cmd, e->histogram, 0, sizeof(struct exposure_counts), 0);
}

void exposure_record_auto(const struct exposure *e, struct gpu_cmd *cmd,
                          struct gpu_binding constants, const struct exposure_push *push)
{
    gpu_dispatch(cmd, e->finish,
                 GPU_BIND(constants, { "exposure_state", .buffer = e->state },
                          { "exposure_histogram", .buffer = e->histogram }),
                 push, sizeof *push, 1, 1, 1);
}

bool exposure_read(struct exposure *e, float *ev)
{
    return gpu_buffer_download(e->gpu, e->state, offsetof(struct exposure_values, ev), ev,
                               sizeof *ev);
}
