// From rows of light to images.
#include "lightmap/lightmap.h"

#include "core/parallel.h"
#include "lightmap/filter.h"
#include "lightmap/tracing.h"

#include <math.h>
#include <string.h>

// Black.
static bool init_images(struct lightmap *map)
{
    const int width = (int)map->charts.width, height = (int)map->charts.height;
    bool ok = true;
    for (int side = 0; ok && side < (map->has_back ? 2 : 1); side++)
        ok = image_init(&map->irradiance[side], map->host, width, height, 3);
    return ok;
}

static void finish_images(struct lightmap *map)
{
    for (int side = 0; side < LIGHTMAP_SIDES; side++)
        image_finish(&map->irradiance[side], map->host);
}

bool lightmap_init(struct lightmap *out, struct charts *charts, const struct scene *scene)
{
    struct host *host = charts->host;
    *out = (struct lightmap){ .host = host, .charts = *charts };
    *charts = (struct charts){ 0 };
    bool ok = out->charts.width > 0 ||
              host_fail(host, FAIL_ARGUMENT, "light map of %s: the scene has no static triangles",
                        scene->name);
    out->has_back = out->charts.side_texel_count > out->charts.texel_count;
    if (ok) out->texels = host_alloc(host, out->charts.side_texel_count, sizeof *out->texels);
    ok = out->texels && init_images(out);
    if (!ok) lightmap_finish(out);
    return ok;
}

void lightmap_finish(struct lightmap *map)
{
    if (!map->host) return;
    finish_images(map);
    host_free(map->host, map->texels);
    charts_finish(&map->charts);
    *map = (struct lightmap){ 0 };
}

// texel: of both sides.
static float *texel_at(const struct lightmap *map, uint32_t texel)
{
    const struct chart_texel *t = chart_texel_of(&map->charts, texel);
    return image_at(&map->irradiance[chart_is_back(&map->charts, texel)], (int)t->x, (int)t->y);
}

bool lightmap_positions(const struct lightmap *map, enum lightmap_side side, struct image *out)
{
    const struct image *like = &map->irradiance[side];
    if (!image_init(out, map->host, like->width, like->height, 3)) return false;
    const size_t count = 3 * (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; i < count; i++) out->pixels[i] = NAN;
    for (uint32_t i = 0; i < map->charts.side_texel_count; i++) {
        const struct chart_texel *t = chart_texel_of(&map->charts, i);
        if (chart_is_back(&map->charts, i) != (side == LIGHTMAP_BACK)) continue;
        memcpy(image_at(out, (int)t->x, (int)t->y), t->position.raw, sizeof t->position.raw);
    }
    return true;
}

// ---- hidden texels and gutters

uint32_t *lightmap_sources(const struct lightmap *map)
{
    const uint32_t count = map->charts.side_texel_count;
    bool *hidden = host_alloc(map->host, count, sizeof *hidden);
    for (uint32_t i = 0; hidden && i < count; i++) hidden[i] = !(map->texels[i].open > 0.0f);
    uint32_t *sources = hidden ? charts_fill(&map->charts, hidden) : NULL;
    host_free(map->host, hidden);
    return sources;
}

static void fill_gutters(struct lightmap *map)
{
    const size_t places = (size_t)map->charts.width * map->charts.height;
    for (size_t i = 0; i < (map->has_back ? 2 : 1) * places; i++) {
        const uint32_t owner = chart_texel_of_place(&map->charts, i);
        float *pixel = map->irradiance[i / places].pixels + 3 * (i % places);
        if (owner != CHART_NONE) memmove(pixel, texel_at(map, owner), 3 * sizeof *pixel);
    }
}

static bool fill(struct lightmap *map)
{
    uint32_t *nearest_valid = lightmap_sources(map);
    const bool ok = nearest_valid;
    for (uint32_t i = 0; ok && i < map->charts.side_texel_count; i++)
        if (nearest_valid[i] != i)
            memcpy(texel_at(map, i), texel_at(map, nearest_valid[i]), 3 * sizeof(float));
    if (ok) fill_gutters(map);
    host_free(map->host, nearest_valid);
    return ok;
}

// ---- pages

bool lightmap_set_pages(struct lightmap *map, const struct scene *scene, uint32_t side)
{
    const uint32_t count = map->charts.side_texel_count;
    float *light = host_alloc(map->host, count, 3 * sizeof *light);
    if (!light) return false;
    for (uint32_t i = 0; i < count; i++)
        memcpy(light + 3 * (size_t)i, texel_at(map, i), 3 * sizeof *light);
    finish_images(map);
    const bool ok = charts_set_pages(&map->charts, scene, side) && init_images(map);
    for (uint32_t i = 0; ok && i < count; i++)
        memcpy(texel_at(map, i), light + 3 * (size_t)i, 3 * sizeof *light);
    if (ok) fill_gutters(map);
    host_free(map->host, light);
    return ok;
}

// ---- light of the path tracer

static float luminance_of(const float *rgb)
{
    return luminance(vec3_of(rgb[0], rgb[1], rgb[2]));
}

// light: `rest`, or filtered.
static void add_rows(struct lightmap *map, const float *punctual, const float *light,
                     const float *rest)
{
    for (uint32_t i = 0; i < map->charts.side_texel_count; i++) {
        float *out = texel_at(map, i);
        const size_t at = LIGHTMAP_COLUMNS * (size_t)i;
        for (size_t c = 0; c < 3; c++)
            out[c] = light[at + c] + (punctual ? punctual[3 * (size_t)i + c] : 0.0f);
        map->texels[i] = (struct lightmap_texel){ .open = rest[at + LIGHTMAP_SHARE],
                                                  .light = luminance_of(light + at),
                                                  .variance = rest[at + LIGHTMAP_VARIANCE] };
    }
}

// Owned by the caller; NULL without memory.
static float *filtered(const struct lightmap *map, const float *rest)
{
    const size_t rows = map->charts.side_texel_count;
    float *light = host_alloc(map->host, rows, LIGHTMAP_COLUMNS * sizeof *light);
    if (light && lightmap_filter(&map->charts, rest, light)) return light;
    host_free(map->host, light);
    return NULL;
}

bool lightmap_set_paths(struct lightmap *map, const struct tensors *bake, bool punctual,
                        bool filter)
{
    const uint64_t rows = map->charts.side_texel_count;
    const float *lights = tensors_expect(map->host, bake, LIGHTMAP_PUNCTUAL, TENSOR_F32, 2,
                                         (const uint64_t[]){ rows, 3 });
    const float *rest = tensors_expect(map->host, bake, LIGHTMAP_REST, TENSOR_F32, 2,
                                       (const uint64_t[]){ rows, LIGHTMAP_COLUMNS });
    float *smooth = lights && rest && filter ? filtered(map, rest) : NULL;
    bool ok = lights && rest && (smooth || !filter);
    if (ok) add_rows(map, punctual ? lights : NULL, smooth ? smooth : rest, rest);
    ok = ok && fill(map);
    host_free(map->host, smooth);
    return ok;
}

// ---- light of a technique

struct layers {
    struct lightmap *map;
    const struct lightmap_layers *from;
    bool punctual;
    const struct gather_scene *scene;
};

// With irradiance E along the surface's normal and vector irradiance V, (E + n·V) / 2 is that along
// the vertex normal.
static vec3s light_along(const struct layers *l, uint32_t texel)
{
    const struct chart_texel *t = chart_texel_of(&l->map->charts, texel);
    const struct gather_point point = { t->triangle, t->u, t->v };
    const bool back = chart_is_back(&l->map->charts, texel);
    const vec3s normal = gather_surface(l->scene, &point, back).normal;
    const size_t pixel = (size_t)t->y * l->map->charts.width + t->x;
    vec3s out;
    for (int c = 0; c < 3; c++) {
        const float *v = l->from->at[back][c] + 4 * pixel;
        const float along = glms_vec3_dot(normal, vec3_of(v[1], v[2], v[3]));
        out.raw[c] = fmaxf(0.5f * (v[0] + along) / l->from->scale, 0.0f);
    }
    return out;
}

static void set_texel(void *user, size_t i)
{
    struct layers *l = user;
    const uint32_t texel = (uint32_t)i;
    struct gather_points points;
    const unsigned before = embree_flush_denormals();
    gather_find_points(l->scene, texel, &points);
    // Charts that are completely inside geometry stay black, as by paths.
    vec3s light = points.count > 0 ? light_along(l, texel) : vec3_of(0, 0, 0);
    l->map->texels[i] = (struct lightmap_texel){ .open = (float)points.count / GATHER_POINTS,
                                                 .light = luminance(light),
                                                 .variance = NAN };
    if (l->punctual) light = glms_vec3_add(light, gather_punctual(l->scene, &points));
    memcpy(texel_at(l->map, texel), light.raw, sizeof light.raw);
    embree_restore_denormals(before);
}

bool lightmap_set_layers(struct lightmap *map, const struct lightmap_tracing *tracing,
                         const struct lightmap_layers *from, bool punctual)
{
    struct layers l = { .map = map, .from = from, .punctual = punctual, .scene = &tracing->scene };
    parallel_for(map->charts.side_texel_count, 64, set_texel, &l);
    return fill(map);
}

// ---- rays

bool lightmap_tracing_init(struct lightmap_tracing *out, const struct scene_pose *pose,
                           const struct charts *charts)
{
    *out = (struct lightmap_tracing){ 0 };
    if (!scene_statics_init(&out->statics, charts->host, pose)) return false;
    return gather_scene_init(&out->scene, charts->host, &out->statics.pose, charts);
}

void lightmap_tracing_finish(struct lightmap_tracing *tracing)
{
    gather_scene_finish(&tracing->scene);
    scene_statics_finish(&tracing->statics);
}
