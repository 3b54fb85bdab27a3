// Light propagation volumes on a stage, with their grids open to the tests.
#pragma once

#include "techniques/lpv/lpv.h"
#include "techniques/lpv/lpv_state.h"
#include "techniques/lpv/lpv_volumes.h"
#include "techniques/lpv_twin.h"
#include "techniques/stage.h"

enum { LPV_FIXTURE_COLOURS = 3 };

// `gi` is "lpv:options" or "holpv:options", on top of one grid, one bounce and steps enough to
// cross it.
struct lpv *lpv_fixture_create(struct gpu *gpu, const char *gi);
void lpv_fixture_destroy(struct lpv *lpv);
// One frame, waited for.
void lpv_fixture_render(struct lpv *lpv, struct stage *stage);
// One colour of a volume as lumen/sr, bands² floats a cell in use, [z][y][x]. To be freed.
float *lpv_fixture_read(struct lpv *lpv, gpu_image volume, int colour);
// What the stage's reflective shadow maps and emissive surfaces inject of one colour.
void lpv_fixture_inject_twin(struct twin *twin, const struct stage *stage, int colour);
