#include "techniques/dnrt/sphere_fixture.h"

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
