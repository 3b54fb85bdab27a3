// Pixels with a surface, by columns of an invocation; the host has cleared all others (columns.h).
// A driver on a processor executes both sides of a branch for all pixels, but a loop only as often
// as one of a few needs: an invocation has several rows, and a loop over those with a surface. A
// processor's caches fetch the next lines of memory ahead: there, a workgroup is wide. Declare
// `depth` before, and define `shade`.
//
// A shader whose pipeline has no such constants defines COLUMNS_WIDTH, of a workgroup one row high,
// and COLUMNS_ROWS. COLUMNS_HAS: a function of a pixel and its depth, which is 0 without a surface,
// that selects pixels.
#ifndef AG_LIGHT_MAP_COLUMNS_GLSL
#define AG_LIGHT_MAP_COLUMNS_GLSL

#include "techniques/common/light_map/map_shared.h"

#ifdef COLUMNS_WIDTH
layout(local_size_x = COLUMNS_WIDTH) in;
#else
layout(local_size_x_id = LIGHT_MAP_APPLY_WIDTH, local_size_y_id = LIGHT_MAP_APPLY_HEIGHT) in;
layout(constant_id = LIGHT_MAP_APPLY_ROWS) const int COLUMNS_ROWS = 1;
#endif
#ifdef COLUMNS_HAS
bool COLUMNS_HAS(ivec2 pixel, float z);
#else
#define COLUMNS_HAS(pixel, z) ((z) > 0.0)
#endif

void shade(ivec2 pixel);

// size: of the view.
void shade_column(ivec2 size)
{
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, COLUMNS_ROWS);
    uint surfaces = 0u;
    if (first.x >= size.x) return;
    for (int row = 0; row < min(COLUMNS_ROWS, size.y - first.y); row++) {
        ivec2 pixel = first + ivec2(0, row);
        if (COLUMNS_HAS(pixel, texelFetch(depth, pixel, 0).r)) surfaces |= 1u << row;
    }
    for (; surfaces != 0u; surfaces &= surfaces - 1u) shade(first + ivec2(0, findLSB(surfaces)));
}

#endif
