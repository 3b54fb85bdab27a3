/// Probe volumes: indirect irradiance on a grid of points, to light objects outside the scene, such
/// as a program's dynamic objects, particles or smoke. Techniques with publishes_probes
/// (ag_technique_info) fill a volume in each frame if their option `probes` is true. Lookups leave
/// out the probes behind walls.
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
/// interpolation of the probes that see the position; positions outside the grid are clamped to it.
/// A diffuse surface reflects the radiance albedo / π · irradiance. `probes` must be as read, not a
/// copy. Thread: any.
AG_API void ag_probes_irradiance(const struct ag_probes *probes, const float *position,
                                 const float *normal, float *out);

/// How lookups leave out the probes behind walls.
enum ag_probes_visibility_kind {
    AG_PROBES_VISIBILITY_NONE, ///< not at all: lpv and holpv, unless geometry=scene
    /// By the distances that probes see, mean and deviation by direction: radiosity, mrt, drt, prt.
    AG_PROBES_VISIBILITY_DEPTHS,
    AG_PROBES_VISIBILITY_WALLS, ///< by surfaces between neighbouring probes: lpv, holpv
};
/// Data of walls by which ag_probes_irradiance works, for a program's own lookup or format. The
/// arrays belong to the probes and are NULL with another kind.
struct ag_probes_visibility {
    enum ag_probes_visibility_kind kind;
    /// Side of a tile of depths: points of an octahedral map, at the corners of (tile_side − 1)²
    /// cells. A lookup interpolates in the triangles into which the edges of the octahedron, and
    /// lines parallel to them, cut the cells.
    int tile_side;
    /// [z][y][x][4]: of each probe its place, as an offset from the grid in spacings, and 1, or 0
    /// if it is inside geometry and has the light of another probe.
    const float *offsets;
    /// [z][y][x][tile_side][tile_side][2]: spacing / |v|₁, 0.3 to 32, with |v|₁ the L1 norm of the
    /// offset v of the surface that is visible there, and its standard deviation around the point.
    const float *depths;
    /// [z][y][x][3][2]: of the interval from the next lower probe along x, y and z to this one the
    /// share that surfaces cover, and their place, 0 to 1.
    const float *walls;
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// `probes` must be as read. Thread: any.
AG_API void ag_probes_get_visibility(const struct ag_probes *probes,
                                     struct ag_probes_visibility *out);

/// The same volume on the GPU, for programs that share the device: a 3D image,
/// VK_FORMAT_R16G16B16A16_SFLOAT, of slabs along z with `slab` texels each, of which the first
/// `counts` texels are used. Coefficient i of a colour channel c is component (3 i + c) mod 4 of
/// slab (3 i + c) div 4. Values are lux × scale. Slab 7 has `offsets` if `visibility` is
/// AG_PROBES_VISIBILITY_DEPTHS; slabs 7 and 8 have the shares and the places of `walls` if it is
/// AG_PROBES_VISIBILITY_WALLS. techniques/common/probes/lookup.glsl of the installed shader
/// functions (share/afterglow/glsl) samples it, as ag_probes_irradiance does.
struct ag_probes_handle {
    void *vk_image;
    uint32_t vk_layout; ///< from the next frame on, as vk_depth_layout
    float scale;
    float first[3], spacing;
    int counts[3], slab;
    /// VK_FORMAT_R16G16_SFLOAT, the tiles of `depths` in rows from the first probe; NULL: none.
    void *vk_depth_image;
    uint32_t vk_depth_layout;
    uint32_t visibility;  ///< enum ag_probes_visibility_kind
    uint64_t reserved[2]; ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_renderer_probes_handle(struct ag_renderer *renderer,
                                                struct ag_probes_handle *out);

AG_END

#endif
