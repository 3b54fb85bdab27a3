// Triangles on a raster of unit texels: centres inside, and the part of a texel that a triangle
// covers.
#pragma once

#include "core/vec.h"

#include <stdbool.h>
#include <stdint.h>

struct raster_triangle {
    double at[3][2]; // corners in texels
};

// Twice the signed area.
double raster_area2(const struct raster_triangle *triangle);

// Calls visit for each texel whose centre is inside. Of two triangles with a common edge, exactly
// one contains a centre on that edge, and the rounding of both is the same. Stops when visit
// returns false, and returns that.
typedef bool (*raster_visit)(void *user, int32_t x, int32_t y);
bool raster_centres(const struct raster_triangle *triangle, raster_visit visit, void *user);

// A triangle clipped to an axis-aligned rectangle.
enum { RASTER_MAX_CORNERS = 8 };
struct raster_polygon {
    int count;
    double at[RASTER_MAX_CORNERS][2];
};
struct raster_polygon raster_polygon_of(const vec2s corner[3]);
// Keeps the part of the polygon with low ≤ coordinate ≤ low + 1.
struct raster_polygon raster_clip(const struct raster_polygon *polygon, int axis, double low);
double raster_polygon_area(const struct raster_polygon *polygon);
// Calls visit for each texel that the polygon meets, with its part there. Stops when visit returns
// false, and returns that.
typedef bool (*raster_part_visit)(void *user, int32_t x, int32_t y,
                                  const struct raster_polygon *part);
bool raster_parts(const struct raster_polygon *polygon, raster_part_visit visit, void *user);
// The centroid of a polygon that has an area.
void raster_polygon_centroid(const struct raster_polygon *polygon, double out[2]);
