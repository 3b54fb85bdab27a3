// Tangents as MikkTSpace makes them (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited",
// section 5.2), per vertex instead of per corner: each triangle's direction of increasing u,
// projected onto the plane of the vertex normal, normalised and weighted by the triangle's angle.
// Vertices of equal position, normal, texture coordinates and handedness share one tangent, also
// where the file has them twice.
//
// The handedness is glTF's: the green channel of a normal map points up in the image, against v. An
// unmirrored mapping has w = +1 there, where MikkTSpace on the same texture coordinates gives -1.
#include "scene/mesh_geometry.h"

#include "core/hash.h"

#include <math.h>
#include <string.h>

struct corner_key { // corners with equal keys share a tangent
    vec3s position, normal;
    vec2s uv;
    uint32_t mirrored;
};

struct tangent_work {
    const struct mesh *mesh;
    vec2s *uv;          // transformed
    int8_t *flags;      // per vertex: FLAG_*
    uint32_t *mirrored; // vertex → its mirrored duplicate, or itself
    uint32_t *source;   // new vertex → old vertex
    uint32_t count;     // new vertices
};

enum { FLAG_STRAIGHT = 1, FLAG_MIRRORED = 2 };

static vec2s transform_uv(const struct texture_use *map, vec2s uv)
{
    // KHR_texture_transform: offset + rotation · scale · uv, rotation counter-clockwise in the
    // image (v down).
    float c = cosf(map->uv_rotation_rad), s = sinf(map->uv_rotation_rad);
    float x = uv.x * map->uv_scale[0], y = uv.y * map->uv_scale[1];
    return (vec2s){ { c * x + s * y + map->uv_offset[0], -s * x + c * y + map->uv_offset[1] } };
}

// Twice the signed area in texture space; v grows downwards, so that unmirrored triangles are
// negative.
static float uv_area(const struct tangent_work *work, const uint32_t *t)
{
    const vec2s *uv = work->uv;
    float x1 = uv[t[1]].x - uv[t[0]].x, y1 = uv[t[1]].y - uv[t[0]].y;
    float x2 = uv[t[2]].x - uv[t[0]].x, y2 = uv[t[2]].y - uv[t[0]].y;
    return x1 * y2 - x2 * y1;
}

// Duplicates the vertices that triangles of both handednesses use.
static void split_mirrored(struct tangent_work *work, uint32_t *indices)
{
    const struct mesh *mesh = work->mesh;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        float area = uv_area(work, indices + i);
        int8_t flag = area < 0.0f ? FLAG_STRAIGHT : area > 0.0f ? FLAG_MIRRORED : 0;
        for (int k = 0; k < 3; k++) work->flags[indices[i + (uint32_t)k]] |= flag;
    }
    work->count = mesh->vertex_count;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        bool both = work->flags[v] == (FLAG_STRAIGHT | FLAG_MIRRORED);
        work->source[v] = v;
        work->mirrored[v] = both ? work->count : v;
        if (both) work->source[work->count++] = v;
    }
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        if (!(uv_area(work, indices + i) > 0.0f)) continue;
        for (int k = 0; k < 3; k++)
            indices[i + (uint32_t)k] = work->mirrored[indices[i + (uint32_t)k]];
    }
}

static bool is_mirrored(const struct tangent_work *work, uint32_t vertex)
{
    return vertex >= work->mesh->vertex_count || work->flags[vertex] == FLAG_MIRRORED;
}

// shared[v]: the first vertex with the same key. `table` has a power of two of slots, more than
// vertices.
static void find_shared(const struct tangent_work *work, uint32_t *shared, uint32_t *table,
                        size_t slots)
{
    const struct mesh *mesh = work->mesh;
    for (size_t i = 0; i < slots; i++) table[i] = UINT32_MAX;
    for (uint32_t v = 0; v < work->count; v++) {
        uint32_t old = work->source[v];
        struct corner_key key = { mesh->positions[old], mesh->normals[old], work->uv[old],
                                  is_mirrored(work, v) };
        size_t slot = hash_bytes(&key, sizeof key, 0) & (slots - 1);
        for (;; slot = (slot + 1) & (slots - 1)) {
            if (table[slot] == UINT32_MAX) {
                shared[v] = table[slot] = v;
                break;
            }
            uint32_t u = table[slot];
            uint32_t from = work->source[u];
            struct corner_key other = { mesh->positions[from], mesh->normals[from], work->uv[from],
                                        is_mirrored(work, u) };
            if (memcmp(&key, &other, sizeof key) == 0) {
                shared[v] = u;
                break;
            }
        }
    }
}

static vec3s on_plane(vec3s v, vec3s normal)
{
    return glms_vec3_sub(v, glms_vec3_scale(normal, glms_vec3_dot(normal, v)));
}

// Normalised; zero where the length is zero or not finite.
static vec3s unit_or_zero(vec3s v)
{
    float length = glms_vec3_norm(v);
    return length > 0.0f && isfinite(length) ? glms_vec3_scale(v, 1.0f / length)
                                             : vec3_of(0.0f, 0.0f, 0.0f);
}

// Adds the triangle's direction of increasing u to the tangents of its corners.
static void add_triangle(const struct tangent_work *work, const uint32_t *triangle,
                         const uint32_t *shared, vec3s *sums)
{
    const struct mesh *mesh = work->mesh;
    uint32_t old[3];
    vec3s p[3];
    for (int k = 0; k < 3; k++) {
        old[k] = work->source[triangle[k]];
        p[k] = mesh->positions[old[k]];
    }
    float area = uv_area(work, old);
    if (area == 0.0f) return;
    float v1 = work->uv[old[1]].y - work->uv[old[0]].y,
          v2 = work->uv[old[2]].y - work->uv[old[0]].y;
    vec3s along_u = glms_vec3_sub(glms_vec3_scale(glms_vec3_sub(p[1], p[0]), v2),
                                  glms_vec3_scale(glms_vec3_sub(p[2], p[0]), v1));
    along_u = unit_or_zero(glms_vec3_scale(along_u, area > 0.0f ? 1.0f : -1.0f));
    for (int k = 0; k < 3; k++) {
        vec3s normal = mesh->normals[old[k]];
        vec3s a = unit_or_zero(on_plane(glms_vec3_sub(p[(k + 1) % 3], p[k]), normal));
        vec3s b = unit_or_zero(on_plane(glms_vec3_sub(p[(k + 2) % 3], p[k]), normal));
        float cosine = fminf(fmaxf(glms_vec3_dot(a, b), -1.0f), 1.0f);
        vec3s tangent = unit_or_zero(on_plane(along_u, normal));
        vec3s *sum = &sums[shared[triangle[k]]];
        *sum = glms_vec3_add(*sum, glms_vec3_scale(tangent, acosf(cosine)));
    }
}

static void fill_tangents(const struct tangent_work *work, struct mesh *made,
                          const uint32_t *shared, vec3s *sums)
{
    for (uint32_t i = 0; i < made->index_count; i += 3) {
        add_triangle(work, made->indices + i, shared, sums);
    }
    for (uint32_t v = 0; v < made->vertex_count; v++) {
        vec3s normal = made->normals[v], bitangent;
        vec3s tangent = unit_or_zero(on_plane(sums[shared[v]], normal));
        if (glms_vec3_norm2(tangent) == 0.0f) basis_of(normal, &tangent, &bitangent);
        made->tangents[v] = vec4_of(tangent, is_mirrored(work, v) ? -1.0f : 1.0f);
    }
}

// Temporary arrays come from `scratch`.
static bool make_tangents(struct arena *arena, struct arena *scratch, struct mesh *mesh,
                          const struct texture_use *map)
{
    struct mesh made = *mesh;
    made.tangents = NULL;
    size_t old_count = mesh->vertex_count;
    struct tangent_work work = { .mesh = mesh };
    work.uv = arena_alloc(scratch, old_count, sizeof *work.uv);
    work.flags = arena_alloc(scratch, old_count, sizeof *work.flags);
    work.mirrored = arena_alloc(scratch, old_count, sizeof *work.mirrored);
    work.source = arena_alloc(scratch, 2 * old_count, sizeof *work.source);
    made.indices = arena_alloc(arena, mesh->index_count, sizeof *made.indices);
    if (!work.uv || !work.flags || !work.mirrored || !work.source || !made.indices) return false;
    for (size_t v = 0; v < old_count; v++) work.uv[v] = transform_uv(map, mesh->uv[map->uv_set][v]);
    memcpy(made.indices, mesh->indices, mesh->index_count * sizeof *made.indices);
    split_mirrored(&work, made.indices);

    size_t slots = 16;
    while (slots < (size_t)work.count * 2) slots *= 2;
    uint32_t *shared = arena_alloc(scratch, work.count, sizeof *shared);
    uint32_t *table = arena_alloc(scratch, slots, sizeof *table);
    vec3s *sums = arena_alloc(scratch, work.count, sizeof *sums);
    if (!shared || !table || !sums) return false;
    find_shared(&work, shared, table, slots);
    if (work.count > mesh->vertex_count && !mesh_gather(arena, &made, work.source, work.count)) {
        return false;
    }
    made.tangents = arena_alloc(arena, made.vertex_count, sizeof *made.tangents);
    if (!made.tangents) return false;
    fill_tangents(&work, &made, shared, sums);
    *mesh = made;
    return true;
}

bool mesh_make_tangents(struct arena *arena, struct mesh *mesh, const struct texture_use *map)
{
    if (map->uv_set < 0 || map->uv_set > 1 || !mesh->uv[map->uv_set]) return true;
    if (mesh->vertex_count > UINT32_MAX / 2) {
        return host_fail(arena->host, FAIL_UNSUPPORTED, "tangents of mesh %s: too many vertices",
                         mesh->name ? mesh->name : "");
    }
    struct arena scratch;
    arena_init(&scratch, arena->host);
    bool ok = make_tangents(arena, &scratch, mesh, map);
    arena_finish(&scratch);
    return ok;
}

static bool update_tangents(struct arena *scratch, struct mesh *mesh, const struct texture_use *map)
{
    const uint32_t count = mesh->vertex_count;
    struct tangent_work work = { .mesh = mesh, .count = count };
    size_t slots = 16;
    while (slots < (size_t)count * 2) slots *= 2;
    work.uv = arena_alloc(scratch, count, sizeof *work.uv);
    work.flags = arena_alloc(scratch, count, sizeof *work.flags);
    work.source = arena_alloc(scratch, count, sizeof *work.source);
    uint32_t *shared = arena_alloc(scratch, count, sizeof *shared);
    uint32_t *table = arena_alloc(scratch, slots, sizeof *table);
    vec3s *sums = arena_alloc(scratch, count, sizeof *sums);
    if (!work.uv || !work.flags || !work.source || !shared || !table || !sums) return false;
    for (uint32_t v = 0; v < count; v++) {
        work.uv[v] = transform_uv(map, mesh->uv[map->uv_set][v]);
        work.flags[v] = mesh->tangents[v].w < 0.0f ? FLAG_MIRRORED : FLAG_STRAIGHT;
        work.source[v] = v;
    }
    find_shared(&work, shared, table, slots);
    fill_tangents(&work, mesh, shared, sums);
    return true;
}

bool mesh_update_tangents(struct host *host, struct mesh *mesh, const struct texture_use *map)
{
    if (!mesh->tangents || map->image < 0 || !mesh->uv[map->uv_set]) return true;
    struct arena scratch;
    arena_init(&scratch, host);
    const bool ok = update_tangents(&scratch, mesh, map);
    arena_finish(&scratch);
    return ok;
}
