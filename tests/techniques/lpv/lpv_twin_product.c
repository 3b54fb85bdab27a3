#include "techniques/lpv/lpv_twin_product.h"

#include "techniques/lpv/lpv_math.h"
#include "techniques/lpv/lpv_twin.h"

#include <math.h>

// Flux and first and second moments of a cell's light.
struct moments {
    double flux, along[3], second[3][3];
};

static double band(int i)
{
    return sqrt((i == 0 ? 1.0 : i == 1 ? 3.0 : 15.0) / (4.0 * GLM_PI));
}

// Band 2 in the order of core/sh.h: xy, yz, 3z² − 1, xz, x² − y².
static struct moments moments_of(const double light[9])
{
    enum { X, Y, Z };
    struct moments m = { .flux = light[0] / band(0) };
    m.along[X] = light[3] / band(1);
    m.along[Y] = light[1] / band(1);
    m.along[Z] = light[2] / band(1);
    m.second[X][Y] = m.second[Y][X] = light[4] / band(2);
    m.second[Y][Z] = m.second[Z][Y] = light[5] / band(2);
    m.second[X][Z] = m.second[Z][X] = light[7] / band(2);
    const double zz = light[6] / band(2) * sqrt(12.0), xx_yy = 2.0 * light[8] / band(2);
    m.second[Z][Z] = (m.flux + zz) / 3.0;
    m.second[X][X] = 0.5 * (m.flux - m.second[Z][Z] + xx_yy);
    m.second[Y][Y] = 0.5 * (m.flux - m.second[Z][Z] - xx_yy);
    return m;
}

static void add(double to[9], const struct moments *m, const struct lpv_lobe_weights *weights)
{
    enum { X, Y, Z };
    const double added[9] = {
        band(0) * m->flux,
        band(1) * m->along[Y],
        band(1) * m->along[Z],
        band(1) * m->along[X],
        band(2) * m->second[X][Y],
        band(2) * m->second[Y][Z],
        band(2) / sqrt(12.0) * (2.0 * m->second[Z][Z] - m->second[X][X] - m->second[Y][Y]),
        band(2) * m->second[X][Z],
        band(2) / 2.0 * (m->second[X][X] - m->second[Y][Y]),
    };
    for (int i = 0; i < 9; i++) to[i] += lpv_lobe_weight(weights, i) * added[i];
}

// The distribution of ω along an axis, by the means of ω, ω², |ω|, and that of |ω|³ over |ω|.
struct axis {
    double mean, square, size, third;
};

static struct axis axis_of(double mean, double square)
{
    struct axis a;
    a.mean = fmin(fmax(mean, -1.0), 1.0);
    a.square = fmin(fmax(square, a.mean * a.mean), 1.0);
    const double least = (sqrt(12.0 * fmax(a.square, 0.25) - 3.0) - 1.0) / 2.0; // c of [c, 1]
    const double disk = sqrt(3.0 * a.square) / 2.0, wall = 1.5 * a.square;
    const bool cone = a.square > 1.0 / 3.0;
    a.size = fmax(cone ? 0.5 + 0.5 * least : 0.5 * (disk + wall), fabs(a.mean));
    // An interval of the mean κ and the variance v has the third moment κ³ + 3 κ v.
    a.third = a.size * a.size + 3.0 * (a.square - a.size * a.size);
    if (!cone && a.size > 0.0) a.third = fmax(a.third, 1.125 * pow(a.square / a.size, 2.0));
    return a;
}

// Moments of light of unit flux that moves by `offset`: flux, ∫ ω, ∫ ω².
struct moved {
    double flux, mean, square;
};

static struct moved moved_by(const struct axis *a, int offset)
{
    struct moved all = { 1.0, a->mean, a->square };
    for (int side = -1; side <= 1; side += 2) {
        struct moved m = { .flux = 0.5 * (a->size + side * a->mean) };
        m.mean = a->size > 0.0 ? side * m.flux * a->square / a->size : 0.0;
        m.square = m.flux * a->third;
        if (offset == side) return m;
        all.flux -= m.flux;
        all.mean -= m.mean;
        all.square -= m.square;
    }
    return all;
}

// Moments of the light that moves by `offset`, of the source's light `from`.
static struct moments moved_moments(const struct moments *from, const int offset[3])
{
    struct axis axes[3];
    struct moved moved[3];
    struct moments out = { .flux = from->flux };
    for (int a = 0; a < 3; a++) {
        axes[a] = axis_of(from->along[a] / from->flux, from->second[a][a] / from->flux);
        moved[a] = moved_by(&axes[a], offset[a]);
        out.flux *= moved[a].flux;
    }
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        const double rest = from->flux * moved[b].flux * moved[c].flux;
        out.along[a] += rest * moved[a].mean;
        out.second[a][a] += rest * moved[a].square;
        // The squares along the other axes make up for the difference, the means half as much.
        const double difference =
            (axes[a].square * moved[a].flux - moved[a].square) / fmax(1.0 - axes[a].square, 1e-3);
        out.second[b][b] += axes[b].square * difference * rest;
        out.second[c][c] += axes[c].square * difference * rest;
        out.along[b] += 0.5 * from->flux * moved[b].mean * moved[c].flux * difference;
        out.along[c] += 0.5 * from->flux * moved[c].mean * moved[b].flux * difference;
        const double covariance = from->second[a][b] / from->flux - axes[a].mean * axes[b].mean;
        out.second[a][b] = out.second[b][a] =
            from->flux * moved[c].flux * moved[a].mean * moved[b].mean + out.flux * covariance;
    }
    return out;
}

void product_send(const double light[9], const int offset[3],
                  const struct lpv_lobe_weights *weights, double transmittance, double to[9])
{
    const struct moments from = moments_of(light);
    if (from.flux <= 0.0 || transmittance == 0.0) return;
    const struct moments sent = moved_moments(&from, offset);
    double added[9] = { 0 };
    add(added, &sent, weights);
    for (int i = 0; i < 9; i++) to[i] += transmittance * added[i];
}

double product_irradiance(const double light[9], vec3s normal)
{
    const struct moments m = moments_of(light);
    if (m.flux <= 0.0) return 0.0;
    double mean = 0.0, square = 0.0;
    for (int a = 0; a < 3; a++) {
        mean -= (double)normal.raw[a] * m.along[a] / m.flux;
        for (int b = 0; b < 3; b++)
            square += (double)(normal.raw[a] * normal.raw[b]) * m.second[a][b] / m.flux;
    }
    const struct axis axis = axis_of(mean, square);
    return m.flux * moved_by(&axis, 1).flux;
}
