// What the tests of the geometry volume share.
#pragma once

#include "techniques/geometry_twin.h"
#include "techniques/lpv_fixture.h"

enum { GEOMETRY_SIZE = 24, GEOMETRY_WIDTH = 20, GEOMETRY_HEIGHT = 12 }; // of maps and pictures

// A sun's map and a point light's, of two lights, texels scattered over a box and somewhat beyond.
void geometry_scatter(struct stage *stage, struct gpu *gpu);
// The volume's texels in use, four numbers each, [z][y][x]; to be freed. And how many numbers these
// are.
float *geometry_read(struct lpv *lpv);
size_t geometry_floats(const struct lpv *lpv);
// The volume is the twin's.
void geometry_check(struct lpv *lpv, const struct geometry_twin *twin, double tolerance);
// The light after all steps is what the twin lets through.
void geometry_check_light(struct lpv *lpv, struct stage *stage, const struct geometry_twin *twin);
