// Walls that stand on a chart subdivide its clusters, and nodes are groups only if their clusters
// are visible from each other: else light would leak from one room to the next. So does the edge of
// a surface that is near in front of a part of them, as a panel below a ceiling: else the light
// between both, which the room hardly sees, would leak into it.
#include "techniques/radiosity/bake/gather.h"

#include "core/parallel.h"
#include "trace/texels/walls.h"

#include <math.h>

// Points are compared at this height over the surface, in distances between them, so that a curved
// surface does not hide its own.
static const float HEIGHT = 0.25f;

// A surface in front covers a place, and not another one, if it is nearer to it than they are to
// each other, and this factor nearer than what is in front of the other.
static const float NEARER = 2.0f;

struct surface_point {
    vec3s position, normal;
    float opening; // distance to what is in front, along the normal; of open_point_of
};

static struct surface_point point_of(const struct radiosity_scene *scene, uint32_t texel)
{
    const struct charts *charts = &scene->map.charts;
    return (struct surface_point){ .position = chart_texel_of(charts, texel)->position,
                                   .normal = chart_texel_normal(charts, texel) };
}

static struct surface_point open_point_of(const struct radiosity_scene *scene, uint32_t texel)
{
    const struct chart_triangle *of = chart_triangle_of(&scene->map.charts, texel);
    const float reach = trace_mesh_of(scene->trace, of->instance)->facets[of->triangle].reach;
    struct surface_point p = point_of(scene, texel);
    struct trace_hit hit;
    const vec3s from = glms_vec3_muladds(p.normal, reach, p.position);
    const bool covered = trace_closest(scene->trace, from, p.normal, INFINITY, &hit);
    p.opening = covered ? hit.distance : INFINITY;
    return p;
}

static bool are_mutually_visible(const struct radiosity_scene *scene, struct surface_point a,
                                 struct surface_point b)
{
    const float height = HEIGHT * glms_vec3_distance(a.position, b.position);
    const vec3s from = glms_vec3_muladds(a.normal, height, a.position);
    const vec3s to = glms_vec3_muladds(b.normal, height, b.position);
    return height == 0.0f || !trace_occluded(scene->trace, from, glms_vec3_sub(to, from), 1.0f);
}

static bool are_equally_open(struct surface_point a, struct surface_point b)
{
    const float least = fminf(a.opening, b.opening), most = fmaxf(a.opening, b.opening);
    return least >= glms_vec3_distance(a.position, b.position) || most <= NEARER * least;
}

static bool are_alike(const struct radiosity_scene *scene, struct surface_point a,
                      struct surface_point b)
{
    return are_equally_open(a, b) && are_mutually_visible(scene, a, b);
}

bool radiosity_texels_see(const struct radiosity_scene *scene, uint32_t a, uint32_t b)
{
    return are_mutually_visible(scene, point_of(scene, a), point_of(scene, b));
}

// The first texel of a cluster outside geometry; without one the first.
static uint32_t first_open(const struct radiosity_scene *scene, uint32_t cluster)
{
    const struct radiosity_map *map = &scene->map;
    for (uint32_t m = map->first[cluster]; m < map->first[cluster + 1]; m++) {
        const uint32_t texel = map->members[m];
        if (!texel_is_inside(scene->trace, &map->charts, texel,
                             chart_texel_of(&map->charts, texel)->position))
            return texel;
    }
    return map->members[map->first[cluster]];
}

static void subdivide_cluster(void *user, size_t cluster)
{
    struct radiosity_scene *scene = user;
    const struct radiosity_map *map = &scene->map;
    if (map->first[cluster + 1] - map->first[cluster] < 2) return;
    const struct surface_point from = open_point_of(scene, first_open(scene, (uint32_t)cluster));
    for (uint32_t m = map->first[cluster]; m < map->first[cluster + 1]; m++)
        scene->part[map->members[m]] =
            !are_alike(scene, from, open_point_of(scene, map->members[m]));
}

static void find_group(void *user, size_t n)
{
    struct radiosity_scene *scene = user;
    const struct radiosity_map *map = &scene->map;
    const struct radiosity_node *node = &map->tree.nodes[n];
    if (node->count > RADIOSITY_GROUP) return;
    const struct surface_point from = open_point_of(scene, first_open(scene, node->first));
    scene->is_group[n] = true;
    for (uint32_t c = node->first + 1; c < node->first + node->count; c++)
        if (!are_alike(scene, from, open_point_of(scene, first_open(scene, c))))
            scene->is_group[n] = false;
}

static void find_beside_wall(void *user, size_t texel)
{
    struct radiosity_scene *scene = user;
    scene->beside_wall[texel] =
        texel_is_beside_wall(scene->trace, &scene->map.charts, (uint32_t)texel);
}

bool radiosity_subdivide(struct radiosity_scene *scene)
{
    struct radiosity_map *map = &scene->map;
    scene->part = host_alloc(scene->host, map->texel_count, sizeof *scene->part);
    scene->beside_wall = host_alloc(scene->host, map->texel_count, sizeof *scene->beside_wall);
    if (!scene->part || !scene->beside_wall) return false;
    parallel_for(map->texel_count, 64, find_beside_wall, scene);
    parallel_for(map->cluster_count, 64, subdivide_cluster, scene);
    if (!radiosity_map_subdivide(map, scene->part)) return false;
    scene->is_group = host_alloc(scene->host, map->tree.count, sizeof *scene->is_group);
    if (!scene->is_group) return false;
    parallel_for(map->tree.count, 64, find_group, scene);
    return true;
}
