// Closes seams: bilinear lookups on both sides of an edge that two charts share are about equal.
#pragma once

#include "lightmap/lightmap.h"
#include "trace/texels/close.h"

// Changes texels and gutters beside seams. Edges that a wall divides stay. False without memory.
bool lightmap_close(struct lightmap *map, const struct seam_closing *closing);
