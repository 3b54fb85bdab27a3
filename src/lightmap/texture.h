// A map as an 8-bit texture, for engines that load nothing else.
#pragma once

#include "image/image.h"

// PNG with linear values: a byte of 255 is the irradiance *range, lux. At most one in a thousand
// lit texels is brighter, and clipped. An ordered dither hides steps: a value is off by less than
// one. The bytes are owned by the caller (host_free).
bool lightmap_texture(struct host *host, const struct image *map, uint8_t **png, size_t *size,
                      float *range);
