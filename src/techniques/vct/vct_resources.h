// GPU resources and their sizes. Creation may stop half-way; vct_destroy_resources accepts that.
#pragma once

#include "techniques/vct/vct_options.h"

struct vct;

// Of the traced pixels of a view; 0 × 0 destroys them.
bool vct_create_images(struct vct *vct, int view, uint32_t width, uint32_t height);
bool vct_create_resources(struct vct *vct); // buffers, voxel images, light volume
void vct_destroy_resources(struct vct *vct);
uint64_t vct_resource_bytes(const struct vct_options *options, uint32_t width, uint32_t height);
