#include "paint.h"

#include "viewer/methods/bakes.h"
#include "viewer/operations.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float STEP_PIXELS = 6.0f, BEHIND = 0.5f, BEHIND_TEXELS = 1.5f;
enum { MOST_STEPS = 64 };

void paint_init(struct viewer *v)
{
    v->paint = (struct paint){ .radius = 0.25f, .lux = 1000.0f, .color = { 1, 1, 1 } };
}

static void forget_surfaces(struct viewer *v)
{
    ag_image_destroy(v->desc->context, v->paint.place);
    ag_image_destroy(v->desc->context, v->paint.normal);
    v->paint.place = v->paint.normal = NULL;
}

static void forget_texels(struct viewer *v)
{
    for (int side = 0; side < 2; side++) {
        ag_image_destroy(v->desc->context, v->paint.place_of[side]);
        v->paint.place_of[side] = NULL;
    }
    v->paint.gi[0] = 0;
}

static void forget_paint(struct paint *p)
{
    for (int side = 0; side < 2; side++) {
        free(p->lux_of[side]);
        p->lux_of[side] = NULL;
    }
}

void paint_close(struct viewer *v)
{
    forget_surfaces(v);
    forget_texels(v);
    forget_paint(&v->paint);
}

bool paint_possible(struct viewer *v)
{
    const char *name = NULL;
    return ag_lightmap_technique(v->desc->context, v->gi, &name) == AG_OK && name;
}

bool paint_has(const struct viewer *v)
{
    return v->paint.lux_of[0] || v->paint.lux_of[1];
}

// ---- texels

static bool upload(struct viewer *v, int side, const int from[2], const int to[2])
{
    const struct paint *p = &v->paint;
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
               p->lux_of[side] + 3 * ((size_t)y * (size_t)p->width + (size_t)from[0]),
               row * sizeof *lux);
    rectangle.lux = lux;
    const bool done = lux && viewer_check(v, ag_renderer_paint_light(v->main.renderer, &rectangle));
    free(lux);
    if (done) viewer_touch(v);
    return done;
}

static void upload_all(struct viewer *v)
{
    const struct paint *p = &v->paint;
    const int from[2] = { 0, 0 }, to[2] = { p->width, p->height };
    for (int side = 0; side < p->sides; side++)
        if (p->lux_of[side]) upload(v, side, from, to);
}

static bool read_texels(struct viewer *v, const struct ag_lightmap *map,
                        struct ag_lightmap_info *info)
{
    struct paint *p = &v->paint;
    if (!viewer_check(v, ag_lightmap_get_info(map, info))) return false;
    for (int side = 0; side < (info->has_back ? 2 : 1); side++)
        if (!viewer_check(v, ag_lightmap_positions(map, side == 1, &p->place_of[side])))
            return false;
    return true;
}

// Paint stays where the light map has the same size; else its texels are others.
static void keep_paint(struct viewer *v, const struct ag_lightmap_info *info)
{
    struct paint *p = &v->paint;
    const bool same = p->width == info->width && p->height == info->height &&
                      p->sides == (info->has_back ? 2 : 1);
    p->width = info->width;
    p->height = info->height;
    p->sides = info->has_back ? 2 : 1;
    p->texel_m = info->texels_per_m > 0 ? 1.0f / info->texels_per_m : 0.0f;
    if (same) {
        upload_all(v);
        return;
    }
    if (paint_has(v)) viewer_say(v, "the painted light is gone: the light map has other texels");
    forget_paint(p);
}

static bool find_texels(struct viewer *v)
{
    struct ag_lightmap_desc desc;
    struct ag_lightmap_info info;
    struct ag_lightmap *map = NULL;
    struct paint *p = &v->paint;
    if (p->gi[0] && strcmp(p->gi, v->gi) == 0) return true;
    ag_lightmap_desc_default(&desc);
    desc.no_light = true;
    forget_texels(v);
    bool done = viewer_check(v, ag_lightmap_from_renderer(v->main.renderer, &desc, &map)) &&
                read_texels(v, map, &info);
    ag_lightmap_destroy(map);
    if (!done) return false;
    snprintf(p->gi, sizeof p->gi, "%s", v->gi);
    keep_paint(v, &info);
    return true;
}

void paint_switch(struct viewer *v, bool on)
{
    struct ag_light_paint none;
    ag_light_paint_default(&none);
    none.width = none.height = 1;
    v->paint.on =
        on && find_texels(v) && viewer_check(v, ag_renderer_paint_light(v->main.renderer, &none));
    if (v->paint.on && paint_has(v)) upload_all(v); // over the texel that was tried
}

void paint_clear(struct viewer *v)
{
    struct paint *p = &v->paint;
    for (int side = 0; side < p->sides; side++)
        if (p->lux_of[side])
            memset(p->lux_of[side], 0,
                   3 * (size_t)p->width * (size_t)p->height * sizeof *p->lux_of[side]);
    upload_all(v);
    forget_paint(p);
}

void paint_step(struct viewer *v)
{
    struct paint *p = &v->paint;
    if (v->dirty > 0 || bakes_running(v) || strcmp(p->gi, v->gi) == 0) return;
    if (!p->on && !paint_has(v)) return;
    if (paint_possible(v) && find_texels(v)) return;
    p->on = p->stroke = false;
    if (paint_has(v)) viewer_say(v, "the painted light is gone: %.200s has no light map", v->gi);
    forget_paint(p);
    forget_texels(v);
}

// ---- the surface under the mouse

static bool surfaces_hold(const struct viewer *v)
{
    const struct paint *p = &v->paint;
    return p->place && p->normal && p->place->width == v->main.width &&
           p->place->height == v->main.height &&
           memcmp(&p->camera, &v->camera, sizeof p->camera) == 0;
}

static bool read_surfaces(struct viewer *v)
{
    struct paint *p = &v->paint;
    if (!v->main.shown.vk_image) return false;
    forget_surfaces(v);
    p->camera = v->camera;
    p->version = v->version;
    return viewer_check(v, ag_renderer_read(v->main.renderer, "position", &p->place)) &&
           viewer_check(v, ag_renderer_read(v->main.renderer, "normal", &p->normal));
}

bool paint_surface(struct viewer *v, float x, float y, float position[3], float normal[3])
{
    const struct paint *p = &v->paint;
    const int px = (int)(v->scale * x), py = (int)(v->scale * y);
    if (!p->stroke && v->dirty == 0 && p->version != v->version) read_surfaces(v);
    if (!surfaces_hold(v) || px < 0 || py < 0 || px >= p->place->width || py >= p->place->height)
        return false;
    const size_t at = 3 * ((size_t)py * (size_t)p->place->width + (size_t)px);
    memcpy(position, p->place->pixels + at, 3 * sizeof *position);
    memcpy(normal, p->normal->pixels + at, 3 * sizeof *normal);
    return normal[0] != 0 || normal[1] != 0 || normal[2] != 0; // 0: no surface
}

// ---- strokes

// 1 in the middle of the brush, 0 at its radius. What is behind the surface, as the other side of a
// wall, gets nothing, but a surface may be curved.
static float weight_of(const struct paint *p, const float texel[3], const float position[3],
                       const float normal[3])
{
    float square = 0, height = 0;
    for (int i = 0; i < 3; i++) {
        const float d = texel[i] - position[i];
        square += d * d;
        height += d * normal[i];
    }
    const float far = square / (p->radius * p->radius);
    const float along = sqrtf(fmaxf(square - height * height, 0.0f));
    if (!(far < 1.0f) || -height > BEHIND * along + BEHIND_TEXELS * p->texel_m) return 0;
    return (1.0f - far) * (1.0f - far);
}

static void mix_texel(const struct paint *p, float *lux, float weight)
{
    for (int c = 0; c < 3; c++) lux[c] += weight * (p->lux * p->color[c] - lux[c]);
}

static void dab_side(struct viewer *v, int side, const float position[3], const float normal[3])
{
    struct paint *p = &v->paint;
    int from[2] = { p->width, p->height }, to[2] = { 0, 0 };
    const float *places = p->place_of[side]->pixels;
    if (!p->lux_of[side])
        p->lux_of[side] = calloc((size_t)p->width * (size_t)p->height, 3 * sizeof(float));
    for (int y = 0; p->lux_of[side] && y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            const size_t at = 3 * ((size_t)y * (size_t)p->width + (size_t)x);
            const float weight = weight_of(p, places + at, position, normal);
            if (!(weight > 0)) continue;
            mix_texel(p, p->lux_of[side] + at, weight);
            from[0] = x < from[0] ? x : from[0];
            from[1] = y < from[1] ? y : from[1];
            to[0] = x >= to[0] ? x + 1 : to[0];
            to[1] = y + 1;
        }
    if (to[1] == 0 || upload(v, side, from, to)) return;
    p->on = p->stroke = false; // another method runs by now, which takes no paint
    forget_paint(p);
}

static void dab(struct viewer *v, float x, float y)
{
    float position[3], normal[3];
    if (!paint_surface(v, x, y, position, normal)) return;
    for (int side = 0; side < v->paint.sides && v->paint.stroke; side++)
        dab_side(v, side, position, normal);
}

bool paint_press(struct viewer *v)
{
    struct paint *p = &v->paint;
    if (!p->on || !p->armed) return false;
    if (!find_texels(v)) return p->on = false;
    if (p->version != v->version || !surfaces_hold(v)) read_surfaces(v);
    p->stroke = true;
    p->last[0] = v->mouse_x;
    p->last[1] = v->mouse_y;
    dab(v, v->mouse_x, v->mouse_y);
    return true;
}

void paint_move(struct viewer *v)
{
    struct paint *p = &v->paint;
    if (!p->stroke) return;
    const float dx = v->mouse_x - p->last[0], dy = v->mouse_y - p->last[1];
    int steps = (int)(sqrtf(dx * dx + dy * dy) / (STEP_PIXELS * window_scale(v->window)));
    if (steps > MOST_STEPS) steps = MOST_STEPS;
    for (int i = 1; i <= steps; i++)
        dab(v, p->last[0] + dx * (float)i / (float)steps,
            p->last[1] + dy * (float)i / (float)steps);
    if (steps == 0) return;
    p->last[0] = v->mouse_x;
    p->last[1] = v->mouse_y;
}

void paint_release(struct viewer *v)
{
    v->paint.stroke = false;
}
