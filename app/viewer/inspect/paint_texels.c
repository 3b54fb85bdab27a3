#include "paint_texels.h"

#include "viewer/operations.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void forget_lux(struct paint_texels *t)
{
    for (int side = 0; side < 2; side++) {
        free(t->lux_of[side]);
        t->lux_of[side] = NULL;
    }
}

static void forget_places(struct viewer *v)
{
    struct paint_texels *t = &v->paint.texels;
    for (int side = 0; side < 2; side++) {
        ag_image_destroy(v->desc->context, t->place_of[side]);
        t->place_of[side] = NULL;
    }
}

void paint_texels_forget(struct viewer *v)
{
    forget_places(v);
    forget_lux(&v->paint.texels);
    v->paint.texels.gi[0] = 0;
    v->paint.texels.found = false;
}

// ---- the renderer

static bool upload(struct viewer *v, int side, const int from[2], const int to[2])
{
    const struct paint_texels *t = &v->paint.texels;
    struct ag_light_paint rectangle;
    ag_light_paint_default(&rectangle);
    rectangle.x = from[0];
    rectangle.y = from[1];
    rectangle.width = to[0] - from[0];
    rectangle.height = to[1] - from[1];
    rectangle.back = side == 1;
    const size_t row = 3 * (size_t)rectangle.width;
    float *lux = malloc(row * (size_t)rectangle.height * sizeof *lux);
    for (int y = from[1]; lux && y < to[1]; y++)
        memcpy(lux + row * (size_t)(y - from[1]),
               t->lux_of[side] + 3 * ((size_t)y * (size_t)t->width + (size_t)from[0]),
               row * sizeof *lux);
    rectangle.lux = lux;
    const bool done = lux && viewer_check(v, ag_renderer_paint_light(v->main.renderer, &rectangle));
    free(lux);
    if (done) viewer_touch(v);
    return done;
}

static bool upload_all(struct viewer *v)
{
    struct paint_texels *t = &v->paint.texels;
    const int from[2] = { 0, 0 }, to[2] = { t->width, t->height };
    for (int side = 0; side < t->sides; side++)
        if (t->lux_of[side] && !upload(v, side, from, to)) {
            forget_lux(t);
            return false;
        }
    return true;
}

// ---- dabs

static bool begin_side(struct paint_texels *t, int side)
{
    if (!t->lux_of[side])
        t->lux_of[side] = calloc((size_t)t->width * (size_t)t->height, 3 * sizeof(float));
    return t->lux_of[side];
}

// The rectangle of changed texels; false: there are none.
static bool mix(struct paint_texels *t, int side, const struct dab *dab, int from[2], int to[2])
{
    const float *places = t->place_of[side]->pixels;
    from[0] = t->width;
    from[1] = t->height;
    to[0] = to[1] = 0;
    if (!begin_side(t, side)) return false;
    for (int y = 0; y < t->height; y++)
        for (int x = 0; x < t->width; x++) {
            const size_t at = 3 * ((size_t)y * (size_t)t->width + (size_t)x);
            const float weight = dab_weight(dab, places + at, t->texel_m);
            float *lux = t->lux_of[side] + at;
            if (!(weight > 0)) continue;
            for (int c = 0; c < 3; c++) lux[c] += weight * (dab->lux[c] - lux[c]);
            from[0] = x < from[0] ? x : from[0];
            from[1] = y < from[1] ? y : from[1];
            to[0] = x >= to[0] ? x + 1 : to[0];
            to[1] = y + 1;
        }
    return to[1] > 0;
}

bool paint_texels_add(struct viewer *v, const struct dab *dab)
{
    struct paint_texels *t = &v->paint.texels;
    int from[2], to[2];
    for (int side = 0; side < t->sides; side++) {
        if (!mix(t, side, dab, from, to) || upload(v, side, from, to)) continue;
        forget_lux(t); // another method runs by now, which takes no paint
        return false;
    }
    return true;
}

bool paint_texels_again(struct viewer *v)
{
    struct paint_texels *t = &v->paint.texels;
    const struct dabs *dabs = &v->paint.dabs;
    const size_t bytes = 3 * (size_t)t->width * (size_t)t->height * sizeof(float);
    int from[2], to[2];
    for (int side = 0; side < t->sides; side++) {
        if (t->lux_of[side]) memset(t->lux_of[side], 0, bytes);
        for (int i = 0; i < dabs->count; i++) mix(t, side, &dabs->at[i], from, to);
    }
    const bool done = upload_all(v);
    if (dabs->count == 0) forget_lux(t);
    return done;
}

// ---- the light map

static bool read_places(struct viewer *v, const struct ag_lightmap *map,
                        struct ag_lightmap_info *info)
{
    struct paint_texels *t = &v->paint.texels;
    if (!viewer_check(v, ag_lightmap_get_info(map, info))) return false;
    for (int side = 0; side < (info->has_back ? 2 : 1); side++)
        if (!viewer_check(v, ag_lightmap_positions(map, side == 1, &t->place_of[side])))
            return false;
    return true;
}

static bool read_map(struct viewer *v)
{
    struct ag_lightmap_desc desc;
    struct ag_lightmap_info info;
    struct ag_lightmap *map = NULL;
    struct paint_texels *t = &v->paint.texels;
    ag_lightmap_desc_default(&desc);
    desc.no_light = true;
    const bool done = viewer_check(v, ag_lightmap_from_renderer(v->main.renderer, &desc, &map)) &&
                      read_places(v, map, &info);
    ag_lightmap_destroy(map);
    if (!done) return false;
    t->width = info.width;
    t->height = info.height;
    t->sides = info.has_back ? 2 : 1;
    t->texel_m = info.texels_per_m > 0 ? 1.0f / info.texels_per_m : 0.0f;
    return true;
}

bool paint_texels_find(struct viewer *v)
{
    struct paint_texels *t = &v->paint.texels;
    if (strcmp(t->gi, v->gi) == 0) return t->found;
    paint_texels_forget(v);
    t->found = read_map(v) && (v->paint.dabs.count == 0 || paint_texels_again(v));
    snprintf(t->gi, sizeof t->gi, "%s", v->gi);
    return t->found;
}
