// Tables and pass of reflectors.
#include "techniques/mrt/gpu/upload.h"

#include "technique_shaders.h"

_Static_assert(sizeof(struct mrt_reflector_share) == sizeof(struct mrt_gpu_reflector_share),
               "shaders read what the level has");

enum { BOUNCES = 3 }; // between reflectors; odd

static void fill_reflectors(const struct mrt_runtime_input *input, void *items)
{
    if (input->reflectors) mrt_fill_texels(input->reflectors->at, input->reflectors->count, items);
}

bool mrt_reflectors_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    static const struct mrt_reflectors none;
    const struct mrt_reflectors *from = input->reflectors ? input->reflectors : &none;
    runtime->level.reflectors = from->count;
    return mrt_table_upload(runtime, input, "mrt_reflectors", from->count, sizeof(struct mrt_texel),
                            fill_reflectors) &&
           mrt_buffer_of(runtime, "mrt_reflector_shares", from->shares,
                         from->share_count * sizeof *from->shares) &&
           mrt_buffer_of(runtime, "mrt_reflector_direct", NULL, from->count * sizeof(vec3s)) &&
           mrt_buffer_of(runtime, "mrt_reflector_light", NULL, from->count * sizeof(vec3s)) &&
           mrt_buffer_of(runtime, "mrt_reflector_other", NULL, from->count * sizeof(vec3s)) &&
           mrt_pipeline_of(runtime, "reflectors", &shader_mrt_gpu_reflectors_comp, 0,
                           &runtime->pipelines.reflectors) &&
           mrt_pipeline_of(runtime, "reflectors_bounce", &shader_mrt_gpu_reflectors_bounce_comp, 0,
                           &runtime->pipelines.reflectors_bounce);
}

// Two buffers take turns; the last bounce is in mrt_reflector_light.
static void record_bounce(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                          struct gpu_binding texels, int i)
{
    static const char *const turns[] = { "mrt_reflector_light", "mrt_reflector_other" };
    const char *from = i == 0 ? "mrt_reflector_direct" : turns[(i + 1) % 2], *to = turns[i % 2];
    mrt_dispatch(runtime, cmd, runtime->pipelines.reflectors_bounce,
                 GPU_BIND(texels,
                          { .name = "mrt_reflector_light", .buffer = mrt_buffer(runtime, from) },
                          { .name = "mrt_reflector_bounced", .buffer = mrt_buffer(runtime, to) }),
                 NULL, 0, gpu_groups(runtime->level.reflectors, MRT_LOCAL), 1, 1);
}

void mrt_record_reflectors(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                           const struct frame_view *view)
{
    const struct gpu_binding texels = { .name = "mrt_texels",
                                        .buffer = mrt_buffer(runtime, "mrt_reflectors") };
    const uint32_t groups = gpu_groups(runtime->level.reflectors, MRT_LOCAL);
    if (groups == 0) return;
    gpu_scope_begin(cmd, "reflectors");
    mrt_dispatch(runtime, cmd, runtime->pipelines.reflectors,
                 GPU_BIND(FRAME_LIGHT_BINDINGS(view), texels), NULL, 0, groups, 1, 1);
    for (int i = 0; i < BOUNCES; i++) record_bounce(runtime, cmd, texels, i);
    gpu_scope_end(cmd);
}
