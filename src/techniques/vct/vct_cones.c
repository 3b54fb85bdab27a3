#include "techniques/vct/vct_cones.h"

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

static double wrap(double x)
{
    return x - floor(x);
}

// Solid angle is proportional to height z = cos θ (Archimedes): a ring between heights a > b has
// 2π(a − b) sr, and ∫ cos dω = π(a² − b²). Its cones point to the height at which half of that
// integral lies above, or with `number` to others, evenly in its share and in angle.
void vct_cone_set_turned(int choice, uint32_t number, struct vct_cone *out)
{
    const int count = sets[choice].count;
    int done = 0;
    for (int ring = 0; done < count; ring++) {
        const int parts = sets[choice].rings[ring];
        const double a = 1.0 - (double)done / count, b = 1.0 - (double)(done + parts) / count;
        for (int i = 0; i < parts; i++, done++) {
            // Two numbers of every set that fill the square evenly (Roberts 2018, the sequence R2),
            // begun elsewhere for each cone, so that what one sees more of others see less.
            const double begin = number == 0 ? 0.5 : 0.5 + 0.6180339887498949 * done;
            const double x = wrap(begin + 0.5698402909980532 * number);
            const double y = wrap(begin + 0.7548776662466927 * number);
            // Not to a ring's ends: the lowest cones would meet the surface that they start from.
            const double share = 0.5 + 0.7 * (y - 0.5);
            const double z = parts == 1 ? 1.0 : sqrt(b * b + share * (a * a - b * b));
            // Every other ring is turned by half a part.
            const double phi = 2.0 * GLM_PI * (i + 0.5 * (ring % 2) + x - 0.5) / parts;
            const double r = sqrt(1.0 - z * z);
            out[done].direction = vec3_of((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
            out[done].weight = (float)(GLM_PI * (a * a - b * b) / parts);
        }
    }
}

void vct_cone_set(int choice, struct vct_cone *out)
{
    vct_cone_set_turned(choice, 0, out);
}

// A cone of half-angle h has 2π(1 − cos h) sr. One cone for all would have no width to speak of its
// edge: it is taken for the one around which the cosine is concentrated, with ∫ cos dω = π/2
// inside: half-angle 45°.
float vct_cone_width(int choice)
{
    const double c = choice == VCT_CONES_1 ? sqrt(0.5) : 1.0 - 1.0 / sets[choice].count;
    return (float)(2.0 * sqrt(1.0 - c * c) / c);
}
