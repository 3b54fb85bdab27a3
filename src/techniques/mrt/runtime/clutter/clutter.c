// Tables and passes of clutter.
#include "techniques/mrt/runtime/clutter/clutter.h"

#include "techniques/mrt/runtime/objects.h"
#include "techniques/mrt/runtime/operators.h"
#include "techniques/mrt/runtime/tables.h"

#include "technique_shaders.h"

static uint32_t slots_of(const struct mrt_runtime_input *input)
{
    return 4 * mrt_quads(input->k_r);
}

// ---- tables

static void fill_reflectance(const struct mrt_runtime_input *input, void *items)
{
    float *reflectance = items;
    const uint32_t slots = slots_of(input);
    for (int i = 0; i < input->clutter->face_count; i++) {
        const struct mrt_clutter_face_input *face = &input->clutter->faces[i];
        const uint32_t clutter = mrt_clutter_of_opening(input->clutter, face->opening);
        for (uint32_t c = 0; c < 3; c++)
            reflectance[(3 * clutter + c) * slots + (uint32_t)face->slot] =
                face->reflectance.raw[c];
    }
}

static uint32_t clutter_of_block(const struct mrt_runtime_input *input, int block)
{
    uint32_t i = 0;
    while (input->openings[input->clutter->openings[i]].block != block) i++;
    return i;
}

static bool upload_senders(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    uint32_t count = 0;
    const uint32_t slots = slots_of(input);
    for (int i = 0; i < input->opening_count; i++) count += mrt_senders(input, i, NULL);
    struct mrt_sender *senders = host_alloc(runtime->host, count, sizeof *senders);
    uint32_t *at = host_alloc(runtime->host, count, sizeof *at);
    bool ok = senders && at;
    for (int i = 0, next = 0; ok && i < input->opening_count; i++)
        next += (int)mrt_senders(input, i, senders + next);
    for (uint32_t i = 0; ok && i < count; i++)
        at[i] = clutter_of_block(input, senders[i].block) * 3 * slots + (uint32_t)senders[i].slot;
    ok = ok && mrt_buffer_of(runtime, "clutter_senders", at, count * sizeof *at,
                             &runtime->clutter.senders);
    host_free(runtime->host, senders);
    host_free(runtime->host, at);
    return ok;
}

bool mrt_clutter_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_runtime_clutter *c = &runtime->clutter;
    if (!input->clutter) return true;
    const size_t openings = (size_t)input->clutter->opening_count;
    const size_t coefficients = 3 * slots_of(input) * sizeof(float);
    c->opening_count = (uint32_t)openings;
    return mrt_clutter_direct_upload(runtime, input) &&
           mrt_table_upload(runtime, input, "clutter_reflectance", openings, coefficients,
                            fill_reflectance, &c->reflectance) &&
           upload_senders(runtime, input) &&
           mrt_table_upload(runtime, input, "clutter_reflected", openings, coefficients, NULL,
                            &c->reflected[0]) &&
           mrt_table_upload(runtime, input, "clutter_reflected", openings, coefficients, NULL,
                            &c->reflected[1]) &&
           mrt_pipeline_of(runtime, "clutter_couple", &shader_mrt_runtime_clutter_couple_comp,
                           1u << MRT_CONSTANT_QUADS_R | 1u << MRT_CONSTANT_QUADS_B |
                               1u << MRT_CONSTANT_HALF,
                           &c->couple) &&
           mrt_clutter_map_upload(runtime, input);
}

// ---- pass

void mrt_record_clutter_couple(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    const struct mrt_runtime_buffers *b = &runtime->buffers;
    struct mrt_runtime_clutter *c = &runtime->clutter;
    const gpu_buffer before = c->reflected[c->newest];
    c->newest = 1 - c->newest;
    gpu_dispatch(cmd, c->couple,
                 GPU_BIND(gpu_transient(cmd, "mrt_level", &runtime->level, sizeof runtime->level),
                          { .name = "mrt_openings", .buffer = b->openings },
                          { .name = "mrt_sources", .buffer = b->sources },
                          { .name = "mrt_t_br", .buffer = b->t_br },
                          { .name = "mrt_b", .buffer = b->b }, { .name = "mrt_r", .buffer = b->r },
                          { .name = "mrt_clutter_direct", .buffer = c->direct },
                          { .name = "mrt_clutter_reflectance", .buffer = c->reflectance },
                          { .name = "mrt_clutter_coupling", .buffer = c->coupling },
                          { .name = "mrt_clutter_senders", .buffer = c->senders },
                          { .name = "mrt_clutter_before", .buffer = before },
                          { .name = "mrt_clutter_reflected", .buffer = c->reflected[c->newest] }),
                 NULL, 0, runtime->opening_count, 1, 1);
}
