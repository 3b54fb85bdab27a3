// Sums over the triangles of a voxel's face, and which faces have more than a single large
// triangle. Define VCT_DEFERS where single large triangles are not summed up.
#ifndef AG_VCT_SUM_WORDS_GLSL
#define AG_VCT_SUM_WORDS_GLSL

#define VCT_SLOTS(name)   vct_##name
#define VCT_SLOTS_BINDING 16
#include "techniques/vct/voxelize/slots.glsl"

layout(set = 0, binding = 18, scalar) buffer vct_sum_words
{
    uint sums[];
};
#ifdef VCT_DEFERS
layout(set = 0, binding = 19, scalar) readonly buffer vct_accumulated
{
    uint accumulated[];
};

bool is_accumulated(uint index)
{
    return (accumulated[index >> 5] >> (index & 31u) & 1u) != 0u;
}
#else
bool is_accumulated(uint index)
{
    return true;
}
#endif

// Words of a face whose triangles are summed up.
bool vct_sum_words_of(uint index, out uint first)
{
    uint slot = is_accumulated(index) ? vct_slot(index) : VCT_NO_SLOT;
    first = slot * VCT_SUM_WORDS;
    return slot != VCT_NO_SLOT;
}

#endif
