// Irradiance from a cell's light. Include after core/sh.glsl, lpv_grid.glsl and lpv_light.glsl.
#ifndef AG_LPV_IRRADIANCE_GLSL
#define AG_LPV_IRRADIANCE_GLSL

#include "techniques/lpv/lpv_closure.glsl"

// Of the positive closure: light 1 + 3 J·ω gives φ/4 − J·n/2, a beam the cosine of its angle.
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

const float LPV_RINGING = 0.18; // times the mean over all normals: below, bands ring
const float LPV_DARKEST = 0.04; // times the same mean: least irradiance

// Three bands ring to negative irradiance beside bright emitters, where light from elsewhere does
// arrive. Below a share of the mean over all normals a hyperbola continues the irradiance with its
// value and slope to a lower share: never negative, and twice the light is twice the result.
vec3 lpv_without_ringing(vec3 irradiance, vec3 mean)
{
    mean = max(mean, vec3(0.0));
    vec3 room = (LPV_RINGING - LPV_DARKEST) * mean;
    vec3 below = max(LPV_RINGING * mean - irradiance, vec3(0.0));
    vec3 tail = LPV_DARKEST * mean + room * room / max(room + below, vec3(1e-20));
    return mix(tail, irradiance, equal(below, vec3(0.0)));
}

// The flux that a step sends across a side of a cell with the normal −n (lpv_crossing_of): a wall
// gets all light that arrives and none of its own. On a slope, stairs of |x| + |y| + |z| sides per
// area let the light that leaves have that many times the directional band; without geometry there
// are none.
vec3 lpv_irradiance(lpv_light light, vec3 n)
{
    if (LPV_CLOSED) return lpv_closed_irradiance(lpv_closure_of(light), n);
    vec3 mean = SH_COSINE_0 * SH_Y0 * light.mean, band_1 = vec3(0.0), band_2 = vec3(0.0);
    vec3 products = n.yzx * n.zxy;
    for (int a = 0; a < 3; a++) {
        band_1 -= SH_Y1 * n[a] * light.along[a];
        band_2 += n[a] * n[a] * light.square[a] + SH_Y2_XY * products[a] * light.product[a];
    }
    float sides = mix(1.0, abs(n.x) + abs(n.y) + abs(n.z), lpv.staircase);
    vec3 sum =
        mean + (lpv.window_1 / sides) * SH_COSINE_1 * band_1 + lpv.window_2 * SH_COSINE_2 * band_2;
    return LPV_CLOSURE == LPV_BANDS_CLOSURE ? lpv_without_ringing(sum, mean) : sum;
}

#endif
