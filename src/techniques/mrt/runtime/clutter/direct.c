// Radiosity of direct light of the faces of clutter: tables and pass.
#include "techniques/mrt/runtime/clutter/clutter.h"

#include "techniques/mrt/runtime/objects.h"
#include "techniques/mrt/runtime/operators.h"
#include "techniques/mrt/runtime/tables.h"

#include "technique_shaders.h"

#include <math.h>
#include <string.h>

uint32_t mrt_clutter_of_opening(const struct mrt_clutter_input *clutter, int opening)
{
    uint32_t i = 0;
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
                                        .reflectance = from->at.reflectance,
                                        .sky = from->sky,
                                        .emitted = from->emitted };
    }
}

// Samples of a face are in one workgroup.
struct packer {
    uint32_t group, used;
};

static uint32_t samples_of(const struct mrt_clutter_face_input *face)
{
    return face->texel_count < MRT_FACE_SAMPLES ? (uint32_t)face->texel_count : MRT_FACE_SAMPLES;
}

static uint32_t pack(struct packer *packer, const struct mrt_clutter_face_input *face)
{
    const uint32_t samples = samples_of(face);
    if (packer->used + samples > MRT_LOCAL) *packer = (struct packer){ packer->group + 1, 0 };
    packer->used += samples;
    return packer->used - samples;
}

static uint32_t groups_of(const struct mrt_clutter_input *clutter)
{
    struct packer packer = { 0 };
    for (int i = 0; i < clutter->face_count; i++) pack(&packer, &clutter->faces[i]);
    return clutter->face_count > 0 ? packer.group + 1 : 0;
}

static void fill_groups(const struct mrt_runtime_input *input, void *items)
{
    struct mrt_gpu_clutter_group *groups = items;
    struct packer packer = { 0 };
    for (int i = 0; i < input->clutter->face_count; i++) {
        pack(&packer, &input->clutter->faces[i]);
        if (groups[packer.group].faces++ == 0) groups[packer.group].first_face = (uint32_t)i;
    }
}

// Radiosity of a face by area lights: means over the area of its texels.
static void add_area_light(const struct mrt_runtime_input *input,
                           const struct mrt_clutter_face_input *from,
                           struct mrt_gpu_clutter_face *to)
{
    float area = 0.0f;
    for (int t = from->first_texel; t < from->first_texel + from->texel_count; t++) {
        const struct mrt_clutter_texel *texel = &input->clutter->texels[t];
        const vec3s reflected = glms_vec3_scale(texel->at.reflectance, texel->area_m2);
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
    struct packer packer = { 0 };
    for (int i = 0; i < input->clutter->face_count; i++) {
        const struct mrt_clutter_face_input *from = &input->clutter->faces[i];
        faces[i] = (struct mrt_gpu_clutter_face){
            .clutter = mrt_clutter_of_opening(input->clutter, from->opening),
            .slot = (uint32_t)from->slot,
            .first_sample = pack(&packer, from),
            .samples = samples_of(from),
        };
        add_area_light(input, from, &faces[i]);
    }
}

// One texel of each of equal stretches of a face, at places that no width of a chart repeats.
static uint32_t texel_of(const struct mrt_clutter_face_input *face, uint32_t sample)
{
    static const double GOLDEN = 0.6180339887498949;
    const double turns = GOLDEN * sample;
    if (face->texel_count <= MRT_FACE_SAMPLES) return (uint32_t)face->first_texel + sample;
    return (uint32_t)face->first_texel +
           (uint32_t)((sample + turns - floor(turns)) * face->texel_count / MRT_FACE_SAMPLES);
}

static void fill_samples(const struct mrt_runtime_input *input, void *items)
{
    struct packer packer = { 0 };
    for (int i = 0; i < input->clutter->face_count; i++) {
        const struct mrt_clutter_face_input *face = &input->clutter->faces[i];
        const uint32_t first = pack(&packer, face);
        struct mrt_gpu_clutter_sample *samples = items;
        float area = 0.0f;
        samples += packer.group * MRT_LOCAL + first;
        for (uint32_t s = 0; s < samples_of(face); s++) {
            samples[s].texel = texel_of(face, s);
            samples[s].share = input->clutter->texels[samples[s].texel].area_m2;
            area += samples[s].share;
        }
        for (uint32_t s = 0; s < samples_of(face); s++) samples[s].share /= area;
    }
}

bool mrt_clutter_direct_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_runtime_clutter *c = &runtime->clutter;
    const size_t coefficients = 12 * (size_t)mrt_quads(input->k_r) * sizeof(float);
    c->group_count = groups_of(input->clutter);
    return mrt_table_upload(runtime, input, "clutter_texels", (size_t)input->clutter->texel_count,
                            sizeof(struct mrt_texel), fill_texels, &c->texels) &&
           mrt_table_upload(runtime, input, "clutter_groups", c->group_count,
                            sizeof(struct mrt_gpu_clutter_group), fill_groups, &c->groups) &&
           mrt_table_upload(runtime, input, "clutter_faces", (size_t)input->clutter->face_count,
                            sizeof(struct mrt_gpu_clutter_face), fill_faces, &c->faces) &&
           mrt_table_upload(runtime, input, "clutter_samples", c->group_count,
                            MRT_LOCAL * sizeof(struct mrt_gpu_clutter_sample), fill_samples,
                            &c->samples) &&
           mrt_table_upload(runtime, input, "clutter_direct", (size_t)input->clutter->opening_count,
                            coefficients, NULL, &c->direct) &&
           mrt_pipeline_of(runtime, "clutter_direct", &shader_mrt_runtime_clutter_direct_comp,
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
    gpu_dispatch(cmd, c->light,
                 GPU_BIND(FRAME_LIGHT_BINDINGS(view),
                          gpu_transient(cmd, "mrt_level", &runtime->level, sizeof runtime->level),
                          { .name = "mrt_texels", .buffer = c->texels },
                          { .name = "mrt_clutter_groups", .buffer = c->groups },
                          { .name = "mrt_clutter_faces", .buffer = c->faces },
                          { .name = "mrt_clutter_samples", .buffer = c->samples },
                          { .name = "mrt_clutter_direct", .buffer = c->direct }),
                 NULL, 0, c->group_count, 1, 1);
    gpu_scope_end(cmd);
}
