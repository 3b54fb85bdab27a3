// Radiosity of direct light of the faces of clutter: tables and pass.
#include "techniques/mrt/gpu/upload.h"

#include "technique_shaders.h"

#include <math.h>
#include <string.h>

// ---- tables

static void fill_texels(const struct mrt_runtime_input *input, void *items)
{
    mrt_fill_texels(input->clutter_texels, input->clutter->charts.side_texel_count, items);
}

// Faces one after the other. Samples of a face are in one workgroup.
struct face_place {
    const struct mrt_operators *of;
    int opening, in_opening; // of the face
    uint32_t face, clutter;  // which of all, which of the openings that are clutter
    const struct mrt_opening_face *from;
    uint32_t group, first_sample, samples, used;
};

static bool next_face(struct face_place *at)
{
    const struct mrt_operators *o = at->of;
    at->face += at->from != NULL;
    at->in_opening += at->from != NULL;
    for (; at->opening < o->opening_count; at->opening++, at->in_opening = 0) {
        const struct mrt_opening *opening = &o->openings[at->opening];
        if (at->in_opening < opening->face_count) break;
        at->clutter += opening->face < 0;
    }
    if (at->opening == o->opening_count) return false;
    at->from = &o->openings[at->opening].faces[at->in_opening];
    at->samples = at->from->texel_count < MRT_FACE_SAMPLES ? (uint32_t)at->from->texel_count
                                                           : MRT_FACE_SAMPLES;
    if (at->used + at->samples > MRT_LOCAL) {
        at->group++;
        at->used = 0;
    }
    at->first_sample = at->used;
    at->used += at->samples;
    return true;
}

static void fill_groups(const struct mrt_runtime_input *input, void *items)
{
    struct mrt_gpu_clutter_group *groups = items;
    for (struct face_place at = { .of = input->operators }; next_face(&at);)
        if (groups[at.group].faces++ == 0) groups[at.group].first_face = at.face;
}

// Radiosity of a face by area lights: means over the area of its texels.
static void add_area_light(const struct mrt_runtime_input *input,
                           const struct mrt_opening_face *from, struct mrt_gpu_clutter_face *to)
{
    float area = 0.0f;
    for (int t = from->first_texel; t < from->first_texel + from->texel_count; t++) {
        const struct mrt_geometry_texel *texel = &input->clutter_texels[t];
        const vec3s reflected = glms_vec3_scale(texel->reflectance, texel->area_m2);
        to->emitted = glms_vec3_add(to->emitted, glms_vec3_mul(reflected, texel->emitted));
        to->sky = glms_vec3_muladds(reflected, texel->sky, to->sky);
        area += texel->area_m2;
    }
    to->emitted = glms_vec3_divs(to->emitted, area);
    to->sky = glms_vec3_divs(to->sky, area);
}

static void fill_faces(const struct mrt_runtime_input *input, void *items)
{
    struct mrt_gpu_clutter_face *faces = items;
    for (struct face_place at = { .of = input->operators }; next_face(&at);) {
        faces[at.face] = (struct mrt_gpu_clutter_face){ .clutter = at.clutter,
                                                        .slot = (uint32_t)at.from->slot,
                                                        .first_sample = at.first_sample,
                                                        .samples = at.samples };
        add_area_light(input, at.from, &faces[at.face]);
    }
}

// One texel of each of equal stretches of a face, at places that no width of a chart repeats.
static uint32_t texel_of(const struct mrt_opening_face *face, uint32_t sample)
{
    static const double GOLDEN = 0.6180339887498949;
    const double turns = GOLDEN * sample;
    if (face->texel_count <= MRT_FACE_SAMPLES) return (uint32_t)face->first_texel + sample;
    return (uint32_t)face->first_texel +
           (uint32_t)((sample + turns - floor(turns)) * face->texel_count / MRT_FACE_SAMPLES);
}

static void fill_samples(const struct mrt_runtime_input *input, void *items)
{
    for (struct face_place at = { .of = input->operators }; next_face(&at);) {
        struct mrt_gpu_clutter_sample *samples = items;
        float area = 0.0f;
        samples += at.group * MRT_LOCAL + at.first_sample;
        for (uint32_t s = 0; s < at.samples; s++) {
            samples[s].texel = texel_of(at.from, s);
            samples[s].share = input->clutter_texels[samples[s].texel].area_m2;
            area += samples[s].share;
        }
        for (uint32_t s = 0; s < at.samples; s++) samples[s].share /= area;
    }
}

bool mrt_clutter_direct_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_runtime_clutter *c = &runtime->clutter;
    const size_t coefficients = 12 * (size_t)mrt_quads(input->operators->k_r) * sizeof(float);
    struct face_place end = { .of = input->operators };
    while (next_face(&end)) c->group_count = end.group + 1;
    return mrt_table_upload(runtime, input, "mrt_clutter_texels",
                            input->clutter->charts.side_texel_count, sizeof(struct mrt_texel),
                            fill_texels) &&
           mrt_table_upload(runtime, input, "mrt_clutter_groups", c->group_count,
                            sizeof(struct mrt_gpu_clutter_group), fill_groups) &&
           mrt_table_upload(runtime, input, "mrt_clutter_faces", end.face,
                            sizeof(struct mrt_gpu_clutter_face), fill_faces) &&
           mrt_table_upload(runtime, input, "mrt_clutter_samples", c->group_count,
                            MRT_LOCAL * sizeof(struct mrt_gpu_clutter_sample), fill_samples) &&
           mrt_table_upload(runtime, input, "mrt_clutter_direct", c->opening_count, coefficients,
                            NULL) &&
           mrt_pipeline_of(runtime, "clutter_direct", &shader_mrt_gpu_clutter_direct_comp,
                           1u << MRT_CONSTANT_QUADS_R, &c->light);
}

// ---- pass

// The light map adds light of emissive surfaces and the sky at its texels.
static void note_area_light(struct mrt_runtime *runtime, const struct frame_view *view)
{
    struct mrt_clutter_fill_push *push = &runtime->clutter.map.fill_push;
    push->emitted = runtime->level.emitters * view->constants->radiance_scale;
    memcpy(push->environment_sh, view->constants->environment_sh, sizeof push->environment_sh);
}

void mrt_record_clutter_direct(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                               const struct frame_view *view)
{
    const struct mrt_runtime_clutter *c = &runtime->clutter;
    note_area_light(runtime, view);
    if (c->opening_count == 0) return;
    gpu_scope_begin(cmd, "clutter");
    mrt_dispatch(
        runtime, cmd, c->light,
        GPU_BIND(FRAME_LIGHT_BINDINGS(view),
                 { .name = "mrt_texels", .buffer = mrt_buffer(runtime, "mrt_clutter_texels") }),
        NULL, 0, c->group_count, 1, 1);
    gpu_scope_end(cmd);
}
