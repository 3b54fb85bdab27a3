// Whether texture coordinates of a mesh are an unwrap that light maps can use: each point of the
// texture belongs to one point of the surface.
#pragma once

#include "core/host.h"
#include "scene/scene.h"

enum unwrap_fault {
    UNWRAP_VALID,
    UNWRAP_ABSENT,
    UNWRAP_NOT_FINITE,
    UNWRAP_OUTSIDE,   // of 0…1
    UNWRAP_COLLAPSED, // a triangle with an area has none in the texture
    UNWRAP_OVERLAPS,  // two triangles cover the centres of texels of the check's raster
};

// set: of TEXCOORD_n. tolerance: share of the covered texels that may be covered twice, and of the
// surface that may be collapsed. False without memory. Triangles without an area are ignored.
bool unwrap_check(struct host *host, const struct mesh *mesh, int set, double tolerance,
                  enum unwrap_fault *fault);
// Whether a triangle has no area in the texture.
bool unwrap_is_collapsed(const vec2s uv[3]);
const char *unwrap_fault_text(enum unwrap_fault fault); // "overlaps itself", …
