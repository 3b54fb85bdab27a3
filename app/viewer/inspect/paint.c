#include "paint.h"

#include "viewer/methods/bakes.h"
#include "viewer/operations.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const float STEP_PIXELS = 6.0f;
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

void paint_close(struct viewer *v)
{
    forget_surfaces(v);
    paint_texels_forget(v);
    dabs_close(&v->paint.dabs);
}

bool paint_possible(struct viewer *v)
{
    const char *name = NULL;
    return ag_lightmap_technique(v->desc->context, v->gi, &name) == AG_OK && name;
}

bool paint_has(const struct viewer *v)
{
    return v->paint.texels.lux_of[0] || v->paint.texels.lux_of[1];
}

void paint_switch(struct viewer *v, bool on)
{
    struct ag_light_paint none;
    ag_light_paint_default(&none);
    none.width = none.height = 1;
    v->paint.on = on && paint_texels_find(v) &&
                  viewer_check(v, ag_renderer_paint_light(v->main.renderer, &none));
    if (v->paint.on && paint_has(v)) paint_texels_again(v); // over the texel that was tried
}

// The texels of a method that has run for no frame are not known: paint_step paints on them.
static void paint_again(struct viewer *v)
{
    if (strcmp(v->paint.texels.gi, v->gi) == 0 && v->paint.texels.found)
        paint_texels_again(v);
    else
        v->paint.texels.gi[0] = 0;
}

void paint_clear(struct viewer *v)
{
    if (v->paint.dabs.count == 0) return;
    dabs_close(&v->paint.dabs);
    paint_again(v);
    viewer_note(v, "paint", -1);
}

void paint_restore(struct viewer *v, const struct dabs *dabs)
{
    struct dabs copy;
    if (dabs_same(&v->paint.dabs, dabs)) return;
    if (!dabs_copy(&copy, dabs)) {
        viewer_warn(v, "cannot restore the painted light: out of memory");
        return;
    }
    dabs_close(&v->paint.dabs);
    v->paint.dabs = copy;
    paint_again(v);
}

void paint_step(struct viewer *v)
{
    struct paint *p = &v->paint;
    if (v->dirty > 0 || bakes_running(v) || strcmp(p->texels.gi, v->gi) == 0) return;
    if (!p->on && p->dabs.count == 0) return;
    if (paint_possible(v) && paint_texels_find(v)) return;
    p->on = p->stroke = false;
    paint_texels_forget(v);
    snprintf(p->texels.gi, sizeof p->texels.gi, "%s", v->gi);
    if (p->dabs.count > 0)
        viewer_say(v, "the painted light is not shown: %.200s takes none", v->gi);
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

bool paint_dab(struct viewer *v, const struct dab *dab)
{
    struct paint *p = &v->paint;
    if (!paint_possible(v) || !paint_texels_find(v)) {
        viewer_warn(v, "%.200s has no light map that takes paint", v->gi);
        return false;
    }
    if (p->dabs.count == DABS_MOST) {
        viewer_warn(v, "there are %d dabs of the brush already: clear the paint", DABS_MOST);
        return false;
    }
    if (!paint_texels_add(v, dab)) return false;
    if (!dabs_add(&p->dabs, dab)) viewer_warn(v, "this dab cannot be kept: out of memory");
    viewer_note(v, "paint", -1);
    return true;
}

static void dab_at(struct viewer *v, float x, float y)
{
    struct paint *p = &v->paint;
    struct dab dab = { .radius = p->radius };
    if (!p->stroke || !paint_surface(v, x, y, dab.position, dab.normal)) return;
    for (int c = 0; c < 3; c++) dab.lux[c] = p->lux * p->color[c];
    p->stroke = paint_dab(v, &dab);
    if (!p->stroke) p->on = false;
}

bool paint_press(struct viewer *v)
{
    struct paint *p = &v->paint;
    if (!p->on || !p->armed) return false;
    if (!paint_texels_find(v)) return p->on = false;
    if (p->version != v->version || !surfaces_hold(v)) read_surfaces(v);
    p->stroke = true;
    p->last[0] = v->mouse_x;
    p->last[1] = v->mouse_y;
    dab_at(v, v->mouse_x, v->mouse_y);
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
        dab_at(v, p->last[0] + dx * (float)i / (float)steps,
               p->last[1] + dy * (float)i / (float)steps);
    if (steps == 0) return;
    p->last[0] = v->mouse_x;
    p->last[1] = v->mouse_y;
}

void paint_release(struct viewer *v)
{
    v->paint.stroke = false;
}
