#include "techniques/vct/cones/cone_sets.h"

#include <math.h>

// Cones in each ring, from the pole down; the first is the cap.
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

// Solid angle is proportional to height z = cos θ (Archimedes): a ring between heights a > b has
// 2π(a − b) sr, and ∫ cos dω = π(a² − b²). Its cones point to the height at which half of that
// integral lies above.
void vct_cone_set(int choice, struct vct_cone *out)
{
    const int count = sets[choice].count;
    int done = 0;
    for (int ring = 0; done < count; ring++) {
        const int parts = sets[choice].rings[ring];
        const double a = 1.0 - (double)done / count, b = 1.0 - (double)(done + parts) / count;
        const double z = parts == 1 ? 1.0 : sqrt(0.5 * (a * a + b * b)), r = sqrt(1.0 - z * z);
        for (int i = 0; i < parts; i++, done++) {
            // Every other ring is turned by half a part.
            const double phi = 2.0 * GLM_PI * ((double)i + 0.5 * (ring % 2)) / parts;
            out[done].direction = vec3_of((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
            out[done].weight = (float)(GLM_PI * (a * a - b * b) / parts);
        }
    }
}

// A cone of half-angle h has 2π(1 − cos h) sr. One cone for all would have no width to speak of its
// edge: it is taken for the one around which the cosine is concentrated, with ∫ cos dω = π/2
// inside: half-angle 45°.
float vct_cone_width(int choice)
{
    const double c = choice == VCT_CONES_1 ? sqrt(0.5) : 1.0 - 1.0 / sets[choice].count;
    return (float)(2.0 * sqrt(1.0 - c * c) / c);
}

// Where the lines begin to move: the upper half of a spiral around an axis that no wall of a scene
// is likely to have, since on walls at right angles to a line's circle others lie in the wall and
// find nothing. Of eight axes the one with the least error in the rooms of tests/quality.
static vec3s spiral(int i, int count)
{
    const double golden = GLM_PI * (3.0 - sqrt(5.0));
    const double z = (i + 0.5) / count, r = sqrt(1.0 - z * z);
    const vec3s axis = glms_vec3_normalize(vec3_of(10, 1, 3));
    const vec3s x = glms_vec3_normalize(glms_vec3_cross(axis, vec3_of(0.31f, 0.2f, 0.7f)));
    const vec3s y = glms_vec3_cross(axis, x);
    const vec3s across = glms_vec3_add(glms_vec3_scale(x, (float)(r * cos(golden * i))),
                                       glms_vec3_scale(y, (float)(r * sin(golden * i))));
    return glms_vec3_add(across, glms_vec3_scale(axis, (float)z));
}

// The force on a charge at the end `at` of a line from both ends of the others.
static vec3s push_of(const vec3s *lines, int count, int at)
{
    vec3s sum = vec3_of(0, 0, 0);
    for (int i = 0; i < 2 * count; i++) {
        if (i / 2 == at) continue;
        const vec3s end = i % 2 ? glms_vec3_negate(lines[i / 2]) : lines[i / 2];
        const vec3s off = glms_vec3_sub(lines[at], end);
        const float d2 = glms_vec3_norm2(off);
        sum = glms_vec3_add(sum, glms_vec3_scale(off, 1.0f / (d2 * sqrtf(d2))));
    }
    return sum;
}

// Equal charges at both ends of each line push each other apart (Thomson's problem).
void vct_cone_axes(int choice, vec3s *out)
{
    enum { STEPS = 200 };
    const int count = sets[choice].count;
    for (int i = 0; i < count; i++) out[i] = spiral(i, count);
    // The force of 2 · count charges on one grows with their number, their distance as its root.
    const float step = 0.5f / ((float)count * sqrtf((float)count));
    for (int k = 0; k < STEPS; k++)
        for (int i = 0; i < count; i++)
            out[i] = glms_vec3_normalize(
                glms_vec3_add(out[i], glms_vec3_scale(push_of(out, count, i), step)));
}

static double wrap(double x)
{
    return x - floor(x);
}

// A unit quaternion (x, y, z; w) for three numbers in 0…1: even numbers make even turns (Shoemake
// 1992).
static vec4s rotation_of(double u, double v, double w)
{
    const double a = sqrt(1.0 - u), b = sqrt(u), p = 2.0 * GLM_PI * v, q = 2.0 * GLM_PI * w;
    return (vec4s){ { (float)(a * sin(p)), (float)(a * cos(p)), (float)(b * sin(q)),
                      (float)(b * cos(q)) } };
}

void vct_rotate_cone_axes(uint32_t number, int count, vec3s *lines)
{
    if (number == 0) return;
    // Numbers that fill the cube evenly (Roberts 2018, the sequence R3).
    const vec4s turn =
        rotation_of(wrap(0.8191725133961645 * number), wrap(0.6710436067037893 * number),
                    wrap(0.5497004779019702 * number));
    const vec3s axis = vec3_of(turn.x, turn.y, turn.z);
    for (int i = 0; i < count; i++) {
        const vec3s across = glms_vec3_scale(glms_vec3_cross(axis, lines[i]), 2.0f);
        lines[i] = glms_vec3_add(glms_vec3_add(lines[i], glms_vec3_scale(across, turn.w)),
                                 glms_vec3_cross(axis, across));
    }
}
