// Cones through the light volume in plain C, as cones/trace.glsl and volume/sample.glsl say them.
// Six ways, mips.
#pragma once

#include "techniques/vct_rig.h"

enum { VCT_TWIN_WAYS = 6, VCT_TWIN_LEVELS = 8 };

// A level of the light volume.
struct vct_twin_volume {
    float *light; // to be freed
    int dim;      // texels along a side of one way
    int size[3];  // in use
};

struct vct_twin_volume vct_twin_volume(const struct vct_rig *rig, uint32_t level);
// Premultiplied radiance and opacity.
const float *vct_twin_texel(const struct vct_twin_volume *v, int way, const int at[3]);
bool vct_twin_in_use(const struct vct_twin_volume *v, const int at[3]);

// All levels of the rig's volume.
struct vct_twin {
    struct vct_twin_volume levels[VCT_TWIN_LEVELS];
    int level_count;
    bool occlusion;
    double decay, offset; // per texel; texels
};

struct vct_twin vct_twin_of(const struct vct_rig *rig);
void vct_twin_finish(struct vct_twin *twin);

// Premultiplied radiance and opacity along a cone. Lengths in texels; from: where it starts, off a
// surface of that normal; wide: width of texels over the distance. Of a rig of occlusion what is
// hidden is in place of the radiance.
void vct_twin_trace(const struct vct_twin *twin, const double from[3], const double normal[3],
                    const double direction[3], double wide, double sum[4]);
