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
// LPV_GEOMETRY_SCENE: the occluded share of the light that crosses each cell's low faces (−x, −y,
// −z), upwards in the first slab of dim³ texels, downwards in the second. Light across an edge or a
// corner moves along two or three axes, one after the other.
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

// Across the face of `cell` towards `side` along an axis.
float lpv_face_transmittance(ivec3 cell, int axis, int side)
{
    if (side > 0)
        cell[axis]++;
    else
        cell.z += lpv.dim; // the second slab
    return lpv_transmitted(texelFetch(geometry, cell, 0)[axis]);
}

// Mean over all paths from face to face: one axis after the other, in every order.
float lpv_path_transmittance(ivec3 cell, ivec3 offset)
{
    float sum = 0.0;
    for (int a = 0; a < 3; a++) {
        if (offset[a] == 0) continue;
        ivec3 second = cell, rest = offset;
        second[a] += offset[a];
        rest[a] = 0;
        float first = lpv_face_transmittance(cell, a, offset[a]), further = 0.0;
        for (int b = 0; b < 3; b++) {
            if (rest[b] == 0) continue;
            ivec3 third = second, last = rest;
            third[b] += rest[b];
            last[b] = 0;
            float path = lpv_face_transmittance(second, b, rest[b]);
            for (int c = 0; c < 3; c++)
                if (last[c] != 0) path *= lpv_face_transmittance(third, c, last[c]);
            further += path;
        }
        int left = abs(rest.x) + abs(rest.y) + abs(rest.z);
        sum += first * (left == 0 ? 1.0 : further / float(left));
    }
    return sum / float(abs(offset.x) + abs(offset.y) + abs(offset.z));
}

// Fraction of the light of `cell` that reaches the neighbour at `offset`, 0…1. Both cells must be
// inside of the grid.
float lpv_transmittance_of(ivec3 cell, ivec3 offset)
{
    if (LPV_GEOMETRY == LPV_GEOMETRY_OFF) return 1.0;
    vec3 at = vec3(cell) + 0.5 + 0.5 * vec3(offset);
    if (LPV_GEOMETRY == LPV_GEOMETRY_MAPS)
        return lpv_transmitted(lpv_corner_occlusion(at, vec3(offset)));
    return lpv_path_transmittance(cell, offset);
}

// The same for the neighbour at ±1 along an axis.
float lpv_transmittance_along(ivec3 cell, int axis, int side)
{
    ivec3 offset = ivec3(0);
    offset[axis] = side;
    if (LPV_GEOMETRY == LPV_GEOMETRY_SCENE) return lpv_face_transmittance(cell, axis, side);
    return lpv_transmittance_of(cell, offset);
}

#endif
