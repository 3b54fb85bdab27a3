// Which pixels trace a ray of their specular lobe in a frame: all smooth ones, and of rough
// surfaces one in each block of stride × stride pixels, in turns.
#ifndef AG_VCT_LOBE_TURNS_GLSL
#define AG_VCT_LOBE_TURNS_GLSL

const float LOBE_ROUGH_PIXEL = 0.15; // roughness from which pixels take turns

// A pixel of 2 x 2: over four turns all, the diagonal first.
uvec2 lobe_of_four(uint turn)
{
    return uvec2(turn & 1u, (turn >> 1 ^ turn) & 1u);
}

// The pixel of the block whose turn it is.
ivec2 lobe_turn(uint stride, uint turn)
{
    return ivec2(lobe_of_four(turn)) % int(stride);
}

bool lobe_traces(ivec2 pixel, uint stride, uint turn)
{
    return pixel % int(stride) == lobe_turn(stride, turn);
}

// The stratum of a pixel of 4 x 4, of which a frame has one in each quarter of the cone, or all:
// over 64 turns a pixel that takes part in each fourth one has had all.
uvec2 lobe_stratum(uvec2 within, uint stride, uint turn)
{
    uvec2 quarter = within >> 1 ^ lobe_of_four(turn >> 4);
    return 2u * quarter + (stride == 1u ? within & 1u : lobe_of_four(turn + (turn >> 2)));
}

#endif
