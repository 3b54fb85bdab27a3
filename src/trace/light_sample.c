// Light sampling: punctual lights as in light.glsl, emissive triangles by power with an alias
// table. The map of the environment: environment_sample.c. A uniform sky has no sampler: BSDF
// sampling alone finds it well.
#include "trace/light_sample.h"

#include "trace/surface.h"

#include "core/sampling.h"
#include "scene/environment/environment_map.h"
#include "scene/unlit.h"

#include <math.h>

static const float MIN_DISTANCE_M = 0.01f; // light.glsl: 1/r² is clamped there

// ---- light table

static bool is_emissive(const struct trace_mesh *mesh)
{
    return mesh->material->emissive && mesh->mesh->index_count > 0;
}

// Mean luminance over a triangle from a lattice of points, at least a hundredth of the factor's, so
// that texels between the points are sampled too.
static float mean_emission(const struct trace_mesh *mesh, uint32_t triangle)
{
    enum { SIDE = 4 };
    float factor = luminance(mesh->material->emission);
    if (!mesh->material->emissive_map.texture) return factor;
    float sum = 0.0f;
    for (int i = 0; i < SIDE * SIDE; i++) {
        vec2s u = { { ((float)(i % SIDE) + 0.5f) / SIDE, ((float)(i / SIDE) + 0.5f) / SIDE } };
        vec2s b = sample_triangle(u);
        sum += luminance(surface_emission(mesh, triangle, b.x, b.y));
    }
    return fmaxf(sum / (SIDE * SIDE), 0.01f * factor);
}

void light_table_build_alias(struct emitter *emitters, uint32_t count, double *scaled,
                             uint32_t *work)
{
    uint32_t small = 0, large = count;
    for (uint32_t i = 0; i < count; i++) {
        if (scaled[i] < 1.0)
            work[small++] = i;
        else
            work[--large] = i;
    }
    // work[0…small) are small, work[large…count) are large.
    while (small > 0 && large < count) {
        uint32_t s = work[--small], l = work[large];
        emitters[s].stay = (float)scaled[s];
        emitters[s].alias = l;
        scaled[l] -= 1.0 - scaled[s];
        if (scaled[l] >= 1.0) continue;
        large++;
        work[small++] = l;
    }
    // The remaining entries differ from 1 by rounding alone.
    while (large < count) emitters[work[large++]].stay = 1.0f;
    while (small > 0) emitters[work[--small]].stay = 1.0f;
}

static bool choose_by_power(struct trace_scene *scene)
{
    struct light_table *t = &scene->lights;
    double *power = host_alloc(scene->host, t->emitter_count, sizeof *power);
    uint32_t *work = host_alloc(scene->host, t->emitter_count, sizeof *work);
    double total = 0.0;
    bool ok = power && work;
    for (uint32_t i = 0; ok && i < t->emitter_count; i++) {
        const struct trace_mesh *mesh = &scene->meshes[t->emitters[i].mesh];
        uint32_t corner[3];
        trace_corners(mesh, t->emitters[i].triangle, corner);
        double area = 0.5 * (double)glms_vec3_norm(trace_area_normal(mesh, corner));
        power[i] = area * (double)mean_emission(mesh, t->emitters[i].triangle);
        if (!isfinite(power[i])) power[i] = 0.0;
        total += power[i];
        t->flux += GLM_PIf * (float)power[i] * (mesh->material->double_sided ? 2.0f : 1.0f);
    }
    t->has_emitters = ok && total > 0.0 && isfinite(total);
    for (uint32_t i = 0; t->has_emitters && i < t->emitter_count; i++) {
        const struct trace_mesh *mesh = &scene->meshes[t->emitters[i].mesh];
        uint32_t corner[3];
        trace_corners(mesh, t->emitters[i].triangle, corner);
        double area = 0.5 * (double)glms_vec3_norm(trace_area_normal(mesh, corner));
        t->emitters[i].density = power[i] > 0.0 ? (float)(power[i] / total / area) : 0.0f;
        power[i] *= (double)t->emitter_count / total;
    }
    if (t->has_emitters) light_table_build_alias(t->emitters, t->emitter_count, power, work);
    host_free(scene->host, power);
    host_free(scene->host, work);
    return ok;
}

static struct emitter emitter_of(const struct trace_scene *scene, uint32_t mesh, uint32_t triangle)
{
    const struct trace_mesh *m = &scene->meshes[mesh];
    uint32_t corner[3];
    trace_corners(m, triangle, corner);
    vec3s p = m->vertices[corner[0]].position;
    return (struct emitter){
        .mesh = mesh,
        .triangle = triangle,
        .corner = p,
        .edges = { glms_vec3_sub(m->vertices[corner[1]].position, p),
                   glms_vec3_sub(m->vertices[corner[2]].position, p) },
        .normal = m->facets[triangle].normal,
        .radiance = m->material->emission,
        .reach = m->facets[triangle].reach,
        .textured = m->material->emissive_map.texture,
        .double_sided = m->material->double_sided,
    };
}

static bool list_emitters(struct trace_scene *scene)
{
    struct light_table *t = &scene->lights;
    size_t count = 0;
    for (uint32_t m = 0; m < scene->mesh_count; m++) {
        struct trace_mesh *mesh = &scene->meshes[m];
        mesh->emitter_first = is_emissive(mesh) ? (uint32_t)count : NO_EMITTER;
        if (is_emissive(mesh)) count += mesh->mesh->index_count / 3;
        if (count >= NO_EMITTER)
            return host_fail(scene->host, FAIL_UNSUPPORTED,
                             "light of %s: too many emissive triangles", scene->scene->name);
    }
    if (count == 0) return true;
    t->emitters = host_alloc(scene->host, count, sizeof *t->emitters);
    if (!t->emitters) return false;
    for (uint32_t m = 0; m < scene->mesh_count; m++) {
        if (scene->meshes[m].emitter_first == NO_EMITTER) continue;
        for (uint32_t i = 0; i < scene->meshes[m].mesh->index_count / 3; i++)
            t->emitters[t->emitter_count++] = emitter_of(scene, m, i);
    }
    return choose_by_power(scene);
}

bool light_table_init(struct trace_scene *scene, const struct scene_pose *pose)
{
    struct light_table *t = &scene->lights;
    t->environment = scene->scene->environment;
    environment_map_retain(t->environment.map);
    if (!environment_table_init(&t->environment_table, scene->host, &t->environment)) return false;
    const vec3s sky = environment_mean(&t->environment);
    t->has_sky = !environment_is_black(&t->environment);
    int count = pose_light_count(pose);
    t->punctual = host_alloc(scene->host, (size_t)count, sizeof *t->punctual);
    if (!t->punctual) return false;
    for (int i = 0; i < count; i++) t->punctual[t->punctual_count++] = pose_light(pose, i);
    if (!list_emitters(scene)) return false;
    t->unlit_white = unlit_white(t->punctual, t->punctual_count, sky, t->flux, pose->bounds);
    return true;
}

void light_table_finish(struct trace_scene *scene)
{
    environment_map_release(scene->lights.environment.map);
    environment_table_finish(&scene->lights.environment_table, scene->host);
    host_free(scene->host, scene->lights.punctual);
    host_free(scene->host, scene->lights.emitters);
    scene->lights = (struct light_table){ 0 };
}

// ---- punctual lights

// light.glsl: light_cone.
static float cone(const struct world_light *light, vec3s from_light)
{
    if (light->type != LIGHT_SPOT) return 1.0f;
    float scale = 1.0f / fmaxf(light->cos_inner - light->cos_outer, 1e-3f);
    float t = (glms_vec3_dot(light->direction, from_light) - light->cos_outer) * scale;
    t = fminf(fmaxf(t, 0.0f), 1.0f);
    return t * t;
}

// light.glsl: light_window.
static float window(const struct world_light *light, float distance2_m2)
{
    if (light->range_m <= 0.0f) return 1.0f;
    float ratio2 = distance2_m2 / (light->range_m * light->range_m);
    return fminf(fmaxf(1.0f - ratio2 * ratio2, 0.0f), 1.0f);
}

struct punctual_light light_punctual(const struct world_light *light, vec3s position)
{
    struct punctual_light p = { glms_vec3_negate(light->direction), INFINITY, light->intensity };
    if (light->type == LIGHT_SUN) return p;
    vec3s to_light = glms_vec3_sub(light->position, position);
    float distance2 = glms_vec3_norm2(to_light);
    p.distance_m = sqrtf(distance2);
    p.to_light = glms_vec3_scale(to_light, 1.0f / sqrtf(fmaxf(distance2, 1e-12f)));
    float attenuation = cone(light, glms_vec3_negate(p.to_light)) * window(light, distance2) /
                        fmaxf(distance2, MIN_DISTANCE_M * MIN_DISTANCE_M);
    p.illuminance = glms_vec3_scale(light->intensity, attenuation);
    return p;
}

// ---- emitters

static const struct emitter *choose(const struct light_table *t, float choice, float *rest)
{
    float at = choice * (float)t->emitter_count;
    uint32_t i = (uint32_t)at;
    if (i >= t->emitter_count) i = t->emitter_count - 1;
    const struct emitter *e = &t->emitters[i];
    *rest = at - (float)i;
    return *rest < e->stay ? e : &t->emitters[e->alias];
}

struct emitter_sample light_sample_emitter(const struct trace_scene *scene, vec3s from,
                                           float choice, vec2s u)
{
    float rest;
    const struct emitter *e = choose(&scene->lights, choice, &rest);
    vec2s b = sample_triangle(u);
    vec3s p = glms_vec3_muladds(e->edges[0], b.x, e->corner);
    p = glms_vec3_muladds(e->edges[1], b.y, p);
    vec3s to_light = glms_vec3_sub(p, from);
    float distance2 = glms_vec3_norm2(to_light);
    struct emitter_sample s = { .position = p, .mesh = e->mesh };
    if (!(distance2 > 0.0f)) return s;
    s.to_light = glms_vec3_scale(to_light, 1.0f / sqrtf(distance2));
    float cosine = -glms_vec3_dot(e->normal, s.to_light), side = 1.0f;
    if (cosine < 0.0f && e->double_sided) {
        cosine = -cosine;
        side = -1.0f;
    }
    if (!(cosine > 0.0f)) return s;
    s.position = glms_vec3_muladds(e->normal, side * e->reach, p);
    s.radiance = e->radiance;
    if (e->textured) s.radiance = surface_emission(&scene->meshes[e->mesh], e->triangle, b.x, b.y);
    s.pdf = e->density * distance2 / cosine;
    return s;
}

float light_emitter_pdf(const struct trace_scene *scene, uint32_t mesh, uint32_t triangle,
                        float distance_m, float cosine)
{
    uint32_t first = scene->meshes[mesh].emitter_first;
    if (first == NO_EMITTER || !scene->lights.has_emitters || !(cosine > 0.0f)) return 0.0f;
    return scene->lights.emitters[first + triangle].density * distance_m * distance_m / cosine;
}
