#include "techniques/dnrt/sphere_fixture.h"

#include "framework/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ACROSS = 96, SPHERE_VERTICES = 6 * (ACROSS + 1) * (ACROSS + 1) };

// A cube of quads, projected.
int sphere_fixture_add(struct scene *scene, int material)
{
    vec3s *positions = calloc(SPHERE_VERTICES, sizeof *positions);
    uint32_t *indices = calloc((size_t)36 * ACROSS * ACROSS, sizeof *indices);
    uint32_t vertex = 0, count = 0;
    for (int face = 0; face < 6; face++) {
        const uint32_t first = vertex;
        for (int y = 0; y <= ACROSS; y++)
            for (int x = 0; x <= ACROSS; x++) {
                const float side = face % 2 ? 1.0f : -1.0f;
                const float u = tanf(GLM_PI_4f * (2.0f * (float)x / ACROSS - 1.0f)) * side;
                const float v = tanf(GLM_PI_4f * (2.0f * (float)y / ACROSS - 1.0f));
                vec3s p;
                p.raw[face / 2] = side;
                p.raw[(face / 2 + 1) % 3] = u;
                p.raw[(face / 2 + 2) % 3] = v;
                positions[vertex++] = glms_vec3_normalize(p);
            }
        for (uint32_t y = 0; y < ACROSS; y++)
            for (uint32_t x = 0; x < ACROSS; x++) {
                const uint32_t a = first + y * (ACROSS + 1) + x, b = a + ACROSS + 1;
                const uint32_t quad[6] = { a, a + 1, b + 1, a, b + 1, b };
                memcpy(indices + count, quad, sizeof quad);
                count += 6;
            }
    }
    const struct mesh mesh = { .name = "sphere",
                               .vertex_count = vertex,
                               .index_count = count,
                               .positions = positions,
                               .normals = positions,
                               .indices = indices,
                               .material = material };
    const int index = scene_add_mesh(scene, &mesh);
    free(positions);
    free(indices);
    return index;
}

int bowl_fixture_add(struct scene *scene, int material)
{
    enum { RINGS = 48, AROUND = 96, VERTICES = (RINGS + 1) * (AROUND + 1) };
    static vec3s positions[VERTICES], normals[VERTICES];
    static uint32_t indices[6 * RINGS * AROUND];
    uint32_t count = 0;
    for (int r = 0; r <= RINGS; r++)
        for (int a = 0; a <= AROUND; a++) {
            const float theta = GLM_PI_2f * (float)r / RINGS, phi = 2 * GLM_PIf * (float)a / AROUND;
            const vec3s p = vec3_of(sinf(theta) * cosf(phi), -cosf(theta), sinf(theta) * sinf(phi));
            positions[r * (AROUND + 1) + a] = p;
            normals[r * (AROUND + 1) + a] = glms_vec3_negate(p);
        }
    for (uint32_t r = 0; r < RINGS; r++)
        for (uint32_t a = 0; a < AROUND; a++) {
            const uint32_t i = r * (AROUND + 1) + a, up = i + AROUND + 1;
            const uint32_t quad[6] = { i, i + 1, up + 1, i, up + 1, up };
            memcpy(indices + count, quad, sizeof quad);
            count += 6;
        }
    const struct mesh mesh = { .name = "bowl",
                               .vertex_count = VERTICES,
                               .index_count = count,
                               .positions = positions,
                               .normals = normals,
                               .indices = indices,
                               .material = material };
    return scene_add_mesh(scene, &mesh);
}

int crate_fixture_add(struct scene *scene, int material)
{
    enum { SIDES = 5 };
    vec3s positions[4 * SIDES], normals[4 * SIDES];
    uint32_t indices[6 * SIDES];
    for (int side = 0; side < SIDES; side++) { // −x, x, −z, z, −y
        const int axis = (int[]){ 0, 0, 2, 2, 1 }[side];
        const float sign = side % 2 ? 1.0f : -1.0f;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int k = 0; k < 4; k++) {
            vec3s *p = &positions[4 * side + k], n = { { 0, 0, 0 } };
            p->raw[axis] = sign;
            p->raw[u] = (k == 1 || k == 2 ? 1.0f : -1.0f) * -sign;
            p->raw[v] = k >= 2 ? 1.0f : -1.0f;
            n.raw[axis] = -sign;
            normals[4 * side + k] = n;
        }
        const uint32_t first = 4 * (uint32_t)side;
        const uint32_t quad[6] = { first, first + 1, first + 2, first, first + 2, first + 3 };
        memcpy(indices + 6 * side, quad, sizeof quad);
    }
    const struct mesh mesh = { .name = "crate",
                               .vertex_count = 4 * SIDES,
                               .index_count = 6 * SIDES,
                               .positions = positions,
                               .normals = normals,
                               .indices = indices,
                               .material = material };
    return scene_add_mesh(scene, &mesh);
}

void traced_shape_open(struct traced_shape *shape, const struct material *material,
                       int (*add)(struct scene *, int material))
{
    const struct node node = node_default();
    shape->scene = scene_create(test_host(), "shape");
    const int mesh = add(shape->scene, scene_add_material(shape->scene, material));
    const struct instance it = { .node = scene_add_node(shape->scene, &node),
                                 .mesh = mesh,
                                 .skin = -1 };
    CHECK(scene_add_instance(shape->scene, &it) == 0);
    CHECK(pose_init(&shape->pose, shape->scene, -1, 0));
    shape->trace = trace_scene_create(test_host(), &shape->pose);
    assert_non_null(shape->trace);
}

void traced_shape_close(struct traced_shape *shape)
{
    trace_scene_destroy(shape->trace);
    pose_finish(&shape->pose);
    scene_destroy(shape->scene);
}

const struct tensor *baked_tensor(const struct tensors *bake, const char *name)
{
    for (size_t i = 0; i < bake->count; i++) {
        const char *last = strrchr(bake->at[i].name, '/');
        if (last && strcmp(last + 1, name) == 0) return &bake->at[i];
    }
    return NULL;
}
