// Reflections: a ray or a cone for each pixel, averaged over the lobe.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/cones/cones_shared.h"

// RGBA16F, of a view at full size.
struct vct_reflections {
    gpu_image arriving;    // radiance in the specular lobe
    gpu_image averaged[2]; // its mean over pixels and frames with its weight in frames, of this
                           // frame and of the previous one
};

struct vct_specular {
    gpu_pipeline trace[4]; // by vct_light_variant
    gpu_pipeline lobe_average, reflect;
};

struct vct_frame;
struct vct_temporal;

// temporal: NULL without it.
void vct_record_specular(const struct vct_specular *specular, const struct vct_reflections *images,
                         const struct vct_temporal *temporal, const struct vct_frame *frame);
// Metals reflect E/π, the mean radiance. Dielectrics reflect nothing: towards the horizon, where
// their reflectance grows, light from overhead is not.
void vct_record_metals(const struct vct_specular *specular, const struct vct_frame *frame);
