// The brush that paints light on the texels of a light map.
#include "panel.h"

#include "viewer/operations.h"
#include "viewer/inspect/paint.h"

#include <math.h>

enum { RING = 40 };

// Two unit vectors perpendicular to a unit normal and to each other.
static void tangents(const float n[3], float a[3], float b[3])
{
    const int axis = fabsf(n[0]) < 0.6f ? 0 : 1;
    float length = 0;
    for (int i = 0; i < 3; i++) a[i] = (i == axis) - n[axis] * n[i];
    for (int i = 0; i < 3; i++) length += a[i] * a[i];
    for (int i = 0; i < 3; i++) a[i] /= sqrtf(length);
    for (int i = 0; i < 3; i++)
        b[i] = n[(i + 1) % 3] * a[(i + 2) % 3] - n[(i + 2) % 3] * a[(i + 1) % 3];
}

// The brush on the surface under the mouse.
static void draw_ring(struct viewer *v)
{
    const struct region r = viewer_region(v);
    float position[3], normal[3], a[3], b[3], last[2] = { 0, 0 };
    if (v->mouse_x >= r.x1 || !paint_surface(v, v->mouse_x, v->mouse_y, position, normal)) return;
    tangents(normal, a, b);
    for (int k = 0; k <= RING; k++) {
        const float angle = 6.2831853f * (float)k / (float)RING;
        float point[3], at[2];
        for (int i = 0; i < 3; i++)
            point[i] = position[i] + v->paint.radius * (cosf(angle) * a[i] + sinf(angle) * b[i]);
        if (!viewer_project(v, point, &at[0], &at[1])) return;
        if (k > 0)
            ui_stroke(last[0], last[1], at[0], at[1], 0xffffffc0, 1.5f * window_scale(v->window));
        last[0] = at[0];
        last[1] = at[1];
    }
}

void panel_paint(struct viewer *v)
{
    struct paint *p = &v->paint;
    bool on = p->on;
    if (!paint_possible(v) || !ui_section("Painted light", false)) return;
    if (ui_switch("paint with the left button", &on)) paint_switch(v, on);
    ui_tooltip("Gives the texels of the light map under the brush irradiance of their own, which "
               "bounces and scatters. 0 lux removes it.");
    ui_number("brush radius (m)", &p->radius, 0.005f, 20.0f, "%.3f", true);
    ui_number("irradiance (lux)", &p->lux, 0.0f, 2e5f, "%.4g", true);
    ui_tooltip("In the middle of the brush; at its radius the light is as before.");
    ui_color("color##paint", p->color);
    ui_disable(p->dabs.count == 0);
    if (ui_button("Clear paint")) paint_clear(v);
    ui_enable();
    ui_faint("The reference and copied commands are without paint.");
    p->armed = p->on;
    if (p->armed) draw_ring(v);
}
