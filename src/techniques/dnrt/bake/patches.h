// Points on an object's own surface, where self-transfer changes the object's own pixels: of each
// triangle and side those of a barycentric grid whose steps are small beside the object (mesh
// colours, Yuksel, Keyser & House 2010).
#pragma once

#include "techniques/dnrt/dnrt_part.h"
#include "techniques/dnrt/bake/transfer.h"

// Points of a side are those with weights i/n and j/n of the second and third corner, i + j ≤ n,
// row j after row j − 1.
struct dnrt_patch {
    uint32_t first; // point, of the front; those of the back follow
    uint32_t grid;  // n, and DNRT_PATCH_… bits
};

struct dnrt_patches {
    struct host *host;
    struct dnrt_patch *at; // triangles of the part's meshes, one mesh after another
    uint32_t count, points;
};

// The patches of a shape; all its key frames have those of the first one. dnrt_patches_finish
// accepts zero.
bool dnrt_patches_init(struct dnrt_patches *out, struct host *host, const struct dnrt_part *part);
void dnrt_patches_finish(struct dnrt_patches *patches);

// The corners of a triangle from the centre of the bounding sphere.
void dnrt_patch_corners(const struct dnrt_part *part, uint32_t patch, vec3s corners[3]);

// The change of irradiance Y_j(n) at a point of the object by the object itself, by colour. w: the
// irradiance that it occludes; direct light of punctual lights has lost that already. how: rays,
// bands, trace.
void dnrt_self_at(const struct dnrt_sampling *how, const struct dnrt_patches *patches,
                  uint32_t point, uint32_t seed, vec4s out[DNRT_MAX_COEFFICIENTS]);
