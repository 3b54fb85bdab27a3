// Fixture: a small scene and its reference.
#include "trace/trace_fixture.h"

#include <math.h>
#include <string.h>

void fixture_init(struct trace_fixture *s)
{
    *s = (struct trace_fixture){ .width = 16, .height = 16, .samples = 64 };
    s->options = reference_options_default();
    s->options.diffuse_only = true;
    s->scene = scene_create(test_host(), "trace fixture");
    assert_non_null(s->scene);
    fixture_aim_camera(s, vec3_of(0, 0, 0), vec3_of(0, 0, -1), 0.1f);
}

void fixture_builtin(struct trace_fixture *s, const char *name)
{
    *s = (struct trace_fixture){ .width = 32, .height = 32, .samples = 16 };
    s->options = reference_options_default();
    s->scene = scene_load(test_host(), name);
    assert_non_null(s->scene);
    assert_true(pose_init(&s->pose, s->scene, -1, 0));
    s->camera = pose_camera(&s->pose, 0);
}

void fixture_finish(struct trace_fixture *s)
{
    pose_finish(&s->pose);
    scene_destroy(s->scene);
}

int fixture_material(struct trace_fixture *s, const struct material *material)
{
    int index = scene_add_material(s->scene, material);
    assert_true(index >= 0);
    return index;
}

int fixture_diffuse(struct trace_fixture *s, vec3s albedo, vec3s emission)
{
    struct material m = material_default();
    m.base_color = vec4_of(albedo, 1);
    m.emissive = emission;
    return fixture_material(s, &m);
}

static void add_instance(struct trace_fixture *s, const struct mesh *mesh)
{
    struct node node = node_default();
    int m = scene_add_mesh(s->scene, mesh), n = scene_add_node(s->scene, &node);
    assert_true(m >= 0 && n >= 0);
    struct instance instance = { .node = n, .mesh = m, .skin = -1 };
    assert_true(scene_add_instance(s->scene, &instance) >= 0);
}

void fixture_quad(struct trace_fixture *s, vec3s a, vec3s b, vec3s c, vec3s d, int material)
{
    vec3s positions[4] = { a, b, c, d };
    vec2s uv[4] = { { { 0, 1 } }, { { 1, 1 } }, { { 1, 0 } }, { { 0, 0 } } };
    uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    add_instance(s, &(struct mesh){ .name = "quad",
                                    .vertex_count = 4,
                                    .index_count = 6,
                                    .positions = positions,
                                    .uv = { uv },
                                    .indices = indices,
                                    .material = material });
}

void fixture_disk(struct trace_fixture *s, vec3s centre, vec3s normal, float area_m2, int corners,
                  int material)
{
    enum { MAX_CORNERS = 512 };
    vec3s positions[MAX_CORNERS + 1], t, b;
    uint32_t indices[3 * MAX_CORNERS];
    assert_true(corners <= MAX_CORNERS);
    basis_of(normal, &t, &b);
    float step = 2.0f * GLM_PIf / (float)corners;
    float radius = sqrtf(area_m2 / (0.5f * (float)corners * sinf(step)));
    positions[corners] = centre;
    for (int i = 0; i < corners; i++) {
        vec3s p = glms_vec3_muladds(t, radius * cosf(step * (float)i), centre);
        positions[i] = glms_vec3_muladds(b, radius * sinf(step * (float)i), p);
        indices[3 * i] = (uint32_t)corners;
        indices[3 * i + 1] = (uint32_t)i;
        indices[3 * i + 2] = (uint32_t)((i + 1) % corners);
    }
    add_instance(s, &(struct mesh){ .name = "disk",
                                    .vertex_count = (uint32_t)corners + 1,
                                    .index_count = 3 * (uint32_t)corners,
                                    .positions = positions,
                                    .indices = indices,
                                    .material = material });
}

void fixture_room(struct trace_fixture *s, float half, int material)
{
    for (int face = 0; face < 6; face++) {
        int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        vec3s corner[4];
        for (int i = 0; i < 4; i++) {
            corner[i].raw[axis] = face % 2 ? half : -half;
            corner[i].raw[u] = i == 1 || i == 2 ? half : -half;
            corner[i].raw[v] = i >= 2 ? half : -half;
        }
        if (face % 2)
            fixture_quad(s, corner[0], corner[3], corner[2], corner[1], material);
        else
            fixture_quad(s, corner[0], corner[1], corner[2], corner[3], material);
    }
}

void fixture_light(struct trace_fixture *s, enum light_type type, vec3s position, vec3s direction,
                   vec3s intensity)
{
    int node = scene_add_node_looking(s->scene, "light", position, direction);
    struct light light = { .name = "light",
                           .type = type,
                           .node = node,
                           .intensity = intensity,
                           .inner_rad = 0.2f,
                           .outer_rad = 0.6f };
    assert_true(node >= 0 && scene_add_light(s->scene, &light) >= 0);
}

void fixture_aim_camera(struct trace_fixture *s, vec3s position, vec3s target, float fov_rad)
{
    s->camera = camera_look_at(position, target, fov_rad, 0.001f);
}

struct reference *fixture_reference(struct trace_fixture *s)
{
    pose_finish(&s->pose);
    assert_true(pose_init(&s->pose, s->scene, -1, 0));
    struct reference *r =
        reference_create(test_host(), &s->pose, &s->camera, s->width, s->height, &s->options);
    if (!r) fail_msg("%s", test_last_message());
    return r;
}

double image_mean(const struct image *image, int channel)
{
    double sum = 0;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++)
        sum += (double)image->pixels[i * (size_t)image->channels + (size_t)channel];
    return sum / (double)pixels;
}

static void check_finite(const struct image *image)
{
    size_t values = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < values; i++) assert_true(isfinite(image->pixels[i]));
}

struct image fixture_layer(struct trace_fixture *s, enum reference_layer layer)
{
    struct reference *r = fixture_reference(s);
    struct image image = { 0 };
    assert_true(reference_render(r, s->samples, NULL, NULL));
    assert_true(reference_read(r, layer, &image));
    check_finite(&image);
    reference_destroy(r);
    return image;
}

struct layer_mean fixture_mean(struct trace_fixture *s, enum reference_layer layer)
{
    struct reference *r = fixture_reference(s);
    struct image image = { 0 };
    assert_true(reference_render(r, s->samples, NULL, NULL));
    assert_true(reference_read(r, layer, &image));
    struct layer_mean m = { .error = reference_info(r).error / sqrt(s->width * s->height) };
    for (int c = 0; c < 3 && c < image.channels; c++) m.mean[c] = image_mean(&image, c);
    image_finish(&image, test_host());
    reference_destroy(r);
    return m;
}
