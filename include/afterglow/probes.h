/// Probe volumes: indirect light at the points of a grid, for what is not in the scene — a
/// program's dynamic objects, particles, smoke. A technique that publishes one (ag_technique_info)
/// fills it each frame where its option `probes` is on.
#ifndef AFTERGLOW_PROBES_H
#define AFTERGLOW_PROBES_H

#include <afterglow/renderer.h>

AG_BEGIN

/// Probe (x, y, z) stands at first + spacing · (x, y, z), in world space. It holds the irradiance
/// E(n) of a surface with the unit normal n that stood there, without albedo and without 1/π: E(n)
/// = Σ c_i Y_i(n), nine real spherical harmonics in the order Y00, y, z, x, xy, yz, 3z²−1, xz,
/// x²−y² (orthonormal, all signs positive), for each of R, G, B.
struct ag_probes {
    float first[3], spacing; ///< metres
    int counts[3];           ///< along x, y, z
    float *coefficients;     ///< lux, [counts z][counts y][counts x][9][3]
};
/// Copies the newest frame's volume. Waits for the GPU. A sum without probes is AG_ERROR_ARGUMENT:
/// the message says which option brings them. The copy outlives the renderer.
AG_API enum ag_result ag_renderer_read_probes(struct ag_renderer *renderer, struct ag_probes **out);
AG_API void ag_probes_destroy(struct ag_context *context, struct ag_probes *probes);
/// Irradiance in lux at a point for a unit normal, filtered between the eight probes around;
/// outside of the grid that of its nearest face, never negative. A diffuse surface reflects albedo
/// / π of it. probes as they were read. Any thread.
AG_API void ag_probes_irradiance(const struct ag_probes *probes, const float *position,
                                 const float *normal, float *out);

/// The same volume on the GPU, for programs that share the device: one 3D image,
/// VK_FORMAT_R16G16B16A16_SFLOAT, of seven slabs one behind the other along z, `slab` texels each,
/// of which counts × texels are in use. Number 3 i + colour of a probe stands in component (3 i +
/// colour) mod 4 of slab (3 i + colour) div 4. Values are lux × scale. src/frame/probes.glsl looks
/// it up.
struct ag_probes_handle {
    void *vk_image;
    uint32_t vk_layout;
    float scale;
    float first[3], spacing;
    int counts[3], slab;
};
AG_API enum ag_result ag_renderer_probes_handle(struct ag_renderer *renderer,
                                                struct ag_probes_handle *out);

AG_END

#endif
