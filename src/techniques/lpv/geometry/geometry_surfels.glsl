// Adds surfels to the geometry volume of one source. Include after core/sh.glsl and lpv_grid.glsl;
// define LPV_SURFELS_BINDING.
//
// A surfel of area A (m²) and normal n adds A/S² (n·ω)₊, S the side of a cell (m), to the nearest
// corner of the cells: the fraction of a cell's face that it covers, seen along ω. Sums are
// integers, so that their order does not change a bit.
#ifndef AG_LPV_SURFELS_GLSL
#define AG_LPV_SURFELS_GLSL

// [corner][coefficient]
layout(set = 0, binding = LPV_SURFELS_BINDING, scalar) buffer lpv_surfels
{
    int surfel_sums[];
};

const int LPV_NO_CORNER = -1;
// Fixed-point 1. The surfels of one source around a corner are the surfaces visible from one point
// within a cell: with LPV_LEAST_COSINE their areas sum to less than 120 faces, and 2^31/2^23 = 256.
const float LPV_SURFEL_FIXED = 8388608.0; // 2^23
// Least cosine between a surfel's normal and the direction to the viewer: at grazing angles the
// shading normal is not a measure of the slope.
const float LPV_LEAST_COSINE = 0.1;

// Texel of the corner next to a position; LPV_NO_CORNER on the grid's border and outside.
int lpv_corner(vec3 position)
{
    ivec3 corner = ivec3(floor(lpv_cells_from_world(position) + 0.5));
    if (any(lessThan(corner, ivec3(1))) || any(greaterThanEqual(corner, lpv_cells())))
        return LPV_NO_CORNER;
    return lpv_index(corner - 1);
}

// Coefficients of a surfel. `across`: perpendicular area (m²) of its texel at its distance;
// `to_viewer`: unit.
vec4 lpv_surfel(vec3 normal, vec3 to_viewer, float across)
{
    float area = across / max(dot(normal, to_viewer), LPV_LEAST_COSINE);
    return min(area / (lpv.cell_m * lpv.cell_m), 1.0) * sh4_clamped_cosine(normal);
}

// Consecutive surfels mostly share a corner; a run of them needs one atomic addition.
struct lpv_surfel_run {
    int corner;
    vec4 lobe;
};

void lpv_surfel_run_flush(lpv_surfel_run run)
{
    if (run.corner == LPV_NO_CORNER) return;
    ivec4 fixed_lobe = ivec4(roundEven(run.lobe * LPV_SURFEL_FIXED));
    for (int i = 0; i < 4; i++)
        if (fixed_lobe[i] != 0) atomicAdd(surfel_sums[4 * run.corner + i], fixed_lobe[i]);
}

void lpv_surfel_run_add(inout lpv_surfel_run run, int corner, vec4 lobe)
{
    if (corner == LPV_NO_CORNER) return;
    if (corner != run.corner) {
        lpv_surfel_run_flush(run);
        run = lpv_surfel_run(corner, vec4(0.0));
    }
    run.lobe += lobe;
}

#endif
