// Matrices of cameras, in the conventions of engines.
#pragma once

#include <afterglow/afterglow.h>

enum depth_kind { REVERSED_INFINITE, REVERSED_FINITE, FORWARD_FINITE, FORWARD_INFINITE };
struct matrix_options {
    enum depth_kind depth;
    bool y_up;        // clip space
    bool left_handed; // view space looks along +z, x right, y up
    bool opencv;      // view space looks along +z, x right, y down
    float far_m;
    // Sides of a perspective image, relative to tan(fov/2); default −1, 1, −1, 1.
    float left, right, bottom, top;
    float orthographic_half_m; // half the height; 0: perspective
};
struct matrix_options matrix_options_default(void);
// width, height: of an image with sides −1…1 in both axes.
struct ag_view_matrices matrices_of(const struct ag_camera *camera, float width, float height,
                                    const struct matrix_options *options);
// Stored depth of a surface at this distance along the axis.
float depth_at(const struct ag_camera *camera, const struct matrix_options *options,
               float distance_m);
