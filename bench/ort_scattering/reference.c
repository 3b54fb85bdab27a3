// The second pass of Jensen & Buhler 2002, "A Rapid Hierarchical Rendering Technique for
// Translucent Materials", without its hierarchy: the profile summed over all points nearby.
#include "ort_scattering/reference.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "techniques/gi_spec.h"
#include "techniques/ort/bake/near.h"
#include "trace/surface.h"
#include "trace/trace_scene.h"

#include <math.h>

struct scattering_reference {
    struct host host;
    struct scene *scene;
    struct scene_pose pose;
    struct trace_scene *trace;
    struct ort_kernel kernel;
    struct chart_texel *points; // their centroid and area
    vec3s *normals;             // at which rays begin: times the reach
    vec3s *shading;             // normals that receive light
    vec3s *light;               // lux
    struct ort_map map;         // of the points, for `near`
    struct ort_near near;
    struct world_light lit_by;
    uint32_t capacity;
};

// ---- points

static double mesh_area(const struct trace_mesh *mesh)
{
    double sum = 0.0;
    for (uint32_t t = 0; t < mesh->mesh->index_count / 3; t++) {
        uint32_t corner[3];
        trace_corners(mesh, t, corner);
        sum += 0.5 * (double)glms_vec3_norm(trace_area_normal(mesh, corner));
    }
    return sum;
}

static vec3s shading_normal(const struct scattering_reference *r, const struct trace_mesh *mesh,
                            uint32_t t, float u, float v)
{
    struct surface surface;
    const struct ray_hit hit = {
        .geometry = r->trace->mesh_of[mesh->instance], .triangle = t, .u = u, .v = v
    };
    const struct ray ray = { .direction = glms_vec3_negate(mesh->facets[t].normal) };
    surface_at(r->trace, &ray, &hit, NULL, &surface);
    return surface.normal;
}

// The golden ratio's multiples across, equal steps along: even in each triangle.
static void add_points(struct scattering_reference *r, const struct trace_mesh *mesh, uint32_t t,
                       double per_m2)
{
    uint32_t corner[3];
    trace_corners(mesh, t, corner);
    const double area = 0.5 * (double)glms_vec3_norm(trace_area_normal(mesh, corner));
    struct rng rng = rng_for(t, (uint32_t)mesh->instance, 0);
    const uint32_t count = (uint32_t)(area * per_m2 + (double)rng_float(&rng));
    const float turn = rng_float(&rng);
    for (uint32_t i = 0; i < count && r->map.texel_count < r->capacity; i++) {
        const float root = sqrtf(((float)i + 0.5f) / (float)count);
        const float along = fmodf(turn + 0.618034f * (float)i, 1.0f);
        const uint32_t k = r->map.texel_count++;
        r->points[k].centroid = trace_point(mesh, corner, root * (1.0f - along), root * along);
        r->points[k].area_m2 = (float)(1.0 / per_m2);
        r->normals[k] = glms_vec3_scale(mesh->facets[t].normal, mesh->facets[t].reach);
        r->shading[k] = shading_normal(r, mesh, t, root * (1.0f - along), root * along);
    }
}

static bool make_points(struct scattering_reference *r, int wanted)
{
    double area = 0.0;
    r->capacity = (uint32_t)wanted + (uint32_t)wanted / 8;
    r->points = host_alloc(&r->host, r->capacity, sizeof *r->points);
    r->normals = host_alloc(&r->host, r->capacity, sizeof *r->normals);
    r->shading = host_alloc(&r->host, r->capacity, sizeof *r->shading);
    r->light = host_alloc(&r->host, r->capacity, sizeof *r->light);
    if (!r->points || !r->normals || !r->shading || !r->light) return false;
    for (uint32_t m = 0; m < r->trace->mesh_count; m++) area += mesh_area(&r->trace->meshes[m]);
    for (uint32_t m = 0; m < r->trace->mesh_count; m++)
        for (uint32_t t = 0; t < r->trace->meshes[m].mesh->index_count / 3; t++)
            add_points(r, &r->trace->meshes[m], t, wanted / area);
    r->map.host = &r->host;
    r->map.charts.texels = r->points;
    r->map.charts.texel_count = r->map.charts.side_texel_count = r->map.texel_count;
    return ort_near_init(&r->near, &r->map, r->kernel.reach_m);
}

static bool open_reference(struct scattering_reference *r, const struct scattering_desc *desc)
{
    struct gi_spec spec;
    if (!gi_spec_parse(&spec, &r->host, desc->gi)) return false;
    ort_kernel_init(&r->kernel, spec.options[0]);
    gi_spec_finish(&spec);
    r->scene = scene_load(&r->host, desc->scene);
    if (!r->scene || !pose_init(&r->pose, r->scene, -1, 0.0f)) return false;
    r->trace = trace_scene_create(&r->host, &r->pose);
    return r->trace && make_points(r, desc->points);
}

bool scattering_reference_open(const struct scattering_desc *desc,
                               struct scattering_reference **out)
{
    struct host host = host_default();
    struct scattering_reference *r = *out = host_alloc(&host, 1, sizeof *r);
    if (!r) return false;
    r->host = host;
    return open_reference(r, desc);
}

void scattering_reference_close(struct scattering_reference *r)
{
    if (!r) return;
    struct host host = r->host;
    ort_near_finish(&r->near);
    host_free(&host, r->points);
    host_free(&host, r->normals);
    host_free(&host, r->shading);
    host_free(&host, r->light);
    trace_scene_destroy(r->trace);
    pose_finish(&r->pose);
    scene_destroy(r->scene);
    host_free(&host, r);
}

// ---- light

static struct world_light world_light_of(const struct ag_light_desc *l)
{
    static const enum light_type TYPES[] = {
        [AG_LIGHT_SUN] = LIGHT_SUN, [AG_LIGHT_POINT] = LIGHT_POINT, [AG_LIGHT_SPOT] = LIGHT_SPOT
    };
    const vec3s direction = vec3_of(l->direction[0], l->direction[1], l->direction[2]);
    return (struct world_light){
        .type = TYPES[l->type],
        .position = vec3_of(l->position[0], l->position[1], l->position[2]),
        .direction = glms_vec3_normalize(direction),
        .intensity = vec3_of(l->intensity[0], l->intensity[1], l->intensity[2]),
        .cos_inner = cosf(l->inner_rad),
        .cos_outer = cosf(l->outer_rad),
    };
}

static void light_point(void *user, size_t i)
{
    struct scattering_reference *r = user;
    const vec3s from = glms_vec3_add(r->points[i].centroid, r->normals[i]);
    const struct punctual_light at = light_punctual(&r->lit_by, from);
    const float cosine = glms_vec3_dot(r->shading[i], at.to_light);
    const bool lit = cosine > 0.0f && glms_vec3_max(at.illuminance) > 0.0f &&
                     !trace_occluded(r->trace, from, at.to_light, at.distance_m);
    r->light[i] = lit ? glms_vec3_scale(at.illuminance, cosine) : vec3_of(0, 0, 0);
}

void scattering_reference_light(struct scattering_reference *r, const struct ag_light_desc *light)
{
    r->lit_by = world_light_of(light);
    parallel_for(r->map.texel_count, 256, light_point, r);
}

// ---- the sum

struct gather {
    const struct scattering_reference *reference;
    const struct ag_image *positions;
    struct ag_image *out;
};

struct pixel {
    const struct scattering_reference *reference;
    vec3s at;
    double sum[3];
};

static void add_point(void *user, uint32_t i)
{
    struct pixel *p = user;
    const struct chart_texel *point = &p->reference->points[i];
    const float distance = fmaxf(glms_vec3_distance(point->centroid, p->at), 1e-30f);
    float share[3];
    if (glms_vec3_max(p->reference->light[i]) <= 0.0f) return;
    ort_kernel_at(&p->reference->kernel, distance, point->area_m2, share);
    for (int c = 0; c < 3; c++)
        p->sum[c] += (double)(share[c] * point->area_m2 * p->reference->light[i].raw[c]);
}

static void gather_pixel(void *user, size_t i)
{
    const struct gather *g = user;
    const float *at = g->positions->pixels + 3 * i;
    struct pixel p = { .reference = g->reference, .at = vec3_of(at[0], at[1], at[2]) };
    if (at[0] != 0.0f || at[1] != 0.0f || at[2] != 0.0f)
        ort_near_visit(&g->reference->near, p.at, add_point, &p);
    for (size_t c = 0; c < 3; c++) g->out->pixels[3 * i + c] = (float)p.sum[c];
}

void scattering_reference_gather(const struct scattering_reference *r,
                                 const struct ag_image *positions, struct ag_image *out)
{
    struct gather g = { r, positions, out };
    parallel_for((size_t)out->width * out->height, 64, gather_pixel, &g);
}
