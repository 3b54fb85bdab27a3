#include "techniques/prt/receivers/vertices.h"

#include "core/hash.h"

#include <math.h>
#include <string.h>

void prt_vertices_finish(struct prt_vertices *v)
{
    if (!v->host) return;
    host_free(v->host, v->at);
    host_free(v->host, v->triangle_0);
    host_free(v->host, v->corners);
    host_free(v->host, v->face);
    host_free(v->host, v->fan_0);
    host_free(v->host, v->fan);
    *v = (struct prt_vertices){ 0 };
}

// ---- memory

static bool is_double_sided(const struct scene *scene, int instance)
{
    return scene->materials[scene_mesh_of(scene, instance)->material].double_sided;
}

static uint32_t most_vertices(const struct mesh *mesh)
{
    return mesh->vertex_count < mesh->index_count ? mesh->vertex_count : mesh->index_count;
}

// Vertices and triangles to allocate memory for.
struct capacity {
    size_t vertices, triangles; // of all instances
    uint32_t mesh;              // vertices of the largest mesh
};

static struct capacity capacity_of(const struct scene *scene)
{
    struct capacity capacity = { 0 };
    for (int i = 0; i < scene->instance_count; i++) {
        const struct mesh *mesh = scene_mesh_of(scene, i);
        if (scene->instances[i].mesh < 0) continue;
        capacity.vertices += (is_double_sided(scene, i) ? 2 : 1) * (size_t)most_vertices(mesh);
        capacity.triangles += mesh->index_count / 3;
        if (mesh->vertex_count > capacity.mesh) capacity.mesh = mesh->vertex_count;
    }
    return capacity;
}

// ---- equal vertices

struct key {
    float at[6]; // position, normal
};

struct merging {
    struct prt_vertices *out;
    const struct scene_pose *pose;
    size_t size;      // of the table, a power of two
    uint32_t *table;  // [size] by hash: a vertex of the mesh
    uint32_t *merged; // [vertices of the mesh] in `out`
};

static struct key key_of(const struct scene_pose *pose, int instance, uint32_t vertex)
{
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    const struct deformed_mesh *deformed = &pose->deformed[instance];
    const vec3s p = deformed->positions ? deformed->positions[vertex] : mesh->positions[vertex];
    const vec3s n = deformed->positions ? deformed->normals[vertex] : mesh->normals[vertex];
    // Adding 0 turns −0 into 0, which is equal.
    return (
        struct key){ { p.x + 0.0f, p.y + 0.0f, p.z + 0.0f, n.x + 0.0f, n.y + 0.0f, n.z + 0.0f } };
}

static struct prt_vertex world_of(const struct scene_pose *pose, int instance, const struct key *k)
{
    const vec3s p = vec3_of(k->at[0], k->at[1], k->at[2]);
    const vec3s n = vec3_of(k->at[3], k->at[4], k->at[5]);
    if (pose->deformed[instance].positions) return (struct prt_vertex){ instance, p, n };
    const mat4s m = pose_world_from_instance(pose, instance);
    vec3s normal = glms_mat3_mulv(mat4_normal_transform(m), n);
    const float length = glms_vec3_norm(normal);
    normal = length > 0.0f ? glms_vec3_divs(normal, length) : vec3_of(0, 1, 0);
    return (struct prt_vertex){ instance, mat4_point(m, p), normal };
}

// The receiver of a vertex of the instance's mesh: that of the first equal one.
static uint32_t merge(struct merging *m, int instance, uint32_t vertex)
{
    if (m->merged[vertex] != PRT_NO_VERTEX) return m->merged[vertex];
    const struct key key = key_of(m->pose, instance, vertex);
    size_t at = (size_t)hash_bytes(&key, sizeof key, 0) & (m->size - 1);
    for (; m->table[at] != PRT_NO_VERTEX; at = (at + 1) & (m->size - 1)) {
        const struct key old = key_of(m->pose, instance, m->table[at]);
        if (memcmp(&key, &old, sizeof key) == 0) return m->merged[vertex] = m->merged[m->table[at]];
    }
    m->table[at] = vertex;
    m->out->at[m->out->front_count] = world_of(m->pose, instance, &key);
    return m->merged[vertex] = m->out->front_count++;
}

static void add_fronts(struct merging *m, int instance)
{
    const struct mesh *mesh = scene_mesh_of(m->pose->scene, instance);
    uint32_t(*corners)[3] = m->out->corners + m->out->triangle_0[instance];
    memset(m->table, 0xff, m->size * sizeof *m->table);
    memset(m->merged, 0xff, mesh->vertex_count * sizeof *m->merged);
    for (uint32_t i = 0; i < mesh->index_count; i++)
        corners[i / 3][i % 3] = merge(m, instance, mesh->indices[i]);
}

static bool add_all_fronts(struct prt_vertices *v, const struct scene_pose *pose, uint32_t most)
{
    struct merging m = { .out = v, .pose = pose, .size = 2 };
    while (m.size < 2 * (size_t)most) m.size *= 2;
    m.table = host_alloc(v->host, m.size, sizeof *m.table);
    m.merged = host_alloc(v->host, most, sizeof *m.merged);
    const bool ok = m.table && m.merged;
    for (int i = 0; ok && i < pose->scene->instance_count; i++) {
        add_fronts(&m, i);
        v->triangle_0[i + 1] = v->triangle_0[i] + scene_mesh_of(pose->scene, i)->index_count / 3;
    }
    host_free(v->host, m.table);
    host_free(v->host, m.merged);
    return ok;
}

// ---- triangles

static void find_faces(struct prt_vertices *v, const struct scene_pose *pose)
{
    for (int i = 0; i < pose->scene->instance_count; i++) {
        const bool mirrored = v->triangle_0[i] < v->triangle_0[i + 1] && pose_is_mirrored(pose, i);
        for (size_t t = v->triangle_0[i]; t < v->triangle_0[i + 1]; t++) {
            const vec3s a = v->at[v->corners[t][0]].position;
            const vec3s b = v->at[v->corners[t][1]].position;
            const vec3s c = v->at[v->corners[t][2]].position;
            const vec3s normal = glms_vec3_cross(glms_vec3_sub(b, a), glms_vec3_sub(c, a));
            const float area2 = glms_vec3_norm(normal);
            // Its inverse is finite, too, as light_map_triangle_of needs.
            if (!(area2 > 1e-18f)) continue;
            v->face[t] = glms_vec3_divs(normal, mirrored ? -area2 : area2);
        }
    }
}

// ---- backs

// Fronts of an instance are consecutive, and so are its backs.
static void add_backs(struct prt_vertices *v, const struct scene *scene)
{
    uint32_t(*backs)[3] = v->corners + v->triangle_count;
    memset(backs, 0xff, v->triangle_count * sizeof *backs);
    v->count = v->front_count;
    for (uint32_t i = 0, shift = 0; i < v->front_count; i++) {
        struct prt_vertex back = v->at[i];
        const bool first = i == 0 || v->at[i - 1].instance != back.instance;
        if (!is_double_sided(scene, back.instance)) continue;
        if (first) shift = v->count - i;
        back.normal = glms_vec3_negate(back.normal);
        v->at[v->count++] = back;
        if (!first) continue;
        for (size_t t = v->triangle_0[back.instance]; t < v->triangle_0[back.instance + 1]; t++)
            for (int k = 0; k < 3; k++) backs[t][k] = v->corners[t][k] + shift;
    }
}

// ---- fans

static bool find_fans(struct prt_vertices *v)
{
    const size_t corners = 6 * v->triangle_count;
    const uint32_t *at = v->triangle_count > 0 ? v->corners[0] : NULL;
    v->fan_0 = host_alloc(v->host, (size_t)v->count + 2, sizeof *v->fan_0);
    v->fan = host_alloc(v->host, corners, sizeof *v->fan);
    if (!v->fan_0 || !v->fan) return false;
    // Counts are two vertices late, so that filling leaves each one's first.
    for (size_t i = 0; i < corners; i++)
        if (at[i] != PRT_NO_VERTEX) v->fan_0[at[i] + 2]++;
    for (uint32_t i = 0; i < v->count; i++) v->fan_0[i + 2] += v->fan_0[i + 1];
    for (size_t i = 0; i < corners; i++)
        if (at[i] != PRT_NO_VERTEX) v->fan[v->fan_0[at[i] + 1]++] = i;
    return true;
}

bool prt_vertices_init(struct prt_vertices *out, struct host *host, const struct scene_pose *pose)
{
    const struct capacity capacity = capacity_of(pose->scene);
    *out = (struct prt_vertices){ .host = host, .triangle_count = capacity.triangles };
    if (capacity.triangles > UINT32_MAX / 8)
        return host_fail(host, FAIL_MEMORY, "prt: vertices of %s: more than %u triangles",
                         pose->scene->name, UINT32_MAX / 8);
    out->at = host_alloc(host, capacity.vertices, sizeof *out->at);
    out->triangle_0 =
        host_alloc(host, (size_t)pose->scene->instance_count + 1, sizeof *out->triangle_0);
    out->corners = host_alloc(host, 2 * capacity.triangles, sizeof *out->corners);
    out->face = host_alloc(host, capacity.triangles, sizeof *out->face);
    if (!out->at || !out->triangle_0 || !out->corners || !out->face ||
        !add_all_fronts(out, pose, capacity.mesh))
        return false;
    find_faces(out, pose);
    add_backs(out, pose->scene);
    return find_fans(out);
}

// ---- hidden vertices

struct filling {
    const struct prt_vertices *vertices;
    const bool *hidden;
    uint32_t *nearest_valid;
    float *distance; // along edges, to `nearest_valid`
};

// Whether the way over its neighbour is shorter than the shortest yet.
static bool relax(struct filling *f, uint32_t vertex, uint32_t neighbor)
{
    const struct prt_vertex *at = f->vertices->at;
    if (!f->hidden[vertex] || !isfinite(f->distance[neighbor])) return false;
    const float way =
        f->distance[neighbor] + glms_vec3_distance(at[vertex].position, at[neighbor].position);
    if (!(way < f->distance[vertex])) return false;
    f->distance[vertex] = way;
    f->nearest_valid[vertex] = f->nearest_valid[neighbor];
    return true;
}

static bool sweep(struct filling *f)
{
    bool changed = false;
    for (size_t t = 0; t < 2 * f->vertices->triangle_count; t++) {
        const uint32_t *corner = f->vertices->corners[t];
        if (corner[0] == PRT_NO_VERTEX) continue;
        for (int k = 0; k < 3; k++) {
            changed |= relax(f, corner[k], corner[(k + 1) % 3]);
            changed |= relax(f, corner[k], corner[(k + 2) % 3]);
        }
    }
    return changed;
}

uint32_t *prt_vertices_fill(const struct prt_vertices *v, const bool *hidden)
{
    struct filling f = { .vertices = v,
                         .hidden = hidden,
                         .nearest_valid = host_alloc(v->host, v->count, sizeof *f.nearest_valid),
                         .distance = host_alloc(v->host, v->count, sizeof *f.distance) };
    const bool ok = f.nearest_valid && f.distance;
    for (uint32_t i = 0; ok && i < v->count; i++) {
        f.nearest_valid[i] = i;
        f.distance[i] = hidden[i] ? INFINITY : 0.0f;
    }
    while (ok && sweep(&f)) {}
    host_free(v->host, f.distance);
    if (ok) return f.nearest_valid;
    host_free(v->host, f.nearest_valid);
    return NULL;
}
