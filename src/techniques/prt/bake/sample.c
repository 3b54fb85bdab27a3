// Receivers in the traced scene: their sample points and reflectance.
#include "techniques/prt/bake/scene.h"

#include "core/rng.h"
#include "trace/reflectance.h"
#include "trace/texels/inside.h"

#include <math.h>

// ---- vertices

// A corner at a vertex.
struct corner {
    const struct trace_mesh *mesh;
    uint32_t triangle, k;   // of the mesh
    const uint32_t *others; // vertices of the triangle's side
};

static struct corner corner_of(const struct prt_scene *scene, uint32_t vertex, size_t fan)
{
    const struct prt_vertices *v = &scene->receivers.vertices;
    const int instance = v->at[vertex].instance;
    const size_t at = v->fan[fan], triangle = at / 3 % v->triangle_count;
    return (struct corner){ .mesh = trace_mesh_of(scene->trace, instance),
                            .triangle = (uint32_t)(triangle - v->triangle_0[instance]),
                            .k = (uint32_t)(at % 3),
                            .others = v->corners[at / 3] };
}

static float reach_of(const struct prt_scene *scene, uint32_t vertex)
{
    const struct prt_vertices *v = &scene->receivers.vertices;
    float reach = 0.0f;
    for (size_t i = v->fan_0[vertex]; i < v->fan_0[vertex + 1]; i++) {
        const struct corner c = corner_of(scene, vertex, i);
        reach = fmaxf(reach, c.mesh->facets[c.triangle].reach);
    }
    return reach;
}

// From the vertex by this part of the way to the middle of the triangle.
static vec3s towards_middle(const struct corner *c, float part)
{
    uint32_t corner[3];
    trace_corners(c->mesh, c->triangle, corner);
    float weight[3] = { part / 3.0f, part / 3.0f, part / 3.0f };
    weight[c->k] = 1.0f - part * (2.0f / 3.0f);
    return trace_point(c->mesh, corner, weight[1], weight[2]);
}

// Whether triangles surround the vertex: each neighbour is the next one of a triangle, and the last
// one of another. Sums of their hashes differ otherwise.
static bool is_surrounded(const struct prt_scene *scene, uint32_t vertex)
{
    const struct prt_vertices *v = &scene->receivers.vertices;
    uint64_t sum = 0;
    for (size_t i = v->fan_0[vertex]; i < v->fan_0[vertex + 1]; i++) {
        const struct corner c = corner_of(scene, vertex, i);
        sum += rng_mix(c.others[(c.k + 1) % 3] + UINT64_C(1));
        sum -= rng_mix(c.others[(c.k + 2) % 3] + UINT64_C(1));
    }
    return sum == 0;
}

// The middles of the triangles have a mean; that of the result is the nearest to it.
static struct corner middle_corner(const struct prt_scene *scene, uint32_t vertex)
{
    const struct prt_vertices *v = &scene->receivers.vertices;
    const size_t first = v->fan_0[vertex], end = v->fan_0[vertex + 1];
    vec3s mean = vec3_of(0, 0, 0);
    struct corner nearest = corner_of(scene, vertex, first);
    float least = INFINITY;
    for (size_t i = first; i < end; i++) {
        const struct corner c = corner_of(scene, vertex, i);
        mean = glms_vec3_muladds(towards_middle(&c, 1.0f), 1.0f / (float)(end - first), mean);
    }
    for (size_t i = first; i < end; i++) {
        const struct corner c = corner_of(scene, vertex, i);
        const float distance2 = glms_vec3_distance2(towards_middle(&c, 1.0f), mean);
        if (!(distance2 < least)) continue;
        least = distance2;
        nearest = c;
    }
    return nearest;
}

static bool is_open(const struct prt_scene *scene, uint32_t vertex, vec3s at)
{
    const vec3s normal = scene->receivers.vertices.at[vertex].normal;
    const vec3s from = glms_vec3_muladds(normal, reach_of(scene, vertex), at);
    return !inside_solid(scene->trace, from, normal);
}

// A vertex at a border is sampled beside it: rays from the edge of a floor pass between it and the
// wall. One inside geometry is sampled in one of its triangles, if a part of them is outside.
static struct texel_point point_of_vertex(const struct prt_scene *scene, uint32_t vertex)
{
    static const float BORDER = 1.0f / 64, PARTS[] = { 1.0f / 8, 1.0f / 2 };
    const struct prt_vertices *v = &scene->receivers.vertices;
    vec3s at = v->at[vertex].position;
    if (!is_surrounded(scene, vertex)) {
        const struct corner middle = middle_corner(scene, vertex);
        at = towards_middle(&middle, BORDER);
    }
    if (is_open(scene, vertex, at)) return (struct texel_point){ at, 1.0f };
    for (int k = 0; k < 2; k++)
        for (size_t i = v->fan_0[vertex]; i < v->fan_0[vertex + 1]; i++) {
            const struct corner c = corner_of(scene, vertex, i);
            const vec3s beside = towards_middle(&c, PARTS[k]);
            if (is_open(scene, vertex, beside)) return (struct texel_point){ beside, 1.0f };
        }
    return (struct texel_point){ at, 0.0f };
}

// ---- reflectance of vertices

// At the weights of the next corners, from the side of the vertex's normal.
static void surface_of(const struct prt_scene *scene, const struct corner *c, bool back, float next,
                       float last, struct surface *out)
{
    const vec3s front = c->mesh->facets[c->triangle].normal;
    const struct ray ray = { .direction = back ? front : glms_vec3_negate(front) };
    float weight[3];
    weight[c->k] = 1.0f - next - last;
    weight[(c->k + 1) % 3] = next;
    weight[(c->k + 2) % 3] = last;
    const struct ray_hit hit = { .geometry = (uint32_t)(c->mesh - scene->trace->meshes),
                                 .triangle = c->triangle,
                                 .u = weight[1],
                                 .v = weight[2] };
    surface_at(scene->trace, &ray, &hit, NULL, out);
}

// Mean over the quadrilateral of the vertex, the middles of both edges and that of the triangle.
static vec4s reflectance_of_corner(const struct prt_scene *scene, const struct corner *c,
                                   vec3s normal, bool back)
{
    const int across = c->mesh->material->textured || c->mesh->mesh->colors ? 4 : 1;
    vec4s sum = { { 0, 0, 0, 0 } };
    for (int i = 0; i < across * across; i++) {
        const float s = ((float)(i % across) + 0.5f) / (float)across;
        const float t = ((float)(i / across) + 0.5f) / (float)across;
        struct surface surface;
        surface_of(scene, c, back, s * (1.0f - t) / 2.0f + s * t / 3.0f,
                   t * (1.0f - s) / 2.0f + s * t / 3.0f, &surface);
        const float cosine = glms_vec3_dot(surface.normal, normal);
        sum = glms_vec4_muladds(vec4_of(surface_reflectance(&surface), cosine),
                                1.0f / (float)(across * across), sum);
    }
    return sum;
}

static vec4s reflectance_of_vertex(const struct prt_scene *scene, uint32_t vertex)
{
    const struct prt_vertices *v = &scene->receivers.vertices;
    const bool back = vertex >= v->front_count;
    vec4s sum = { { 0, 0, 0, 0 } };
    float area = 0.0f;
    for (size_t i = v->fan_0[vertex]; i < v->fan_0[vertex + 1]; i++) {
        const struct corner c = corner_of(scene, vertex, i);
        uint32_t corner[3];
        trace_corners(c.mesh, c.triangle, corner);
        const float weight = glms_vec3_norm(trace_area_normal(c.mesh, corner));
        if (!(weight > 0.0f)) continue;
        sum = glms_vec4_muladds(reflectance_of_corner(scene, &c, v->at[vertex].normal, back),
                                weight, sum);
        area += weight;
    }
    return area > 0.0f ? glms_vec4_divs(sum, area) : sum;
}

// ---- both

struct texel_point prt_receiver_point(const struct prt_scene *scene, uint32_t i)
{
    return scene->receivers.at_vertices ? point_of_vertex(scene, i)
                                        : texel_find_point(scene->trace, &scene->charts, i);
}

float prt_receiver_reach(const struct prt_scene *scene, uint32_t i)
{
    if (scene->receivers.at_vertices) return reach_of(scene, i);
    const struct chart_triangle *of = chart_triangle_of(&scene->charts, i);
    return trace_mesh_of(scene->trace, of->instance)->facets[of->triangle].reach;
}

vec4s prt_receiver_reflectance(const struct prt_scene *scene, uint32_t i)
{
    return scene->receivers.at_vertices ? reflectance_of_vertex(scene, i)
                                        : texel_reflectance(scene->trace, &scene->charts, i, NULL);
}
