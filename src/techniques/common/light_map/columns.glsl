// Pixels with a surface, by columns of an invocation; the host has cleared all others (columns.h).
// A driver on a processor executes both sides of a branch for all pixels, but a loop only as often
// as one of a few needs: an invocation has several rows, and a loop over those with a surface. A
// processor's caches fetch the next lines of memory ahead: there, a workgroup is wide. Declare
// `depth` before, and define `shade`.
#ifndef AG_LIGHT_MAP_COLUMNS_GLSL
#define AG_LIGHT_MAP_COLUMNS_GLSL

#include "techniques/common/light_map/map_shared.h"

layout(local_size_x_id = LIGHT_MAP_APPLY_WIDTH, local_size_y_id = LIGHT_MAP_APPLY_HEIGHT) in;
layout(constant_id = LIGHT_MAP_APPLY_ROWS) const int ROWS = 1;

void shade(ivec2 pixel);

// size: of the view.
void shade_column(ivec2 size)
{
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, ROWS);
    uint surfaces = 0u;
    if (first.x >= size.x) return;
    for (int row = 0; row < min(ROWS, size.y - first.y); row++)
        if (texelFetch(depth, first + ivec2(0, row), 0).r > 0.0) surfaces |= 1u << row;
    for (; surfaces != 0u; surfaces &= surfaces - 1u) shade(first + ivec2(0, findLSB(surfaces)));
}

#endif
