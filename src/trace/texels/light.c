#include "trace/texels/light.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "trace/surface.h"
#include "trace/texels/inside.h"

#include <math.h>

struct texel_hit texel_hit_at(const struct trace_scene *scene, const struct ray *ray,
                              const struct ray_hit *hit)
{
    const struct trace_mesh *mesh = &scene->meshes[hit->geometry];
    const float along = -glms_vec3_dot(mesh->facets[hit->triangle].normal, ray->direction);
    struct texel_hit at_hit = { .back = along<0.0f, .inside = inside_side_of(scene, ray, hit)> 0,
                                .mesh = hit->geometry };
    if (at_hit.inside || !mesh->material->emissive) return at_hit;
    at_hit.emission = surface_emission(mesh, hit->triangle, hit->u, hit->v);
    at_hit.pdf =
        light_emitter_pdf(scene, hit->geometry, hit->triangle, hit->distance, fabsf(along));
    return at_hit;
}

// Cosine-distributed rays that have the density of a cell over the whole hemisphere.
static float rays_of_cell(const struct texel_receiver *r, uint32_t cell)
{
    return (float)((uint32_t)r->rays + r->cells.side * r->cells.side * r->cells.further[cell]);
}

static float rays_at(const struct texel_receiver *r, vec2s at)
{
    return r->cells.side ? rays_of_cell(r, texel_cell_at(r->cells.side, at)) : (float)r->rays;
}

static float rays_towards(const struct texel_receiver *r, vec3s direction)
{
    vec3s tangent, bitangent;
    if (!r->cells.side) return (float)r->rays;
    basis_of(r->normal, &tangent, &bitangent);
    const vec2s disk = { { glms_vec3_dot(direction, tangent),
                           glms_vec3_dot(direction, bitangent) } };
    return rays_at(r, sample_disk_inverse(disk));
}

static float density_of(const struct texel_receiver *r, float rays, float cosine, float pdf_light)
{
    return rays * cosine / GLM_PIf + (float)r->light_samples * pdf_light;
}

float texel_sample_density(const struct texel_receiver *r, vec3s direction, float pdf_light)
{
    if (glms_vec3_norm2(r->normal) > 0.0f)
        return density_of(r, rays_towards(r, direction), glms_vec3_dot(direction, r->normal),
                          pdf_light);
    return (float)r->rays / (4.0f * GLM_PIf) + (float)r->light_samples * pdf_light;
}

bool texel_sample_emitter(const struct trace_scene *scene, vec3s position, const vec3s *normal,
                          uint32_t k, uint32_t count, uint32_t seed, struct emitter_sample *out)
{
    const vec2s jitter = sobol_2d(k, pcg_hash(seed));
    const float choice = fminf(((float)k + jitter.x) / (float)count, 1.0f - 0x1p-24f);
    *out = light_sample_emitter(scene, position, choice, sobol_2d(k, pcg_hash(seed + 1u) | 1u));
    if (!(out->pdf > 0.0f) || (normal && !(glms_vec3_dot(out->to_light, *normal) > 0.0f)))
        return false;
    return !trace_occluded(scene, position, glms_vec3_sub(out->position, position), 1.0f);
}

void texel_emission_columns(const struct trace_scene *scene, const struct emission_basis *emission,
                            uint32_t mesh, vec3s radiance, texel_add_column add, void *user)
{
    const struct emission_part *part = &emission->parts[scene->meshes[mesh].mesh->material];
    for (int k = 0; k < part->count; k++) add(user, part->first + k, radiance.raw[k] / part->unit);
}

// An emitter that a receiver sees.
struct seen_emitter {
    uint32_t mesh;
    vec3s direction, radiance;
    float density; // of samples of the direction, sr⁻¹
};

static void add_light(struct texel_light *to, vec3s direction, float cosine, float light)
{
    to->irradiance += light * cosine;
    for (int k = 0; k < 3; k++) to->vector[k] += light * direction.raw[k];
}

struct column_sums {
    struct texel_lights *out;
    vec3s direction;
    float cosine, density;
};

static void add_column(void *user, int column, float radiance)
{
    const struct column_sums *to = user;
    add_light(&to->out->columns[column], to->direction, to->cosine, radiance / to->density);
    to->out->column_fluence[column] += radiance / to->density;
}

static void add_emission(struct texel_lights *out, const struct trace_scene *scene,
                         const struct texel_receiver *r, const struct seen_emitter *e)
{
    const float cosine = glms_vec3_dot(e->direction, r->normal);
    if (!(cosine > 0.0f) || !(e->density > 0.0f)) return;
    for (int c = 0; c < 3; c++)
        add_light(&out->emitted[c], e->direction, cosine, e->radiance.raw[c] / e->density);
    struct column_sums sums = { out, e->direction, cosine, e->density };
    if (r->emission)
        texel_emission_columns(scene, r->emission, e->mesh, e->radiance, add_column, &sums);
}

static void add_uniform(struct texel_lights *out, vec3s direction, float density)
{
    for (int k = 0; k < 3; k++) out->uniform_vector[k] += direction.raw[k] / density;
}

static void add_sky(struct texel_lights *out, float rays, vec3s direction, float cosine)
{
    const float weight = GLM_PIf / rays; // of a cosine-distributed ray, sr
    out->sky.irradiance += weight;
    out->sky_fluence += weight / cosine;
    out->sky_patches[environment_patch_of(direction)] += weight;
    for (int k = 0; k < 3; k++) out->sky.vector[k] += weight * direction.raw[k] / cosine;
}

// Directions along the surface have no finite weight in the vector irradiance.
static const float LEAST_COSINE = 1e-3f;

struct gather {
    const struct trace_scene *scene;
    const struct texel_receiver *receiver;
    const struct texel_visitor *visitor;
    struct texel_lights *out;
    vec3s tangent, bitangent;
};

static vec3s place_of(const struct texel_receiver *r, uint32_t i)
{
    return r->place_count ? r->places[i % r->place_count] : r->position;
}

// at: in the unit square. rays: that have the density of this one over the whole hemisphere.
static void gather_ray(const struct gather *g, vec3s from, vec2s at, float rays)
{
    const struct texel_receiver *r = g->receiver;
    vec3s local = sample_hemisphere_cosine(at);
    local.z = fmaxf(local.z, LEAST_COSINE);
    struct ray ray = { from, glms_vec3_scale(r->normal, local.z), 0.0f, INFINITY };
    ray.direction = glms_vec3_muladds(g->tangent, local.x, ray.direction);
    ray.direction = glms_vec3_muladds(g->bitangent, local.y, ray.direction);
    const float cosine = glms_vec3_dot(ray.direction, r->normal);
    struct ray_hit hit;
    if (!embree_closest(g->scene->embree, &ray, NULL, false, &hit)) {
        add_sky(g->out, rays, ray.direction, local.z);
        add_uniform(g->out, ray.direction, density_of(r, rays, cosine, 0.0f));
        if (g->visitor->miss) g->visitor->miss(g->visitor->user, ray.direction);
        return;
    }
    struct texel_hit at_hit = texel_hit_at(g->scene, &ray, &hit);
    at_hit.share = 1.0f / rays;
    const float density = density_of(r, rays, cosine, at_hit.pdf);
    add_uniform(g->out, ray.direction, density);
    if (glms_vec3_max(at_hit.emission) > 0.0f)
        add_emission(
            g->out, g->scene, r,
            &(struct seen_emitter){ at_hit.mesh, ray.direction, at_hit.emission, density });
    if (g->visitor->hit) g->visitor->hit(g->visitor->user, &ray, &hit, local, &at_hit);
}

static void gather_cell(const struct gather *g, uint32_t cell)
{
    const struct texel_receiver *r = g->receiver;
    const uint32_t side = r->cells.side, seed = pcg_hash(r->seed + cell) | 1u;
    const vec2s corner = { { (float)(cell % side), (float)(cell / side) } };
    for (uint32_t k = 0; k < r->cells.further[cell]; k++) {
        const vec2s at = glms_vec2_add(corner, sobol_2d(k, seed));
        gather_ray(g, place_of(r, pcg_hash(seed + k)), glms_vec2_divs(at, (float)side),
                   rays_of_cell(r, cell));
    }
}

static void gather_emitters(const struct gather *g)
{
    const struct texel_receiver *r = g->receiver;
    for (uint32_t k = 0; k < (uint32_t)r->light_samples; k++) {
        struct emitter_sample s;
        if (!texel_sample_emitter(g->scene, place_of(r, pcg_hash(r->seed + k)), &r->normal, k,
                                  (uint32_t)r->light_samples, r->seed + r->first, &s))
            continue;
        const float density = texel_sample_density(r, s.to_light, s.pdf);
        add_uniform(g->out, s.to_light, density);
        add_emission(g->out, g->scene, r,
                     &(struct seen_emitter){ s.mesh, s.to_light, s.radiance, density });
    }
}

void texel_gather(const struct trace_scene *scene, const struct texel_receiver *r,
                  const struct texel_visitor *visitor, struct texel_lights *out)
{
    struct gather g = { .scene = scene, .receiver = r, .visitor = visitor, .out = out };
    *out = (struct texel_lights){ 0 };
    basis_of(r->normal, &g.tangent, &g.bitangent);
    for (uint32_t k = 0; k < (uint32_t)r->rays; k++) {
        const vec2s at = sobol_2d(r->first + k, r->seed);
        // Runs of the Sobol sequence are spread evenly, every n-th point is not.
        const uint32_t place = (uint32_t)((uint64_t)k * r->place_count / (uint32_t)r->rays);
        gather_ray(&g, place_of(r, place), at, rays_at(r, at));
    }
    for (uint32_t cell = 0; cell < r->cells.side * r->cells.side; cell++) gather_cell(&g, cell);
    gather_emitters(&g);
}

void texel_gather_light(const struct trace_scene *scene, const struct texel_receiver *receiver,
                        texel_visit visit, void *user, struct texel_lights *out)
{
    texel_gather(scene, receiver, &(struct texel_visitor){ .hit = visit, .user = user }, out);
}

// Rounding errors are carried on, so that the sum is 255.
void texel_sky_shares(const struct texel_lights *lights, uint8_t out[ENVIRONMENT_PATCHES])
{
    const float scale = lights->sky.irradiance > 0.0f ? 255.0f / lights->sky.irradiance : 0.0f;
    float rest = 0.0f;
    for (int i = 0; i < ENVIRONMENT_PATCHES; i++) {
        const float share = lights->sky_patches[i] * scale + rest;
        const float rounded =
            lights->sky_patches[i] > 0.0f ? fminf(fmaxf(rintf(share), 0.0f), 255.0f) : 0.0f;
        out[i] = (uint8_t)rounded;
        rest = share - rounded;
    }
}
