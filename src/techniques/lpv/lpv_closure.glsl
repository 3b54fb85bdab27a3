// The directional distribution of a cell's light with two bands and six neighbours: never negative,
// and with the cell's flux φ and first moment J = ∫ I ω dω. Include after core/sh.glsl and
// lpv_light.glsl.
//
// Above a wall of constant radiance light fills a hemisphere, |J| = φ/2; further away it is
// parallel, |J| = φ. In between the distribution is a hemisphere's plus a beam of the flux
// 2 |J| − φ; below |J| = φ/2 it is a hemisphere's plus isotropic light, whose moments are linear.
// Such a moment closure is homogeneous, I(s φ, s J) = s I(φ, J), like those of radiation
// hydrodynamics (Levermore 1984).
#ifndef AG_LPV_CLOSURE_GLSL
#define AG_LPV_CLOSURE_GLSL

layout(constant_id = LPV_CONSTANT_CLOSURE) const int LPV_CLOSURE = LPV_NO_CLOSURE;
const bool LPV_CLOSED = LPV_CLOSURE == LPV_BEAM_CLOSURE;

struct lpv_closure {
    vec3 wide;          // flux within a hemisphere or more
    vec3 wide_along[3]; // its first moment, at most half of it
    vec3 beam;          // flux of parallel light
    vec3 direction[3];  // of all light; of unit length, 0 without light
    vec3 widening;      // pressure of the wide light along the beam: 0 hemisphere, 1/2 parallel
    vec3 steps;         // of the beam per cell of its path, |x| + |y| + |z|
};

lpv_closure lpv_closure_of(lpv_light light)
{
    const float LEAST = 1e-15;
    lpv_closure c;
    vec3 flux = light.mean / SH_Y0, moment[3], square = vec3(0.0);
    for (int a = 0; a < 3; a++) {
        moment[a] = light.along[a] / SH_Y1;
        square += moment[a] * moment[a];
    }
    vec3 over_size = 1.0 / max(sqrt(square), vec3(LEAST));
    vec3 size = min(sqrt(square), flux); // rounding may exceed the flux
    c.beam = max(2.0 * size - flux, vec3(0.0));
    c.wide = flux - c.beam;
    c.widening = 0.5 * c.beam / max(flux, vec3(LEAST));
    c.steps = vec3(LEAST);
    for (int a = 0; a < 3; a++) {
        c.direction[a] = over_size * moment[a];
        c.wide_along[a] = (size - c.beam) * c.direction[a];
        c.steps += abs(c.direction[a]);
    }
    return c;
}

#endif
