#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// The exposure value from the histogram of metered luminances: the GPU's version of
// image/exposure.c. One work group; each thread has a run of neighbouring bins.
#include "frame/frame.glsl"
#include "frame/composite/exposure_shared.h"

layout(local_size_x = EXPOSURE_THREADS) in;

layout(set = 0, binding = 1, scalar) buffer exposure_state
{
    exposure_values state;
};
layout(set = 0, binding = 2, scalar) readonly buffer exposure_histogram
{
    exposure_counts histogram;
};

layout(push_constant, scalar) uniform push_block
{
    exposure_push push;
};

const uint RUN = EXPOSURE_BINS / EXPOSURE_THREADS;
const int LOW = 0, HIGH = 1, HIGHLIGHTS = 2;

shared uint counts[EXPOSURE_THREADS]; // of lit pixels, per run
shared float sums[EXPOSURE_THREADS];  // of log2 luminances
shared uint percentiles[3];           // bins

// log2 of the luminance in the middle of a bin.
float bin_log2(uint bin)
{
    uint octave = 1 << EXPOSURE_OCTAVE_BITS;
    uint all = bin + EXPOSURE_FIRST_BIN;
    float fraction = (float(all % octave) + 0.5) / float(octave);
    return float(int(all / octave) - EXPOSURE_BIAS) + log2(1.0 + fraction);
}

uint sum_of_counts(uint end)
{
    uint sum = 0;
    for (uint i = 0; i < end; i++) sum += counts[i];
    return sum;
}

// Lowest bin up to which more than a share of the lit pixels lie; one thread has it in its run.
void find_percentile(int which, float wanted, uint before, uint first)
{
    uint sum = before;
    for (uint i = 0; i < RUN; i++) {
        bool below = float(sum) <= wanted;
        sum += histogram.lit[first + i];
        if (below && float(sum) > wanted) percentiles[which] = first + i;
    }
}

float sum_of_run(uint first)
{
    float sum = 0.0;
    for (uint i = 0; i < RUN; i++) {
        uint bin = clamp(first + i, percentiles[LOW], percentiles[HIGH]);
        sum += float(histogram.lit[first + i]) * bin_log2(bin);
    }
    return sum;
}

float mean_log2(uint lit)
{
    float sum = float(histogram.black) * bin_log2(percentiles[LOW]);
    for (uint i = 0; i < EXPOSURE_THREADS; i++) sum += sums[i];
    return sum / float(lit + histogram.black);
}

// log2 of the luminance that becomes middle grey.
float metered_log2(uint lit)
{
    float mean = mean_log2(lit);
    if (push.metering != EXPOSURE_METERING_HIGHLIGHTS) return mean;
    float bright = bin_log2(percentiles[HIGHLIGHTS]) + log2(EXPOSURE_MIDDLE_GREY);
    return clamp(bright, mean, mean + EXPOSURE_HIGHLIGHTS_LOSS);
}

void main()
{
    uint thread = gl_LocalInvocationID.x, first = thread * RUN;
    uint own = 0;
    for (uint i = 0; i < RUN; i++) own += histogram.lit[first + i];
    counts[thread] = own;
    barrier();
    uint lit = sum_of_counts(EXPOSURE_THREADS), before = sum_of_counts(thread);
    find_percentile(LOW, EXPOSURE_LOW * float(lit), before, first);
    find_percentile(HIGH, EXPOSURE_HIGH * float(lit), before, first);
    find_percentile(HIGHLIGHTS, EXPOSURE_HIGHLIGHTS * float(lit), before, first);
    barrier();
    sums[thread] = lit > 0 ? sum_of_run(first) : 0.0;
    barrier();
    if (thread != 0) return;
    float metered = lit > 0 ? metered_log2(lit) : log2(max(push.fallback, 1e-30));
    // exposure_scale(ev) · metered = middle grey, with metered in physical units. Rounded so that
    // twice the light adds exactly 1.
    float scaled = metered - log2(1.2 * EXPOSURE_MIDDLE_GREY);
    scaled = round(scaled * EXPOSURE_EV_STEPS) / EXPOSURE_EV_STEPS;
    float ev = scaled - round(log2(frame.radiance_scale)); // the scale is a power of two
    bool any = lit > 0 || push.fallback > 0.0;
    ev = any ? clamp(ev, -EXPOSURE_EV_LIMIT, EXPOSURE_EV_LIMIT) : 0.0;
    float last = state.ev;
    state.ev = mix(last + (ev - last) * push.share, ev, push.share >= 1.0);
}
