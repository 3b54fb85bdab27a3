// Data of a level that the host uploads for the shaders of modular radiance transfer. Scalar
// layout.
#ifndef AG_MRT_SHARED_H
#define AG_MRT_SHARED_H

#include "core/shared.h"
#include "frame/frame_shared.h"
#include "techniques/common/light_map/surface_shared.h"

#define MRT_LOCAL         64  // workgroup size over texels
#define MRT_LOCAL_2D      8   // workgroup size over pixels, in x and y
#define MRT_REDUCE_LOCAL  256 // workgroup size of sums over texels and over modes
#define MRT_CLUTTER_LOCAL 64  // workgroup size of r and c of a level with clutter
#define MRT_FACE_SAMPLES  32  // texels of a face of clutter that lights are computed at, at most

#define MRT_BRIGHT_TEXELS 256   // of a block, at most
#define MRT_BRIGHT_TIMES  12.0f // their radiosity over the mean of the block's texels, at least

// Specialization constants.
#define MRT_CONSTANT_HALF     0 // operators are half floats, else floats
#define MRT_CONSTANT_QUADS_B  1 // k_b / 4
#define MRT_CONSTANT_QUADS_R  2 // k_r / 4
#define MRT_CONSTANT_VALUES   3 // per texel: 1 irradiance, 4 irradiance by normal (OHLSH)
#define MRT_CONSTANT_PROBES   4 // bool: surfaces inside blocks are lit by probes
#define MRT_CONSTANT_AFFINE   5 // bool: all warps of the level are affine
#define MRT_CONSTANT_TUBES    6 // bool: blocks are tubes, else cubes
#define MRT_CONSTANT_CLUTTER  7 // bool: some openings are clutter
#define MRT_CONSTANT_SIGHT    8 // voxels along an edge of a block that see probes; 0: all are seen
#define MRT_CONSTANT_OUTDOORS 9 // bool: some places are not enclosed
#define MRT_MAX_QUADS         16

// Vector irradiance along a surface over the slope of irradiance by normal there, where the latter
// is linear SH that fit the hemisphere (OHLSH; Loos 2015, appendix B). Radiance x L, linear in its
// direction, has the vector irradiance 2π/3 L. Coefficients 3 and 7 of its irradiance are
// (2π/3)² Y₁ L and (π/4)² Y₂ L, with Y₁ = √(3/4π) and Y₂ = √(15/4π). The slope of the fit to both
// is Y₁ ((2π/3)² Y₁ + 3√5/8 (π/4)² Y₂) L = 647π/1536 L.
#define MRT_VECTOR_OF_SLOPE (1024.0f / 647.0f)

// Shares of reflectors: those of light that surfaces in no block send (light/reflectors.h).
struct mrt_gpu_reflector_row {
    uint32_t first, count;
};

struct mrt_gpu_reflector_share {
    uint32_t reflector, direction; // towards it: octahedral, two snorm values
    float weight;                  // of its radiosity
};

// A texel of the geometry image: the point of the scene where direct light is computed.
struct mrt_texel {
    vec3s position; // world
    float area_m2;  // of the wall
    vec3s normal;   // unit
    uint32_t found; // bool: there is a surface
    vec3s reflectance;
    float sky;     // irradiance of a sky of radiance 1/π
    vec3s emitted; // irradiance of emissive surfaces, lux
    AG_STRUCT(mrt_gpu_reflector_row) reflected;
    vec3s emitted_vector[3], sky_vector; // of struct mrt_geometry_texel
    uint32_t across;                     // of a wall: octahedral, two snorm values
    vec3s hidden;                        // of struct mrt_geometry_texel
};

// Light of emissive surfaces, the sky and reflectors at a texel: irradiance, and vector irradiance
// along the first two axes of the frame of irradiance by normal. hidden: share of
// the block's light that objects hide.
struct mrt_gpu_area_light {
    vec3s irradiance, along[2], hidden;
};

// A texel on a wall, and its radiosity above the mean. normal: inwards, of the
// length of its area.
struct mrt_gpu_bright_texel {
    vec3s position, normal, radiosity;
};

// A wall of a block: `texels` texels from first_texel.
struct mrt_gpu_tile {
    uint32_t block;
    uint32_t first_texel;
    uint32_t basis_row;    // of its first texel in T_d→b, U_b and U_vec
    uint32_t response_row; // of its first texel in the response to one opening
    int32_t x, y;          // of its first texel in the light map, inside the border
};

struct mrt_gpu_block {
    vec3s corner[8]; // world; x is high in corner c if c & 1, y if c & 2, z if c & 4
    int32_t tile[6]; // by face; −1: an opening; of a tube tile[0] alone
    uint32_t first_texel, texels;
    uint32_t basis_row; // of first_texel
    uint32_t first_opening, openings;
    uint32_t columns;    // of its bounce: b and its openings, but coefficients that are 0
    int32_t neighbor[6]; // block beyond each face; −1: none
    vec3s middle;        // world, of the cell
    vec3s inverse[3];    // rows of the warp's inverse Jacobian there
    int32_t bend;        // of a tube: enum tube_bend; −1: a cube
};

// An opening through which light enters a block, and the blocks that send it; or the clutter of a
// block, and the blocks that light it.
struct mrt_gpu_opening {
    uint32_t response; // first row of its response tables
    uint32_t first_pair, pairs;
    uint32_t quads;                 // of its coefficients; the others are 0
    int32_t clutter;                // which; −1: an opening
    uint32_t first_sender, senders; // faces that send light to it
};

// Light of emissive surfaces (lux) and the sky (of radiance 1/π) at a probe: nine SH coefficients
// of irradiance by normal, world frame.
struct mrt_gpu_probe {
    vec3s emitted[9];
    float sky[9];
    AG_STRUCT(mrt_gpu_reflector_row) reflected;
};

// The same at a point of the outdoor grid, premultiplied by `open` (light/area_light.h).
struct mrt_gpu_outdoor_probe {
    AG_STRUCT(mrt_gpu_probe) light;
    float open;
};

// A texel of the border of the light map: see struct mrt_border of level/atlas.h.
struct mrt_gpu_border {
    uint32_t texel, count;
    uint32_t source[8];
    float weight[8];
};

// A face of clutter: one r-coefficient of an opening that is clutter.
struct mrt_gpu_clutter_face {
    uint32_t clutter, slot;         // which of those openings, which coefficient
    uint32_t first_sample, samples; // of its group
    vec3s emitted, sky; // as of struct mrt_texel, times reflectance: means over its texels
};

// Faces of a workgroup of MRT_LOCAL samples.
struct mrt_gpu_clutter_group {
    uint32_t first_face, faces;
};

// A texel where lights of a face of clutter are computed.
struct mrt_gpu_clutter_sample {
    uint32_t texel;
    float share; // of the face; 0: none
};

// A texel of the light map of clutter, and whose light it has.
struct mrt_gpu_clutter_place {
    uint32_t place;        // light_map_place_word
    uint32_t light, texel; // of mrt_clutter_light, of the clutter's texels
};

// Rows of a block in a table of an image (gpu/block_rows.glsl).
#define MRT_BLOCK_ROWS  4u
#define MRT_ROW_INVERSE 0u // three
#define MRT_ROW_FACES   3u
#define MRT_ROW_OPENING 64u
#define MRT_NO_BLOCK    0xffffffffu // of a cell of the lookup grid

// Begins a list of pixels.
struct mrt_list_header {
    uint32_t count;
    uint32_t groups[3]; // of the dispatch: MRT_LOCAL pixels each
};

struct mrt_rows_push {
    uint32_t blocks, cells;
};

struct mrt_clutter_fill_push {
    uint32_t places;
    float emitted;           // radiance scale; 0: emissive surfaces are no sources
    vec3s environment_sh[9]; // of struct frame_constants
};

// Uniform block "mrt_level".
struct mrt_level_params {
    vec3s grid_origin_m; // lookup grid of blocks
    float cells_per_m;
    int32_t cells_x, cells_y, cells_z;
    uint32_t resolution;      // texels along an edge of a wall
    uint32_t texels_of_tile;  // resolution²
    uint32_t texels, borders; // of the light map: inside tiles, around them
    uint32_t map_width;       // texels
    uint32_t tiles;
    uint32_t map_height;
    int32_t shadow_radius; // texels
    float offset_m;        // of lookups, along the normal
    float feedback;        // weight of the indirect irradiance that is reflected again
    float emitters;        // 1: emissive surfaces are sources, 0: they are not
    float gain;            // artistic factor on the result
    uint32_t probes;       // along an edge of a block
    uint32_t brick_columns;
    uint32_t has_dielectric; // FRAME_DIELECTRIC

    uint32_t reflectors;
    AG_STRUCT(light_map_instances) clutter; // in the light map of clutter
    AG_STRUCT(frame_probes) outdoors;       // no probes: all places are enclosed
};

struct mrt_view_push {
    uint32_t view; // MRT_VIEW_…
};

// A voxel of a block (objects/delta.h): bits of probes, openness in 1/255, whether some of it
// is in a solid.
#define MRT_SIGHT_PROBES 0xffu
#define MRT_SIGHT_OPEN   8
#define MRT_SIGHT_SOLID  0x10000u

#define MRT_VIEW_BLOCKS 0
#define MRT_VIEW_DIRECT 1

#ifndef AG_GLSL
_Static_assert(sizeof(struct mrt_gpu_reflector_row) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_reflector_share) == 12, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_texel) == 132, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_area_light) == 48, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_bright_texel) == 36, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_tile) == 24, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_block) == 220, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_probe) == 152, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_outdoor_probe) == 156, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_opening) == 28, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_clutter_face) == 40, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_clutter_group) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_clutter_place) == 12, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_clutter_sample) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_list_header) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_rows_push) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_clutter_fill_push) == 116, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_gpu_border) == 72, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_level_params) == 132, "layout is shared with GLSL");
_Static_assert(sizeof(struct mrt_view_push) == 4, "layout is shared with GLSL");
#endif

#endif
