// Second pass: heights of the outermost surfaces on faces of voxels that have more than a single
// large triangle. The third pass leaves out surfaces that they hide.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/voxelize/voxelize.glsl"
#include "techniques/vct/voxelize/material.glsl"
#include "techniques/vct/voxelize/line_places.glsl"
#include "techniques/vct/voxelize/lines.glsl"
#include "techniques/vct/voxelize/sum_words.glsl"

vct_triangle_faces faces;

void vct_begin_triangle(vct_triangle t)
{
    faces = vct_faces_of(t);
    if (IS_MASKED) vct_begin_material(t);
}

void raise_word(uint at, uint index, uvec4 lines)
{
    uint before = sums[at];
    for (;;) {
        uint raised = vct_outermost_of(uvec4(before), lines)[index];
        if (raised == before) return;
        uint found = atomicCompSwap(sums[at], before, raised);
        if (found == before) return;
        before = found;
    }
}

void raise(uint index, uvec4 lines)
{
    uint first;
    if (!vct_sum_words_of(index, first)) return;
    for (uint i = 0u; i < 4u; i++) raise_word(first + VCT_SUM_OUTERMOST + i, i, lines);
}

void raise_faces(ivec3 voxel, vct_triangle t)
{
    uvec4 lines = vct_lines_through(voxel, t, faces.front);
    if (lines == uvec4(0u) || IS_MASKED && vct_surface_point_in(voxel, t).opacity == 0.0) return;
    raise(vct_face_index(voxel, faces.front), lines);
    if (faces.both) raise(vct_face_index(voxel, faces.front ^ 1u), vct_lines_behind(lines));
}

#ifdef VCT_DEFERS

void vct_visit(ivec3 voxel, vct_triangle t)
{
    if (is_accumulated(vct_face_index(voxel, faces.front)) ||
        faces.both && is_accumulated(vct_face_index(voxel, faces.front ^ 1u)))
        vct_defer(voxel, t);
}

void vct_visit_deferred(ivec3 voxel, vct_triangle t)
{
    raise_faces(voxel, t);
}

#else

void vct_visit(ivec3 voxel, vct_triangle t)
{
    raise_faces(voxel, t);
}

#endif
