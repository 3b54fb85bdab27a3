// The layers at the pixel under the mouse, or at the one that was clicked.
#include "panel.h"

#include "viewer/operations.h"
#include "viewer/inspect/pixel.h"
#include "shell/srgb.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const float INV_PI = 0.31830989f;

// ---- swatches

static uint32_t rgba(const float rgb[3])
{
    return (uint32_t)srgb_byte(rgb[0]) << 24 | (uint32_t)srgb_byte(rgb[1]) << 16 |
           (uint32_t)srgb_byte(rgb[2]) << 8 | 255u;
}

// Radiance as the image shows it.
static uint32_t exposed(struct viewer *v, const float radiance[3])
{
    float pixels[3] = { radiance[0], radiance[1], radiance[2] };
    const struct ag_image one = { .width = 1, .height = 1, .channels = 3, .pixels = pixels };
    struct ag_image *display = NULL;
    uint32_t color = 0;
    if (ag_image_tonemap_curve(v->desc->context, &one, viewer_exposure(v), v->tonemap, &display) ==
        AG_OK)
        color = rgba(display->pixels);
    ag_image_destroy(v->desc->context, display);
    return color;
}

static uint32_t swatch(struct viewer *v, int layer, const float values[3])
{
    float shown[3];
    memcpy(shown, values, sizeof shown);
    if (layer == PIXEL_ALBEDO) return rgba(shown);
    if (layer == PIXEL_NORMAL) { // unchanged, as the layer of an image
        uint32_t color = 255;
        for (int c = 0; c < 3; c++)
            color |= (uint32_t)(127.5f * (1.0f + fminf(fmaxf(values[c], -1.0f), 1.0f)))
                     << (24 - 8 * c);
        return color;
    }
    for (int c = 0; c < 3 && layer == PIXEL_IRRADIANCE; c++) shown[c] *= INV_PI;
    return exposed(v, shown);
}

// ---- rows: a label, a swatch, values, a unit

struct row {
    const char *label, *unit, *tooltip;
    int layer; // of the swatch; -1: none
    const char *format;
};
static const struct row layer_rows[] = {
    { "color", "cd/m²", "Radiance towards the camera: direct and indirect light.", PIXEL_COLOR,
      "%8.4g" },
    { "direct", "cd/m²",
      "Emission and sky that the camera sees, and light reflected once from punctual lights.",
      PIXEL_DIRECT, "%8.4g" },
    { "indirect", "cd/m²", "Radiance that the method adds.", PIXEL_INDIRECT, "%8.4g" },
    { "specular", "cd/m²", "The part of it that the method reflects specularly.", PIXEL_SPECULAR,
      "%8.4g" },
    { "irradiance", "lux",
      "Indirect irradiance at the surface, without albedo and 1/pi. The swatch is a white surface "
      "that reflects it.",
      PIXEL_IRRADIANCE, "%8.4g" },
    { "albedo", "", "Base colour, linear, 0 to 1.", PIXEL_ALBEDO, "%8.4f" },
    { "normal", "", "Unit shading normal in world space.", PIXEL_NORMAL, "%8.4f" },
    { "position", "m", "In world space.", PIXEL_POSITION, "%8.3f" },
};
enum { ROWS = sizeof layer_rows / sizeof *layer_rows };

// values NULL: none.
static void show_row(struct viewer *v, const struct row *row, const float *values, int count)
{
    const float unit = window_scale(v->window), height = 15.0f * unit;
    const struct ui_area area = ui_area(height);
    float x = area.x + 82.0f * unit;
    char text[32];
    ui_tooltip(row->tooltip);
    ui_area_text(area.x, area.y, 0xb0b0b0ff, row->label);
    if (!values) return;
    if (row->layer >= 0)
        ui_area_box(x, area.y + unit, x + 14.0f * unit, area.y + height - unit,
                    swatch(v, row->layer, values));
    x += 22.0f * unit;
    for (int i = 0; i < count; i++) {
        snprintf(text, sizeof text, row->format, (double)values[i]);
        ui_area_text(x, area.y, 0xffffffff, text);
        x += 64.0f * unit;
    }
    ui_area_text(x + 8.0f * unit, area.y, 0xb0b0b0ff, row->unit);
}

static void show_layer(struct viewer *v, const struct pixel *pixel, int index)
{
    struct row row = layer_rows[index];
    const int layer = row.layer;
    const bool shown = pixel && (pixel->instance >= 0 || layer <= PIXEL_DIRECT);
    if (layer == PIXEL_POSITION) row.layer = -1;
    show_row(v, &row, shown ? pixel->layers[layer] : NULL, 3);
}

static void show_name(const char *what, int index, const char *name)
{
    if (index >= 0)
        ui_faint("%s %d  %.30s", what, index, name);
    else
        ui_faint("%s", what);
}

// The rows stay where they are when there are no values, so that what is below does not move. pixel
// NULL: none.
static void show(struct viewer *v, const struct pixel *pixel)
{
    static const struct pixel none = {
        .instance = -1, .mesh = -1, .material = -1, .ev = -INFINITY
    };
    static const struct row depth = { "depth", "m", "Distance along the view axis.", -1, "%8.3f" },
                            luminance = { "luminance", "cd/m²", "Of the color.", -1, "%8.4g" },
                            ev = { "exposure", "EV",
                                   "At ISO 100: shows this luminance as middle grey.", -1,
                                   "%8.2f" };
    const struct pixel *p = pixel ? pixel : &none;
    show_row(v, &luminance, pixel ? &pixel->luminance : NULL, 1);
    show_row(v, &ev, isfinite(p->ev) ? &p->ev : NULL, 1);
    for (int i = 0; i < ROWS; i++) show_layer(v, pixel, i);
    show_row(v, &depth, p->instance >= 0 ? p->layers[PIXEL_DEPTH] : NULL, 1);
    show_name("instance", p->instance, p->instance_name);
    show_name("mesh", p->mesh, p->mesh_name);
    show_name("material", p->material, p->material_name);
}

// A small frame around the clicked pixel.
static void mark(const struct viewer *v, const struct pixel_at *at)
{
    const float unit = window_scale(v->window), r = 4.0f * unit;
    const float x = ((float)at->x + 0.5f) / v->scale, y = ((float)at->y + 0.5f) / v->scale;
    for (int pass = 0; pass < 2; pass++) {
        const uint32_t color = pass ? 0xffffffff : 0x000000a0;
        const float width = pass ? unit : 3.0f * unit;
        ui_stroke(x - r, y - r, x + r, y - r, color, width);
        ui_stroke(x + r, y - r, x + r, y + r, color, width);
        ui_stroke(x + r, y + r, x - r, y + r, color, width);
        ui_stroke(x - r, y + r, x - r, y - r, color, width);
    }
}

void panel_pixel(struct viewer *v)
{
    struct pixel_at at;
    struct pixel pixel;
    if (!ui_section("Pixel", true)) return;
    const bool chosen = pixel_chosen(v, &at);
    if (!chosen)
        ui_text("Point at the image; a click keeps a pixel.");
    else if (!pixels_read(v, at.other))
        ui_text("%d, %d: once the image has settled", at.x, at.y);
    else
        ui_text("%d, %d%s", at.x, at.y,
                at.clicked ? ", clicked"
                : at.other ? ", of the method at the right"
                           : "");
    ui_tooltip("From the left and the top, in pixels of the rendered image.");
    if (chosen && at.clicked) mark(v, &at);
    const bool has = chosen && pixels_read(v, at.other) && pixel_get(v, &at, &pixel);
    show(v, has ? &pixel : NULL);
}
