/// Probe volumes: indirect irradiance on a grid of points, to light objects outside the scene, such
/// as a program's dynamic objects, particles or smoke. Techniques with publishes_probes
/// (ag_technique_info) fill a volume in each frame if their option `probes` is true.
#ifndef AFTERGLOW_PROBES_H
#define AFTERGLOW_PROBES_H

#include <afterglow/renderer.h>

AG_BEGIN

/// Probe (x, y, z) is at first + spacing · (x, y, z), in world space. It stores irradiance as a
/// function of the unit normal n, without albedo and 1/π: E(n) = Σ c_i Y_i(n), with nine real
/// spherical harmonics in the order Y00, y, z, x, xy, yz, 3z²−1, xz, x²−y² (orthonormal, all signs
/// positive), for each of R, G, B.
struct ag_probes {
    float first[3], spacing; ///< metres
    int counts[3];           ///< along x, y, z
    float *coefficients;     ///< lux, [counts z][counts y][counts x][9][3]
};
/// Copies the volume of the newest frame; waits for the GPU. AG_ERROR_ARGUMENT if no running
/// technique publishes probes; the message names the option to set. The copy is independent of the
/// renderer. Thread: the context's.
AG_API enum ag_result ag_renderer_read_probes(struct ag_renderer *renderer, struct ag_probes **out);
/// context as for ag_image_destroy. Thread: the context's.
AG_API void ag_probes_destroy(struct ag_context *context, struct ag_probes *probes);
/// Irradiance (3 values, lux, ≥ 0) at a world position for a unit normal, by trilinear
/// interpolation; positions outside the grid are clamped to it. A diffuse surface reflects the
/// radiance albedo / π · irradiance. `probes` must be as read. Thread: any.
AG_API void ag_probes_irradiance(const struct ag_probes *probes, const float *position,
                                 const float *normal, float *out);

/// The same volume on the GPU, for programs that share the device: one 3D image,
/// VK_FORMAT_R16G16B16A16_SFLOAT, of seven slabs along z with `slab` texels each, of which the
/// first `counts` texels are used. Coefficient i of a colour channel c is component (3 i + c) mod 4
/// of slab (3 i + c) div 4. Values are lux × scale. frame/probes.glsl of
/// the installed shader functions (share/afterglow/glsl) samples it.
struct ag_probes_handle {
    void *vk_image;
    uint32_t vk_layout;
    float scale;
    float first[3], spacing;
    int counts[3], slab;
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_renderer_probes_handle(struct ag_renderer *renderer,
                                                struct ag_probes_handle *out);

AG_END

#endif
