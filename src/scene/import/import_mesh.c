// Validation and completion of imported meshes.
#include "scene/import/import_mesh.h"

#include "scene/mesh_geometry.h"

#include <math.h>
#include <string.h>

// Bytes of a vertex with all attributes, for the budget.
static size_t vertex_bytes(const struct mesh *mesh)
{
    return 2 * sizeof(vec3s) + 3 * sizeof(vec4s) + 2 * sizeof(vec2s) + 4 * sizeof(uint16_t) +
           sizeof(uint32_t) + (size_t)mesh->morph_count * 2 * sizeof(vec3s);
}

bool import_check_indices(struct import *import, const struct mesh *mesh, uint32_t *low,
                          uint32_t *high)
{
    *low = UINT32_MAX;
    *high = 0;
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        uint32_t index = mesh->indices[i];
        if (index < *low) *low = index;
        if (index > *high) *high = index;
    }
    if (*high >= mesh->vertex_count) {
        return host_fail(import->host, FAIL_FORMAT, "%s: mesh %s: index %u exceeds its %u vertices",
                         import->path, import_printable(mesh->name).s, *high, mesh->vertex_count);
    }
    return true;
}

// Primitives may share one large vertex buffer: each mesh keeps only the vertices of its triangles.
static bool drop_unused_vertices(struct import *import, struct mesh *mesh)
{
    uint32_t low, high, used = 0;
    if (!import_check_indices(import, mesh, &low, &high)) return false;
    uint32_t range = high - low + 1;
    if (!import_charge(import, range, sizeof(uint32_t))) return false;
    uint32_t *number = host_alloc(import->host, range, sizeof *number);
    if (!number) return false;
    for (uint32_t i = 0; i < mesh->index_count; i++) number[mesh->indices[i] - low] = 1;
    for (uint32_t i = 0; i < range; i++) used += number[i];
    bool ok = true;
    if (used < mesh->vertex_count) {
        ok = import_charge(import, used, vertex_bytes(mesh));
        uint32_t *source = ok ? host_alloc(import->host, used, sizeof *source) : NULL;
        uint32_t *indices =
            source ? import_alloc(import, mesh->index_count, sizeof *indices) : NULL;
        ok = indices != NULL;
        for (uint32_t i = 0, next = 0; ok && i < range; i++) {
            if (!number[i]) continue;
            number[i] = next;
            source[next++] = low + i;
        }
        for (uint32_t i = 0; ok && i < mesh->index_count; i++) {
            indices[i] = number[mesh->indices[i] - low];
        }
        ok = ok && mesh_gather(&import->scene->arena, mesh, source, used);
        if (ok) mesh->indices = indices;
        host_free(import->host, source);
    }
    host_free(import->host, number);
    return ok;
}

static bool check_finite(struct import *import, const struct mesh *mesh, const char *what,
                         const void *array, size_t width)
{
    const float *values = array;
    if (!values) return true;
    size_t count = (size_t)mesh->vertex_count * width;
    for (size_t i = 0; i < count; i++) {
        if (isfinite(values[i])) continue;
        return host_fail(import->host, FAIL_FORMAT, "%s: mesh %s: %s of vertex %zu is not finite",
                         import->path, import_printable(mesh->name).s, what, i / width);
    }
    return true;
}

static bool check_all_finite(struct import *import, const struct mesh *mesh)
{
    bool ok = check_finite(import, mesh, "position", mesh->positions, 3) &&
              check_finite(import, mesh, "normal", mesh->normals, 3) &&
              check_finite(import, mesh, "texture coordinate", mesh->uv[0], 2) &&
              check_finite(import, mesh, "texture coordinate", mesh->uv[1], 2) &&
              check_finite(import, mesh, "colour", mesh->colors, 4) &&
              check_finite(import, mesh, "joint weight", mesh->weights, 4);
    for (int i = 0; ok && i < mesh->morph_count; i++) {
        ok = check_finite(import, mesh, "morph position", mesh->morphs[i].positions, 3) &&
             check_finite(import, mesh, "morph normal", mesh->morphs[i].normals, 3);
    }
    return ok;
}

static bool has_length(vec3s v)
{
    float squared = glms_vec3_norm2(v);
    return squared > 0.0f && isfinite(squared);
}

// Normalises normals; a normal of length zero becomes that of the last triangle that uses it.
static bool unit_normals(struct import *import, struct mesh *mesh)
{
    vec3s *normals = import_alloc(import, mesh->vertex_count, sizeof *normals);
    if (!normals) return false;
    bool missing = false;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        vec3s n = mesh->normals[i];
        float largest = fmaxf(fmaxf(fabsf(n.x), fabsf(n.y)), fabsf(n.z));
        if (largest > 0.0f)
            normals[i] = glms_vec3_normalize(glms_vec3_divs(n, largest));
        else
            missing = true;
    }
    for (uint32_t i = 0; missing && i < mesh->index_count; i++) {
        uint32_t v = mesh->indices[i];
        if (glms_vec3_norm2(mesh->normals[v]) > 0.0f) continue;
        const uint32_t *t = mesh->indices + i - i % 3;
        const vec3s *p = mesh->positions;
        vec3s n = glms_vec3_cross(glms_vec3_sub(p[t[1]], p[t[0]]), glms_vec3_sub(p[t[2]], p[t[0]]));
        normals[v] = has_length(n) ? glms_vec3_normalize(n) : vec3_of(0.0f, 1.0f, 0.0f);
    }
    mesh->normals = normals;
    return true;
}

// Exporters write NaN or zero where texture coordinates are degenerate.
static bool unit_tangents(struct import *import, struct mesh *mesh)
{
    vec4s *tangents = import_alloc(import, mesh->vertex_count, sizeof *tangents);
    if (!tangents) return false;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        tangents[i] = mesh_unit_tangent(mesh->normals[i], mesh->tangents[i]);
    mesh->tangents = tangents;
    return true;
}

bool import_finish_mesh(struct import *import, struct mesh *mesh)
{
    struct arena *arena = &import->scene->arena;
    const struct texture_use *normal_map = &import->scene->materials[mesh->material].normal_map;
    if (!drop_unused_vertices(import, mesh) || !check_all_finite(import, mesh)) return false;
    if (mesh->normals && normal_map->image < 0) mesh->tangents = NULL;
    if (!mesh->normals) {
        if (!import_charge(import, mesh->index_count, vertex_bytes(mesh))) return false;
        if (!mesh_make_normals(arena, mesh)) return false;
    } else if (!unit_normals(import, mesh)) {
        return false;
    }
    if (mesh->tangents && !unit_tangents(import, mesh)) return false;
    if (!mesh->tangents && normal_map->image >= 0) {
        if (!import_charge(import, mesh->vertex_count, 2 * vertex_bytes(mesh))) return false;
        if (!mesh_make_tangents(arena, mesh, normal_map)) return false;
    }
    mesh->bounds = mesh_bounds(mesh);
    return true;
}
