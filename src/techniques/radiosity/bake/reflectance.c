// Reflectance of texels for light that bounces: brdf_bounce_reflectance (frame/brdf.glsl), the mean
// of points inside the texel.
#include "techniques/radiosity/bake/gather.h"

#include "trace/surface.h"

#include <math.h>

enum { POINTS_ACROSS = 4, COSINES = 16 };

// Hemispherical albedo of the dielectric's lobe with multiple scattering: ∫ 2 μ E(μ) dμ.
static vec3s lobe_albedo(const struct bsdf_material *m)
{
    const float roughness = fmaxf(m->roughness, GGX_MIN_ROUGHNESS);
    float a = 0.0f, b = 0.0f;
    for (int i = 0; i < COSINES; i++) {
        const float cosine = ((float)i + 0.5f) / COSINES;
        const struct ggx_albedo at = ggx_albedo_at(cosine, roughness);
        a += at.a * 2.0f * cosine / COSINES;
        b += at.b * 2.0f * cosine / COSINES;
    }
    const float loss = (1.0f - a - b) / (a + b);
    vec3s albedo;
    for (int c = 0; c < 3; c++)
        albedo.raw[c] = (m->dielectric_f0.raw[c] * a + m->dielectric_f90 * b) *
                        (1.0f + m->dielectric_f0.raw[c] * loss);
    return albedo;
}

static vec3s reflectance_of(const struct surface *s)
{
    if (s->unlit) return vec3_of(0, 0, 0);
    const vec3s lobe = lobe_albedo(&s->material);
    const float transmitted = fminf(fmaxf(1.0f - glms_vec3_max(lobe), 0.0f), 1.0f);
    const vec3s sum = glms_vec3_muladds(s->material.albedo, transmitted, lobe);
    return glms_vec3_scale(sum, 1.0f - s->material.metallic);
}

bool radiosity_weigh(const struct chart_triangle *t, float x, float y, float *u, float *v)
{
    const vec2s a = glms_vec2_sub(t->place[1], t->place[0]);
    const vec2s b = glms_vec2_sub(t->place[2], t->place[0]);
    const float px = x - t->place[0].x, py = y - t->place[0].y;
    const float area = a.x * b.y - a.y * b.x;
    *u = (px * b.y - py * b.x) / area;
    *v = (a.x * py - a.y * px) / area;
    return *u >= 0.0f && *v >= 0.0f && *u + *v <= 1.0f;
}

vec3s radiosity_reflectance(const struct radiosity_scene *scene, uint32_t texel)
{
    const struct chart_texel *t = radiosity_chart_texel(&scene->map, texel);
    const struct chart_triangle *of = &scene->map.charts.triangles[t->triangle];
    const vec3s normal = scene->map.texels[texel].normal;
    const uint32_t mesh = scene->mesh_of[of->instance];
    const int across =
        scene->trace->meshes[mesh].material->mapped || scene->trace->meshes[mesh].mesh->colors
            ? POINTS_ACROSS
            : 1;
    vec3s sum = vec3_of(0, 0, 0);
    for (int i = 0; i < across * across; i++) {
        struct ray_hit hit = { .distance = 1.0f, .geometry = mesh, .triangle = of->triangle };
        const float x = ((float)(i % across) + 0.5f) / (float)across;
        const float y = ((float)(i / across) + 0.5f) / (float)across;
        if (!radiosity_weigh(of, (float)t->x + x, (float)t->y + y, &hit.u, &hit.v)) {
            hit.u = t->u;
            hit.v = t->v;
        }
        const struct ray ray = { glms_vec3_add(t->position, normal), glms_vec3_negate(normal), 0.0f,
                                 INFINITY };
        struct surface surface;
        surface_at(scene->trace, &ray, &hit, NULL, &surface);
        sum = glms_vec3_add(sum, reflectance_of(&surface));
    }
    return glms_vec3_divs(sum, (float)(across * across));
}
