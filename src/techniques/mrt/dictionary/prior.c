// Sphere lights of the prior.
#include "prior.h"

#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>

enum {
    LATTICE = PRIOR_LATTICE,
    BEYOND = PRIOR_BEYOND,
    LAYER = LATTICE * LATTICE,
    SHADOW_RAYS = 64,
};

// Light inside a cube or a straight tube is visible from everywhere.
static bool is_occluded(const struct mrt_shape *shape, struct mrt_prior_light light)
{
    return !light.inside || (shape->kind != MRT_CUBE && shape->kind != MRT_TUBE);
}

static float lattice(int i)
{
    return (float)(i + 1) / (float)(LATTICE + 1) - 0.5f;
}

// Two openings that share an edge.
static bool is_corner(const struct mrt_shape *shape, int a, int b)
{
    return shape->kind == MRT_CUBE && a / 2 != b / 2 && mrt_shape_is_open(shape, a) &&
           mrt_shape_is_open(shape, b);
}

int mrt_prior_light_count(const struct mrt_shape *shape)
{
    int count = LATTICE * LAYER;
    for (int a = 0; a < CUBE_FACES; a++) {
        if (mrt_shape_is_open(shape, a)) count += BEYOND * LAYER;
        for (int b = 0; b < a; b++)
            if (is_corner(shape, a, b)) count += BEYOND * BEYOND * LATTICE;
    }
    return count;
}

// Layer i of the lattice, counted from the face outward.
static float layer_beyond(int face, int i)
{
    float depth = 0.5f + (float)(i + 1) / (float)(LATTICE + 1);
    return face & 1 ? depth : -depth;
}

double mrt_prior_rays(const struct mrt_shape *shape)
{
    const int inside =
        is_occluded(shape, (struct mrt_prior_light){ .inside = true }) ? 0 : LATTICE * LAYER;
    return (double)(mrt_prior_light_count(shape) - inside) * mrt_shape_texels(shape) * SHADOW_RAYS;
}

static struct mrt_prior_light *add_inside(struct mrt_prior_light *light)
{
    for (int i = 0; i < LATTICE * LAYER; i++)
        *light++ = (struct mrt_prior_light){
            vec3_of(lattice(i % LATTICE), lattice(i / LATTICE % LATTICE), lattice(i / LAYER)), true
        };
    return light;
}

static struct mrt_prior_light *add_beyond(int face, struct mrt_prior_light *light)
{
    int axis = face / 2;
    for (int i = 0; i < BEYOND * LAYER; i++, light++) {
        light->inside = false;
        light->centre.raw[axis] = layer_beyond(face, i / LAYER);
        light->centre.raw[(axis + 1) % 3] = lattice(i % LATTICE);
        light->centre.raw[(axis + 2) % 3] = lattice(i / LATTICE % LATTICE);
    }
    return light;
}

static struct mrt_prior_light *add_corner(int a, int b, struct mrt_prior_light *light)
{
    for (int i = 0; i < BEYOND * BEYOND * LATTICE; i++, light++) {
        light->inside = false;
        light->centre.raw[a / 2] = layer_beyond(a, i / LATTICE % BEYOND);
        light->centre.raw[b / 2] = layer_beyond(b, i / LATTICE / BEYOND);
        light->centre.raw[3 - a / 2 - b / 2] = lattice(i % LATTICE);
    }
    return light;
}

// The lattice of a tube: on the disk and along it; beyond its ends the tube goes on straight.
static vec3s tube_light(enum tube_bend bend, int i, float along)
{
    float within = glm_clamp(along, 0.0f, 1.0f);
    vec3s at = vec3_of(0.5f + lattice(i % LATTICE), 0.5f + lattice(i / LATTICE), within);
    return glms_vec3_muladds(tube_axis(bend, within).forward, along - within,
                             tube_inside(bend, at));
}

static void add_tube(enum tube_bend bend, struct mrt_prior_light *light)
{
    for (int layer = -BEYOND; layer < LATTICE + BEYOND; layer++) {
        bool inside = layer >= 0 && layer < LATTICE;
        float depth = (float)(layer < 0 ? layer : layer + 1) / (float)(LATTICE + 1);
        if (layer >= LATTICE) depth = 1.0f + (float)(layer + 1 - LATTICE) / (float)(LATTICE + 1);
        for (int i = 0; i < LAYER; i++)
            *light++ = (struct mrt_prior_light){ tube_light(bend, i, depth), inside };
    }
}

void mrt_prior_lights(const struct mrt_shape *shape, struct mrt_prior_light *lights)
{
    if (shape->kind != MRT_CUBE) {
        add_tube((enum tube_bend)((int)shape->kind - MRT_TUBE), lights);
        return;
    }
    lights = add_inside(lights);
    for (int a = 0; a < CUBE_FACES; a++) {
        if (mrt_shape_is_open(shape, a)) lights = add_beyond(a, lights);
        for (int b = 0; b < a; b++)
            if (is_corner(shape, a, b)) lights = add_corner(a, b, lights);
    }
}

float mrt_point_light(struct mrt_point at, vec3s light)
{
    vec3s to = glms_vec3_sub(light, at.position);
    float squared = glms_vec3_norm2(to), along = glms_vec3_dot(to, at.frame.col[2]);
    return along > 0.0f ? along / (squared * sqrtf(squared)) : 0.0f;
}

static float light_radius(const struct mrt_shape *shape)
{
    float width = shape->kind == MRT_CUBE ? 1.0f : 2.0f * TUBE_RADIUS;
    return 0.5f * width / (float)(LATTICE + 1);
}

static bool points_at_opening(const struct mrt_shape *shape, vec3s from, vec3s ray)
{
    for (int f = 0; f < CUBE_FACES; f++)
        if (mrt_shape_is_open(shape, f) && mrt_shape_points_at(shape, f, from, ray)) return true;
    return false;
}

// The share of the sphere's irradiance that arrives: directions within the cone that the sphere
// subtends, by cosine. Light from beyond enters through an opening; a bend can occlude
// light from inside.
static float visible_share(const struct mrt_shape *shape, struct mrt_point at,
                           struct mrt_prior_light light, const vec2s disk[SHADOW_RAYS])
{
    vec3s axis = glms_vec3_sub(light.centre, at.position), t, b;
    float distance = glms_vec3_norm(axis), reach = light_radius(shape) / distance;
    float lit = 0.0f, all = 0.0f;
    axis = glms_vec3_scale(axis, 1.0f / distance);
    basis_of(axis, &t, &b);
    for (int i = 0; i < SHADOW_RAYS; i++) {
        struct mrt_hit hit;
        vec2s d = glms_vec2_scale(disk[i], reach);
        vec3s ray = glms_vec3_scale(axis, sqrtf(1.0f - glms_vec2_norm2(d)));
        ray = glms_vec3_muladds(t, d.x, glms_vec3_muladds(b, d.y, ray));
        float cosine = glm_max(glms_vec3_dot(ray, at.frame.col[2]), 0.0f);
        all += cosine;
        if (!light.inside && !points_at_opening(shape, at.position, ray)) continue;
        mrt_shape_trace(shape, at.position, ray, &hit);
        if (light.inside ? hit.distance >= distance - light_radius(shape) : hit.opening >= 0)
            lit += cosine;
    }
    return all > 0.0f ? lit / all : 0.0f;
}

void mrt_prior_column(const struct mrt_shape *shape, struct mrt_prior_light light, float *column,
                      size_t stride)
{
    vec2s disk[SHADOW_RAYS];
    int texels = mrt_shape_texels(shape);
    for (uint32_t i = 0; i < SHADOW_RAYS; i++) disk[i] = sample_disk(sobol_2d(i, 1));
    for (int i = 0; i < texels; i++) {
        struct mrt_point at = mrt_shape_texel(shape, i);
        const float direct = mrt_point_light(at, light.centre);
        const bool traced = direct > 0.0f && is_occluded(shape, light);
        column[(size_t)i * stride] =
            traced ? direct * visible_share(shape, at, light, disk) : direct;
    }
}
