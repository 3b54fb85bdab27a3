// Irradiance from a cell's light. Include after core/sh.glsl, lpv_grid.glsl and lpv_light.glsl.
#ifndef AG_LPV_IRRADIANCE_GLSL
#define AG_LPV_IRRADIANCE_GLSL

// ∫ I(ω) (−n·ω)₊ dω in the bands of I, weighted by the window.
vec3 lpv_irradiance(lpv_light light, vec3 n)
{
    vec3 sum = SH_COSINE_0 * SH_Y0 * light.mean, band_1 = vec3(0.0), band_2 = vec3(0.0);
    vec3 products = n.yzx * n.zxy;
    for (int a = 0; a < 3; a++) {
        band_1 -= SH_Y1 * n[a] * light.along[a];
        band_2 += n[a] * n[a] * light.square[a] + SH_Y2_XY * products[a] * light.product[a];
    }
    return sum + lpv.window * (SH_COSINE_1 * band_1 + SH_COSINE_2 * band_2);
}

#endif
