#include "techniques/lpv/lpv_twin_closed.h"

#include <math.h>

// Index in the order of core/sh.h of the coefficient of band 1 along an axis.
static const int BAND_1[3] = { 3, 1, 2 };

struct mixture {
    double isotropic, hemisphere, beam; // fluxes; they sum to the light's
    double direction[3];                // of the hemisphere and the beam
};

static double band_0(void)
{
    return sqrt(1.0 / (4.0 * GLM_PI));
}

static double band_1(void)
{
    return sqrt(3.0 / (4.0 * GLM_PI));
}

// The mean cosine of a hemisphere is 1/2.
static struct mixture mixture_of(const double light[9])
{
    const double flux = light[0] / band_0();
    double moment[3], size = 0.0;
    for (int a = 0; a < 3; a++) {
        moment[a] = light[BAND_1[a]] / band_1();
        size += moment[a] * moment[a];
    }
    size = sqrt(size);
    struct mixture m = { .direction = { 0 } };
    for (int a = 0; a < 3 && size > 0.0; a++) m.direction[a] = moment[a] / size;
    size = fmin(size, flux);
    m.beam = fmax(2.0 * size - flux, 0.0);
    m.hemisphere = 2.0 * (size - m.beam);
    m.isotropic = flux - m.beam - m.hemisphere;
    return m;
}

static double steps_of(const double direction[3])
{
    return fabs(direction[0]) + fabs(direction[1]) + fabs(direction[2]);
}

// Moments of light of unit flux across the side ±axis: flux, and flux × mean direction.
struct moments {
    double flux, along[3];
};

static void add(struct moments *to, double weight, struct moments light)
{
    to->flux += weight * light.flux;
    for (int a = 0; a < 3; a++) to->along[a] += weight * light.along[a];
}

// A sixth crosses each side, with the mean cosine 2/3; under the pressure of a cone more.
static struct moments isotropic(int axis, double side, double pressure)
{
    struct moments out = { .flux = 1.0 / 6.0 };
    out.along[axis] = side * pressure / 9.0;
    return out;
}

// The flux is that of light 1 + 3/2 n·ω, the moments those of a hemisphere around an axis, with the
// part that goes along a side that the hemisphere's light crosses reduced.
static struct moments hemisphere(const double n[3], int axis, double side, double pressure)
{
    struct moments out = isotropic(axis, side, pressure);
    out.flux += side * n[axis] / 6.0;
    for (int a = 0; a < 3; a++) {
        const double along = 5.0 / 72.0 * (1.0 - 0.6 * n[axis] * n[axis]);
        const double left = 5.0 / 72.0 * (1.0 - 0.6 * (1.0 - n[axis] * n[axis]) / 2.0);
        out.along[a] += n[a] * (a == axis ? 0.25 - 2.0 * left : along);
    }
    return out;
}

static struct moments beam(const double n[3], int axis, double side)
{
    const double steps = steps_of(n);
    struct moments out = { .flux = steps > 0.0 ? fmax(side * n[axis], 0.0) / steps : 0.0 };
    for (int a = 0; a < 3; a++) out.along[a] = out.flux * n[a];
    return out;
}

void closed_send(const double light[9], const int offset[3], double focus, double transmittance,
                 double to[9])
{
    const struct mixture m = mixture_of(light);
    const int axis = offset[0] ? 0 : offset[1] ? 1 : 2;
    const double side = offset[axis], flux = m.isotropic + m.hemisphere + m.beam;
    const double across = 1.0 - m.direction[axis] * m.direction[axis];
    const double pressure = flux > 0.0 ? 1.0 + 0.5 * m.beam / flux * across : 1.0;
    struct moments sum = { 0 };
    add(&sum, m.isotropic, isotropic(axis, side, pressure));
    add(&sum, m.hemisphere, hemisphere(m.direction, axis, side, pressure));
    add(&sum, m.beam, beam(m.direction, axis, side));
    to[0] += transmittance * band_0() * sum.flux;
    for (int a = 0; a < 3; a++) to[BAND_1[a]] += transmittance * focus * band_1() * sum.along[a];
}

double closed_irradiance(const double light[9], vec3s normal)
{
    const struct mixture m = mixture_of(light);
    double cosine = 0.0;
    for (int a = 0; a < 3; a++) cosine -= m.direction[a] * (double)normal.raw[a];
    const double steps = steps_of(m.direction);
    return 0.25 * m.isotropic + 0.25 * m.hemisphere * (1.0 + cosine) +
           (m.beam > 0.0 ? 1.5 * m.beam * fmax(cosine, 0.0) / steps : 0.0);
}
