// Sponza with a dynamic object, for paper-dnrt.
#ifndef AG_BENCH_PAPER_DNRT_SCENES_H
#define AG_BENCH_PAPER_DNRT_SCENES_H

#include "bench.h"

// path: Crytek's Sponza, 29.8 m long, +y up.
enum ag_result dnrt_open_sponza(const struct bench *bench, const char *path,
                                struct ag_scene **scene, struct ag_frame_desc *frame);

#endif
