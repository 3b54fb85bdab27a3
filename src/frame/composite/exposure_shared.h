// State of automatic exposure on the GPU.
#ifndef AG_FRAME_EXPOSURE_SHARED_H
#define AG_FRAME_EXPOSURE_SHARED_H

#include "core/shared.h"
#include "image/exposure_shared.h"

// Bins of scaled luminances from 2^-32 to 2^18: what sums of half floats can be.
#define EXPOSURE_FIRST_BIN ((EXPOSURE_BIAS - 32) << EXPOSURE_OCTAVE_BITS)
#define EXPOSURE_BINS      (50 << EXPOSURE_OCTAVE_BITS)

#define EXPOSURE_THREADS 64 // of exposure_finish.comp, one group

// Content of the storage block "exposure_state".
struct exposure_values {
    float ev;
};

// Content of the storage block "exposure_histogram".
struct exposure_counts {
    uint32_t black; // surface pixels without light
    uint32_t lit[EXPOSURE_BINS];
};

struct exposure_push {
    float fallback;    // scaled luminance that is metered if no visible surface is lit
    float share;       // of this frame in the mean of EVs; 1: this frame alone
    uint32_t metering; // enum exposure_metering
};

#endif
