// Connected parts of meshes.
#include "framework/test.h"

#include "core/rng.h"
#include "scene/mesh_parts.h"

#include <stdlib.h>

enum { QUADS = 5 };

// Quads in a row along x, `gap` apart, each with four vertices of its own.
static void row_of_quads(float gap, vec3s positions[4 * QUADS], uint32_t indices[6 * QUADS])
{
    for (uint32_t i = 0; i < QUADS; i++) {
        const float x = (1.0f + gap) * (float)i;
        const vec3s corners[4] = { { { x, 0, -0.0f } },
                                   { { x + 1, 0, 0 } },
                                   { { x + 1, 1, 0 } },
                                   { { x, 1, i % 2 ? -0.0f : 0.0f } } };
        const uint32_t quad[6] = { 0, 1, 2, 0, 2, 3 };
        for (uint32_t k = 0; k < 4; k++) positions[4 * i + k] = corners[k];
        for (uint32_t k = 0; k < 6; k++) indices[6 * i + k] = 4 * i + quad[k];
    }
}

static int parts_of_row(float gap, uint32_t part[2 * QUADS])
{
    vec3s positions[4 * QUADS];
    uint32_t indices[6 * QUADS];
    row_of_quads(gap, positions, indices);
    const struct mesh mesh = { .vertex_count = 4 * QUADS,
                               .index_count = 6 * QUADS,
                               .positions = positions,
                               .indices = indices };
    return mesh_parts(test_host(), &mesh, part);
}

TEST(separate_quads_are_parts_in_order)
{
    uint32_t part[2 * QUADS];
    CHECK(parts_of_row(0.5f, part) == QUADS);
    for (uint32_t t = 0; t < 2 * QUADS; t++) CHECK(part[t] == t / 2);
}

// Vertices of their own, −0 beside 0: only positions connect.
TEST(equal_positions_connect)
{
    uint32_t part[2 * QUADS];
    CHECK(parts_of_row(0.0f, part) == 1);
    for (uint32_t t = 0; t < 2 * QUADS; t++) CHECK(part[t] == 0);
}

// Random triangles over few vertices against the transitive closure by repeated passes.
TEST(parts_are_the_transitive_closure)
{
    enum { VERTICES = 400, TRIANGLES = 90 };
    for (uint32_t trial = 0; trial < 20; trial++) {
        vec3s positions[VERTICES];
        uint32_t indices[3 * TRIANGLES], part[TRIANGLES], label[TRIANGLES];
        struct rng rng = rng_for(trial, 0, 0);
        for (int v = 0; v < VERTICES; v++)
            positions[v] = vec3_of((float)(rng_u32(&rng) % 16), (float)(rng_u32(&rng) % 16),
                                   (float)(rng_u32(&rng) % 4));
        for (int i = 0; i < 3 * TRIANGLES; i++) indices[i] = rng_u32(&rng) % VERTICES;
        for (uint32_t t = 0; t < TRIANGLES; t++) label[t] = t;
        for (bool changed = true; changed;) {
            changed = false;
            for (int a = 0; a < 3 * TRIANGLES; a++)
                for (int b = 0; b < 3 * TRIANGLES; b++) {
                    const vec3s p = positions[indices[a]], q = positions[indices[b]];
                    if (p.x != q.x || p.y != q.y || p.z != q.z || label[a / 3] <= label[b / 3])
                        continue;
                    label[a / 3] = label[b / 3];
                    changed = true;
                }
        }
        const struct mesh mesh = { .vertex_count = VERTICES,
                                   .index_count = 3 * TRIANGLES,
                                   .positions = positions,
                                   .indices = indices };
        const int count = mesh_parts(test_host(), &mesh, part);
        CHECK(count > 1 && count < TRIANGLES);
        for (int a = 0; a < TRIANGLES; a++)
            for (int b = 0; b < TRIANGLES; b++)
                CHECK((part[a] == part[b]) == (label[a] == label[b]));
    }
}
