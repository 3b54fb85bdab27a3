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
    UNWRAP_OVERLAPS,  // two triangles cover the centre of a texel of the check's raster
};

// set: of TEXCOORD_n. False without memory. Triangles without an area are ignored.
bool unwrap_check(struct host *host, const struct mesh *mesh, int set, enum unwrap_fault *fault);
const char *unwrap_fault_text(enum unwrap_fault fault); // "overlaps itself", …
