// Where a texel is sampled: in its middle, or where that is inside of something, beside it. A texel
// of a ledge whose larger part is in a wall still has light.
#include "techniques/radiosity/bake/gather.h"

#include "core/rng.h"
#include "core/sampling.h"

enum { ACROSS = 8, PROBES = 16 };

static bool meets_back(const struct radiosity_scene *scene, vec3s from, vec3s direction)
{
    const struct ray ray = { from, direction, 0.0f, INFINITY };
    struct ray_hit hit;
    if (!embree_closest(scene->trace->embree, &ray, NULL, false, &hit)) return false;
    const struct trace_mesh *mesh = &scene->trace->meshes[hit.geometry];
    return !mesh->material->double_sided &&
           glms_vec3_dot(mesh->facets[hit.triangle].normal, direction) > 0.0f;
}

// A point is inside of something if most rays meet the back of single-sided surfaces.
bool radiosity_is_inside(const struct radiosity_scene *scene, uint32_t texel, vec3s at)
{
    const struct chart_texel *t = radiosity_chart_texel(&scene->map, texel);
    const struct chart_triangle *of = &scene->map.charts.triangles[t->triangle];
    const struct trace_mesh *mesh = &scene->trace->meshes[scene->mesh_of[of->instance]];
    const vec3s normal = scene->map.texels[texel].normal;
    const float reach = mesh->facets[of->triangle].reach;
    const vec3s from = glms_vec3_muladds(normal, reach, at);
    vec3s u, v;
    int behind = 0;
    basis_of(normal, &u, &v);
    for (uint32_t k = 0; k < PROBES; k++) {
        const vec3s local = sample_hemisphere_cosine(sobol_2d(k, 1));
        vec3s direction = glms_vec3_scale(normal, local.z);
        direction = glms_vec3_muladds(u, local.x, direction);
        direction = glms_vec3_muladds(v, local.y, direction);
        behind += meets_back(scene, from, direction);
    }
    return 2 * behind > PROBES;
}

static vec3s point_of(const struct chart_triangle *t, float u, float v)
{
    vec3s p = glms_vec3_scale(t->corner[0], 1.0f - u - v);
    p = glms_vec3_muladds(t->corner[1], u, p);
    return glms_vec3_muladds(t->corner[2], v, p);
}

struct radiosity_point radiosity_find_point(const struct radiosity_scene *scene, uint32_t texel)
{
    const struct chart_texel *t = radiosity_chart_texel(&scene->map, texel);
    const struct chart_triangle *of = &scene->map.charts.triangles[t->triangle];
    struct radiosity_point point = { t->position, 1.0f };
    if (!radiosity_is_inside(scene, texel, t->position)) return point;
    int tried = 1, open = 0;
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        const float x = (float)t->x + ((float)(i % ACROSS) + 0.5f) / ACROSS;
        const float y = (float)t->y + ((float)(i / ACROSS) + 0.5f) / ACROSS;
        float u, v;
        if (!radiosity_weigh(of, x, y, &u, &v)) continue;
        const vec3s at = point_of(of, u, v);
        tried++;
        if (radiosity_is_inside(scene, texel, at)) continue;
        if (open++ == 0) point.position = at;
    }
    point.share = (float)open / (float)tried;
    return point;
}
