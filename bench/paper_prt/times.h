// Times of the passes in frames whose light turns, for a number of texels.
#pragma once

#include "paper_prt/view.h"

enum { PRT_PASSES = 5, PRT_VARIANTS = 4 };
enum prt_pass { PASS_ROWS, PASS_LIGHT, PASS_LIGHT_MAP, PASS_REFLECT, PASS_APPLY };
extern const char *const prt_passes[PRT_PASSES];
// Diffuse before glossy, uncompressed before compressed.
extern const struct prt_variant {
    const char *name;
    bool glossy;
    const char *compression;
} prt_variants[PRT_VARIANTS];

struct prt_times {
    int texels;                               // the option
    double points;                            // texels that it gave
    double pass_ms[PRT_VARIANTS][PRT_PASSES]; // medians; 0: there is no such pass
    uint64_t bytes[PRT_VARIANTS];             // GPU memory of prt
};
// texels is given. options: more options of prt; NULL: few rays.
enum ag_result prt_times_measure(struct prt_view *view, const char *options, struct prt_times *out);
