#include "techniques/radiosity/radiosity_map.h"

#include <string.h>

// ---- texels

static bool has_back(const struct scene *scene, const struct chart *chart)
{
    return scene->materials[scene_mesh_of(scene, chart->instance)->material].double_sided;
}

static bool make_texels(struct radiosity_map *map, const struct scene *scene)
{
    const struct charts *charts = &map->charts;
    map->back_of = host_alloc(map->host, charts->count, sizeof *map->back_of);
    if (!map->back_of) return false;
    uint64_t count = charts->texel_count;
    for (uint32_t c = 0; c < charts->count; c++) {
        map->back_of[c] = CHART_NONE;
        if (!has_back(scene, &charts->charts[c])) continue;
        map->back_of[c] = (uint32_t)count;
        count += charts->charts[c].texel_count;
    }
    map->texel_count = (uint32_t)count; // at most twice the atlas
    map->texels = host_alloc(map->host, map->texel_count, sizeof *map->texels);
    return map->texels;
}

static void place_texel(struct radiosity_map *map, uint32_t texel, uint32_t chart_texel, bool back)
{
    const vec3s normal = chart_texel_normal(&map->charts, chart_texel);
    map->texels[texel] = (struct radiosity_texel){
        .chart_texel = chart_texel, .normal = back ? glms_vec3_negate(normal) : normal, .back = back
    };
}

// ---- clusters

// Numbers the squares of one side of a chart, in the order in which its texels meet them. `square`:
// [2 · chart->width × chart->height]. part: NULL: all 0.
static void number_squares(struct radiosity_map *map, const struct chart *chart, uint32_t edge,
                           uint32_t first, const uint8_t *part, uint32_t *square)
{
    const uint32_t across = (chart->width + edge - 1) / edge;
    memset(square, 0xff, 2 * (size_t)chart->width * chart->height * sizeof *square);
    for (uint32_t i = 0; i < chart->texel_count; i++) {
        const struct chart_texel *t = &map->charts.texels[chart->first_texel + i];
        const uint32_t column = (t->x - chart->x) / edge, row = (t->y - chart->y) / edge;
        uint32_t *at = &square[2 * ((size_t)row * across + column) + (part ? part[first + i] : 0)];
        if (*at == CHART_NONE) *at = map->cluster_count++;
        place_texel(map, first + i, chart->first_texel + i, first != chart->first_texel);
        map->texels[first + i].cluster = *at;
    }
}

static bool make_clusters(struct radiosity_map *map, uint32_t edge, const uint8_t *part)
{
    const struct charts *charts = &map->charts;
    size_t most = 0;
    for (uint32_t c = 0; c < charts->count; c++) {
        const size_t size = (size_t)charts->charts[c].width * charts->charts[c].height;
        if (size > most) most = size;
    }
    uint32_t *square = host_alloc(map->host, most, 2 * sizeof *square);
    if (!square) return false;
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct chart *chart = &charts->charts[c];
        number_squares(map, chart, edge, chart->first_texel, part, square);
        if (map->back_of[c] == CHART_NONE) continue;
        number_squares(map, chart, edge, map->back_of[c], part, square);
    }
    host_free(map->host, square);
    return true;
}

static void list_members(struct radiosity_map *map)
{
    memset(map->first, 0, ((size_t)map->cluster_count + 1) * sizeof *map->first);
    for (uint32_t i = 0; i < map->texel_count; i++) map->first[map->texels[i].cluster + 1]++;
    for (uint32_t c = 0; c < map->cluster_count; c++) map->first[c + 1] += map->first[c];
    for (uint32_t i = 0; i < map->texel_count; i++)
        map->members[map->first[map->texels[i].cluster]++] = i;
    for (uint32_t c = map->cluster_count; c > 0; c--) map->first[c] = map->first[c - 1];
    map->first[0] = 0;
}

static struct radiosity_place place_of(const struct radiosity_map *map, uint32_t cluster)
{
    struct radiosity_place sum = { 0 };
    float area = 0.0f;
    for (uint32_t m = map->first[cluster]; m < map->first[cluster + 1]; m++) {
        const struct chart_texel *t = radiosity_chart_texel(map, map->members[m]);
        sum.position = glms_vec3_muladds(t->position, t->area_m2, sum.position);
        sum.normal = glms_vec3_muladds(map->texels[map->members[m]].normal, t->area_m2, sum.normal);
        area += t->area_m2;
    }
    if (area > 0.0f) sum.position = glms_vec3_divs(sum.position, area);
    sum.normal = vec3_unit(sum.normal);
    return sum;
}

static bool number_as_tree(struct radiosity_map *map)
{
    const uint32_t count = map->cluster_count;
    struct radiosity_place *places = host_alloc(map->host, count, sizeof *places);
    uint32_t *order = host_alloc(map->host, count, sizeof *order);
    uint32_t *number = host_alloc(map->host, count, sizeof *number);
    bool ok = places && order && number;
    for (uint32_t c = 0; ok && c < count; c++) places[c] = place_of(map, c);
    ok = ok && radiosity_tree_init(&map->tree, map->host, places, count, order);
    for (uint32_t c = 0; ok && c < count; c++) number[order[c]] = c;
    for (uint32_t i = 0; ok && i < map->texel_count; i++)
        map->texels[i].cluster = number[map->texels[i].cluster];
    host_free(map->host, places);
    host_free(map->host, order);
    host_free(map->host, number);
    return ok;
}

static bool make_hierarchy(struct radiosity_map *map)
{
    map->first = host_alloc(map->host, (size_t)map->cluster_count + 1, sizeof *map->first);
    map->members = host_alloc(map->host, map->texel_count, sizeof *map->members);
    if (!map->first || !map->members) return false;
    list_members(map);
    if (!number_as_tree(map)) return false;
    list_members(map);
    return true;
}

// ---- triangles

static bool index_triangles(struct radiosity_map *map, const struct scene *scene)
{
    const size_t count = scene_triangle_count(scene);
    map->triangle_0 =
        host_alloc(map->host, (size_t)scene->instance_count + 1, sizeof *map->triangle_0);
    map->chart_triangle = host_alloc(map->host, count, sizeof *map->chart_triangle);
    if (!map->triangle_0 || !map->chart_triangle) return false;
    for (int i = 0; i < scene->instance_count; i++)
        map->triangle_0[i + 1] = map->triangle_0[i] + scene_mesh_of(scene, i)->index_count / 3;
    memset(map->chart_triangle, 0xff, count * sizeof *map->chart_triangle);
    for (uint32_t t = 0; t < map->charts.triangle_count; t++) {
        const struct chart_triangle *of = &map->charts.triangles[t];
        map->chart_triangle[map->triangle_0[of->instance] + of->triangle] = t;
    }
    return true;
}

// Charts of a surface in many small parts touch several times as many texels as its area has. The
// atlas has room for the gutters of those.
enum { DENSITY_TRIES = 5, ATLAS_ROOM = 64, MOST_ATLAS = 1 << 28 };

// What may bring the number of texels nearer to the wanted one. False: nothing.
static bool want_fewer(struct charts_options *how, uint32_t texels, const struct charts *charts)
{
    // Each small part of a surface has a texel at any density: the others keep a quarter of them.
    const uint32_t least = texels / 4;
    if (charts->texel_count <= texels + texels / 8) return false;
    if (how->surface_texels > least) {
        const double surface = (double)how->surface_texels * texels / charts->texel_count;
        how->surface_texels = surface > least ? (uint32_t)surface : least;
        return true;
    }
    if (how->join == CHARTS_JOINED_ACROSS) return false;
    how->join = CHARTS_JOINED_ACROSS;
    return true;
}

// Of the surface, where the density is given.
enum { MOST_TEXELS = 1 << 22 };

static bool charts_at(struct charts *out, struct host *host, const struct scene_pose *pose,
                      float density)
{
    const struct charts_options how = { .texels_per_m = density,
                                        .max_texels = MOST_ATLAS,
                                        .surface_texels = MOST_TEXELS,
                                        .join = CHARTS_JOINED };
    if (!charts_init(out, host, pose, &how)) return false;
    const float reached = out->texels_per_m;
    if (out->count == 0 || reached > 0.999f * density) return true;
    return host_fail(host, FAIL_MEMORY,
                     "radiosity: density=%g needs more than %d texels for %s; density=%.3g fits",
                     (double)density, MOST_TEXELS, pose->scene->name, 0.99 * (double)reached);
}

bool radiosity_charts_init(struct charts *out, struct host *host, const struct scene_pose *pose,
                           const struct radiosity_options *options)
{
    const uint32_t texels = (uint32_t)options->texels;
    struct charts_options how = { .texels_per_m = 1e6f,
                                  .max_texels = texels < MOST_ATLAS / ATLAS_ROOM
                                                    ? texels * ATLAS_ROOM
                                                    : MOST_ATLAS,
                                  .surface_texels = texels,
                                  .join = CHARTS_JOINED,
                                  .atlas_per_texel = ATLAS_ROOM,
                                  .most_texels = MOST_TEXELS,
                                  .most_charts = RADIOSITY_MAX_CLUSTERS / 2 };
    if (options->density > 0.0f) return charts_at(out, host, pose, options->density);
    for (int i = 0; i < DENSITY_TRIES; i++) {
        if (!charts_init(out, host, pose, &how)) return false;
        if (!want_fewer(&how, texels, out)) return true;
        if (i + 1 < DENSITY_TRIES) charts_finish(out);
    }
    return true;
}

static bool refuse(const struct radiosity_map *map)
{
    return host_fail(map->host, FAIL_MEMORY,
                     "radiosity: %u sources of light, at most %d; the scene has too many small "
                     "charts",
                     map->cluster_count, RADIOSITY_MAX_CLUSTERS / 2);
}

enum { MOST_EDGE = 32 };

// Clusters, larger ones than wanted where there would be too many: each may have two parts.
static bool make_sources(struct radiosity_map *map, const struct radiosity_options *options)
{
    for (map->edge = (uint32_t)options->cluster;; map->edge++) {
        map->cluster_count = 0;
        if (!make_clusters(map, map->edge, NULL)) return false;
        if (map->cluster_count <= RADIOSITY_MAX_CLUSTERS / 2) return make_hierarchy(map);
        if (map->edge >= MOST_EDGE) return refuse(map);
    }
}

bool radiosity_map_init(struct radiosity_map *out, struct host *host, const struct scene_pose *pose,
                        const struct radiosity_options *options)
{
    *out = (struct radiosity_map){ .host = host };
    const bool ok = radiosity_charts_init(&out->charts, host, pose, options) &&
                    make_texels(out, pose->scene) && make_sources(out, options) &&
                    index_triangles(out, pose->scene);
    if (!ok) radiosity_map_finish(out);
    return ok;
}

static void finish_sources(struct radiosity_map *map)
{
    host_free(map->host, map->first);
    host_free(map->host, map->members);
    radiosity_tree_finish(&map->tree);
    map->first = map->members = NULL;
    map->cluster_count = 0;
}

bool radiosity_map_divide(struct radiosity_map *map, const uint8_t *part)
{
    finish_sources(map);
    return make_clusters(map, map->edge, part) && make_hierarchy(map);
}

void radiosity_map_finish(struct radiosity_map *map)
{
    if (!map->host) return;
    charts_finish(&map->charts);
    finish_sources(map);
    host_free(map->host, map->texels);
    host_free(map->host, map->back_of);
    host_free(map->host, map->triangle_0);
    host_free(map->host, map->chart_triangle);
    *map = (struct radiosity_map){ 0 };
}

// ---- lookup

static uint32_t clamp_to(float at, uint32_t first, uint32_t count)
{
    const float last = (float)(first + count - 1);
    return (uint32_t)(at < (float)first ? (float)first : at > last ? last : at);
}

uint32_t radiosity_texel_at(const struct radiosity_map *map, int instance, uint32_t triangle,
                            float u, float v, bool back)
{
    const uint32_t at = map->chart_triangle[map->triangle_0[instance] + triangle];
    if (at == CHART_NONE) return CHART_NONE;
    const struct chart_triangle *t = &map->charts.triangles[at];
    const struct chart *chart = &map->charts.charts[t->chart];
    const float w = 1.0f - u - v;
    const float x = w * t->place[0].x + u * t->place[1].x + v * t->place[2].x;
    const float y = w * t->place[0].y + u * t->place[1].y + v * t->place[2].y;
    const uint32_t column = clamp_to(x, chart->x, chart->width);
    const uint32_t row = clamp_to(y, chart->y, chart->height);
    const uint32_t texel = map->charts.owner[(size_t)row * map->charts.width + column];
    if (texel == CHART_NONE || !back) return texel;
    const uint32_t first = map->back_of[t->chart];
    return first == CHART_NONE ? CHART_NONE : first + (texel - chart->first_texel);
}

uint32_t radiosity_texel_of_place(const struct radiosity_map *map, size_t place)
{
    const struct charts *charts = &map->charts;
    const size_t side = (size_t)charts->width * charts->height;
    const uint32_t texel = charts->owner[place % side];
    if (texel == CHART_NONE || place < side) return texel;
    const uint32_t chart = charts->triangles[charts->texels[texel].triangle].chart;
    if (map->back_of[chart] == CHART_NONE) return CHART_NONE;
    return map->back_of[chart] + (texel - charts->charts[chart].first_texel);
}

// ---- hidden texels

struct filling {
    const struct radiosity_map *map;
    uint32_t *shown, *next; // CHART_NONE: not known yet
};

// A neighbour's value of the last sweep: the first of those along the edges, then of the corners.
static uint32_t neighbor_value(const struct filling *f, uint32_t texel)
{
    static const int step[8][2] = { { 0, -1 },  { -1, 0 }, { 1, 0 },  { 0, 1 },
                                    { -1, -1 }, { 1, -1 }, { -1, 1 }, { 1, 1 } };
    const struct charts *charts = &f->map->charts;
    const struct chart_texel *t = radiosity_chart_texel(f->map, texel);
    const uint32_t c = charts->triangles[t->triangle].chart;
    const struct chart *chart = &charts->charts[c];
    for (int k = 0; k < 8; k++) {
        // Gutters are at least as wide as the step.
        const size_t at = (size_t)((int64_t)t->y + step[k][1]) * charts->width +
                          (size_t)((int64_t)t->x + step[k][0]);
        uint32_t neighbor = charts->owner[at];
        if (neighbor == CHART_NONE) continue;
        if (f->map->texels[texel].back)
            neighbor = f->map->back_of[c] + (neighbor - chart->first_texel);
        if (f->shown[neighbor] != CHART_NONE) return f->shown[neighbor];
    }
    return CHART_NONE;
}

static bool sweep(const struct filling *f)
{
    bool changed = false;
    for (uint32_t i = 0; i < f->map->texel_count; i++) {
        f->next[i] = f->shown[i] != CHART_NONE ? f->shown[i] : neighbor_value(f, i);
        changed |= f->next[i] != f->shown[i];
    }
    return changed;
}

uint32_t *radiosity_fill(const struct radiosity_map *map, const bool *hidden)
{
    const size_t count = map->texel_count;
    struct filling f = { .map = map,
                         .shown = host_alloc(map->host, count, sizeof *f.shown),
                         .next = host_alloc(map->host, count, sizeof *f.next) };
    const bool ok = f.shown && f.next;
    if (ok) {
        for (uint32_t i = 0; i < count; i++) f.shown[i] = hidden[i] ? CHART_NONE : i;
        while (sweep(&f)) memcpy(f.shown, f.next, count * sizeof *f.shown);
        for (uint32_t i = 0; i < count; i++)
            if (f.shown[i] == CHART_NONE) f.shown[i] = i;
    }
    host_free(map->host, f.next);
    if (ok) return f.shown;
    host_free(map->host, f.shown);
    return NULL;
}
