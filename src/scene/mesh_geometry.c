// Rearranged vertex arrays of a mesh, and its bounds.
#include "scene/mesh_geometry.h"

#include <math.h>
#include <string.h>

// NULL for a NULL array; *ok becomes false when out of memory.
static void *gather(struct arena *arena, const void *old, size_t size, const uint32_t *source,
                    uint32_t count, bool *ok)
{
    if (!old || !*ok) return NULL;
    unsigned char *array = arena_alloc(arena, count, size);
    if (!array) {
        *ok = false;
        return NULL;
    }
    const unsigned char *from = old;
    for (uint32_t i = 0; i < count; i++) memcpy(array + i * size, from + source[i] * size, size);
    return array;
}

static void gather_morphs(struct arena *arena, struct mesh *mesh, const uint32_t *source,
                          uint32_t count, bool *ok)
{
    const struct morph_target *old = mesh->morphs;
    if (!old || mesh->morph_count == 0 || !*ok) return;
    mesh->morphs = arena_alloc(arena, (size_t)mesh->morph_count, sizeof *mesh->morphs);
    *ok = mesh->morphs != NULL;
    for (int i = 0; *ok && i < mesh->morph_count; i++) {
        const struct morph_target *from = &old[i];
        struct morph_target *to = &mesh->morphs[i];
        to->positions = gather(arena, from->positions, sizeof *from->positions, source, count, ok);
        to->normals = gather(arena, from->normals, sizeof *from->normals, source, count, ok);
    }
}

// `made` has the source of the old mesh.
static bool compose_source(struct arena *arena, struct mesh *made, const uint32_t *source,
                           uint32_t count)
{
    const uint32_t *before = made->source;
    made->source = arena_alloc(arena, count, sizeof *made->source);
    if (!made->source) return false;
    for (uint32_t i = 0; i < count; i++) made->source[i] = before ? before[source[i]] : source[i];
    return true;
}

bool mesh_gather(struct arena *arena, struct mesh *mesh, const uint32_t *source, uint32_t count)
{
    bool ok = true;
    struct mesh made = *mesh;
    made.vertex_count = count;
    if (!mesh->source) made.source_count = mesh->vertex_count;
#define GATHER(array)                                                                              \
    made.array = gather(arena, mesh->array, sizeof *mesh->array, source, count, &ok)
    GATHER(positions);
    GATHER(normals);
    GATHER(tangents);
    GATHER(uv[0]);
    GATHER(uv[1]);
    GATHER(colors);
    GATHER(joints);
    GATHER(weights);
#undef GATHER
    gather_morphs(arena, &made, source, count, &ok);
    ok = ok && compose_source(arena, &made, source, count);
    if (ok) *mesh = made;
    return ok;
}

vec4s mesh_unit_tangent(vec3s normal, vec4s tangent)
{
    vec3s t = vec3_xyz(tangent), bitangent;
    t = glms_vec3_sub(t, glms_vec3_scale(normal, glms_vec3_dot(normal, t)));
    const float length = glms_vec3_norm(t);
    if (length > 1e-6f && isfinite(length))
        t = glms_vec3_divs(t, length);
    else
        basis_of(normal, &t, &bitangent);
    return vec4_of(t, tangent.w < 0.0f ? -1.0f : 1.0f);
}

struct box3 mesh_bounds(const struct mesh *mesh)
{
    struct box3 box = box3_empty();
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        box = box3_add_point(box, mesh->positions[i]);
    }
    return box;
}
