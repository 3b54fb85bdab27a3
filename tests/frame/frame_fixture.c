// A small scene, a camera, lights and a rendered frame.
#include "frame/frame_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void fixture_init(struct frame_fixture *s, struct gpu *gpu)
{
    *s = (struct frame_fixture){ .gpu = gpu, .width = 32, .height = 32 };
    s->scene = scene_create(test_host(), "fixture");
    assert_non_null(s->scene);
    option_defaults(&frame_option_table, &s->options);
    s->options.shadow_size = 256;
    s->options.rsm_size = 64;
    s->input.lights = s->lights;
    fixture_look(s, vec3_of(0, 0, 0), vec3_of(0, 0, -1));
}

void fixture_init_furnace(struct frame_fixture *s, struct gpu *gpu, float albedo, float emission)
{
    fixture_init(s, gpu);
    fixture_box(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true,
                fixture_emissive(s, albedo, emission));
    fixture_look(s, vec3_of(-1.7f, 2.6f, 1.7f), vec3_of(1, 0.5f, -1));
}

void fixture_finish(struct frame_fixture *s)
{
    frame_destroy(s->frame);
    pose_finish(&s->pose);
    scene_destroy(s->scene);
}

void fixture_open(struct frame_fixture *s)
{
    assert_true(pose_init(&s->pose, s->scene, s->scene->animation_count ? 0 : -1, 0));
    fixture_open_frame(s);
}

void fixture_open_frame(struct frame_fixture *s)
{
    s->frame = frame_create(test_host(), s->gpu, &s->options);
    assert_non_null(s->frame);
    assert_true(frame_set_scene(s->frame, s->scene));
    s->input.pose = &s->pose;
    fixture_resize(s, s->width, s->height);
}

void fixture_resize(struct frame_fixture *s, uint32_t width, uint32_t height)
{
    s->width = width;
    s->height = height;
    assert_true(frame_resize(s->frame, width, height));
}

void fixture_render(struct frame_fixture *s)
{
    const struct frame_indirect *indirect =
        s->indirect.needs || s->indirect.record ? &s->indirect : NULL;
    assert_true(frame_prepare(s->frame, &s->input, indirect));
    struct gpu_cmd *cmd = gpu_frame_begin(s->gpu);
    assert_non_null(cmd);
    frame_record_light(s->frame, cmd, &s->input, indirect);
    frame_record_view(s->frame, cmd, &s->input, indirect);
    assert_true(gpu_frame_end(s->gpu, cmd));
    assert_true(gpu_wait(s->gpu));
}

int fixture_material(struct frame_fixture *s, const struct material *material)
{
    int index = scene_add_material(s->scene, material);
    assert_true(index >= 0);
    return index;
}

int fixture_matte(struct frame_fixture *s, vec3s albedo)
{
    struct material m = material_default();
    m.base_color = vec4_of(albedo, 1);
    m.metallic = 0;
    m.roughness = 1;
    m.specular = 0;
    return fixture_material(s, &m);
}

int fixture_emissive(struct frame_fixture *s, float albedo, float emission)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(albedo, albedo, albedo), 1);
    m.emissive = vec3_of(emission, emission, emission);
    m.metallic = 0;
    m.roughness = 1;
    m.specular = 0; // a furnace's reflectance is the albedo
    return fixture_material(s, &m);
}

int fixture_instance(struct frame_fixture *s, int mesh, const struct node *node)
{
    struct node identity = node_default();
    int n = scene_add_node(s->scene, node ? node : &identity);
    int index =
        scene_add_instance(s->scene, &(struct instance){ .node = n, .mesh = mesh, .skin = -1 });
    assert_true(n >= 0 && index >= 0);
    return index;
}

int fixture_quad(struct frame_fixture *s, vec3s a, vec3s b, vec3s c, vec3s d, int material)
{
    vec3s positions[4] = { a, b, c, d };
    vec2s uv[4] = { { { 0, 1 } }, { { 1, 1 } }, { { 1, 0 } }, { { 0, 0 } } };
    vec3s n = glms_vec3_normalize(glms_vec3_cross(glms_vec3_sub(b, a), glms_vec3_sub(c, a)));
    vec3s normals[4] = { n, n, n, n };
    uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    int mesh = scene_add_mesh(s->scene, &(struct mesh){ .name = "quad",
                                                        .vertex_count = 4,
                                                        .index_count = 6,
                                                        .positions = positions,
                                                        .normals = normals,
                                                        .uv = { uv },
                                                        .indices = indices,
                                                        .material = material });
    assert_true(mesh >= 0);
    return fixture_instance(s, mesh, NULL);
}

int fixture_floor(struct frame_fixture *s, float half, int material)
{
    return fixture_quad(s, vec3_of(-half, 0, half), vec3_of(half, 0, half), vec3_of(half, 0, -half),
                        vec3_of(-half, 0, -half), material);
}

void fixture_box(struct frame_fixture *s, vec3s min, vec3s max, bool inwards, int material)
{
    for (int face = 0; face < 6; face++) {
        int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        vec3s corners[4];
        for (int i = 0; i < 4; i++) {
            corners[i].raw[axis] = face % 2 ? min.raw[axis] : max.raw[axis];
            corners[i].raw[u] = i == 1 || i == 2 ? max.raw[u] : min.raw[u];
            corners[i].raw[v] = i >= 2 ? max.raw[v] : min.raw[v];
        }
        bool forwards = (face % 2 == 0) != inwards;
        fixture_quad(s, corners[0], corners[forwards ? 1 : 3], corners[2],
                     corners[forwards ? 3 : 1], material);
    }
}

static struct world_light *add_light(struct frame_fixture *s, struct world_light light)
{
    assert_true(s->input.light_count < (int)(sizeof s->lights / sizeof *s->lights));
    s->lights[s->input.light_count] = light;
    return &s->lights[s->input.light_count++];
}

struct world_light *fixture_add_sun(struct frame_fixture *s, vec3s direction, vec3s lux)
{
    return add_light(s, (struct world_light){ .type = LIGHT_SUN,
                                              .direction = glms_vec3_normalize(direction),
                                              .intensity = lux });
}

struct world_light *fixture_add_point(struct frame_fixture *s, vec3s position, vec3s candela)
{
    return add_light(s, (struct world_light){ .type = LIGHT_POINT,
                                              .position = position,
                                              .direction = vec3_of(0, 0, -1),
                                              .intensity = candela });
}

struct world_light *fixture_add_spot(struct frame_fixture *s, vec3s position, vec3s direction,
                                     float inner_rad, float outer_rad, vec3s candela)
{
    return add_light(s, (struct world_light){ .type = LIGHT_SPOT,
                                              .position = position,
                                              .direction = glms_vec3_normalize(direction),
                                              .cos_inner = cosf(inner_rad),
                                              .cos_outer = cosf(outer_rad),
                                              .intensity = candela });
}

void fixture_look(struct frame_fixture *s, vec3s position, vec3s target)
{
    s->input.camera = camera_look_at(position, target, 1.0f, 0.05f);
}

static int channels_of(enum frame_readback what)
{
    return what == READ_DEPTH || what == READ_VISIBILITY ? 1 : what == READ_ID ? 2 : 3;
}

float *fixture_read(struct frame_fixture *s, enum frame_readback what)
{
    int channels = channels_of(what);
    float *pixels = calloc((size_t)s->width * s->height, (size_t)channels * sizeof *pixels);
    assert_non_null(pixels);
    assert_true(frame_read(s->frame, what, pixels, channels));
    return pixels;
}

vec3s fixture_pixel(struct frame_fixture *s, enum frame_readback what, uint32_t x, uint32_t y)
{
    float *pixels = fixture_read(s, what);
    size_t channels = (size_t)channels_of(what);
    const float *p = &pixels[((size_t)y * s->width + x) * channels];
    vec3s value = vec3_of(p[0], p[channels > 1 ? 1 : 0], p[channels > 2 ? 2 : 0]);
    free(pixels);
    return value;
}

vec3s fixture_ray(const struct frame_fixture *s, float x, float y)
{
    const struct world_camera *c = &s->input.camera;
    float tan_y = tanf(0.5f * c->vertical_fov_rad);
    float tan_x = tan_y * (float)s->width / (float)s->height;
    vec3s right = glms_vec3_cross(c->forward, c->up);
    vec3s d = glms_vec3_muladds(right, tan_x * (2 * x / (float)s->width - 1), c->forward);
    return glms_vec3_muladds(c->up, tan_y * (1 - 2 * y / (float)s->height), d);
}

vec3s fixture_ray_on_plane(const struct frame_fixture *s, uint32_t x, uint32_t y, vec3s normal,
                           float offset)
{
    const struct world_camera *c = &s->input.camera;
    vec3s d = fixture_ray(s, (float)x + 0.5f, (float)y + 0.5f);
    float t = (offset - glms_vec3_dot(normal, c->eye)) / glms_vec3_dot(normal, d);
    return glms_vec3_muladds(d, t, c->eye);
}

void fixture_open_two_walls(struct frame_fixture *s)
{
    const int matte = fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f));
    fixture_quad(s, vec3_of(0, -20, 0), vec3_of(20, -20, 0), vec3_of(20, 20, 0), vec3_of(0, 20, 0),
                 matte);
    fixture_quad(s, vec3_of(0, -20, 20), vec3_of(0, -20, 0), vec3_of(0, 20, 0), vec3_of(0, 20, 20),
                 matte);
    fixture_look(s, vec3_of(3, 0, 3), vec3_of(0, 0, 0));
    fixture_open(s);
}
