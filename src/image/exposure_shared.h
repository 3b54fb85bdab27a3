// Automatic exposure: constants of the CPU's version (exposure.c) and the GPU's (frame/composite).
//
// Metered are the pixels of a regular grid. Their luminances go into a histogram whose bins are
// ranges of the leading bits of a float: twice the light moves each pixel by exactly one octave of
// bins, and a histogram does not depend on the order of its additions.
#ifndef AG_IMAGE_EXPOSURE_SHARED_H
#define AG_IMAGE_EXPOSURE_SHARED_H

#define EXPOSURE_SAMPLES     16384 // pixels of the grid, at most
#define EXPOSURE_BIN_SHIFT   17    // of a float's bits to its bin
#define EXPOSURE_OCTAVE_BITS 6     // 64 bins per octave
#define EXPOSURE_BIAS        127   // exponent of a float

// Luminances below and above these percentiles of the lit pixels are clamped to them.
#define EXPOSURE_LOW  0.1f
#define EXPOSURE_HIGH 0.9f

// Metering by highlights: this percentile of the lit pixels is exposed to 1 at most. LOSS, EV: the
// image is at most that much darker than by its mean.
#define EXPOSURE_HIGHLIGHTS      0.98f
#define EXPOSURE_HIGHLIGHTS_LOSS 3.0f

#define EXPOSURE_MIDDLE_GREY 0.18f
#define EXPOSURE_EV_STEPS    65536  // per EV
#define EXPOSURE_EV_LIMIT    100.0f // keeps exposure_scale a normal float

// Values of enum exposure_metering.
#define EXPOSURE_METERING_MEAN       0
#define EXPOSURE_METERING_HIGHLIGHTS 1

#endif
