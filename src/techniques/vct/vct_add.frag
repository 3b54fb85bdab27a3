// One column of a triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VCT_RASTER
#include "vct_add.glsl"

layout(location = 0) flat in uint vary_triangle;

void main()
{
    vct_triangle t;
    ivec2 column = ivec2(gl_FragCoord.xy);
    if (!triangle_at(vary_triangle, t) || any(lessThan(column, t.low.xy)) ||
        any(greaterThan(column, t.high.xy)))
        return;
    vct_meet(t, column);
    walk_column(t, column);
}
