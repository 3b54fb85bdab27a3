// Vertices of the enlarged triangles whose fragments are columns of voxels.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VCT_RASTER
#include "techniques/vct/voxelize/voxelize.glsl"
#include "techniques/vct/voxelize/raster.glsl"

layout(location = 0) flat out uint vary_triangle;

void vct_begin_triangle(vct_triangle t)
{
}

void vct_visit(ivec3 voxel, vct_triangle t)
{
}

void main()
{
    vary_triangle = uint(gl_VertexIndex) / 3u;
    vct_triangle t;
    vec2 corner = vec2(-4.0); // clipped, as are the other two
    if (triangle_at(vary_triangle, t))
        corner = vct_raster_corner(t, uint(gl_VertexIndex) % 3u) * (2.0 / vct.dim) - 1.0;
    gl_Position = vec4(corner, 0.5, 1.0);
}
