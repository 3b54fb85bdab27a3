#include "techniques/vct_rig.h"

#include <math.h>
#include <stdlib.h>

void vct_rig_init(struct vct_rig *rig, struct gpu *gpu)
{
    *rig = (struct vct_rig){ .technique = &technique_vct };
    fixture_init(&rig->frame_fixture, gpu);
}

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct vct *vct = user;
    gpu_owner_push(vct->gpu, "vct");
    technique_vct.record(vct, cmd, view); // also that of vctao
    gpu_owner_pop(vct->gpu);
}

void vct_rig_open(struct vct_rig *rig, const char *text)
{
    struct frame_fixture *s = &rig->frame_fixture;
    const struct technique *technique = rig->technique;
    fixture_open(s);
    struct vct_options options = { 0 };
    option_defaults(&technique->options, &options);
    CHECK(option_parse(test_host(), &technique->options, technique->name, text, &options));
    const struct technique_create how = { .host = rig->host ? rig->host : test_host(),
                                          .gpu = s->gpu,
                                          .pose = &s->pose,
                                          .options = &options,
                                          .width = s->width,
                                          .height = s->height };
    rig->vct = calloc(1, technique->state_size);
    CHECK(technique->check(&how));
    gpu_owner_push(s->gpu, "vct");
    CHECK(technique->create(rig->vct, &how));
    gpu_owner_pop(s->gpu);
    s->indirect =
        (struct frame_indirect){ .record = record,
                                 .user = rig->vct,
                                 .needs = technique->needs | technique->more_needs(&options) };
}

void vct_rig_finish(struct vct_rig *rig)
{
    rig->technique->destroy(rig->vct);
    free(rig->vct);
    fixture_finish(&rig->frame_fixture);
}

void vct_rig_hall(struct vct_rig *rig, struct gpu *gpu)
{
    vct_rig_init(rig, gpu);
    struct frame_fixture *s = &rig->frame_fixture;
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(27, 12, 20), true,
                fixture_matte(s, vec3_of(0.7f, 0.6f, 0.5f)));
    for (int i = 0; i < 5; i++)
        fixture_box(s, vec3_of(3.0f + 5.0f * (float)i, 0, 8), vec3_of(4.1f + 5.0f * (float)i, 9, 9),
                    false, fixture_matte(s, vec3_of(0.3f, 0.5f, 0.8f)));
    fixture_add_point(s, vec3_of(9, 9, 15), vec3_of(900, 900, 900));
    fixture_look(s, vec3_of(12, 5, 15), vec3_of(13, 4, 4));
}

int vct_rig_add_triangle(struct vct_rig *rig, const vec3s corners[3], int material)
{
    vec3s positions[3] = { corners[0], corners[1], corners[2] };
    vec3s normals[3] = { vec3_of(0, 1, 0), vec3_of(0, 1, 0), vec3_of(0, 1, 0) };
    uint32_t indices[3] = { 0, 1, 2 };
    const int mesh =
        scene_add_mesh(rig->frame_fixture.scene, &(struct mesh){ .name = "triangle",
                                                                 .vertex_count = 3,
                                                                 .index_count = 3,
                                                                 .positions = positions,
                                                                 .normals = normals,
                                                                 .indices = indices,
                                                                 .material = material });
    CHECK(mesh >= 0);
    return fixture_instance(&rig->frame_fixture, mesh, NULL);
}

uint32_t *vct_rig_words(const struct vct_rig *rig, gpu_buffer buffer)
{
    const size_t bytes = gpu_buffer_bytes(rig->frame_fixture.gpu, buffer);
    uint32_t *words = malloc(bytes);
    CHECK(gpu_buffer_download(rig->frame_fixture.gpu, buffer, 0, words, bytes));
    return words;
}

uint32_t *vct_rig_mask(const struct vct_rig *rig, const struct vct_voxel_set *set)
{
    return vct_rig_words(rig, set->mask);
}

bool vct_rig_has(const struct vct_rig *rig, const uint32_t *mask, int x, int y, int z)
{
    // As vct_index of vct_grid.glsl says: texels of eight voxels.
    const int dim = rig->vct->options.resolution / 2;
    const int texel = ((z / 2) * dim + y / 2) * dim + x / 2;
    const uint32_t index = (uint32_t)(8 * texel + x % 2 + 2 * (y % 2) + 4 * (z % 2));
    return mask[index / 32] >> (index % 32) & 1u;
}

float *vct_rig_light(const struct vct_rig *rig, uint32_t level)
{
    const size_t dim = vct_volume_dim(&rig->vct->options) >> level;
    const size_t floats = vct_direction_count(&rig->vct->options) * dim * dim * dim * 4;
    float *light = malloc(floats * sizeof *light);
    CHECK(gpu_image_download_float(rig->frame_fixture.gpu, rig->vct->light, level, 0, light, 4,
                                   floats));
    // Of occlusion there is opacity alone, in the first channel.
    for (size_t i = 0; rig->vct->options.occlusion && i < floats; i++) light[i] = light[i / 4 * 4];
    return light;
}

double vct_rig_shown(double left, double alpha, double sheet)
{
    const double by_chance = left * fmin(alpha, 1.0), next_to = fmin(alpha, left);
    return by_chance + pow(sheet, 4.0) * (next_to - by_chance);
}
