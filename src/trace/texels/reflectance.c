// Reflectance of texels for light that bounces: brdf_bounce_reflectance (frame/brdf.glsl), and
// their shading normals: the means of points inside the texel.
#include "trace/texels/texels.h"

#include "trace/reflectance.h"

#include <math.h>

enum { POINTS_ACROSS = 4 };

bool texel_weigh(const struct chart_triangle *t, float x, float y, float *u, float *v)
{
    const vec2s a = glms_vec2_sub(t->place[1], t->place[0]);
    const vec2s b = glms_vec2_sub(t->place[2], t->place[0]);
    const float px = x - t->place[0].x, py = y - t->place[0].y;
    const float area = a.x * b.y - a.y * b.x;
    *u = (px * b.y - py * b.x) / area;
    *v = (a.x * py - a.y * px) / area;
    return *u >= 0.0f && *v >= 0.0f && *u + *v <= 1.0f;
}

void texel_surface(const struct trace_scene *scene, const struct chart_triangle *of, float u,
                   float v, vec3s normal, struct surface *out)
{
    const struct ray_hit hit = {
        .geometry = scene->mesh_of[of->instance], .triangle = of->triangle, .u = u, .v = v
    };
    const struct ray ray = { .direction = glms_vec3_negate(normal) };
    surface_at(scene, &ray, &hit, NULL, out);
}

struct look {
    vec3s reflectance, normal;
    struct texel_factors factors;
};

static void add_factors(struct texel_factors *sum, const struct bsdf_material *m, float weight)
{
    sum->base = glms_vec3_muladds(m->albedo, weight, sum->base);
    sum->metallic += weight * m->metallic;
    sum->roughness += weight * m->roughness;
    sum->weight += weight * m->dielectric_f90;
    sum->color = glms_vec3_muladds(m->dielectric_f0, weight, sum->color);
}

static void add_look(struct look *sum, const struct trace_scene *scene,
                     const struct chart_triangle *of, vec3s normal, float u, float v, float weight)
{
    struct surface surface;
    texel_surface(scene, of, u, v, normal, &surface);
    sum->reflectance = glms_vec3_muladds(surface_reflectance(&surface), weight, sum->reflectance);
    sum->normal = glms_vec3_muladds(surface.normal, weight, sum->normal);
    add_factors(&sum->factors, &surface.material, weight);
}

// The mean of the middles of its triangles by area.
static struct look look_of_triangles(const struct trace_scene *scene, const struct charts *charts,
                                     const struct chart *chart, vec3s normal)
{
    struct look sum = { 0 };
    for (uint32_t i = 0; i < chart->triangle_count; i++) {
        const struct chart_triangle *t = &charts->triangles[chart->first_triangle + i];
        add_look(&sum, scene, t, normal, 1.0f / 3.0f, 1.0f / 3.0f, t->area_m2 / chart->area_m2);
    }
    return sum;
}

static struct look look_of(const struct trace_scene *scene, const struct charts *charts,
                           uint32_t texel)
{
    const struct chart_texel *t = chart_texel_of(charts, texel);
    const struct chart_triangle *of = &charts->triangles[t->triangle];
    const struct chart *chart = &charts->charts[of->chart];
    const vec3s normal = chart_texel_normal(charts, texel);
    const struct trace_mesh *mesh = trace_mesh_of(scene, of->instance);
    const int across = mesh->material->textured || mesh->mesh->colors ? POINTS_ACROSS : 1;
    struct look sum = { 0 };
    if (chart->single_texel) return look_of_triangles(scene, charts, chart, normal);
    for (int i = 0; i < across * across; i++) {
        const float x = ((float)(i % across) + 0.5f) / (float)across;
        const float y = ((float)(i / across) + 0.5f) / (float)across;
        float u, v;
        if (!texel_weigh(of, (float)t->x + x, (float)t->y + y, &u, &v)) {
            u = t->u;
            v = t->v;
        }
        add_look(&sum, scene, of, normal, u, v, 1.0f / (float)(across * across));
    }
    return sum;
}

static float cosine_of(const struct look *look, const struct charts *charts, uint32_t texel)
{
    return glms_vec3_dot(look->normal, chart_texel_normal(charts, texel));
}

vec4s texel_reflectance(const struct trace_scene *scene, const struct charts *charts,
                        uint32_t texel, vec3s *shading)
{
    const struct look look = look_of(scene, charts, texel);
    if (shading) *shading = look.normal;
    return vec4_of(look.reflectance, cosine_of(&look, charts, texel));
}

struct texel_factors texel_free_factors(const struct trace_scene *scene,
                                        const struct charts *charts, uint32_t texel)
{
    struct look look = look_of(scene, charts, texel);
    look.factors.cosine = cosine_of(&look, charts, texel);
    return look.factors;
}

vec3s texel_reflectance_with(const struct texel_factors *f, const struct material *material)
{
    if (material->unlit) return vec3_of(0, 0, 0);
    const float weight = fmaxf(f->weight, 1e-6f);
    const vec3s f0 =
        glms_vec3_mul(material_specular_f0(material), glms_vec3_divs(f->color, weight));
    const struct bsdf_material look = {
        .albedo =
            glms_vec3_clamp(glms_vec3_mul(f->base, vec3_xyz(material->base_color)), 0.0f, 1.0f),
        .metallic = material->metallic * f->metallic,
        .roughness = material->roughness * f->roughness,
        .dielectric_f0 =
            glms_vec3_scale(glms_vec3_minv(f0, vec3_of(1, 1, 1)), material->specular * f->weight),
        .dielectric_f90 = material->specular * f->weight,
    };
    return bsdf_reflectance(&look);
}
