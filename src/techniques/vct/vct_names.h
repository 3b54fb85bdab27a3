// Passes and objects are named after the technique that they belong to, "vct.cones": more than one
// shares this folder.
#pragma once

#include "gpu/gpu.h"

enum { VCT_NAME_SIZE = 32 };

// "technique.thing", in `out`. The GPU layer copies names.
const char *vct_name(const char *technique, const char *thing, char out[VCT_NAME_SIZE]);

// Names without the technique's, which comes before them.
void vct_pass_begin(const char *technique, struct gpu_cmd *cmd,
                    const char *pass); // gpu_scope_end ends it
bool vct_create_image(const char *technique, struct gpu *gpu, struct gpu_image_desc desc,
                      gpu_image *out); // in place of one that is there
bool vct_create_compute(const char *technique, struct gpu *gpu, const char *thing,
                        const struct gpu_shader *shader, const struct gpu_constant *constants,
                        int count, gpu_pipeline *out);
