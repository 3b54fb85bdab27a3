// KTX 2.0 files (Khronos KTX File Format Specification, version 2.0), as GPUs take them: one level,
// not compressed, RGB9E5.
#pragma once

#include "image/image.h"

struct ktx2_entry { // metadata: text
    const char *key, *value;
};

// Pixels divided by `scale`, 3 channels, the top row first. Entries have keys that do not begin
// with "KTX"; those of the format are added. The file is replaced atomically.
bool ktx2_write(struct host *host, const char *path, const struct image *image, float scale,
                const struct ktx2_entry *entries, int entry_count);
// A power of two by which the largest value fits: 1, more where it is above RGB9E5_MAX, less where
// all values are below 1.
float ktx2_scale(const struct image *image);
