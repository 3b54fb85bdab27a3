// Cone tracing in plain C: twin of cones/trace.glsl and volume/sample.glsl for anisotropic mips.
#pragma once

#include "techniques/vct/vct_fixture.h"

enum { VCT_TWIN_DIRECTIONS = 6, VCT_TWIN_LEVELS = 8 };

// A level of the light volume.
struct vct_twin_volume {
    float *light; // to be freed
    int dim;      // texels along a side of one direction
    int size[3];  // in use
};

struct vct_twin_volume vct_twin_volume(const struct vct_fixture *fixture, uint32_t level);
// Premultiplied radiance and opacity.
const float *vct_twin_texel(const struct vct_twin_volume *v, int direction, const int at[3]);
bool vct_twin_in_use(const struct vct_twin_volume *v, const int at[3]);

// All levels of the fixture's volume.
struct vct_twin {
    struct vct_twin_volume levels[VCT_TWIN_LEVELS];
    int level_count;
    bool occlusion;
    double decay, offset; // per texel; texels
};

struct vct_twin vct_twin_of(const struct vct_fixture *fixture);
void vct_twin_finish(struct vct_twin *twin);

// Premultiplied radiance and opacity of a cone. Lengths are in texels. surface: a point of the
// surface of that normal; wide: cone width in texels over the distance. For vctao the attenuated
// occlusion replaces radiance.
void vct_twin_trace(const struct vct_twin *twin, const double surface[3], const double normal[3],
                    const double direction[3], double wide, double sum[4]);
