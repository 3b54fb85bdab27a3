// The size of a technique's light map, as the option `texels` gives it.
#pragma once

#include <afterglow/afterglow.h>

struct map_size {
    int side;          // wished for: side² texels, gutters and empty ones included
    int texels_option; // that comes nearest
    int width, height; // reached, of all sides
    int texels;        // on surfaces
};
// options: more options of ort, or NULL.
enum ag_result map_size_find(struct ag_scene *scene, const char *options, int side,
                             struct map_size *out);
