#include "techniques/vct/vct_options.h"

#include "techniques/vct/vct_layout.h"

// The finest grid is 10 m wide at least: a room, and a part of a street.
static const float LEAST_FINEST_M = 10.0f;
enum { MOST_FITTED = 4 };

void vct_fit_options(void *options, float scene_size_m)
{
    struct vct_options *o = options;
    o->fitted_levels = 1;
    for (float side = 0.5f * scene_size_m; side >= LEAST_FINEST_M && o->fitted_levels < MOST_FITTED;
         side *= 0.5f)
        o->fitted_levels++;
}

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
    out.specular = VCT_SPECULAR_NONE;
    out.aperture = 0.0f;
    out.gain = GLM_1_PIf;
    out.bounces = 1;
    out.small_emitters = false;
    out.occlusion = true;
    return out;
}

static bool fits(const char *technique, const struct technique_create *how,
                 const struct vct_options *options, const char *images, uint32_t texels,
                 uint32_t most)
{
    if (texels <= most) return true;
    return host_fail(how->host, FAIL_UNSUPPORTED,
                     "gi %s: resolution=%d, levels=%d: the device has %s of at most %u texels "
                     "along a side, %u are needed; use a lower resolution or fewer levels",
                     technique, (int)options->resolution, vct_clip_count(options), images, most,
                     texels);
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
    const struct gpu_limits *limits = gpu_limits(how->gpu);
    const uint32_t width = light.width > light.depth ? light.width : light.depth,
                   rows =
                       (uint32_t)vct_clip_count(options) * vct_level_faces(options) / VCT_VOXEL_ROW;
    return fits(technique, how, options, "3D images", width, limits->max_image_3d) &&
           fits(technique, how, options, "images", rows, limits->max_image_2d);
}
