// Automatic exposure: the log-average luminance (Reinhard et al. 2002, eq. 1) between two
// percentiles becomes middle grey. docs/units.md states the rules.
#pragma once

#include "image/exposure_shared.h"
#include "image/image.h"

#include <stdint.h>

// In the order of ag_metering.
enum exposure_metering {
    METERING_MEAN = EXPOSURE_METERING_MEAN,
    // Darker where bright parts would burn out.
    METERING_HIGHLIGHTS = EXPOSURE_METERING_HIGHLIGHTS,
};

// Size of the grid's cells in pixels; the middle of each is metered.
uint32_t exposure_stride(uint32_t width, uint32_t height);
// The EV of a radiance image; 0 if it is black. Of images with 4 channels, pixels with an alpha of
// 0 do not count. Black, negative, NaN and infinite pixels count as the low percentile.
float auto_exposure(const struct image *radiance, enum exposure_metering metering);
