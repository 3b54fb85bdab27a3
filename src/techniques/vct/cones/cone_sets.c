#include "techniques/vct/cones/cone_sets.h"

#include <math.h>

// Cones per ring, from the pole to the horizon; the first ring is the cap.
static const struct {
    int count, rings[4];
} sets[] = {
    [VCT_CONES_1] = { 1, { 1 } },          [VCT_CONES_5] = { 5, { 1, 4 } },
    [VCT_CONES_6] = { 6, { 1, 5 } },       [VCT_CONES_9] = { 9, { 1, 8 } },
    [VCT_CONES_16] = { 16, { 1, 5, 10 } }, [VCT_CONES_25] = { 25, { 1, 8, 16 } },
};

int vct_cone_count(int choice)
{
    return sets[choice].count;
}

// The solid angle between heights a > b, z = cos θ, is 2π(a − b) (Archimedes), and ∫ cos θ dω is
// π(a² − b²). The cones of a ring point to the height that halves this integral.
void vct_cone_set(int choice, struct vct_cone *out)
{
    const int count = sets[choice].count;
    int done = 0;
    for (int ring = 0; done < count; ring++) {
        const int parts = sets[choice].rings[ring];
        const double a = 1.0 - (double)done / count, b = 1.0 - (double)(done + parts) / count;
        const double z = parts == 1 ? 1.0 : sqrt(0.5 * (a * a + b * b)), r = sqrt(1.0 - z * z);
        for (int i = 0; i < parts; i++, done++) {
            // Odd rings are rotated by half a cone.
            const double phi = 2.0 * GLM_PI * ((double)i + 0.5 * (ring % 2)) / parts;
            out[done].direction = vec3_of((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
            out[done].weight = (float)(GLM_PI * (a * a - b * b) / parts);
        }
    }
}

// A cone of half-angle h has 2π(1 − cos h) sr. For a single cone h would be 90°, of infinite
// width; 45° contains half of the cosine-weighted hemisphere, ∫ cos θ dω = π/2.
float vct_cone_width(int choice)
{
    const double c = choice == VCT_CONES_1 ? sqrt(0.5) : 1.0 - 1.0 / sets[choice].count;
    return (float)(2.0 * sqrt(1.0 - c * c) / c);
}

// Axes of sets of lines, the third in the middle of the hemisphere. They are oblique to walls,
// which are mostly axis-aligned: otherwise some lines would lie in the plane of a wall and sample
// nothing. Of eight of them these have the least error in the scenes of tests/quality.
static void oblique_axes(vec3s out[3])
{
    out[2] = glms_vec3_normalize(vec3_of(10, 1, 3));
    out[0] = glms_vec3_normalize(glms_vec3_cross(out[2], vec3_of(0.31f, 0.2f, 0.7f)));
    out[1] = glms_vec3_cross(out[2], out[0]);
}

// Initial lines: a golden-angle spiral over a hemisphere.
static vec3s spiral(int i, int count)
{
    const double golden = GLM_PI * (3.0 - sqrt(5.0));
    const double z = (i + 0.5) / count, r = sqrt(1.0 - z * z);
    vec3s axes[3];
    oblique_axes(axes);
    const vec3s across = glms_vec3_add(glms_vec3_scale(axes[0], (float)(r * cos(golden * i))),
                                       glms_vec3_scale(axes[1], (float)(r * sin(golden * i))));
    return glms_vec3_add(across, glms_vec3_scale(axes[2], (float)z));
}

// Coulomb force on the charge at the end of line `at` from both ends of all other lines.
static vec3s repulsion_on(const vec3s *lines, int count, int at)
{
    vec3s sum = vec3_of(0, 0, 0);
    for (int i = 0; i < 2 * count; i++) {
        if (i / 2 == at) continue;
        const vec3s end = i % 2 ? glms_vec3_negate(lines[i / 2]) : lines[i / 2];
        const vec3s offset = glms_vec3_sub(lines[at], end);
        const float d2 = glms_vec3_norm2(offset);
        sum = glms_vec3_add(sum, glms_vec3_scale(offset, 1.0f / (d2 * sqrtf(d2))));
    }
    return sum;
}

// Equal charges at both ends of each line repel each other (Thomson problem).
void vct_cone_axes(int choice, vec3s *out)
{
    enum { STEPS = 200 };
    const int count = sets[choice].count;
    for (int i = 0; i < count; i++) out[i] = spiral(i, count);
    // The force on a charge grows with count, the mean distance falls with its square root.
    const float step = 0.5f / ((float)count * sqrtf((float)count));
    for (int k = 0; k < STEPS; k++)
        for (int i = 0; i < count; i++)
            out[i] = glms_vec3_normalize(
                glms_vec3_add(out[i], glms_vec3_scale(repulsion_on(out, count, i), step)));
}

static double wrap(double x)
{
    return x - floor(x);
}

// Unit quaternion (x, y, z; w) from three numbers in 0…1: uniform numbers give uniform rotations
// (Shoemake 1992).
static vec4s rotation_of(double u, double v, double w)
{
    const double a = sqrt(1.0 - u), b = sqrt(u), p = 2.0 * GLM_PI * v, q = 2.0 * GLM_PI * w;
    return (vec4s){ { (float)(a * sin(p)), (float)(a * cos(p)), (float)(b * sin(q)),
                      (float)(b * cos(q)) } };
}

void vct_rotate_cone_axes(uint32_t number, int count, vec3s *lines)
{
    if (number == 0) return;
    // Low-discrepancy sequence R3 (Roberts 2018).
    const vec4s rotation =
        rotation_of(wrap(0.8191725133961645 * number), wrap(0.6710436067037893 * number),
                    wrap(0.5497004779019702 * number));
    const vec3s axis = vec3_of(rotation.x, rotation.y, rotation.z);
    for (int i = 0; i < count; i++) {
        const vec3s across = glms_vec3_scale(glms_vec3_cross(axis, lines[i]), 2.0f);
        lines[i] = glms_vec3_add(glms_vec3_add(lines[i], glms_vec3_scale(across, rotation.w)),
                                 glms_vec3_cross(axis, across));
    }
}

void vct_stratum_axes(uint32_t number, vec3s out[3])
{
    oblique_axes(out);
    vct_rotate_cone_axes(number, 3, out);
}
