// Places of the sample lines through a voxel: one in each of VCT_LINES rows and columns.
#ifndef AG_VCT_LINE_PLACES_GLSL
#define AG_VCT_LINE_PLACES_GLSL

#include "techniques/vct/voxelize/voxelize_shared.h"

// Column and row of a line, across the two axes that follow the dominant one in the order x, y, z.
uvec2 vct_line_place(uint line)
{
    return uvec2(line, (line * 7u + 3u) % VCT_LINES);
}

#endif
