// Real spherical harmonics, orthonormal, index i = l(l+1)+m, no Condon–Shortley sign, so that
// Y1,-1 ∝ +y, Y1,0 ∝ +z, Y1,1 ∝ +x. Bands 0…5 (order 5: 36 coefficients). The GLSL twin, bands 0…2,
// is sh.glsl.
//
// Sources: Ramamoorthi & Hanrahan 2001 (irradiance), Sloan 2008 "Stupid Spherical Harmonics Tricks"
// (zonal harmonics, products), Ivanic & Ruedenberg 1996/1998 (rotation). Unit of coefficients: that
// of the function.
#pragma once

#include "core/vec.h"

#define SH_MAX_BANDS    6
#define SH_COUNT(bands) ((bands) * (bands))
#define SH_MAX_COUNT    SH_COUNT(SH_MAX_BANDS)

// Y_i(direction) for all i below bands²; direction is a unit vector.
void sh_eval(int bands, vec3s direction, float *out);
// Σ c_i Y_i(direction).
float sh_dot(int bands, const float *coefficients, vec3s direction);

// Zonal coefficients z_l, l < bands, of the clamped cosine around +z: √π/2, √(π/3), √(5π)/8, 0, …
// (times Y: ∫ (cosθ)₊ Y_l0 dω).
void zh_clamped_cosine(int bands, float *out);
// A zonal function rotated from +z to `direction`: c_lm = √(4π/(2l+1)) z_l Y_lm(direction).
void zh_rotate(int bands, const float *zonal, vec3s direction, float *out);
// Convolution with a zonal kernel: c_lm · √(4π/(2l+1)) z_l. The clamped cosine turns radiance into
// irradiance.
void sh_convolve(int bands, const float *coefficients, const float *zonal, float *out);
// Irradiance coefficients of radiance coefficients: the bands weighted by π, 2π/3, π/4, 0, −π/24,
// 0.
void sh_irradiance(int bands, const float *radiance, float *out);

// Factor of a band by a Hann window (Sloan 2008, "Windowing"): (1 + cos(π band / width)) / 2, 0
// from `width` on. Few bands of a small bright light ring below 0; windowed ones ring less, and are
// wider. width 0: 1, no window.
float sh_window(int band, float width);

// Rotation of a function by the rotation matrix `to_from`: out(to_from · ω) = in(ω). out may not be
// in.
void sh_rotate(int bands, mat3s to_from, const float *in, float *out);
// The same for many functions. Rows and columns of a band's matrix are from −l to l.
struct sh_band {
    int l;
    double at[2 * SH_MAX_BANDS - 1][2 * SH_MAX_BANDS - 1];
};
struct sh_rotation {
    int bands;
    struct sh_band of[SH_MAX_BANDS];
};
void sh_rotation_init(struct sh_rotation *out, int bands, mat3s to_from);
void sh_rotation_apply(const struct sh_rotation *rotation, const float *in, float *out);
