#include "techniques/ort/bake/profile.h"

#include <math.h>

static const double PI_2 = 6.283185307179586;

// Jensen et al. 2001, figure 5: reduced scattering and absorption coefficients by colour, 1/mm, and
// the refractive index. In the order of the option `material`, after the exponential.
static const struct material {
    double scattering[3], absorption[3], index;
} MATERIALS[] = {
    { { 2.29, 2.39, 1.97 }, { 0.0030, 0.0034, 0.046 }, 1.3 },  // apple
    { { 0.15, 0.21, 0.38 }, { 0.015, 0.077, 0.19 }, 1.3 },     // chicken1
    { { 0.19, 0.25, 0.32 }, { 0.018, 0.088, 0.20 }, 1.3 },     // chicken2
    { { 7.38, 5.47, 3.15 }, { 0.0002, 0.0028, 0.0163 }, 1.3 }, // cream
    { { 0.18, 0.07, 0.03 }, { 0.061, 0.97, 1.45 }, 1.3 },      // ketchup
    { { 2.19, 2.62, 3.00 }, { 0.0021, 0.0041, 0.0071 }, 1.5 }, // marble
    { { 0.68, 0.70, 0.55 }, { 0.0024, 0.0090, 0.12 }, 1.3 },   // potato
    { { 0.70, 1.22, 1.90 }, { 0.0014, 0.0025, 0.0142 }, 1.3 }, // skimmilk
    { { 0.74, 0.88, 1.01 }, { 0.032, 0.17, 0.48 }, 1.3 },      // skin1
    { { 1.09, 1.59, 1.79 }, { 0.013, 0.070, 0.145 }, 1.3 },    // skin2
    { { 2.55, 3.21, 3.77 }, { 0.0011, 0.0024, 0.014 }, 1.3 },  // wholemilk
};

// Internal reflection of diffuse light (Egan & Hilgeman 1973, as Jensen et al. cite it).
static double boundary_of(double index)
{
    const double reflected = -1.440 / (index * index) + 0.710 / index + 0.668 + 0.0636 * index;
    return (1.0 + reflected) / (1.0 - reflected);
}

static struct ort_profile dipole_of(const struct material *m, int colour)
{
    const double absorption = m->absorption[colour];
    const double extinction = m->scattering[colour] + absorption;
    struct ort_profile p = { .attenuation = sqrt(3.0 * absorption * extinction),
                             .alpha = m->scattering[colour] / extinction,
                             .real = 1.0 / extinction };
    p.virtual = p.real * (1.0 + 4.0 / 3.0 * boundary_of(m->index));
    p.total = 0.5 * p.alpha * (exp(-p.attenuation * p.real) + exp(-p.attenuation * p.virtual));
    return p;
}

struct ort_profile ort_profile_of(const struct ort_options *options, int colour)
{
    if (options->material == ORT_EXPONENTIAL)
        return (struct ort_profile){ .exponential = true,
                                     .falloff = (double)options->falloff,
                                     .total = 1.0 };
    return dipole_of(&MATERIALS[options->material - 1], colour);
}

// Flux of a source at a depth through the plane, 1/mm², without α′/4π.
static double source_at(const struct ort_profile *p, double depth, double r)
{
    const double distance = sqrt(r * r + depth * depth);
    return depth * (p->attenuation + 1.0 / distance) * exp(-p->attenuation * distance) /
           (distance * distance);
}

// Its integral beyond r, without α′/2.
static double source_beyond(const struct ort_profile *p, double depth, double r)
{
    const double distance = sqrt(r * r + depth * depth);
    return depth * exp(-p->attenuation * distance) / distance;
}

double ort_profile_at(const struct ort_profile *p, double r)
{
    if (p->exponential) return exp(-r / p->falloff) / (PI_2 * p->falloff * p->falloff);
    return p->alpha / (2.0 * PI_2) * (source_at(p, p->real, r) + source_at(p, p->virtual, r)) /
           p->total;
}

double ort_profile_beyond(const struct ort_profile *p, double r)
{
    if (p->exponential) return (1.0 + r / p->falloff) * exp(-r / p->falloff);
    return 0.5 * p->alpha * (source_beyond(p, p->real, r) + source_beyond(p, p->virtual, r)) /
           p->total;
}

double ort_profile_reach(const struct ort_profile *p, double share)
{
    double low = 0.0, high = 1.0;
    while (ort_profile_beyond(p, high) > share) high *= 2.0;
    for (int i = 0; i < 40; i++) {
        const double middle = 0.5 * (low + high);
        *(ort_profile_beyond(p, middle) > share ? &low : &high) = middle;
    }
    return high;
}
