// The geometry volume as propagation reads it: which share of the light on its way from a cell to a
// neighbour meets a surface. Include after core/sh.glsl and lpv_grid.glsl; define
// LPV_GEOMETRY_BINDING.
//
// LPV_GEOMETRY_MAPS (Martin 2012, sec. 3.2.2, 3.2.3): four coefficients of the blocking potential
// B(ω) at each corner of the cells, B = Σ A/S² (n·ω)₊ with A the area of a surfel (m²), S the side
// of a cell (m): as many surfaces there are on a way of S along −ω. Between the corners around the
// place where the light crosses over (four of a face, two of an edge, a corner) they are
// interpolated; light that goes d cells is blocked by what faces it, |d| B(−d/|d|). Two bands of a
// clamped cosine are 3/4 at the peak, which is made good: a wall across the way blocks all. Texel i
// is the corner i + 1 cells from the grid's: half a cell further than cell i's centre. Corners on
// the grid's border are left out; those next to them stand for them.
//
// LPV_GEOMETRY_SCENE: of each cell's low faces (−x, −y, −z) the share that surfaces cover, seen
// along the face's normal. Over an edge or a corner light goes along two or three axes, and all of
// these must be free.
#ifndef AG_LPV_GEOMETRY_GLSL
#define AG_LPV_GEOMETRY_GLSL

layout(constant_id = LPV_CONSTANT_GEOMETRY) const int LPV_GEOMETRY = LPV_GEOMETRY_OFF;

layout(set = 0, binding = LPV_GEOMETRY_BINDING) uniform sampler3D geometry;

vec4 lpv_geometry_at(vec3 texel)
{
    return textureLod(geometry, texel / float(lpv.dim), 0.0);
}

const float LPV_PEAK = 0.75; // of a clamped cosine in two bands

// What light meets that crosses over `at` (in cells from the grid's corner) and goes d cells.
float lpv_corners_block(vec3 at, vec3 d)
{
    vec3 texel = clamp(at - 0.5, vec3(0.5), max(vec3(lpv_cells()) - 1.5, vec3(0.5)));
    return length(d) * sh4_dot(lpv_geometry_at(texel), -normalize(d)) / LPV_PEAK;
}

float lpv_free(float blocked)
{
    return 1.0 - clamp(lpv.occlusion * blocked, 0.0, 1.0);
}

// The share of the light from `cell` that reaches the neighbour at `offset`, 0…1. Both must be
// inside of the grid.
float lpv_passing(ivec3 cell, ivec3 offset)
{
    if (LPV_GEOMETRY == LPV_GEOMETRY_OFF) return 1.0;
    vec3 at = vec3(cell) + 0.5 + 0.5 * vec3(offset);
    if (LPV_GEOMETRY == LPV_GEOMETRY_MAPS) return lpv_free(lpv_corners_block(at, vec3(offset)));
    float free = 1.0;
    for (int axis = 0; axis < 3; axis++) {
        if (offset[axis] == 0) continue;
        // The faces across this axis have their texels half a cell above them.
        vec3 texel = at;
        texel[axis] += 0.5;
        free *= lpv_free(lpv_geometry_at(texel)[axis]);
    }
    return free;
}

#endif
