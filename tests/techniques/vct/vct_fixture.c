#include "techniques/vct/vct_fixture.h"

#include <math.h>
#include <stdlib.h>

void vct_fixture_init(struct vct_fixture *fixture, struct gpu *gpu)
{
    *fixture = (struct vct_fixture){ .technique = &technique_vct };
    fixture_init(&fixture->frame_fixture, gpu);
}

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct vct_fixture *fixture = user;
    struct gpu *gpu = fixture->frame_fixture.gpu;
    gpu_owner_push(gpu, fixture->technique->name);
    fixture->technique->update(fixture->vct, cmd, view);
    fixture->technique->record(fixture->vct, cmd, view);
    gpu_owner_pop(gpu);
}

void vct_fixture_open(struct vct_fixture *fixture, const char *text)
{
    struct frame_fixture *s = &fixture->frame_fixture;
    const struct technique *technique = fixture->technique;
    fixture_open(s);
    struct vct_options options = { 0 };
    option_defaults(&technique->options, &options);
    options.trace = VCT_BY_CONES; // of one frame, unless the text says otherwise
    options.temporal = false;
    CHECK(option_parse(test_host(), &technique->options, technique->name, text, &options));
    const struct technique_create how = { .host = fixture->host ? fixture->host : test_host(),
                                          .gpu = s->gpu,
                                          .pose = &s->pose,
                                          .options = &options,
                                          .width = s->width,
                                          .height = s->height };
    fixture->vct = calloc(1, technique->state_size);
    CHECK(technique->check(&how));
    gpu_owner_push(s->gpu, technique->name);
    CHECK(technique_create(technique, fixture->vct, &how));
    gpu_owner_pop(s->gpu);
    s->indirect =
        (struct frame_indirect){ .record = record,
                                 .user = fixture,
                                 .needs = technique->needs | technique->more_needs(&options) };
}

void vct_fixture_finish(struct vct_fixture *fixture)
{
    struct vct *vct = fixture->vct;
    technique_destroy(fixture->technique, fixture->frame_fixture.gpu, vct, &vct->options);
    free(vct);
    fixture_finish(&fixture->frame_fixture);
}

void vct_fixture_forget_voxels(struct vct_fixture *fixture)
{
    fixture->technique->invalidate(fixture->vct, CHANGED_GEOMETRY);
}

void vct_fixture_hall(struct vct_fixture *fixture, struct gpu *gpu)
{
    vct_fixture_init(fixture, gpu);
    struct frame_fixture *s = &fixture->frame_fixture;
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(27, 12, 20), true,
                fixture_matte(s, vec3_of(0.7f, 0.6f, 0.5f)));
    for (int i = 0; i < 5; i++)
        fixture_box(s, vec3_of(3.0f + 5.0f * (float)i, 0, 8), vec3_of(4.1f + 5.0f * (float)i, 9, 9),
                    false, fixture_matte(s, vec3_of(0.3f, 0.5f, 0.8f)));
    fixture_add_point(s, vec3_of(9, 9, 15), vec3_of(900, 900, 900));
    fixture_look(s, vec3_of(12, 5, 15), vec3_of(13, 4, 4));
}

int vct_fixture_room(struct vct_fixture *fixture, struct gpu *gpu)
{
    vct_fixture_init(fixture, gpu);
    struct frame_fixture *s = &fixture->frame_fixture;
    fixture_box(s, vec3_of(0.3f, 0.2f, 0.4f), vec3_of(11.2f, 9.1f, 10.7f), true,
                fixture_matte(s, vec3_of(0.7f, 0.5f, 0.3f)));
    fixture_box(s, vec3_of(8, 0.2f, 3), vec3_of(10, 4, 6), false,
                fixture_matte(s, vec3_of(0.2f, 0.5f, 0.8f)));
    const int first = s->scene->instance_count;
    fixture_box(s, vec3_of(4, 0.2f, 2), vec3_of(5.5f, 3, 3.5f), false,
                fixture_matte(s, vec3_of(0.8f, 0.1f, 0.1f)));
    fixture_add_point(s, vec3_of(3, 7, 5), vec3_of(300, 500, 200));
    fixture_look(s, vec3_of(1, 6, 9), vec3_of(8, 2, 3));
    return first;
}

void vct_fixture_move_box(struct vct_fixture *fixture, int first, vec3s by)
{
    struct frame_fixture *s = &fixture->frame_fixture;
    for (int i = first; i < first + 6; i++)
        for (int k = 0; k < 3; k++)
            s->pose.world_from_node[s->scene->instances[i].node].raw[3][k] += by.raw[k];
}

float *vct_fixture_irradiance_after(struct vct_fixture *fixture, int frames)
{
    for (int i = 0; i < frames; i++) fixture_render(&fixture->frame_fixture);
    return fixture_read(&fixture->frame_fixture, READ_IRRADIANCE);
}

int vct_fixture_add_triangle(struct vct_fixture *fixture, const vec3s corners[3], int material)
{
    vec3s positions[3] = { corners[0], corners[1], corners[2] };
    vec3s normals[3] = { vec3_of(0, 1, 0), vec3_of(0, 1, 0), vec3_of(0, 1, 0) };
    uint32_t indices[3] = { 0, 1, 2 };
    const int mesh =
        scene_add_mesh(fixture->frame_fixture.scene, &(struct mesh){ .name = "triangle",
                                                                     .vertex_count = 3,
                                                                     .index_count = 3,
                                                                     .positions = positions,
                                                                     .normals = normals,
                                                                     .indices = indices,
                                                                     .material = material });
    CHECK(mesh >= 0);
    return fixture_instance(&fixture->frame_fixture, mesh, NULL);
}

double vct_fixture_difference(const float *a, const float *b, size_t count)
{
    double difference = 0.0, sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        difference += fabs((double)a[i] - (double)b[i]);
        sum += (double)b[i];
    }
    return difference / sum;
}

uint32_t *vct_fixture_buffer_words(const struct vct_fixture *fixture, gpu_buffer buffer)
{
    const size_t bytes = gpu_buffer_bytes(fixture->frame_fixture.gpu, buffer);
    uint32_t *words = malloc(bytes);
    CHECK(gpu_buffer_download(fixture->frame_fixture.gpu, buffer, 0, words, bytes));
    return words;
}

uint32_t *vct_fixture_mask(const struct vct_fixture *fixture, const struct vct_voxel_set *set)
{
    return vct_fixture_buffer_words(fixture, set->mask);
}

// As vct_index of vct_grid.glsl: texels of eight voxels.
static uint32_t voxel_index(const struct vct_fixture *fixture, int x, int y, int z)
{
    const int dim = fixture->vct->options.resolution / 2;
    const int texel = ((z / 2) * dim + y / 2) * dim + x / 2;
    return (uint32_t)(8 * texel + x % 2 + 2 * (y % 2) + 4 * (z % 2));
}

bool vct_fixture_occupied(const struct vct_fixture *fixture, const uint32_t *mask, int x, int y,
                          int z)
{
    const uint32_t index = voxel_index(fixture, x, y, z);
    return (mask[index / 4] >> (8 * (index % 4)) & 0xffu) != 0; // a byte of six faces
}

bool vct_fixture_reflectance(const struct vct_fixture *fixture, const struct vct_voxel_set *set,
                             const int voxel[3], uint32_t face, vec3s *out)
{
    const uint32_t index = voxel_index(fixture, voxel[0], voxel[1], voxel[2]),
                   bit = 1u << (8 * (index % 4) + face);
    struct gpu *gpu = fixture->frame_fixture.gpu;
    uint32_t *mask = vct_fixture_mask(fixture, set),
             *before = vct_fixture_buffer_words(fixture, set->word_offsets);
    const struct gpu_image_desc *desc = gpu_image_info(gpu, set->surfaces);
    const size_t bytes = (size_t)desc->width * desc->height * 16;
    uint32_t *surfaces = malloc(bytes);
    assert_non_null(surfaces);
    assert_true(gpu_image_download(gpu, set->surfaces, 0, 0, surfaces, bytes));
    const bool found = (mask[index / 4] & bit) != 0;
    const uint32_t slot =
        before[index / 4] + (uint32_t)__builtin_popcount(mask[index / 4] & (bit - 1));
    const uint32_t *words = surfaces + (size_t)slot * 8; // two texels
    if (found)
        *out = glms_vec3_divs(vec3_of((float)(words[0] & 8191u), (float)(words[0] >> 13 & 8191u),
                                      (float)(words[0] >> 26 | words[1] >> 24 << 6)),
                              8191.0f); // 13 bits each: voxelize/surface.glsl
    free(mask);
    free(before);
    free(surfaces);
    return found;
}

float *vct_fixture_light(const struct vct_fixture *fixture, uint32_t level)
{
    const size_t dim = vct_volume_dim(&fixture->vct->options) >> level;
    const size_t floats = vct_direction_count(&fixture->vct->options) * dim * dim * dim * 4;
    float *light = malloc(floats * sizeof *light);
    CHECK(gpu_image_download_float(fixture->frame_fixture.gpu, fixture->vct->volume.light, level, 0,
                                   light, 4, floats));
    // The volume of occlusion has one channel, opacity.
    for (size_t i = 0; fixture->vct->options.occlusion && i < floats; i++)
        light[i] = light[i / 4 * 4];
    return light;
}

double vct_fixture_visible_alpha(double left, double alpha, double sheet)
{
    const double by_chance = left * fmin(alpha, 1.0), next_to = fmin(alpha, left);
    return by_chance + pow(sheet, 4.0) * (next_to - by_chance);
}
