// Light propagation volumes without a frame, with access to their volumes.
#pragma once

#include "techniques/lpv/lpv.h"
#include "techniques/lpv/lpv_state.h"
#include "techniques/lpv/lpv_volumes.h"
#include "techniques/lpv/lpv_twin.h"
#include "techniques/lpv/rsm_fixture.h"

enum { LPV_FIXTURE_COLOURS = 3 };

// `gi`: "lpv:options" or "holpv:options", relative to one grid, one bounce and enough steps to
// cross the grid.
struct lpv *lpv_fixture_create(struct gpu *gpu, const char *gi);
void lpv_fixture_destroy(struct lpv *lpv);
// Renders one frame and waits for it.
void lpv_fixture_render(struct lpv *lpv, struct rsm_fixture *rsm);
// One colour of a volume in lumen/sr: bands² floats per cell in use, [z][y][x]. The caller frees
// it.
float *lpv_fixture_read(struct lpv *lpv, gpu_image volume, int colour); // of the finest cascade
float *lpv_fixture_read_cascade(struct lpv *lpv, const struct lpv_cascade *cascade,
                                gpu_image volume, int colour);
// Injects one colour of the reflective shadow maps and emissive surfaces into the twin.
void lpv_fixture_inject_twin(struct twin *twin, const struct rsm_fixture *rsm, int colour);
