// The texels of the method's light map with the irradiance that is painted on them
// (ag_renderer_paint_light).
#pragma once

#include "dabs.h"
#include "viewer/methods/method.h"

struct viewer;

struct paint_texels {
    char gi[METHOD_SPEC]; // for which they were looked for; "": not yet
    bool found;           // the method has a light map
    int width, height, sides;
    float texel_m;                // side of a texel
    float *lux_of[2];             // [height][width][3]; NULL: nothing is painted
    struct ag_image *place_of[2]; // positions of texels
};

// Finds those of the running method, and paints all dabs on them. False, with a message, if it has
// none or takes no paint.
bool paint_texels_find(struct viewer *v);
void paint_texels_forget(struct viewer *v);
// Paints one more dab, or all again. False, with a message, if the method takes no paint.
bool paint_texels_add(struct viewer *v, const struct dab *dab);
bool paint_texels_again(struct viewer *v);
