// Motions of texels and tangent frames.
#include "tube_symmetry.h"

#include "techniques/mrt/dictionary/prior.h"

static bool is_straight(const struct mrt_shape *tube)
{
    return tube->kind == MRT_TUBE;
}

int tube_orbits(const struct mrt_shape *tube)
{
    const int n = tube->resolution, half = (n + 1) / 2;
    return is_straight(tube) ? n : half * half;
}

int tube_representative(const struct mrt_shape *tube, int orbit)
{
    const int n = tube->resolution, half = (n + 1) / 2;
    return is_straight(tube) ? orbit * n : orbit / half * n + orbit % half;
}

int tube_orbit_of(const struct mrt_shape *tube, int texel, struct tube_motion *motion)
{
    const int n = tube->resolution, half = (n + 1) / 2;
    int around = texel % n, along = texel / n;
    *motion = (struct tube_motion){ 0 };
    if (is_straight(tube)) {
        motion->around = around;
        return along;
    }
    motion->up = around >= half;
    motion->ends = along >= half;
    if (motion->up) around = n - 1 - around;
    if (motion->ends) along = n - 1 - along;
    return along * half + around;
}

int tube_moved_texel(const struct mrt_shape *tube, struct tube_motion motion, int texel)
{
    const int n = tube->resolution;
    int around = (texel % n + motion.around) % n, along = texel / n;
    if (motion.up) around = n - 1 - around;
    if (motion.ends) along = n - 1 - along;
    return along * n + around;
}

// Linear SH are 1, y, z, x: y is around the tube and x along it.
static float moved_sign(struct tube_motion motion, int value)
{
    return (value == 1 && motion.up) || (value == 3 && motion.ends) ? -1.0f : 1.0f;
}

void tube_moved_rows(const struct mrt_shape *tube, struct tube_motion motion, int values,
                     const struct matrix_f32 *from, struct matrix_f32 *to)
{
    for (int t = 0; t < mrt_shape_texels(tube); t++) {
        const int moved = tube_moved_texel(tube, motion, t);
        for (int v = 0; v < values; v++)
            to->at[(size_t)v * to->stride + (size_t)moved] =
                moved_sign(motion, v) * from->at[(size_t)v * from->stride + (size_t)t];
    }
}

// Lights are in layers along the tube, of rows that are one above the other.
enum { LAYERS = 2 * PRIOR_BEYOND + PRIOR_LATTICE };

int tube_light_orbits(void)
{
    return LAYERS / 2 * (PRIOR_LATTICE / 2) * PRIOR_LATTICE;
}

int tube_light_representative(int orbit)
{
    const int half = PRIOR_LATTICE / 2 * PRIOR_LATTICE;
    return orbit / half * PRIOR_LATTICE * PRIOR_LATTICE + orbit % half;
}

struct tube_motion tube_bend_motion(int i)
{
    return (struct tube_motion){ 0, i & 1, i & 2 };
}

int tube_mirrored_texel(const struct mrt_shape *tube, int texel)
{
    const int n = tube->resolution;
    return texel / n * n + (n + n / 2 - 1 - texel % n) % n;
}

int tube_mirrored_probe(int probes, int probe)
{
    return probe / probes * probes + probes - 1 - probe % probes;
}

float tube_mirrored_sign(int values, int i)
{
    // x → −x turns the sign of x, xy and xz; of a texel's frame that of y, which is around.
    return (values == 4 ? i == 1 : values == 9 && (i == 3 || i == 4 || i == 7)) ? -1.0f : 1.0f;
}
