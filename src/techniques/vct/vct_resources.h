// GPU objects and their sizes.
#pragma once

#include "techniques/vct/vct_options.h"

void vct_add_volumes(const struct vct_options *options, struct gpu_objects *out); // of all views
void vct_add_pixels(const struct vct_options *options, int view, uint32_t width, uint32_t height,
                    struct gpu_objects *out);
