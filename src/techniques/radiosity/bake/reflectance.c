// Reflectance of texels for light that bounces: brdf_bounce_reflectance (frame/brdf.glsl), the mean
// of points inside the texel.
#include "techniques/radiosity/bake/gather.h"

#include "trace/reflectance.h"

#include <math.h>

enum { POINTS_ACROSS = 4 };

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
        sum = glms_vec3_add(sum, surface_reflectance(&surface));
    }
    return glms_vec3_divs(sum, (float)(across * across));
}
