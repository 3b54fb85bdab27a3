// Radiance RGBE images (.hdr, .pic): Ward, "Real Pixels", Graphics Gems II, 1991, and "The RADIANCE
// Picture File Format", 1997. Files are untrusted: an image is allocated once the file is known to
// have all of its scan lines.
#pragma once

#include "image/image.h"

// 3 channels, EXPOSURE divided out. Flat scan lines and both run-length encodings are read; the
// format xyze and orientations other than "-Y N +X M" are refused (FAIL_UNSUPPORTED), sides above
// IMAGE_MAX_SIZE and damaged files too (FAIL_FORMAT). PRIMARIES, COLORCORR and other lines of the
// header are ignored. On failure *out is zeroed.
bool hdr_read(struct host *host, const char *path, struct image *out);
// The same from memory; `name` is for messages.
bool hdr_decode(struct host *host, const char *name, const void *bytes, size_t size,
                struct image *out);
