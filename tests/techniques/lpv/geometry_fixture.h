// Fixture of the tests of the geometry volume.
#pragma once

#include "techniques/lpv/geometry_twin.h"
#include "techniques/lpv/lpv_fixture.h"

enum { GEOMETRY_SIZE = 24, GEOMETRY_WIDTH = 20, GEOMETRY_HEIGHT = 12 }; // of maps and images

// Reflective shadow maps of a sun and a point light, texels scattered over and around a box.
void geometry_scatter(struct rsm_fixture *rsm, struct gpu *gpu);
// The volume's texels in use, four floats each, [z][y][x]; the caller frees them. And their number
// of floats.
float *geometry_read(struct lpv *lpv);
size_t geometry_floats(const struct lpv *lpv);
// Checks that the volume equals the twin.
void geometry_check(struct lpv *lpv, const struct geometry_twin *twin, double tolerance);
// Checks that the light after all steps equals that of a twin with this geometry.
void geometry_check_light(struct lpv *lpv, const struct geometry_twin *twin);
