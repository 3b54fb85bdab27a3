// Flat normals (glTF 2.0, section 3.7.2.1: "client implementations MUST calculate flat normals").
#include "scene/mesh_geometry.h"

// In double: the squared lengths of a triangle of 1e-20 m underflow in float.
static vec3s plane_normal(const vec3s p[3])
{
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)p[1].raw[k] - (double)p[0].raw[k];
        b[k] = (double)p[2].raw[k] - (double)p[0].raw[k];
    }
    double n[3] = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0] };
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 0.0)) return vec3_of(0.0f, 1.0f, 0.0f);
    return vec3_of((float)(n[0] / length), (float)(n[1] / length), (float)(n[2] / length));
}

bool mesh_make_normals(struct arena *arena, struct mesh *mesh)
{
    struct mesh made = *mesh;
    made.normals = NULL;
    made.tangents = NULL;
    made.flat_normals = true;
    if (!mesh_gather(arena, &made, mesh->indices, mesh->index_count)) return false;
    made.normals = arena_alloc(arena, made.vertex_count, sizeof *made.normals);
    made.indices = arena_alloc(arena, made.index_count, sizeof *made.indices);
    if (!made.normals || !made.indices) return false;
    for (uint32_t i = 0; i < made.index_count; i++) {
        made.indices[i] = i;
        made.normals[i] = i % 3 == 0 ? plane_normal(&made.positions[i]) : made.normals[i - 1];
    }
    *mesh = made;
    return true;
}

void mesh_update_normals(struct mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        const uint32_t *t = &mesh->indices[i];
        const vec3s corner[3] = { mesh->positions[t[0]], mesh->positions[t[1]],
                                  mesh->positions[t[2]] };
        const vec3s normal = plane_normal(corner);
        for (int k = 0; k < 3; k++) mesh->normals[t[k]] = normal;
    }
}
