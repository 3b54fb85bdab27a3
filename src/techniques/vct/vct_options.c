#include "techniques/vct/vct_options.h"

#include "techniques/vct/vct_layout.h"

struct vct_options vct_light_options(const void *options)
{
    struct vct_options out = *(const struct vct_options *)options;
    out.decay = 0.0f;
    out.occlusion = false;
    return out;
}

// Under uniform radiance 1/π the irradiance equals the cosine-weighted visibility.
struct vct_options vct_occlusion_options(const void *options)
{
    struct vct_options out = *(const struct vct_options *)options;
    out.specular = false;
    out.aperture = 0.0f;
    out.gain = GLM_1_PIf;
    out.bounces = 1;
    out.small_emitters = false;
    out.occlusion = true;
    return out;
}

bool vct_check_options(const char *technique, const struct technique_create *how,
                       const struct vct_options *options)
{
    if (options->resolution % 16 != 0)
        return host_fail(how->host, FAIL_ARGUMENT, "gi %s: resolution=%d is not a multiple of 16",
                         technique, (int)options->resolution);
    if (options->levels > 1 && vct_has_svo(options))
        return host_fail(how->host, FAIL_ARGUMENT,
                         "gi %s: levels=%d needs storage=mips: storage=svo has one level",
                         technique, (int)options->levels);
    const struct gpu_image_desc light = vct_light_desc(options);
    const uint32_t most = gpu_limits(how->gpu)->max_image_3d,
                   width = light.width > light.depth ? light.width : light.depth;
    if (most < width)
        return host_fail(
            how->host, FAIL_UNSUPPORTED,
            "gi %s: resolution=%d, levels=%d: the device has 3D images of at most %u "
            "texels along a side, %u are needed; use a lower resolution or fewer levels",
            technique, (int)options->resolution, (int)options->levels, most, width);
    return true;
}
