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

// The share of points that are open; the first of them becomes the sample.
struct search {
    int tried, open;
    struct radiosity_point point;
};

static void try_point(const struct radiosity_scene *scene, uint32_t texel, vec3s at,
                      struct search *search)
{
    search->tried++;
    if (radiosity_is_inside(scene, texel, at)) return;
    if (search->open++ == 0) search->point.position = at;
}

// A spot has no extent in the atlas: the middles of its triangles.
static void search_spot(const struct radiosity_scene *scene, uint32_t texel,
                        const struct chart *chart, struct search *search)
{
    const uint32_t step = 1 + chart->triangle_count / (ACROSS * ACROSS);
    for (uint32_t i = 0; i < chart->triangle_count; i += step)
        try_point(scene, texel,
                  point_of(&scene->map.charts.triangles[chart->first_triangle + i], 1.0f / 3.0f,
                           1.0f / 3.0f),
                  search);
}

static void search_square(const struct radiosity_scene *scene, uint32_t texel,
                          const struct chart_triangle *of, struct search *search)
{
    const struct chart_texel *t = radiosity_chart_texel(&scene->map, texel);
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        const float x = (float)t->x + ((float)(i % ACROSS) + 0.5f) / ACROSS;
        const float y = (float)t->y + ((float)(i / ACROSS) + 0.5f) / ACROSS;
        float u, v;
        if (radiosity_weigh(of, x, y, &u, &v)) try_point(scene, texel, point_of(of, u, v), search);
    }
}

struct radiosity_point radiosity_find_point(const struct radiosity_scene *scene, uint32_t texel)
{
    const struct chart_texel *t = radiosity_chart_texel(&scene->map, texel);
    const struct chart_triangle *of = &scene->map.charts.triangles[t->triangle];
    const struct chart *chart = &scene->map.charts.charts[of->chart];
    struct search search = { .tried = 1, .point = { t->position, 1.0f } };
    if (!radiosity_is_inside(scene, texel, t->position)) return search.point;
    if (chart->spot)
        search_spot(scene, texel, chart, &search);
    else
        search_square(scene, texel, of, &search);
    search.point.share = (float)search.open / (float)search.tried;
    return search.point;
}
