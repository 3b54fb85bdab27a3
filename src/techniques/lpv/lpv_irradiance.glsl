// Irradiance from a cell's light. Include after core/sh.glsl, lpv_grid.glsl and lpv_light.glsl.
#ifndef AG_LPV_IRRADIANCE_GLSL
#define AG_LPV_IRRADIANCE_GLSL

#include "techniques/lpv/lpv_closure.glsl"
#include "techniques/lpv/lpv_product.glsl"

// Irradiance of the positive closure: light 1 + 3 J·ω gives φ/4 − J·n/2, a beam its cosine.
vec3 lpv_closed_irradiance(lpv_closure light, vec3 n)
{
    vec3 along = vec3(0.0), cosine = vec3(0.0);
    for (int a = 0; a < 3; a++) {
        along -= n[a] * light.wide_along[a];
        cosine -= n[a] * light.direction[a];
    }
    return 0.25 * light.wide + 0.5 * along +
           light.beam * max(cosine, vec3(0.0)) / (lpv.mean_path * light.steps);
}

// The flux that a step sends across a side of a cell with the normal −n (lpv_crossing_of): a wall
// gets all light that arrives and none of its own. On a slope, stairs of |x| + |y| + |z| sides per
// area let the light that leaves have that many times the directional band; without geometry there
// are none.
vec3 lpv_irradiance(lpv_light light, vec3 n)
{
    if (LPV_CLOSURE == LPV_PRODUCT_CLOSURE) return lpv_product_irradiance(light, n);
    if (LPV_CLOSED) return lpv_closed_irradiance(lpv_closure_of(light), n);
    vec3 mean = SH_COSINE_0 * SH_Y0 * light.mean, band_1 = vec3(0.0), band_2 = vec3(0.0);
    vec3 products = n.yzx * n.zxy;
    for (int a = 0; a < 3; a++) {
        band_1 -= SH_Y1 * n[a] * light.along[a];
        band_2 += n[a] * n[a] * light.square[a] + SH_Y2_XY * products[a] * light.product[a];
    }
    float sides = mix(1.0, abs(n.x) + abs(n.y) + abs(n.z), lpv.staircase);
    return mean + (lpv.window_1 / sides) * SH_COSINE_1 * band_1 +
           lpv.window_2 * SH_COSINE_2 * band_2;
}

// Vector irradiance ∫ L ω dω of the light that arrives, a column for each colour, in the unit of
// lpv_irradiance. Its part along a surface is free of the surface's own light, which is symmetric
// around the normal.
mat3 lpv_vector_irradiance(lpv_light light)
{
    vec3 by_axis[3];
    if (LPV_CLOSED) {
        lpv_closure closed = lpv_closure_of(light);
        vec3 beam = closed.beam / (lpv.mean_path * closed.steps);
        for (int a = 0; a < 3; a++) by_axis[a] = -closed.wide_along[a] - beam * closed.direction[a];
    } else {
        float scale = LPV_CLOSURE == LPV_PRODUCT_CLOSURE ? 1.0 : lpv.window_1;
        for (int a = 0; a < 3; a++) by_axis[a] = -scale / SH_Y1 * light.along[a];
    }
    return transpose(mat3(by_axis[0], by_axis[1], by_axis[2]));
}

#endif
