// The layers at one pixel of the image. They are read once for an image, after it has settled.
#pragma once

#include <afterglow/afterglow.h>
#include <jansson.h>

enum pixel_layer {
    PIXEL_COLOR,
    PIXEL_DIRECT,
    PIXEL_INDIRECT,
    PIXEL_SPECULAR,
    PIXEL_IRRADIANCE,
    PIXEL_ALBEDO,
    PIXEL_NORMAL,
    PIXEL_POSITION,
    PIXEL_DEPTH,
    PIXEL_ID,
    PIXEL_LAYERS
};
extern const char *const pixel_layers[PIXEL_LAYERS];

struct viewer;

// Copies of the layers of both renderings; [1]: of the right part of a split screen.
struct pixels {
    unsigned version[2]; // viewer.version of the copies
    struct ag_image *layers[2][PIXEL_LAYERS];
};
void pixels_forget(struct viewer *v);
// Reads the layers of an image that has settled and changed since; false: there are none yet.
bool pixels_read(struct viewer *v, bool other);

struct pixel_at {
    int x, y;     // of the rendering
    bool other;   // of the right part of a split screen
    bool clicked; // the mouse is not in the image: the pixel of the last click
};
// The pixel under the mouse, else the one that was clicked; false: neither.
bool pixel_chosen(const struct viewer *v, struct pixel_at *out);

struct pixel {
    float layers[PIXEL_LAYERS][3]; // depth and id: without the others
    float luminance;               // of the colour, cd/m²
    float ev;                      // that exposes this luminance to middle grey; -INFINITY: black
    int instance, triangle;        // -1: no surface
    int mesh, material;            // -1: none
    const char *instance_name, *mesh_name, *material_name; // ""; until the scene changes
};
// After pixels_read; false: the pixel is outside of the image.
bool pixel_get(struct viewer *v, const struct pixel_at *at, struct pixel *out);
// The same as JSON, owned by the caller.
json_t *pixel_json(const struct pixel_at *at, const struct pixel *pixel);
