// All compute pipelines.
#pragma once

struct gpu_objects;
struct lpv_options;

void lpv_add_pipelines(const struct lpv_options *options, struct gpu_objects *out);
