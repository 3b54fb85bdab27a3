// Tables and passes of clutter.
#include "techniques/mrt/gpu/upload.h"

#include "technique_shaders.h"

static uint32_t slots_of(const struct mrt_operators *o)
{
    return 4 * mrt_quads(o->k_r);
}

// ---- tables

static void fill_reflectance(const struct mrt_runtime_input *input, void *items)
{
    const struct mrt_operators *o = input->operators;
    const uint32_t slots = slots_of(o);
    float *reflectance = items; // of the clutter
    for (int i = 0; i < o->opening_count; i++) {
        const struct mrt_opening *opening = &o->openings[i];
        for (int f = 0; f < opening->face_count; f++)
            for (uint32_t c = 0; c < 3; c++)
                reflectance[c * slots + (uint32_t)opening->faces[f].slot] =
                    opening->faces[f].reflectance.raw[c];
        if (opening->face < 0) reflectance += 3 * slots;
    }
}

// Which of the openings that are clutter.
static uint32_t clutter_of_block(const struct mrt_operators *o, int block)
{
    uint32_t clutter = 0;
    for (int i = 0; o->openings[i].block != block; i++) clutter += o->openings[i].face < 0;
    return clutter;
}

static bool upload_senders(struct mrt_runtime *runtime, const struct mrt_operators *o)
{
    uint32_t count = 0;
    const uint32_t slots = slots_of(o);
    struct mrt_sender *senders = mrt_all_senders(runtime->host, o, &count);
    uint32_t *at = host_alloc(runtime->host, count, sizeof *at);
    bool ok = senders && at;
    for (uint32_t i = 0; ok && i < count; i++)
        at[i] = clutter_of_block(o, senders[i].block) * 3 * slots + (uint32_t)senders[i].slot;
    ok = ok && mrt_buffer_of(runtime, "mrt_clutter_senders", at, count * sizeof *at);
    host_free(runtime->host, senders);
    host_free(runtime->host, at);
    return ok;
}

static bool make_reflected(struct mrt_runtime *runtime, size_t bytes)
{
    bool ok = true;
    for (int i = 0; ok && i < 2; i++) {
        runtime->clutter.reflected[i] = runtime->buffer_count;
        ok = mrt_buffer_of(runtime, "mrt_clutter_reflected", NULL, bytes);
    }
    return ok;
}

bool mrt_clutter_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_runtime_clutter *c = &runtime->clutter;
    const size_t openings = (size_t)input->operators->clutter_count;
    const size_t coefficients = 3 * slots_of(input->operators) * sizeof(float);
    if (openings == 0) return true;
    c->opening_count = (uint32_t)openings;
    return mrt_clutter_direct_upload(runtime, input) &&
           mrt_table_upload(runtime, input, "mrt_clutter_reflectance", openings, coefficients,
                            fill_reflectance) &&
           upload_senders(runtime, input->operators) &&
           make_reflected(runtime, openings * coefficients) &&
           mrt_pipeline_of(runtime, "clutter_couple", &shader_mrt_gpu_clutter_couple_comp,
                           1u << MRT_CONSTANT_QUADS_R | 1u << MRT_CONSTANT_QUADS_B |
                               1u << MRT_CONSTANT_HALF,
                           &c->couple) &&
           mrt_clutter_map_upload(runtime, input);
}

// ---- pass

void mrt_record_clutter_couple(struct mrt_runtime *runtime, struct gpu_cmd *cmd)
{
    struct mrt_runtime_clutter *c = &runtime->clutter;
    const gpu_buffer before = runtime->buffers[c->reflected[c->newest]];
    c->newest = 1 - c->newest;
    const gpu_buffer newest = runtime->buffers[c->reflected[c->newest]];
    mrt_dispatch(runtime, cmd, c->couple,
                 GPU_BIND({ .name = "mrt_clutter_before", .buffer = before },
                          { .name = "mrt_clutter_reflected", .buffer = newest }),
                 NULL, 0, runtime->opening_count, 1, 1);
}
