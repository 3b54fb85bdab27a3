// What a ray meets, as the frame's G-buffer would have it (scene.glsl, gbuffer_fragment.glsl).
#include "trace/surface.h"

#include <math.h>

// Rounding errors of a position are a few units in the last place (2⁻²⁴) of the corners that it is
// interpolated from.
static const float REACH = 0x1p-19f;

struct weights {
    float w[3];
};

static struct weights weights_of(float u, float v)
{
    return (struct weights){ { 1.0f - u - v, u, v } };
}

static vec3s interpolate3(const vec3s *values, const uint32_t corner[3], struct weights w)
{
    vec3s p = glms_vec3_scale(values[corner[0]], w.w[0]);
    p = glms_vec3_muladds(values[corner[1]], w.w[1], p);
    return glms_vec3_muladds(values[corner[2]], w.w[2], p);
}

// The coordinates of a set; a mesh without a second one uses the first, one without any has 0.
static const vec2s *uv_set(const struct mesh *mesh, int set)
{
    return set == 1 && mesh->uv[1] ? mesh->uv[1] : mesh->uv[0];
}

static vec2s interpolate2(const vec2s *uv, const uint32_t corner[3], struct weights w)
{
    vec2s p = glms_vec2_scale(uv[corner[0]], w.w[0]);
    p = glms_vec2_add(p, glms_vec2_scale(uv[corner[1]], w.w[1]));
    return glms_vec2_add(p, glms_vec2_scale(uv[corner[2]], w.w[2]));
}

// One point of one triangle, and how its weights change from pixel to pixel.
struct spot {
    const struct trace_mesh *mesh;
    uint32_t corner[3];
    struct weights w;
    float dx[2], dy[2]; // of the second and third weight
};

// The step along the triangle that a step of the ray's direction makes, as weights of its edges.
static void weight_step(const struct pixel_footprint *f, vec3s normal, vec3s e1, vec3s e2, float t,
                        vec3s step, float out[2])
{
    float along = glms_vec3_dot(normal, f->direction);
    if (along == 0.0f) return;
    float slide = -glms_vec3_dot(normal, step) / along;
    vec3s d = glms_vec3_scale(glms_vec3_muladds(f->direction, slide, step), t);
    float a = glms_vec3_dot(e1, e1), b = glms_vec3_dot(e1, e2), c = glms_vec3_dot(e2, e2);
    float determinant = a * c - b * b;
    if (!(determinant > 0.0f)) return;
    float p = glms_vec3_dot(d, e1), q = glms_vec3_dot(d, e2);
    out[0] = (c * p - b * q) / determinant;
    out[1] = (a * q - b * p) / determinant;
}

static struct spot spot_of(const struct trace_mesh *mesh, uint32_t triangle, float u, float v)
{
    struct spot s = { .mesh = mesh, .w = weights_of(u, v) };
    trace_corners(mesh, triangle, s.corner);
    return s;
}

static void spot_widen(struct spot *s, const struct pixel_footprint *f)
{
    vec3s p0 = s->mesh->positions[s->corner[0]];
    vec3s e1 = glms_vec3_sub(s->mesh->positions[s->corner[1]], p0);
    vec3s e2 = glms_vec3_sub(s->mesh->positions[s->corner[2]], p0);
    vec3s normal = glms_vec3_cross(e1, e2);
    vec3s position = interpolate3(s->mesh->positions, s->corner, s->w);
    vec3s away = glms_vec3_sub(position, f->origin);
    float t = glms_vec3_dot(away, f->direction) / glms_vec3_norm2(f->direction);
    weight_step(f, normal, e1, e2, t, f->dx, s->dx);
    weight_step(f, normal, e1, e2, t, f->dy, s->dy);
}

static vec4s sample_map(const struct spot *s, const struct texture_map *map)
{
    const vec2s *uv = uv_set(s->mesh->mesh, map->uv_set);
    vec2s zero = { { 0, 0 } };
    if (!uv) return texture_sample(map, zero, zero, zero);
    vec2s d1 = glms_vec2_sub(uv[s->corner[1]], uv[s->corner[0]]);
    vec2s d2 = glms_vec2_sub(uv[s->corner[2]], uv[s->corner[0]]);
    vec2s dx = glms_vec2_add(glms_vec2_scale(d1, s->dx[0]), glms_vec2_scale(d2, s->dx[1]));
    vec2s dy = glms_vec2_add(glms_vec2_scale(d1, s->dy[0]), glms_vec2_scale(d2, s->dy[1]));
    return texture_sample(map, interpolate2(uv, s->corner, s->w), dx, dy);
}

// Factor × vertex colour × map, as scene_base_color.
static vec4s base_color(const struct spot *s)
{
    const struct trace_material *m = s->mesh->material;
    vec4s base = vec4_of(m->base_color, m->alpha);
    const vec4s *colors = s->mesh->mesh->colors;
    if (colors) {
        vec4s c = glms_vec4_scale(colors[s->corner[0]], s->w.w[0]);
        c = glms_vec4_muladds(colors[s->corner[1]], s->w.w[1], c);
        c = glms_vec4_muladds(colors[s->corner[2]], s->w.w[2], c);
        base = glms_vec4_mul(base, glms_vec4_clamp(c, 0.0f, 1.0f));
    }
    if (m->base_color_map.texture) base = glms_vec4_mul(base, sample_map(s, &m->base_color_map));
    return base;
}

bool surface_is_solid(const void *user, uint32_t triangle, float u, float v, const void *view)
{
    const struct trace_mesh *mesh = user;
    struct spot s = spot_of(mesh, triangle, u, v);
    if (view) spot_widen(&s, view);
    return !(base_color(&s).w < mesh->material->alpha_cutoff);
}

static vec3s emission_of(const struct spot *s)
{
    const struct trace_material *m = s->mesh->material;
    if (!m->emissive || !m->emissive_map.texture) return m->emission;
    return glms_vec3_mul(m->emission, vec3_xyz(sample_map(s, &m->emissive_map)));
}

vec3s surface_emission(const struct trace_mesh *mesh, uint32_t triangle, float u, float v)
{
    struct spot s = spot_of(mesh, triangle, u, v);
    return emission_of(&s);
}

// glTF 2.0, sec. 3.9.3, on the front's side.
static vec3s shading_normal(const struct spot *s, vec3s geometric)
{
    const struct trace_material *m = s->mesh->material;
    vec3s n = interpolate3(s->mesh->normals, s->corner, s->w);
    if (m->normal_map.texture && s->mesh->tangents) {
        vec4s t = glms_vec4_scale(s->mesh->tangents[s->corner[0]], s->w.w[0]);
        t = glms_vec4_muladds(s->mesh->tangents[s->corner[1]], s->w.w[1], t);
        t = glms_vec4_muladds(s->mesh->tangents[s->corner[2]], s->w.w[2], t);
        vec3s tangent = vec3_xyz(t), local = vec3_xyz(sample_map(s, &m->normal_map));
        local = vec3_of((2.0f * local.x - 1.0f) * m->normal_scale,
                        (2.0f * local.y - 1.0f) * m->normal_scale, 2.0f * local.z - 1.0f);
        vec3s bitangent = glms_vec3_scale(glms_vec3_cross(n, tangent), t.w);
        n = glms_vec3_scale(n, local.z);
        n = glms_vec3_muladds(tangent, local.x, n);
        n = glms_vec3_muladds(bitangent, local.y, n);
    }
    float length2 = glms_vec3_norm2(n);
    return length2 > 1e-12f ? glms_vec3_scale(n, 1.0f / sqrtf(length2)) : geometric;
}

// fmaxf is a call, for the sake of NaN.
static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

static inline float largest(vec3s v)
{
    return larger(fabsf(v.x), larger(fabsf(v.y), fabsf(v.z)));
}

float surface_reach(const struct trace_mesh *mesh, const uint32_t corner[3])
{
    float size = largest(mesh->positions[corner[0]]);
    size = larger(size, largest(mesh->positions[corner[1]]));
    size = larger(size, largest(mesh->positions[corner[2]]));
    return REACH * size + 1e-9f;
}

static void read_maps(const struct spot *s, struct surface *out)
{
    const struct trace_material *m = s->mesh->material;
    // The G-buffer's albedo cannot say more than 1 either.
    out->albedo = glms_vec3_clamp(vec3_xyz(base_color(s)), 0.0f, 1.0f);
    out->metallic = m->metallic;
    out->roughness = m->roughness;
    if (m->metallic_roughness_map.texture) {
        vec4s v = sample_map(s, &m->metallic_roughness_map);
        out->roughness *= v.y;
        out->metallic *= v.z;
    }
    if (m->unlit) {
        out->roughness = 1.0f;
        out->metallic = 0.0f;
    }
    if (m->emissive && (out->front || m->double_sided)) out->emission = emission_of(s);
}

struct surface surface_at(const struct trace_scene *scene, const struct ray *ray,
                          const struct ray_hit *hit, const struct pixel_footprint *footprint)
{
    const struct trace_mesh *mesh = &scene->meshes[hit->geometry];
    struct spot s = spot_of(mesh, hit->triangle, hit->u, hit->v);
    if (footprint) spot_widen(&s, footprint);
    vec3s geometric = glms_vec3_normalize(trace_area_normal(mesh, s.corner));
    bool front = glms_vec3_dot(geometric, ray->direction) < 0.0f;
    vec3s normal = shading_normal(&s, geometric);
    struct surface out = {
        .position = interpolate3(mesh->positions, s.corner, s.w),
        .geometric = front ? geometric : glms_vec3_negate(geometric),
        .normal = front ? normal : glms_vec3_negate(normal),
        .reach = surface_reach(mesh, s.corner),
        .front = front,
        .mesh = hit->geometry,
        .triangle = hit->triangle,
    };
    read_maps(&s, &out);
    return out;
}

vec3s surface_leave(const struct surface *s, vec3s direction)
{
    float side = glms_vec3_dot(s->geometric, direction) < 0.0f ? -s->reach : s->reach;
    return glms_vec3_muladds(s->geometric, side, s->position);
}
