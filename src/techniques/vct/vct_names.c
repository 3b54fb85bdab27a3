// Passes and objects are named after the technique that they belong to, "vct.cones".
#include "techniques/vct/vct_names.h"

#include <stdio.h>

const char *vct_name(const char *technique, const char *thing, char out[VCT_NAME_SIZE])
{
    snprintf(out, VCT_NAME_SIZE, "%s.%s", technique, thing);
    return out;
}

void vct_pass_begin(const char *technique, struct gpu_cmd *cmd, const char *pass)
{
    char name[VCT_NAME_SIZE];
    gpu_scope_begin(cmd, vct_name(technique, pass, name));
}

bool vct_create_image(const char *technique, struct gpu *gpu, struct gpu_image_desc desc,
                      gpu_image *out)
{
    char name[VCT_NAME_SIZE];
    desc.name = vct_name(technique, desc.name, name);
    gpu_image_destroy(gpu, out);
    return gpu_image_create(gpu, &desc, out);
}

bool vct_create_compute(const char *technique, struct gpu *gpu, const char *thing,
                        const struct gpu_shader *shader, const struct gpu_constant *constants,
                        int count, gpu_pipeline *out)
{
    char name[VCT_NAME_SIZE];
    return gpu_compute_pipeline_create(gpu, vct_name(technique, thing, name), shader, constants,
                                       count, out);
}
