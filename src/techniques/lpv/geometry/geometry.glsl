// The geometry volume: the fraction of light between neighbour cells that surfaces occlude. Include
// after core/sh.glsl and lpv_grid.glsl; define LPV_GEOMETRY_BINDING.
//
// LPV_GEOMETRY_MAPS (Martin 2012, sec. 3.2.2, 3.2.3): four coefficients of the blocking potential
// B(ω) at each corner of the cells, B = Σ A/S² (n·ω)₊ with A the area of a surfel (m²) and S the
// side of a cell (m). B is the number of surfaces on a path of length S along −ω. Light that moves
// by d cells is occluded by |d| B(−d/|d|), B interpolated between the corners around the crossing
// (four of a face, two of an edge, one corner). Two bands of a clamped cosine peak at 3/4, which is
// divided out: a perpendicular wall occludes all. Texel i is the corner i + 1 cells from the grid's
// corner, half a cell beyond the centre of cell i. Corners on the border of the grid are not
// stored; their inner neighbours replace them.
//
// LPV_GEOMETRY_SCENE: the covered fraction of each cell's low faces (−x, −y, −z), seen along the
// normal. Light across an edge or a corner moves along two or three axes; all must be free.
#ifndef AG_LPV_GEOMETRY_GLSL
#define AG_LPV_GEOMETRY_GLSL

layout(constant_id = LPV_CONSTANT_GEOMETRY) const int LPV_GEOMETRY = LPV_GEOMETRY_OFF;

layout(set = 0, binding = LPV_GEOMETRY_BINDING) uniform sampler3D geometry;

vec4 lpv_geometry_at(vec3 texel)
{
    return textureLod(geometry, texel / float(lpv.dim), 0.0);
}

const float LPV_PEAK = 0.75; // of a clamped cosine in two bands

// Occlusion of light that crosses `at` (in cells from the grid's corner) and moves by d cells.
float lpv_corner_occlusion(vec3 at, vec3 d)
{
    vec3 texel = clamp(at - 0.5, vec3(0.5), max(vec3(lpv_cells()) - 1.5, vec3(0.5)));
    return length(d) * sh4_dot(lpv_geometry_at(texel), -normalize(d)) / LPV_PEAK;
}

float lpv_transmitted(float occluded)
{
    return 1.0 - clamp(lpv.occlusion * occluded, 0.0, 1.0);
}

// Fraction of the light of `cell` that reaches the neighbour at `offset`, 0…1. Both cells must be
// inside of the grid.
float lpv_transmittance_of(ivec3 cell, ivec3 offset)
{
    if (LPV_GEOMETRY == LPV_GEOMETRY_OFF) return 1.0;
    vec3 at = vec3(cell) + 0.5 + 0.5 * vec3(offset);
    if (LPV_GEOMETRY == LPV_GEOMETRY_MAPS)
        return lpv_transmitted(lpv_corner_occlusion(at, vec3(offset)));
    float transmittance = 1.0;
    for (int axis = 0; axis < 3; axis++) {
        if (offset[axis] == 0) continue;
        // Faces across this axis have their texels half a cell above them.
        vec3 texel = at;
        texel[axis] += 0.5;
        transmittance *= lpv_transmitted(lpv_geometry_at(texel)[axis]);
    }
    return transmittance;
}

#endif
