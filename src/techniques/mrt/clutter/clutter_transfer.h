// Transfer of light to the texels of a block's clutter (Loos 2015, section 5.3.3: C_b), for the
// light map of clutter.
//
// A texel has four values: the linear SH of irradiance by normal, in the world's frame, that fit
// the hemisphere around the surface's normal as OHLSH do (appendix B), and at that normal are the
// irradiance. Light that enters by an opening is that of the probes around the texel, scaled by the
// share of its rays to the opening that no clutter blocks.
#pragma once

#include "techniques/mrt/clutter/delta.h"

struct mrt_clutter_transfer {
    struct host *host;
    int block;
    uint32_t first_texel; // in clutter->texels
    size_t texel_count;
    struct matrix_f32 b;     // texels · 4 × k_b
    struct matrix_f32 c;     // texels · 4 × faces of the block
    float *kept[CUBE_FACES]; // of each texel, by opening
    bool *inside;            // of each texel: it is inside another object
};

// A block without faces has no texels. mrt_clutter_transfer_finish accepts zero.
bool mrt_clutter_transfer_init(struct mrt_clutter_transfer *out, struct host *host,
                               const struct mrt_clutter_rays *rays, int block);
void mrt_clutter_transfer_finish(struct mrt_clutter_transfer *transfer);

// Light of an opening at the texels, texels · 4 × k_r, from that of its probes: p³ · 9 × k_r in
// the frame of the cell.
bool mrt_clutter_transfer_response(const struct mrt_clutter_transfer *transfer, struct host *host,
                                   const struct mrt_clutter_rays *rays, int face,
                                   const struct matrix_f32 *probes, struct matrix_f32 *out);
