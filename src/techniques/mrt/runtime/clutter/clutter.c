// Tables and passes of clutter.
#include "techniques/mrt/runtime/clutter/clutter.h"

#include "techniques/mrt/runtime/objects.h"
#include "techniques/mrt/runtime/operators.h"
#include "techniques/mrt/runtime/tables.h"

#include "technique_shaders.h"

#include <math.h>

enum { VEC3_BYTES = 12 };

static uint32_t slots_of(const struct mrt_runtime_input *input)
{
    return 4 * mrt_quads(input->k_r);
}

// Which of the openings that are clutter.
static int clutter_of(const struct mrt_clutter_input *clutter, int opening)
{
    int i = 0;
    while (clutter->openings[i] != opening) i++;
    return i;
}

// ---- tables

static void fill_texels(const struct mrt_runtime_input *input, void *items)
{
    struct mrt_texel *texels = items;
    for (int i = 0; i < input->clutter->texel_count; i++) {
        const struct mrt_clutter_texel *from = &input->clutter->texels[i];
        texels[i] = (struct mrt_texel){ .position = from->at.position,
                                        .area_m2 = from->area_m2,
                                        .normal = from->at.normal,
                                        .found = true,
                                        .albedo = from->at.albedo,
                                        .sky = from->sky,
                                        .emitted = from->emitted };
    }
}

static void fill_faces(const struct mrt_runtime_input *input, void *items)
{
    struct mrt_gpu_clutter_face *faces = items;
    for (int i = 0; i < input->clutter->face_count; i++) {
        const struct mrt_clutter_face_input *from = &input->clutter->faces[i];
        float area = 0.0f;
        for (int t = 0; t < from->texel_count; t++)
            area += input->clutter->texels[from->first_texel + t].area_m2;
        faces[i] = (struct mrt_gpu_clutter_face){
            .clutter = (uint32_t)clutter_of(input->clutter, from->opening),
            .slot = (uint32_t)from->slot,
            .first_texel = (uint32_t)from->first_texel,
            .texels = (uint32_t)from->texel_count,
            .per_m2 = 1.0f / area,
        };
    }
}

// One texel of each of equal stretches of a face, at places that no width of a chart repeats.
static int sample_of(const struct mrt_clutter_face_input *face, int sample)
{
    static const double GOLDEN = 0.6180339887498949;
    if (face->texel_count <= MRT_FACE_SAMPLES) return sample < face->texel_count ? sample : -1;
    const double turns = GOLDEN * sample;
    return (int)((sample + turns - floor(turns)) * face->texel_count / MRT_FACE_SAMPLES);
}

static void fill_samples(const struct mrt_runtime_input *input, void *items)
{
    struct mrt_gpu_clutter_sample *samples = items;
    for (int i = 0; i < input->clutter->face_count; i++, samples += MRT_FACE_SAMPLES) {
        const struct mrt_clutter_face_input *face = &input->clutter->faces[i];
        float area = 0.0f;
        for (int s = 0; s < MRT_FACE_SAMPLES; s++) {
            const int at = sample_of(face, s);
            if (at < 0) continue;
            samples[s].texel = (uint32_t)(face->first_texel + at);
            samples[s].share = input->clutter->texels[samples[s].texel].area_m2;
            area += samples[s].share;
        }
        for (int s = 0; s < MRT_FACE_SAMPLES; s++) samples[s].share /= area;
    }
}

static void fill_albedo(const struct mrt_runtime_input *input, void *items)
{
    float *albedo = items;
    const uint32_t slots = slots_of(input);
    for (int i = 0; i < input->clutter->face_count; i++) {
        const struct mrt_clutter_face_input *face = &input->clutter->faces[i];
        const uint32_t clutter = (uint32_t)clutter_of(input->clutter, face->opening);
        for (uint32_t c = 0; c < 3; c++)
            albedo[(3 * clutter + c) * slots + (uint32_t)face->slot] = face->albedo.raw[c];
    }
}

static int clutter_of_block(const struct mrt_runtime_input *input, int block)
{
    int i = 0;
    while (input->openings[input->clutter->openings[i]].block != block) i++;
    return i;
}

static void fill_face_pairs(const struct mrt_runtime_input *input, void *items)
{
    struct mrt_gpu_face_pair *pairs = items;
    for (int i = 0; i < input->clutter->pair_count; i++)
        pairs[i] = (struct mrt_gpu_face_pair){
            .clutter = (uint32_t)clutter_of_block(input, input->clutter->pairs[i].source),
            .quads = mrt_quads((int)input->clutter->pairs[i].of_c.rows),
        };
}

static void fill_coupling(const struct mrt_runtime_input *input, void *items)
{
    float *coupling = items;
    const size_t slots = slots_of(input);
    for (int i = 0; i < input->clutter->pair_count; i++) {
        const struct matrix_f32 *of_c = &input->clutter->pairs[i].of_c;
        for (size_t from = 0; from < of_c->rows; from++)
            for (size_t to = 0; to < of_c->columns; to++)
                coupling[((size_t)i * slots + from) * slots + to] =
                    of_c->at[from * of_c->stride + to];
    }
}

static bool make_pipelines(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_runtime_clutter *c = &runtime->clutter;
    const struct gpu_constant constants[] = {
        { MRT_CONSTANT_QUADS_R, mrt_quads(input->k_r) },
        { MRT_CONSTANT_QUADS_B, mrt_quads(input->k_b) },
        { MRT_CONSTANT_HALF, runtime->options.half },
    };
    return mrt_pipeline_of(runtime, "clutter_direct", &shader_mrt_runtime_clutter_direct_comp,
                           constants, 1, &c->light) &&
           mrt_pipeline_of(runtime, "clutter_couple", &shader_mrt_runtime_clutter_couple_comp,
                           constants, 3, &c->couple);
}

bool mrt_clutter_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_runtime_clutter *c = &runtime->clutter;
    if (!input->clutter) return true;
    const size_t slots = slots_of(input), texels = (size_t)input->clutter->texel_count;
    const size_t openings = (size_t)input->clutter->opening_count, number = sizeof(float);
    const size_t pairs = (size_t)input->clutter->pair_count;
    c->face_count = (uint32_t)input->clutter->face_count;
    c->opening_count = (uint32_t)openings;
    return mrt_table_upload(runtime, input, "clutter_texels", texels, sizeof(struct mrt_texel),
                            fill_texels, &c->texels) &&
           mrt_table_upload(runtime, input, "clutter_faces", c->face_count,
                            sizeof(struct mrt_gpu_clutter_face), fill_faces, &c->faces) &&
           mrt_table_upload(runtime, input, "clutter_samples", c->face_count,
                            MRT_FACE_SAMPLES * sizeof(struct mrt_gpu_clutter_sample), fill_samples,
                            &c->samples) &&
           mrt_table_upload(runtime, input, "clutter_albedo", openings, 3 * slots * number,
                            fill_albedo, &c->albedo) &&
           mrt_table_upload(runtime, input, "clutter_coupling", pairs, slots * slots * number,
                            fill_coupling, &c->coupling) &&
           mrt_table_upload(runtime, input, "clutter_pairs", pairs,
                            sizeof(struct mrt_gpu_face_pair), fill_face_pairs, &c->pairs) &&
           mrt_table_upload(runtime, input, "clutter_unbounced", texels, VEC3_BYTES, NULL,
                            &c->unbounced) &&
           mrt_table_upload(runtime, input, "clutter_direct", openings, 3 * slots * number, NULL,
                            &c->direct) &&
           mrt_table_upload(runtime, input, "clutter_reflected", openings, 3 * slots * number, NULL,
                            &c->reflected[0]) &&
           mrt_table_upload(runtime, input, "clutter_reflected", openings, 3 * slots * number, NULL,
                            &c->reflected[1]) &&
           make_pipelines(runtime, input) && mrt_clutter_map_upload(runtime, input);
}

void mrt_clutter_end(struct mrt_runtime *runtime)
{
    struct mrt_runtime_clutter *c = &runtime->clutter;
    gpu_buffer *const buffers[] = { &c->texels,       &c->faces,     &c->samples, &c->albedo,
                                    &c->coupling,     &c->unbounced, &c->direct,  &c->reflected[0],
                                    &c->reflected[1], &c->pairs };
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        gpu_buffer_destroy(runtime->gpu, buffers[i]);
    gpu_pipeline_destroy(runtime->gpu, &c->light);
    gpu_pipeline_destroy(runtime->gpu, &c->couple);
    mrt_clutter_map_end(runtime);
}

// ---- passes

void mrt_record_clutter_direct(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                               const struct frame_view *view)
{
    const struct mrt_runtime_clutter *c = &runtime->clutter;
    if (c->opening_count == 0) return;
    gpu_scope_begin(cmd, "clutter");
    gpu_dispatch(
        cmd, c->light,
        GPU_BIND(
            view->constants_binding, view->lights_binding, view->shadow_faces_binding,
            { .name = "shadow_maps", .image = view->shadow_maps, .sampler = view->shadow_sampler },
            { .name = "shadow_sun_maps",
              .image = view->shadow_sun_maps,
              .sampler = view->shadow_sampler },
            gpu_transient(cmd, "mrt_level", &runtime->level, sizeof runtime->level),
            { .name = "mrt_texels", .buffer = c->texels },
            { .name = "mrt_unbounced", .buffer = c->unbounced },
            { .name = "mrt_clutter_faces", .buffer = c->faces },
            { .name = "mrt_clutter_samples", .buffer = c->samples },
            { .name = "mrt_clutter_direct", .buffer = c->direct }),
        NULL, 0, c->face_count, 1, 1);
    gpu_scope_end(cmd);
}

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
                          { .name = "mrt_clutter_albedo", .buffer = c->albedo },
                          { .name = "mrt_clutter_coupling", .buffer = c->coupling },
                          { .name = "mrt_clutter_pairs", .buffer = c->pairs },
                          { .name = "mrt_clutter_before", .buffer = before },
                          { .name = "mrt_clutter_reflected", .buffer = c->reflected[c->newest] }),
                 NULL, 0, runtime->opening_count, 1, 1);
}
