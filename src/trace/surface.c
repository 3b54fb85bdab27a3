// Surface attributes at a hit, equal to the frame's G-buffer (scene.glsl, gbuffer_fragment.glsl).
#include "trace/surface.h"

#include <math.h>

// A point of a triangle with barycentric weights and their screen-space derivatives.
struct triangle_point {
    const struct trace_mesh *mesh;
    const struct trace_facet *facet;
    uint32_t corner[3];
    const struct trace_vertex *a, *b, *c; // vertices of the corners
    float w[3];
    bool has_derivatives; // the derivatives are set
    float dx[2], dy[2];   // of the second and third weight per pixel
};

static inline vec3s weighted3(const float w[3], vec3s a, vec3s b, vec3s c)
{
    return vec3_of(w[0] * a.x + w[1] * b.x + w[2] * c.x, w[0] * a.y + w[1] * b.y + w[2] * c.y,
                   w[0] * a.z + w[1] * b.z + w[2] * c.z);
}

static inline vec4s weighted4(const float w[3], vec4s a, vec4s b, vec4s c)
{
    return vec4_of(weighted3(w, vec3_xyz(a), vec3_xyz(b), vec3_xyz(c)),
                   w[0] * a.w + w[1] * b.w + w[2] * c.w);
}

// Barycentric derivative for a change `step` of the ray direction (ray differentials, Igehy 1999).
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

static inline struct triangle_point triangle_point_at(const struct trace_mesh *mesh,
                                                      uint32_t triangle, float u, float v)
{
    struct triangle_point s = { .mesh = mesh,
                                .facet = &mesh->facets[triangle],
                                .w = { 1.0f - u - v, u, v } };
    trace_corners(mesh, triangle, s.corner);
    s.a = &mesh->vertices[s.corner[0]];
    s.b = &mesh->vertices[s.corner[1]];
    s.c = &mesh->vertices[s.corner[2]];
    return s;
}

static void set_derivatives(struct triangle_point *s, const struct pixel_footprint *f)
{
    vec3s e1 = glms_vec3_sub(s->b->position, s->a->position);
    vec3s e2 = glms_vec3_sub(s->c->position, s->a->position);
    vec3s normal = glms_vec3_cross(e1, e2);
    vec3s position = weighted3(s->w, s->a->position, s->b->position, s->c->position);
    vec3s away = glms_vec3_sub(position, f->origin);
    float t = glms_vec3_dot(away, f->direction) / glms_vec3_norm2(f->direction);
    weight_step(f, normal, e1, e2, t, f->dx, s->dx);
    weight_step(f, normal, e1, e2, t, f->dy, s->dy);
    s->has_derivatives = true;
}

static inline vec2s step_of(const float weights[2], vec2s e1, vec2s e2)
{
    return glms_vec2_add(glms_vec2_scale(e1, weights[0]), glms_vec2_scale(e2, weights[1]));
}

// The second uv set if the map uses it and the mesh has one, else the first.
static void corner_uv(const struct triangle_point *s, const struct texture_map *map, vec2s out[3])
{
    const vec2s *second = map->uv_set == 1 ? s->mesh->mesh->uv[1] : NULL;
    out[0] = second ? second[s->corner[0]] : s->a->uv;
    out[1] = second ? second[s->corner[1]] : s->b->uv;
    out[2] = second ? second[s->corner[2]] : s->c->uv;
}

static inline vec2s weighted2(const float w[3], const vec2s uv[3])
{
    return (vec2s){ { w[0] * uv[0].x + w[1] * uv[1].x + w[2] * uv[2].x,
                      w[0] * uv[0].y + w[1] * uv[1].y + w[2] * uv[2].y } };
}

static vec4s sample_map(const struct triangle_point *s, const struct texture_map *map)
{
    vec2s uv[3];
    corner_uv(s, map, uv);
    vec2s at = weighted2(s->w, uv);
    if (!s->has_derivatives) return texture_sample(map, at, 0.0f);
    vec2s e1 = glms_vec2_sub(uv[1], uv[0]), e2 = glms_vec2_sub(uv[2], uv[0]);
    float level = texture_level(map, step_of(s->dx, e1, e2), step_of(s->dy, e1, e2));
    return texture_sample(map, at, level);
}

static void prefetch_map(const struct triangle_point *s, const struct texture_map *map)
{
    vec2s uv[3];
    if (!map->texture) return;
    corner_uv(s, map, uv);
    texture_prefetch(map, weighted2(s->w, uv));
}

// Factor × vertex colour × map, as scene_base_color.
static vec4s base_color(const struct triangle_point *s)
{
    const struct trace_material *m = s->mesh->material;
    vec4s base = vec4_of(m->base_color, m->alpha);
    const vec4s *colors = s->mesh->mesh->colors;
    if (colors) {
        vec4s c = weighted4(s->w, colors[s->corner[0]], colors[s->corner[1]], colors[s->corner[2]]);
        base = glms_vec4_mul(base, glms_vec4_clamp(c, 0.0f, 1.0f));
    }
    if (m->base_color_map.texture) base = glms_vec4_mul(base, sample_map(s, &m->base_color_map));
    return base;
}

bool surface_is_solid(const void *user, uint32_t triangle, float u, float v, const void *view)
{
    const struct trace_mesh *mesh = user;
    struct triangle_point s = triangle_point_at(mesh, triangle, u, v);
    if (view) set_derivatives(&s, view);
    return !(base_color(&s).w < mesh->material->alpha_cutoff);
}

static vec3s emission_of(const struct triangle_point *s)
{
    const struct trace_material *m = s->mesh->material;
    if (!m->emissive || !m->emissive_map.texture) return m->emission;
    return glms_vec3_mul(m->emission, vec3_xyz(sample_map(s, &m->emissive_map)));
}

vec3s surface_emission(const struct trace_mesh *mesh, uint32_t triangle, float u, float v)
{
    struct triangle_point s = triangle_point_at(mesh, triangle, u, v);
    return emission_of(&s);
}

// glTF 2.0, sec. 3.9.3, on the front side.
static vec3s shading_normal(const struct triangle_point *s)
{
    const struct trace_material *m = s->mesh->material;
    vec3s n = weighted3(s->w, s->a->normal, s->b->normal, s->c->normal);
    if (m->normal_map.texture && s->mesh->has_tangents) {
        vec4s t = weighted4(s->w, s->a->tangent, s->b->tangent, s->c->tangent);
        vec3s tangent = vec3_xyz(t), local = vec3_xyz(sample_map(s, &m->normal_map));
        local = vec3_of((2.0f * local.x - 1.0f) * m->normal_scale,
                        (2.0f * local.y - 1.0f) * m->normal_scale, 2.0f * local.z - 1.0f);
        vec3s bitangent = glms_vec3_scale(glms_vec3_cross(n, tangent), t.w);
        n = glms_vec3_scale(n, local.z);
        n = glms_vec3_muladds(tangent, local.x, n);
        n = glms_vec3_muladds(bitangent, local.y, n);
    }
    float length2 = glms_vec3_norm2(n);
    return length2 > 1e-12f ? glms_vec3_scale(n, 1.0f / sqrtf(length2)) : s->facet->normal;
}

// KHR_materials_specular and KHR_materials_ior, as gbuffer_fragment.glsl.
static void read_specular(const struct triangle_point *s, struct bsdf_material *out)
{
    const struct trace_material *m = s->mesh->material;
    vec3s f0 = m->specular_f0;
    float weight = m->specular;
    if (m->specular_color_map.texture)
        f0 = glms_vec3_mul(f0, vec3_xyz(sample_map(s, &m->specular_color_map)));
    if (m->specular_map.texture) weight *= sample_map(s, &m->specular_map).w;
    out->dielectric_f0 = glms_vec3_scale(glms_vec3_minv(f0, vec3_of(1, 1, 1)), weight);
    out->dielectric_f90 = weight;
}

static void read_maps(const struct triangle_point *s, struct surface *out)
{
    const struct trace_material *m = s->mesh->material;
    out->material = (struct bsdf_material){
        // Clamped as the G-buffer's 8-bit albedo.
        .albedo = glms_vec3_clamp(vec3_xyz(base_color(s)), 0.0f, 1.0f),
        .metallic = m->metallic,
        .roughness = m->roughness,
    };
    read_specular(s, &out->material);
    if (m->metallic_roughness_map.texture) {
        vec4s v = sample_map(s, &m->metallic_roughness_map);
        out->material.roughness *= v.y;
        out->material.metallic *= v.z;
    }
    out->unlit = m->unlit;
    if (m->unlit) {
        out->material.roughness = 1.0f;
        out->material.metallic = 0.0f;
    }
    bool emits = m->emissive && (out->front || m->double_sided);
    out->emission = emits ? emission_of(s) : vec3_of(0, 0, 0);
}

void surface_at(const struct trace_scene *scene, const struct ray *ray, const struct ray_hit *hit,
                const struct pixel_footprint *footprint, struct surface *out)
{
    const struct trace_mesh *mesh = &scene->meshes[hit->geometry];
    struct triangle_point s = triangle_point_at(mesh, hit->triangle, hit->u, hit->v);
    if (footprint) set_derivatives(&s, footprint);
    vec3s geometric = s.facet->normal, normal = shading_normal(&s);
    out->front = glms_vec3_dot(geometric, ray->direction) < 0.0f;
    out->position = weighted3(s.w, s.a->position, s.b->position, s.c->position);
    out->geometric = out->front ? geometric : glms_vec3_negate(geometric);
    out->normal = out->front ? normal : glms_vec3_negate(normal);
    out->reach = s.facet->reach;
    out->mesh = hit->geometry;
    out->triangle = hit->triangle;
    read_maps(&s, out);
}

// ---- prefetch

void surface_prefetch(const struct trace_scene *scene, const struct ray_hit *hit)
{
    const struct trace_mesh *mesh = &scene->meshes[hit->geometry];
    __builtin_prefetch(&mesh->mesh->indices[3 * (size_t)hit->triangle]);
    __builtin_prefetch(&mesh->facets[hit->triangle]);
}

// A vertex may span two cache lines.
static void prefetch_vertex(const struct trace_vertex *vertex)
{
    __builtin_prefetch(vertex);
    __builtin_prefetch((const char *)(vertex + 1) - 1);
}

void surface_prefetch_corners(const struct trace_scene *scene, const struct ray_hit *hit)
{
    const struct trace_mesh *mesh = &scene->meshes[hit->geometry];
    uint32_t corner[3];
    trace_corners(mesh, hit->triangle, corner);
    for (int i = 0; i < 3; i++) prefetch_vertex(&mesh->vertices[corner[i]]);
}

void surface_prefetch_texels(const struct trace_scene *scene, const struct ray_hit *hit)
{
    const struct trace_mesh *mesh = &scene->meshes[hit->geometry];
    const struct trace_material *m = mesh->material;
    if (!m->textured) return;
    struct triangle_point s = triangle_point_at(mesh, hit->triangle, hit->u, hit->v);
    prefetch_map(&s, &m->base_color_map);
    prefetch_map(&s, &m->metallic_roughness_map);
    prefetch_map(&s, &m->normal_map);
    if (m->emissive) prefetch_map(&s, &m->emissive_map);
    prefetch_map(&s, &m->specular_map);
    prefetch_map(&s, &m->specular_color_map);
}
