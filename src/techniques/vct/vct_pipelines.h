// Pipelines for the options.
#pragma once

struct gpu_objects;
struct vct_options;

void vct_add_pipelines(const struct vct_options *options, struct gpu_objects *out);
