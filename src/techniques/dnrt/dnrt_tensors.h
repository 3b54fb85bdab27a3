// Names of the tensors of a bake: of the key of a volume (dnrt_volume_keys).
#pragma once

// A plane is m = t − k of red, green or blue; with the option `direct` the fourth one is k.
#define DNRT_VOLUME "shape/%s/volume" // F16, U8 [normal][coefficient][plane][z][y][x], of the scale
#define DNRT_SCALE  "shape/%s/scale"  // F32 [normal][coefficient][plane]
#define DNRT_SPHERE "shape/%s/sphere" // F32 [4]: centre and radius in the object's frame
#define DNRT_BOX    "shape/%s/box"    // F32 [2][3]: centre and half edges of the bounding box
// With the option `self`, of triangles and of the points on them (bake/patches.h):
#define DNRT_CORNERS "shape/%s/corners" // F32 [triangle][3][3]: from the sphere's centre
#define DNRT_PATCHES "shape/%s/patches" // U32 [triangle][2]: first point, grid
#define DNRT_SELF    "shape/%s/self"    // F16 [point][coefficient][4]: change by colour, occluded
