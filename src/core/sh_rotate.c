// Rotation, band by band: Ivanic & Ruedenberg 1996, "Rotation Matrices for Real Spherical
// Harmonics. Direct Determination by Recursion", with the corrections of 1998 (J. Phys. Chem. A
// 102, 9099). Order of the first band, (y, z, x), and signs are those of the paper.
#include "core/sh.h"

#include <assert.h>
#include <math.h>

static double entry(const struct sh_band *band, int m, int n)
{
    return band->at[m + band->l][n + band->l];
}

static struct sh_band band_one(mat3s to_from)
{
    static const int axis[3] = { 1, 2, 0 }; // y, z, x
    struct sh_band one = { .l = 1 };
    for (int m = 0; m < 3; m++)
        for (int n = 0; n < 3; n++) one.at[m][n] = (double)to_from.raw[axis[n]][axis[m]];
    return one;
}

// Table 2 of the paper: ᵢP with i = −1, 0, 1.
static double p_term(const struct sh_band *one, const struct sh_band *below, int i, int a, int n)
{
    int l = below->l + 1;
    if (n == l)
        return entry(one, i, 1) * entry(below, a, l - 1) -
               entry(one, i, -1) * entry(below, a, 1 - l);
    if (n == -l)
        return entry(one, i, 1) * entry(below, a, 1 - l) +
               entry(one, i, -1) * entry(below, a, l - 1);
    return entry(one, i, 0) * entry(below, a, n);
}

static double v_term(const struct sh_band *one, const struct sh_band *below, int m, int n)
{
    if (m == 0) return p_term(one, below, 1, 1, n) + p_term(one, below, -1, -1, n);
    if (m == 1) return sqrt(2.0) * p_term(one, below, 1, 0, n);
    if (m == -1) return sqrt(2.0) * p_term(one, below, -1, 0, n);
    if (m > 0) return p_term(one, below, 1, m - 1, n) - p_term(one, below, -1, 1 - m, n);
    return p_term(one, below, 1, m + 1, n) + p_term(one, below, -1, -m - 1, n);
}

static double w_term(const struct sh_band *one, const struct sh_band *below, int m, int n)
{
    if (m > 0) return p_term(one, below, 1, m + 1, n) + p_term(one, below, -1, -m - 1, n);
    return p_term(one, below, 1, m - 1, n) - p_term(one, below, -1, 1 - m, n);
}

// One entry: u U + v V + w W. Terms with a zero factor are skipped: they would read outside the
// band below.
static double next_entry(const struct sh_band *one, const struct sh_band *below, int m, int n)
{
    int l = below->l + 1, k = m < 0 ? -m : m;
    double denominator = (n == l || n == -l) ? 2 * l * (2 * l - 1) : (l + n) * (l - n);
    double sum = 0.0;
    if (k < l) sum += sqrt((l + m) * (l - m) / denominator) * p_term(one, below, 0, m, n);
    double v = 0.5 * sqrt((m == 0 ? 2 : 1) * (l + k - 1) * (l + k) / denominator);
    sum += (m == 0 ? -v : v) * v_term(one, below, m, n);
    if (m != 0 && k < l - 1)
        sum -= 0.5 * sqrt((l - k - 1) * (l - k) / denominator) * w_term(one, below, m, n);
    return sum;
}

void sh_rotation_init(struct sh_rotation *out, int bands, mat3s to_from)
{
    assert(bands >= 1 && bands <= SH_MAX_BANDS);
    out->bands = bands;
    out->of[0] = (struct sh_band){ .at[0][0] = 1.0 };
    if (bands > 1) out->of[1] = band_one(to_from);
    for (int l = 2; l < bands; l++) {
        out->of[l].l = l;
        for (int m = -l; m <= l; m++)
            for (int n = -l; n <= l; n++)
                out->of[l].at[m + l][n + l] = next_entry(&out->of[1], &out->of[l - 1], m, n);
    }
}

void sh_rotation_apply(const struct sh_rotation *rotation, const float *in, float *out)
{
    assert(in != out);
    for (int l = 0; l < rotation->bands; l++) {
        const int first = l * l, width = 2 * l + 1;
        for (int m = 0; m < width; m++) {
            double sum = 0.0;
            for (int n = 0; n < width; n++) sum += rotation->of[l].at[m][n] * (double)in[first + n];
            out[first + m] = (float)sum;
        }
    }
}

void sh_rotate(int bands, mat3s to_from, const float *in, float *out)
{
    struct sh_rotation rotation;
    sh_rotation_init(&rotation, bands, to_from);
    sh_rotation_apply(&rotation, in, out);
}
