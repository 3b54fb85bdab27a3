// A bounce: surfaces reflect the accumulated light, which joins the injected light. A cell has six
// surfaces, one for each direction ±a, with the reflecting area of lpv_surfaces.comp; each receives
// E(±a) and sends it as a clamped cosine around ±a.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"
#include "techniques/lpv/lpv_irradiance.glsl"
#define LPV_WALLS_BINDING 5
#include "techniques/lpv/lpv_lookup.glsl"

layout(local_size_x = LPV_CELLS_LOCAL) in;

layout(set = 0, binding = 1, scalar) readonly buffer lpv_surfaces
{
    uvec4 surfaces[]; // [cell][direction]
};
layout(set = 0, binding = 2) uniform sampler3D injected;     // from lights and emissive surfaces
layout(set = 0, binding = 3) uniform sampler3D arrived;      // accumulated so far
layout(set = 0, binding = 4) uniform writeonly image3D sent; // injected + reflected

// Reflectance × area in cells². All surfaces of one direction receive at most the light through one
// side of the cell.
vec3 reflecting_area(int at)
{
    vec4 sums = vec4(surfaces[at]) / LPV_SURFACE_UNIT;
    return sums.rgb / max(sums.a, 1.0);
}

// Bit d: the cell has a surface of direction d.
uint sides_of(ivec3 cell)
{
    uint sides = 0u;
    for (int side = 0; side < 6; side++)
        if (any(notEqual(surfaces[6 * lpv_index(cell) + side].rgb, uvec3(0)))) sides |= 1u << side;
    return sides;
}

// Irradiance is w / a² times the integral, area a² times `area`.
vec3 reflected_flux(ivec3 cell, vec3 area, vec3 n)
{
    vec3 at = vec3(cell) + 0.5 + (lpv.bounce_offset - 0.5) * n; // the surface is half a cell behind
    return lpv.mean_path * area *
           lpv_irradiance(lpv_sample(arrived, lpv_visible(at, lpv_cells())), n);
}

void main()
{
    ivec3 cell = lpv_cell_of_invocation(1);
    if (!lpv_inside(cell)) return;
    vec4 before[7], slabs[7] = vec4[7](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0),
                                       vec4(0.0), vec4(0.0));
    uint sides = sides_of(cell);
    while (sides != 0u) {
        int side = findLSB(sides);
        sides &= sides - 1u;
        vec3 area = reflecting_area(6 * lpv_index(cell) + side), n = vec3(0.0);
        n[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
        vec3 flux = reflected_flux(cell, area, n);
        float lobe[9];
        sh9_eval(n, lobe);
        for (int i = 1; i < 9; i++) lobe[i] *= i < 4 ? lpv.injected_1 : 0.25;
        for (int i = 0; i < LPV_BANDS * LPV_BANDS; i++)
            for (int colour = 0; colour < 3; colour++) {
                int value = 3 * i + colour;
                slabs[value / 4][value % 4] += flux[colour] * lobe[i];
            }
    }
    lpv_fetch_slabs(injected, cell, before);
    for (int i = 0; i < LPV_SLABS; i++) slabs[i] += before[i];
    lpv_store_slabs(sent, cell, slabs);
}
