// From rows of light to images.
#include "lightmap/lightmap.h"

#include "core/parallel.h"
#include "lightmap/gather.h"
#include "scene/statics.h"

#include <math.h>
#include <string.h>

bool lightmap_has_back(const struct scene *scene, const struct chart *chart)
{
    return scene->materials[scene_mesh_of(scene, chart->instance)->material].double_sided;
}

uint64_t lightmap_rows(const struct charts *charts, const struct scene *scene)
{
    for (uint32_t c = 0; c < charts->count; c++)
        if (lightmap_has_back(scene, &charts->charts[c])) return 2 * (uint64_t)charts->texel_count;
    return charts->texel_count;
}

bool lightmap_init(struct lightmap *out, struct charts *charts, const struct scene *scene)
{
    struct host *host = charts->host;
    *out = (struct lightmap){ .host = host, .charts = *charts };
    *charts = (struct charts){ 0 };
    const int width = (int)out->charts.width, height = (int)out->charts.height;
    bool ok =
        width > 0 || host_fail(host, FAIL_ARGUMENT,
                               "light map of %s: the scene has no static triangles", scene->name);
    out->has_back = lightmap_rows(&out->charts, scene) > out->charts.texel_count;
    for (int side = 0; ok && side < (out->has_back ? 2 : 1); side++)
        ok = image_init(&out->irradiance[side], host, width, height, 3);
    if (!ok) lightmap_finish(out);
    return ok;
}

void lightmap_finish(struct lightmap *map)
{
    if (!map->host) return;
    for (int side = 0; side < LIGHTMAP_SIDES; side++)
        image_finish(&map->irradiance[side], map->host);
    charts_finish(&map->charts);
    *map = (struct lightmap){ 0 };
}

static float *texel_at(const struct lightmap *map, int side, uint32_t texel)
{
    const struct chart_texel *t = &map->charts.texels[texel];
    return image_at(&map->irradiance[side], (int)t->x, (int)t->y);
}

// ---- hidden texels and gutters

struct filling {
    const struct lightmap *map;
    uint32_t *shown, *next; // [texels] CHART_NONE: not known yet
};

// The texel that a neighbour showed after the last sweep: the first of those along the edges, then
// of the corners.
static uint32_t neighbor_of(const struct filling *f, uint32_t texel)
{
    static const int step[8][2] = { { 0, -1 },  { -1, 0 }, { 1, 0 },  { 0, 1 },
                                    { -1, -1 }, { 1, -1 }, { -1, 1 }, { 1, 1 } };
    const struct charts *charts = &f->map->charts;
    const struct chart_texel *t = &charts->texels[texel];
    for (int k = 0; k < 8; k++) {
        // Gutters are at least as wide as the step.
        const size_t at = (size_t)((int64_t)t->y + step[k][1]) * charts->width +
                          (size_t)((int64_t)t->x + step[k][0]);
        const uint32_t neighbor = charts->owner[at];
        if (neighbor != CHART_NONE && f->shown[neighbor] != CHART_NONE) return f->shown[neighbor];
    }
    return CHART_NONE;
}

static bool sweep(const struct filling *f)
{
    bool changed = false;
    for (uint32_t i = 0; i < f->map->charts.texel_count; i++) {
        f->next[i] = f->shown[i] != CHART_NONE ? f->shown[i] : neighbor_of(f, i);
        changed |= f->next[i] != f->shown[i];
    }
    return changed;
}

static void show_owners(const struct lightmap *map, int side, const uint32_t *shown)
{
    const struct charts *charts = &map->charts;
    for (uint32_t i = 0; i < charts->texel_count; i++)
        if (shown[i] != CHART_NONE)
            memcpy(texel_at(map, side, i), texel_at(map, side, shown[i]), 3 * sizeof(float));
    for (uint32_t y = 0; y < charts->height; y++)
        for (uint32_t x = 0; x < charts->width; x++) {
            const uint32_t owner = charts->owner[(size_t)y * charts->width + x];
            if (owner == CHART_NONE) continue;
            memcpy(image_at(&map->irradiance[side], (int)x, (int)y), texel_at(map, side, owner),
                   3 * sizeof(float));
        }
}

static bool fill(struct lightmap *map, const bool *hidden)
{
    const uint32_t count = map->charts.texel_count;
    struct filling f = { .map = map,
                         .shown = host_alloc(map->host, count, sizeof *f.shown),
                         .next = host_alloc(map->host, count, sizeof *f.next) };
    const bool ok = f.shown && f.next;
    for (int side = 0; ok && side < (map->has_back ? 2 : 1); side++) {
        for (uint32_t i = 0; i < count; i++)
            f.shown[i] = hidden && hidden[(size_t)side * count + i] ? CHART_NONE : i;
        while (sweep(&f)) memcpy(f.shown, f.next, count * sizeof *f.shown);
        show_owners(map, side, f.shown);
    }
    host_free(map->host, f.shown);
    host_free(map->host, f.next);
    return ok;
}

// ---- light of the path tracer

static void take_rows(struct lightmap *map, const float *punctual, const float *rest, bool *hidden)
{
    const uint32_t count = map->charts.texel_count;
    for (size_t i = 0; i < (map->has_back ? 2 : 1) * (size_t)count; i++) {
        float *out = texel_at(map, i >= count, (uint32_t)(i % count));
        hidden[i] = !(rest[4 * i + 3] > 0.0f);
        for (size_t c = 0; c < 3; c++)
            out[c] = rest[4 * i + c] + (punctual ? punctual[3 * i + c] : 0.0f);
    }
}

bool lightmap_set_paths(struct lightmap *map, const struct tensors *bake, bool punctual)
{
    const uint64_t rows = (map->has_back ? 2 : 1) * (uint64_t)map->charts.texel_count;
    const float *lights = tensors_expect(map->host, bake, LIGHTMAP_PUNCTUAL, TENSOR_F32, 2,
                                         (const uint64_t[]){ rows, 3 });
    const float *rest = tensors_expect(map->host, bake, LIGHTMAP_REST, TENSOR_F32, 2,
                                       (const uint64_t[]){ rows, 4 });
    bool *hidden = lights && rest ? host_alloc(map->host, rows, sizeof *hidden) : NULL;
    if (!hidden) return false;
    take_rows(map, punctual ? lights : NULL, rest, hidden);
    const bool ok = fill(map, hidden);
    host_free(map->host, hidden);
    return ok;
}

// ---- light of a technique

struct layers {
    struct lightmap *map;
    const struct lightmap_layers *from;
    bool punctual;
    struct gather_scene scene;
    bool *hidden;
};

// With irradiance E along the surface's normal and vector irradiance V, (E + n·V) / 2 is that along
// the vertex normal.
static vec3s light_along(const struct layers *l, struct gather_texel at)
{
    const struct chart_texel *t = &l->map->charts.texels[at.texel];
    const struct gather_point point = { t->triangle, t->u, t->v };
    const vec3s normal = gather_surface(&l->scene, &point, at.back).normal;
    const size_t pixel = (size_t)t->y * l->map->charts.width + t->x;
    vec3s out;
    for (int c = 0; c < 3; c++) {
        const float *v = l->from->at[at.back][c] + 4 * pixel;
        const float along = glms_vec3_dot(normal, vec3_of(v[1], v[2], v[3]));
        out.raw[c] = fmaxf(0.5f * (v[0] + along) / l->from->scale, 0.0f);
    }
    return out;
}

static void set_texel(void *user, size_t i)
{
    struct layers *l = user;
    const uint32_t count = l->map->charts.texel_count;
    const struct gather_texel at = { (uint32_t)(i % count), i >= count };
    struct gather_points points;
    const unsigned before = embree_flush_denormals();
    gather_find_points(&l->scene, at, &points);
    // Charts that are inside of something as a whole stay black, as by paths.
    vec3s light = points.count > 0 ? light_along(l, at) : vec3_of(0, 0, 0);
    if (l->punctual) light = glms_vec3_add(light, gather_punctual(&l->scene, &points, at.back));
    memcpy(texel_at(l->map, at.back, at.texel), light.raw, sizeof light.raw);
    l->hidden[i] = points.count == 0;
    embree_restore_denormals(before);
}

bool lightmap_set_layers(struct lightmap *map, const struct scene_pose *pose,
                         const struct lightmap_layers *from, bool punctual)
{
    const size_t rows = (map->has_back ? 2 : 1) * (size_t)map->charts.texel_count;
    struct scene_statics statics;
    struct layers l = { .map = map, .from = from, .punctual = punctual };
    l.hidden = host_alloc(map->host, rows, sizeof *l.hidden);
    bool ok = l.hidden && scene_statics_init(&statics, map->host, pose);
    if (ok) {
        ok = gather_scene_init(&l.scene, map->host, &statics.pose, &map->charts);
        if (ok) parallel_for(rows, 64, set_texel, &l);
        ok = ok && fill(map, l.hidden);
        gather_scene_finish(&l.scene);
        scene_statics_finish(&statics);
    }
    host_free(map->host, l.hidden);
    return ok;
}
