// Corners are joined by a hash table where position, instance and coordinates of an unwrap are
// equal; edges are sorted by their corners.
#include "scene/charts/surface.h"

#include "scene/charts/triangle_area.h"
#include "scene/charts/unwrap.h"

#include "core/hash.h"

#include <stdlib.h>
#include <string.h>

// ---- triangles

// The sets of coordinates that meshes keep. One warning for a scene names the first mesh whose
// TEXCOORD_1 is broken.
enum { NOT_CHECKED, NO_SET, FIRST_SET }; // FIRST_SET + n: TEXCOORD_n
struct unwraps {
    struct host *host;
    const struct scene *scene;
    enum charts_coordinates coordinates;
    uint8_t *set; // [mesh_count]
    int broken, first;
    enum unwrap_fault fault; // of the first
};

// The tolerance of TEXCOORD_0, which is seldom made for light maps: a fold of some texels in a scan
// is no reason to leave a good unwrap.
static const double TOLERANCE_0 = 1e-3;

static bool try_set(struct unwraps *u, int mesh, int set, enum unwrap_fault *fault)
{
    const double tolerance = set == 0 ? TOLERANCE_0 : 0.0;
    if (!unwrap_check(u->host, &u->scene->meshes[mesh], set, tolerance, fault)) return false;
    if (*fault == UNWRAP_VALID) u->set[mesh] = (uint8_t)(FIRST_SET + set);
    return true;
}

static bool refuse_mesh(const struct unwraps *u, int mesh, enum unwrap_fault fault)
{
    const char *name = u->scene->meshes[mesh].name;
    return host_fail(u->host, FAIL_UNSUPPORTED,
                     "TEXCOORD_0 of mesh '%s' in %s %s: it cannot be a light map; give the mesh "
                     "other coordinates, or let charts be made",
                     name ? name : "", u->scene->name, unwrap_fault_text(fault));
}

static bool check_mesh(struct unwraps *u, int mesh)
{
    enum unwrap_fault fault = UNWRAP_ABSENT;
    const bool zero =
        u->coordinates == CHARTS_TEXCOORD_0 || u->coordinates == CHARTS_TEXCOORD_0_OR_1;
    const bool one =
        u->coordinates == CHARTS_TEXCOORD_1 || u->coordinates == CHARTS_TEXCOORD_0_OR_1;
    if (u->set[mesh] != NOT_CHECKED) return true;
    u->set[mesh] = NO_SET;
    if (zero && !try_set(u, mesh, 0, &fault)) return false;
    if (u->coordinates == CHARTS_TEXCOORD_0 && fault != UNWRAP_VALID)
        return refuse_mesh(u, mesh, fault);
    if (u->set[mesh] != NO_SET || !one) return true;
    if (!try_set(u, mesh, 1, &fault)) return false;
    if (fault <= UNWRAP_ABSENT) return true;
    if (u->broken++ == 0) {
        u->first = mesh;
        u->fault = fault;
    }
    return true;
}

static void warn(const struct unwraps *u)
{
    if (u->broken == 0 || atomic_exchange(u->scene->warned_of_unwraps, true)) return;
    const char *name = u->scene->meshes[u->first].name;
    host_log(u->host, LOG_WARNING,
             "TEXCOORD_1 of %d meshes in %s: of '%s' it %s; charts replace it", u->broken,
             u->scene->name, name ? name : "", unwrap_fault_text(u->fault));
}

static void add_triangle(struct surface *out, const struct scene_pose *pose, int instance,
                         uint32_t triangle, const vec2s *unwrap)
{
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    const vec3s *deformed = pose->deformed[instance].positions;
    const mat4s world_from_mesh = pose_world_from_instance(pose, instance);
    struct surface_triangle *t = &out->triangles[out->count];
    *t = (struct surface_triangle){ .instance = instance,
                                    .triangle = triangle,
                                    .double_sided =
                                        pose->scene->materials[mesh->material].double_sided,
                                    .unwrapped = unwrap != NULL,
                                    .neighbor = { CHART_NONE, CHART_NONE, CHART_NONE } };
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t v = mesh->indices[3 * (size_t)triangle + k];
        t->corner[k] = deformed ? deformed[v] : mat4_point(world_from_mesh, mesh->positions[v]);
        t->vertex_normal[k] = mesh->normals[v];
        if (unwrap) t->uv[k] = unwrap[v];
    }
    if (unwrap && unwrap_is_collapsed(t->uv)) t->unwrapped = false;
    t->area_m2 = triangle_area(t->corner, &t->normal);
    if (t->area_m2 == 0.0f) {
        out->without_area++;
        return;
    }
    if (pose_is_mirrored(pose, instance)) t->normal = glms_vec3_negate(t->normal);
    out->area_m2 += (double)t->area_m2;
    for (int k = 0; k < 3; k++) {
        const float edge = glms_vec3_distance(t->corner[k], t->corner[(k + 1) % 3]);
        out->edges_m += (double)edge;
        out->longest_m = fmaxf(out->longest_m, edge);
    }
    out->count++;
}

static bool any_chosen(const bool *chosen, size_t first, uint32_t count)
{
    if (!chosen) return count > 0;
    for (uint32_t t = 0; t < count; t++)
        if (chosen[first + t]) return true;
    return false;
}

static bool add_triangles(struct surface *out, const struct scene_pose *pose, const bool *chosen,
                          struct unwraps *unwraps)
{
    const struct scene *scene = pose->scene;
    size_t first = 0;
    for (int i = 0; i < scene->instance_count; i++) {
        const struct mesh *mesh = scene_mesh_of(scene, i);
        const uint32_t count = mesh->index_count / 3;
        const int index = scene->instances[i].mesh;
        if (index >= 0 && any_chosen(chosen, first, count)) {
            if (!check_mesh(unwraps, index)) return false;
            const int set = unwraps->set[index] - FIRST_SET;
            for (uint32_t t = 0; t < count; t++)
                if (!chosen || chosen[first + t])
                    add_triangle(out, pose, i, t, set >= 0 ? mesh->uv[set] : NULL);
        }
        first += count;
    }
    warn(unwraps);
    return true;
}

// ---- edges

struct corner_key {
    float at[5]; // position, coordinates of an unwrap
    int instance;
};

// Adding 0 turns −0 into 0, which is equal.
static struct corner_key key_of(const struct surface_triangle *t, int k)
{
    const vec3s p = t->corner[k];
    const vec2s uv = t->unwrapped ? t->uv[k] : (vec2s){ { 0.0f, 0.0f } };
    return (struct corner_key){ { p.x + 0.0f, p.y + 0.0f, p.z + 0.0f, uv.x + 0.0f, uv.y + 0.0f },
                                t->instance };
}

// Writes for each corner the first corner that equals it. table: a power of two, all bits set.
static void join_corners(const struct surface *surface, uint32_t *table, size_t size,
                         uint32_t *joined)
{
    for (uint32_t c = 0; c < 3 * surface->count; c++) {
        const struct corner_key key = key_of(&surface->triangles[c / 3], (int)(c % 3));
        size_t at = (size_t)hash_bytes(&key, sizeof key, 0) & (size - 1);
        for (; table[at] != CHART_NONE; at = (at + 1) & (size - 1)) {
            const uint32_t other = table[at];
            const struct corner_key old = key_of(&surface->triangles[other / 3], (int)(other % 3));
            if (memcmp(&key, &old, sizeof key) == 0) break;
        }
        if (table[at] == CHART_NONE) table[at] = c;
        joined[c] = table[at];
    }
}

struct edge {
    uint32_t low, high; // joined corners
    uint32_t side;      // 3 · triangle + k
};

static int compare_edges(const void *a, const void *b)
{
    const struct edge *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return p->side < q->side ? -1 : p->side > q->side;
}

// Edges in pairs: where three triangles meet, the first two are neighbours.
static void connect(struct surface *surface, const uint32_t *joined, struct edge *edges)
{
    const size_t count = 3 * (size_t)surface->count;
    for (uint32_t side = 0; side < count; side++) {
        const uint32_t a = joined[side], b = joined[side - side % 3 + (side % 3 + 1) % 3];
        edges[side] = (struct edge){ a < b ? a : b, a < b ? b : a, side };
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; i + 1 < count; i++) {
        if (edges[i].low != edges[i + 1].low || edges[i].high != edges[i + 1].high) continue;
        const uint32_t a = edges[i].side, b = edges[i + 1].side;
        surface->triangles[a / 3].neighbor[a % 3] = b / 3;
        surface->triangles[b / 3].neighbor[b % 3] = a / 3;
        i++;
    }
}

static bool find_neighbors(struct surface *surface)
{
    const size_t corners = 3 * (size_t)surface->count;
    size_t size = 2;
    while (size < 2 * corners) size *= 2;
    uint32_t *table = host_alloc(surface->host, size, sizeof *table);
    uint32_t *joined = host_alloc(surface->host, corners, sizeof *joined);
    struct edge *edges = host_alloc(surface->host, corners, sizeof *edges);
    const bool ok = table && joined && edges;
    if (ok) {
        memset(table, 0xff, size * sizeof *table);
        join_corners(surface, table, size, joined);
        connect(surface, joined, edges);
    }
    host_free(surface->host, table);
    host_free(surface->host, joined);
    host_free(surface->host, edges);
    return ok;
}

bool surface_init(struct surface *out, struct host *host, const struct scene_pose *pose,
                  const bool *chosen, enum charts_coordinates coordinates)
{
    const size_t count = scene_triangle_count(pose->scene);
    *out = (struct surface){ .host = host };
    if (count > UINT32_MAX / 8) {
        return host_fail(host, FAIL_MEMORY, "charts of %s: more than %u triangles",
                         pose->scene->name, UINT32_MAX / 8);
    }
    struct unwraps unwraps = {
        .host = host, .scene = pose->scene, .coordinates = coordinates, .first = -1
    };
    unwraps.set = host_alloc(host, (size_t)pose->scene->mesh_count, sizeof *unwraps.set);
    out->triangles = host_alloc(host, count, sizeof *out->triangles);
    const bool ok = unwraps.set && out->triangles && add_triangles(out, pose, chosen, &unwraps) &&
                    find_neighbors(out);
    host_free(host, unwraps.set);
    if (!ok) surface_finish(out);
    return ok;
}

void surface_finish(struct surface *surface)
{
    if (surface->host) host_free(surface->host, surface->triangles);
    *surface = (struct surface){ 0 };
}
