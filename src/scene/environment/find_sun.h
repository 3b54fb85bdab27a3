// Takes a small bright sun out of an equirectangular image. As a directional light it has sharp
// shadows and needs few samples; the rest of the image is smooth.
//
// A sun is the connected region about the brightest texel whose luminance exceeds 8 times the mean
// of the ring of 5° to 10° about it, if
// - the region is smaller than a disc of 3° radius and within 6° of the brightest texel, and
// - its excess over the ring lights a surface that faces it by at least a tenth of π times the mean
//   radiance of the image.
#pragma once

#include "core/vec.h"
#include "image/image.h"

struct environment_sun {
    bool found;
    vec3s to_sun;          // unit vector, the mean direction of the excess by luminance
    vec3s illuminance_lux; // of the excess at normal incidence, by colour
    float radius_rad;      // of the uniform disc with the same Σ L·Δω and Σ L²·Δω
};

// The image (equirect.h) has 3 channels in cd/m². The excess of a sun is subtracted: by colour,
// Σ L·Δω before is Σ L·Δω after plus the illuminance. Images without a sun, or with values that
// are not finite, are not changed. Texels must be smaller than the sun: below about 70 columns none
// is found. False: other channels, or no memory; the image is not changed.
bool environment_extract_sun(struct host *host, struct image *equirect,
                             struct environment_sun *out);
