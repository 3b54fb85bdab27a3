// Names of the tensors of a bake; K: a shape's volume (dnrt_shape.volume).
#pragma once

#define DNRT_VOLUME "shape/%d/volume" // F16 or U8 [normal][coefficient][rgb][z][y][x], of the scale
#define DNRT_SCALE  "shape/%d/scale"  // F32 [normal][coefficient][rgb]: of m = t − k
#define DNRT_SPHERE "shape/%d/sphere" // F32 [4]: centre and radius in the object's frame
#define DNRT_BOX    "shape/%d/box"    // F32 [2][3]: centre and half edges of the bounding box
