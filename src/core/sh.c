// The basis, zonal harmonics and convolution. Rotation: sh_rotate.c.
#include "core/sh_basis.h"

#include <assert.h>
#include <math.h>

// K_lm = √((2 − δ_m0) (2l+1)/4π · (l−m)!/(l+m)!): row l, column m.
static const double NORM[SH_MAX_BANDS][SH_MAX_BANDS] = {
    { 0.28209479177387814 },
    { 0.48860251190291992, 0.48860251190291992 },
    { 0.63078313050504009, 0.36418281019735971, 0.18209140509867985 },
    { 0.7463526651802308, 0.3046971996429772, 0.096353714754685141, 0.0393362393284429 },
    { 0.84628437532163447, 0.26761861742291565, 0.063078313050504001, 0.016858388283618388,
      0.0059603403376112018 },
    { 0.9356025796273888, 0.24157154730437169, 0.045652731285460227, 0.0093188247511476266,
      0.0021964680580751762, 0.00069458418713245519 },
};

// √(4π/(2l+1)): factor of a zonal coefficient as a convolution kernel (Funk–Hecke).
static const double KERNEL[SH_MAX_BANDS] = { 3.5449077018110318, 2.046653415892977,
                                             1.5853309190424043, 1.3398491713813576,
                                             1.1816359006036774, 1.0688298875771143 };

// Y_lm = K_lm · P_l|m|(z)/sin^|m|θ · sin^|m|θ cos mφ, with sin |m|φ for negative m. The pair
// sin^mθ (cos mφ, sin mφ) is (x + iy)^m, which avoids the division by sinθ; P_lm/sin^mθ follows the
// recurrence of P_lm in l.
void sh_eval_double(int bands, const double direction[3], double *out)
{
    assert(bands >= 1 && bands <= SH_MAX_BANDS);
    double x = direction[0], y = direction[1], z = direction[2];
    double cosine = 1.0, sine = 0.0, diagonal = 1.0; // (x + iy)^m, P_mm
    for (int m = 0; m < bands; m++) {
        double previous = 0.0, legendre = diagonal;
        for (int l = m; l < bands; l++) {
            double value = NORM[l][m] * legendre;
            out[l * (l + 1) + m] = value * cosine;
            if (m > 0) out[l * (l + 1) - m] = value * sine;
            double next = ((2 * l + 1) * z * legendre - (l + m) * previous) / (l - m + 1);
            previous = legendre;
            legendre = next;
        }
        double next_cosine = x * cosine - y * sine;
        sine = x * sine + y * cosine;
        cosine = next_cosine;
        diagonal *= 2 * m + 1;
    }
}

void sh_eval(int bands, vec3s direction, float *out)
{
    double values[SH_MAX_COUNT];
    sh_eval_double(bands,
                   (double[3]){ (double)direction.x, (double)direction.y, (double)direction.z },
                   values);
    for (int i = 0; i < SH_COUNT(bands); i++) out[i] = (float)values[i];
}

float sh_window(int band, float width)
{
    if (!(width > 0.0f)) return 1.0f;
    if ((float)band >= width) return 0.0f;
    return 0.5f + 0.5f * cosf(3.14159265f * (float)band / width);
}

float sh_dot(int bands, const float *coefficients, vec3s direction)
{
    double values[SH_MAX_COUNT], sum = 0.0;
    sh_eval_double(bands,
                   (double[3]){ (double)direction.x, (double)direction.y, (double)direction.z },
                   values);
    for (int i = 0; i < SH_COUNT(bands); i++) sum += (double)coefficients[i] * values[i];
    return (float)sum;
}

void zh_clamped_cosine(int bands, float *out)
{
    // √((2l+1)/4π) · 2π ∫₀¹ t P_l(t) dt (Ramamoorthi & Hanrahan 2001, eq. 8, before their
    // normalisation)
    static const float cosine[SH_MAX_BANDS] = {
        0.886226925f,  // √π/2
        1.023326708f,  // √(π/3)
        0.495415912f,  // √(5π)/8
        0.0f,          // odd bands above 1 vanish
        -0.110778366f, // −√π/16
        0.0f,
    };
    for (int l = 0; l < bands; l++) out[l] = cosine[l];
}

void zh_rotate(int bands, const float *zonal, vec3s direction, float *out)
{
    sh_eval(bands, direction, out);
    sh_convolve(bands, out, zonal, out);
}

void sh_convolve(int bands, const float *coefficients, const float *zonal, float *out)
{
    for (int l = 0; l < bands; l++) {
        float weight = (float)(KERNEL[l] * (double)zonal[l]);
        for (int i = l * l; i < (l + 1) * (l + 1); i++) out[i] = weight * coefficients[i];
    }
}

void sh_irradiance(int bands, const float *radiance, float *out)
{
    float cosine[SH_MAX_BANDS];
    zh_clamped_cosine(bands, cosine);
    sh_convolve(bands, radiance, cosine, out);
}
