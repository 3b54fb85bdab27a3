// Writes the table of the GGX lobe's directional albedo that src/core/ggx_albedo.c includes, and
// the polynomials of its mean:
//
//     make_ggx_albedo > src/core/ggx_albedo.inc
//     make_ggx_albedo mean                         prints the coefficients for ggx_albedo.h and
//     .glsl
//
// The integrals are over visible normals (Heitz 2018), with D cancelled by the density: smooth
// integrands for any roughness. Midpoint rule; the radius is r² = 1 − y³, which is dense at the rim
// of the disk, where normals are steep. 192² points are within 10⁻⁵ of 1024².
#include "core/ggx_albedo.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { STEPS = 192, MEAN_STEPS = 96, TERMS = GGX_ALBEDO_MEAN_TERMS };

static const double PI = 3.14159265358979323846;

struct pair {
    double a, b; // a: of F0, b: of F90
};

// Weight F G2/G1 of one microfacet normal h, whose reflection of the viewer (sine, 0, cosine) is l.
static struct pair weight_of(const double h[3], double cosine, double sine, double alpha)
{
    const double a2 = alpha * alpha, v_h = sine * h[0] + cosine * h[2];
    const double n_l = 2.0 * v_h * h[2] - cosine;
    if (!(v_h > 0.0) || !(n_l > 0.0)) return (struct pair){ 0 };
    const double smith_v = sqrt(cosine * cosine * (1.0 - a2) + a2);
    const double smith_l = sqrt(n_l * n_l * (1.0 - a2) + a2);
    const double visibility = 0.5 / (n_l * smith_v + cosine * smith_l); // G2 / (4 n·l n·v)
    const double masking = 2.0 * cosine / (cosine + smith_v);           // G1
    const double weight = 4.0 * visibility * n_l * cosine / masking;
    const double schlick = pow(1.0 - v_h, 5.0);
    return (struct pair){ weight * (1.0 - schlick), weight * schlick };
}

// The visible normal of a point of the unit disk (Heitz 2018, listing 1). The disk's first axis is
// perpendicular to the plane of normal and viewer, so that both halves are equal.
static struct pair at_point(double radius, double angle, double cosine, double sine, double alpha)
{
    const double length = hypot(alpha * sine, cosine);
    const double x = alpha * sine / length, z = cosine / length; // the stretched viewer
    const double s = 0.5 * (1.0 + z), p1 = radius * sin(angle);
    const double p2 = (1.0 - s) * sqrt(1.0 - p1 * p1) + s * radius * cos(angle);
    const double p3 = sqrt(fmax(0.0, 1.0 - p1 * p1 - p2 * p2));
    double h[3] = { alpha * (p3 * x - p2 * z), alpha * p1, fmax(p2 * x + p3 * z, 1e-12) };
    const double norm = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int i = 0; i < 3; i++) h[i] /= norm;
    return weight_of(h, cosine, sine, alpha);
}

static struct pair albedo_of(double cosine, double roughness, int steps)
{
    const double alpha = roughness * roughness, sine = sqrt(1.0 - cosine * cosine);
    struct pair sum = { 0 };
    for (int i = 0; i < steps; i++) {
        const double y = 1.0 - (i + 0.5) / steps, density = 3.0 * y * y;
        for (int k = 0; k < steps; k++) {
            const struct pair p =
                at_point(sqrt(1.0 - y * y * y), PI * (k + 0.5) / steps, cosine, sine, alpha);
            sum.a += density * p.a;
            sum.b += density * p.b;
        }
    }
    return (struct pair){ sum.a / (steps * steps), sum.b / (steps * steps) };
}

// Over the hemisphere, weighted by the cosine: 2 ∫ μ E(μ) dμ = ∫ E d(μ²).
static struct pair mean_of(double roughness)
{
    struct pair sum = { 0 };
    for (int i = 0; i < MEAN_STEPS; i++) {
        const struct pair p = albedo_of(sqrt((i + 0.5) / MEAN_STEPS), roughness, MEAN_STEPS);
        sum.a += p.a / MEAN_STEPS;
        sum.b += p.b / MEAN_STEPS;
    }
    return sum;
}

static void print_table(void)
{
    printf("// Written by tools/ggx_albedo; ggx_albedo.h describes the layout.\n");
    for (int j = 0; j < GGX_ALBEDO_SIZE; j++) {
        for (int i = 0; i < GGX_ALBEDO_SIZE; i++) {
            const struct pair p = albedo_of(fmax((double)ggx_albedo_node_cosine(i), 1e-4),
                                            (double)ggx_albedo_node_roughness(j), STEPS);
            const unsigned a = (unsigned)lrint(p.a * 65535.0), b = (unsigned)lrint(p.b * 65535.0);
            printf("0x%08x,%s", a | b << 16, i % 8 == 7 ? "\n" : " ");
        }
    }
}

// Least squares by the normal equations, solved by elimination.
static void fit(const double *x, const double *y, int count, double out[TERMS])
{
    double m[TERMS][TERMS + 1] = { 0 };
    for (int i = 0; i < count; i++) {
        double powers[TERMS] = { 1.0 };
        for (int k = 1; k < TERMS; k++) powers[k] = powers[k - 1] * x[i];
        for (int r = 0; r < TERMS; r++) {
            for (int c = 0; c < TERMS; c++) m[r][c] += powers[r] * powers[c];
            m[r][TERMS] += powers[r] * y[i];
        }
    }
    for (int p = 0; p < TERMS; p++) {
        for (int r = 0; r < TERMS; r++) {
            if (r == p) continue;
            const double factor = m[r][p] / m[p][p];
            for (int c = p; c <= TERMS; c++) m[r][c] -= factor * m[p][c];
        }
    }
    for (int p = 0; p < TERMS; p++) out[p] = m[p][TERMS] / m[p][p];
}

static void print_fit(const char *name, const double *x, const double *y, int count)
{
    double c[TERMS], worst = 0.0;
    fit(x, y, count, c);
    for (int i = 0; i < count; i++) {
        double v = 0.0;
        for (int k = TERMS - 1; k >= 0; k--) v = v * x[i] + c[k];
        worst = fmax(worst, fabs(v - y[i]));
    }
    printf("%s:", name);
    for (int k = 0; k < TERMS; k++) printf(" %.7f", c[k]);
    printf("   largest error %.2e\n", worst);
}

static void print_mean(void)
{
    enum { COUNT = 49 };
    double x[COUNT], a[COUNT], b[COUNT];
    for (int i = 0; i < COUNT; i++) {
        const double least = (double)GGX_MIN_ROUGHNESS;
        x[i] = least + (1.0 - least) * i / (COUNT - 1);
        const struct pair p = mean_of(x[i]);
        a[i] = p.a;
        b[i] = p.b;
    }
    print_fit("A", x, a, COUNT);
    print_fit("B", x, b, COUNT);
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "mean") == 0)
        print_mean();
    else
        print_table();
    return 0;
}
