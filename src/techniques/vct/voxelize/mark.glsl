// First pass: marks the faces of each voxel that a triangle touches. A second bit marks the faces
// that have more than a single large triangle: their attributes are summed up.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/voxelize/voxelize.glsl"

layout(set = 0, binding = 16, scalar) buffer vct_mask
{
    uint mask[];
};
layout(set = 0, binding = 17, scalar) buffer vct_accumulated
{
    uint accumulated[];
};

uint marked_faces; // of the triangle, a bit each

void vct_begin_triangle(vct_triangle t)
{
    vct_triangle_faces faces = vct_faces_of(t);
    marked_faces = (1u << faces.front) | (faces.both ? 1u << (faces.front ^ 1u) : 0u);
}

void vct_visit(ivec3 voxel, vct_triangle t)
{
    uint index = vct_face_index(voxel, 0u), word = index >> 5;
    uint bits = marked_faces << (index & 31u), touched = atomicOr(mask[word], bits) & bits;
#if defined(VCT_RASTER) || !VCT_LARGE
    touched = bits;
#endif
    if (touched != 0u) atomicOr(accumulated[word], touched);
}
