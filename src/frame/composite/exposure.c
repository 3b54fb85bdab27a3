// Host code of the exposure passes.
#include "frame/composite/exposure.h"

#include "frame/composite/exposure_shared.h"

#include "frame_shaders.h"

#include <stddef.h>
#include <string.h>

bool exposure_init(struct exposure *e, struct gpu *gpu)
{
    *e = (struct exposure){ .gpu = gpu };
    struct gpu_sampler_desc nearest = {
        .name = "frame.nearest", .wrap_u = GPU_CLAMP, .wrap_v = GPU_CLAMP, .wrap_w = GPU_CLAMP
    };
    struct gpu_buffer_desc state = { "frame.exposure", sizeof(struct exposure_values),
                                     GPU_BUFFER_STORAGE };
    struct gpu_buffer_desc sums = { "frame.exposure_sums", EXPOSURE_MAX_GROUPS * sizeof(vec2s),
                                    GPU_BUFFER_STORAGE };
    const struct gpu_constant second_pass[] = { { EXPOSURE_CONSTANT_SECOND_PASS, true } };
    return gpu_sampler_get(gpu, &nearest, &e->nearest) &&
           gpu_buffer_create(gpu, &state, &e->state) && gpu_buffer_create(gpu, &sums, &e->sums) &&
           gpu_compute_pipeline_create(gpu, "frame.exposure_sum",
                                       &shader_composite_exposure_sum_comp, NULL, 0, &e->sum[0]) &&
           gpu_compute_pipeline_create(gpu, "frame.exposure_sum_again",
                                       &shader_composite_exposure_sum_comp, second_pass, 1,
                                       &e->sum[1]) &&
           gpu_compute_pipeline_create(gpu, "frame.exposure_finish",
                                       &shader_composite_exposure_finish_comp, NULL, 0, &e->finish);
}

void exposure_finish(struct exposure *e)
{
    if (!e->gpu) return;
    gpu_buffer_destroy(e->gpu, &e->state);
    gpu_buffer_destroy(e->gpu, &e->sums);
    for (int i = 0; i < 2; i++) gpu_pipeline_destroy(e->gpu, &e->sum[i]);
    gpu_pipeline_destroy(e->gpu, &e->finish);
    *e = (struct exposure){ 0 };
}

void exposure_record_fixed(const struct exposure *e, struct gpu_cmd *cmd, float ev)
{
    uint32_t word;
    memcpy(&word, &ev, sizeof word);
    gpu_scope_begin(cmd, "exposure");
    gpu_fill_buffer(cmd, e->state, offsetof(struct exposure_values, ev), sizeof word, word);
    gpu_scope_end(cmd);
}

static uint32_t group_count(uint32_t width, uint32_t height)
{
    uint32_t groups = gpu_groups(width * height, EXPOSURE_THREADS * EXPOSURE_PIXELS);
    return groups < EXPOSURE_MAX_GROUPS ? groups : EXPOSURE_MAX_GROUPS;
}

void exposure_record_auto(const struct exposure *e, struct gpu_cmd *cmd,
                          struct gpu_binding constants, const struct exposure_input *in)
{
    struct exposure_push push = { .groups = group_count(in->width, in->height),
                                  .emitted = in->emitted,
                                  .fallback = in->fallback };
    gpu_scope_begin(cmd, "exposure");
    for (push.pass_index = 0; push.pass_index < 2; push.pass_index++) {
        gpu_dispatch(cmd, e->sum[push.pass_index],
                     GPU_BIND(constants, { "exposure_state", .buffer = e->state },
                              { "exposure_sums", .buffer = e->sums },
                              { "direct_layer", .image = in->direct, .sampler = e->nearest },
                              { "albedo_layer", .image = in->albedo, .sampler = e->nearest },
                              { "material_layer", .image = in->material, .sampler = e->nearest },
                              { "metered_layer", .image = in->scratch }),
                     &push, sizeof push, push.groups, 1, 1);
        gpu_dispatch(cmd, e->finish,
                     GPU_BIND(constants, { "exposure_state", .buffer = e->state },
                              { "exposure_sums", .buffer = e->sums }),
                     &push, sizeof push, 1, 1, 1);
    }
    gpu_scope_end(cmd);
}

bool exposure_read(struct exposure *e, float *ev)
{
    return gpu_buffer_download(e->gpu, e->state, offsetof(struct exposure_values, ev), ev,
                               sizeof *ev);
}
