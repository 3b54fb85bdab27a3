// Painted light: a brush that gives texels of the method's light map irradiance of their own. What
// is painted is kept as dabs, which other texels, session files and undo get again.
#pragma once

#include "paint_texels.h"

#include <afterglow/afterglow.h>

struct viewer;

struct paint {
    bool on;      // the left button paints
    bool armed;   // and the panel is shown
    bool stroke;  // a button is down
    float radius; // m
    float lux, color[3];
    struct dabs dabs;
    struct paint_texels texels;
    struct ag_image *place, *normal; // of the image's pixels
    struct ag_camera camera;         // of these
    unsigned version;
    float last[2]; // the mouse, pixels of the window
};

void paint_init(struct viewer *v);
void paint_close(struct viewer *v);
// The method has a light map, which may take paint; false: it has none.
bool paint_possible(struct viewer *v);
// Lets the left button paint; off, with a message, if the method takes no paint.
void paint_switch(struct viewer *v, bool on);
void paint_clear(struct viewer *v);
// Paints one dab. False, with a message, if the method takes no paint or there are too many.
bool paint_dab(struct viewer *v, const struct dab *dab);
// For undo and sessions: takes over a copy.
void paint_restore(struct viewer *v, const struct dabs *dabs);
// The surface under the mouse; false: none, or it is not known yet.
bool paint_surface(struct viewer *v, float x, float y, float position[3], float normal[3]);
// The left button goes down in the image, the mouse moves, the button goes up. False: no paint.
bool paint_press(struct viewer *v);
void paint_move(struct viewer *v);
void paint_release(struct viewer *v);
// After a frame: paint follows a method that was created again.
void paint_step(struct viewer *v);
bool paint_has(const struct viewer *v); // the image shows painted light
