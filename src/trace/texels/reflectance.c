// Reflectance of texels for light that bounces: brdf_bounce_reflectance (frame/brdf.glsl), and the
// cosine between the shading normal and that of the triangle: the means of points inside the texel.
#include "trace/texels/texels.h"

#include "trace/reflectance.h"

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

static vec4s reflectance_at(const struct trace_scene *scene, const struct chart_triangle *of,
                            vec3s normal, float u, float v)
{
    struct surface surface;
    texel_surface(scene, of, u, v, normal, &surface);
    return vec4_of(surface_reflectance(&surface), glms_vec3_dot(surface.normal, normal));
}

// The mean of the middles of its triangles by area.
static vec4s reflectance_of_spot(const struct trace_scene *scene, const struct charts *charts,
                                 const struct chart *chart, vec3s normal)
{
    vec4s sum = glms_vec4_zero();
    for (uint32_t i = 0; i < chart->triangle_count; i++) {
        const struct chart_triangle *t = &charts->triangles[chart->first_triangle + i];
        sum = glms_vec4_muladds(reflectance_at(scene, t, normal, 1.0f / 3.0f, 1.0f / 3.0f),
                                t->area_m2, sum);
    }
    return glms_vec4_divs(sum, chart->area_m2);
}

vec4s texel_reflectance(const struct trace_scene *scene, const struct charts *charts,
                        uint32_t texel)
{
    const struct chart_texel *t = chart_texel_of(charts, texel);
    const struct chart_triangle *of = &charts->triangles[t->triangle];
    const struct chart *chart = &charts->charts[of->chart];
    const vec3s normal = chart_texel_normal(charts, texel);
    const struct trace_mesh *mesh = trace_mesh_of(scene, of->instance);
    const int across = mesh->material->mapped || mesh->mesh->colors ? POINTS_ACROSS : 1;
    vec4s sum = glms_vec4_zero();
    if (chart->spot) return reflectance_of_spot(scene, charts, chart, normal);
    for (int i = 0; i < across * across; i++) {
        const float x = ((float)(i % across) + 0.5f) / (float)across;
        const float y = ((float)(i / across) + 0.5f) / (float)across;
        float u, v;
        if (!texel_weigh(of, (float)t->x + x, (float)t->y + y, &u, &v)) {
            u = t->u;
            v = t->v;
        }
        sum = glms_vec4_add(sum, reflectance_at(scene, of, normal, u, v));
    }
    return glms_vec4_divs(sum, (float)(across * across));
}
