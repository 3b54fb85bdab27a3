// What the shaders of voxel cone tracing share with the host. Scalar layout.
#ifndef AG_VCT_SHARED_H
#define AG_VCT_SHARED_H

#include "core/shared.h"

// Voxelisation.
#define VCT_LOCAL 64 // invocations of a workgroup that has one dimension
#define VCT_TILE                                                                                   \
    32 // side of the square of columns that one workgroup takes of a large triangle; bits of a word
#define VCT_SMALL_COLUMNS 64 // a triangle over at most so many columns is walked by one invocation
#define VCT_QUEUE         65535 // tiles of large triangles that wait for a workgroup each
#define VCT_BLOCK_WORDS   8     // words of the mask that one invocation counts and lists
#define VCT_SCAN_LOCAL    256
#define VCT_BOUNCE_LOCAL  32 // blocks that a workgroup brings light to

// Words of vct_sum_words for a voxel: see voxelize/surface.glsl.
#define VCT_SUM_WEIGHT      0
#define VCT_SUM_OPACITY     1
#define VCT_SUM_REFLECTANCE 2 // 3 words, × opacity
#define VCT_SUM_NORMAL      5 // 3 words, signed
#define VCT_SUM_POSITION    8 // 3 words, signed: from the voxel's centre
#define VCT_SUM_FRONT       11 // 3 words, signed: emission to the side of the normal; negative: a lamp's
#define VCT_SUM_BACK        14 // 3 words: emission to the other side
#define VCT_SUM_FRONTS      17 // weight of what is covered by fronts to the side of the normal
#define VCT_SUM_BACKS       18 // and to the other side
#define VCT_SUM_WORDS       19
#define VCT_LINES                                                                                  \
    16 // along an axis through each voxel, of which those that a triangle crosses are counted
#define VCT_WEIGHT_LINE  64.0
#define VCT_WEIGHT_ONE   1024.0 // weight of what covers a voxel's face: of all lines
#define VCT_COLOUR_ONE   255.0
#define VCT_NORMAL_ONE   127.0
#define VCT_POSITION_ONE 127.0 // of a whole voxel
#define VCT_EMISSION_ONE 256.0 // of the strongest emission of the scene

// Voxels in a row of vct_surfaces and vct_records, with two texels each, and of vct_brought with
// one.
#define VCT_RECORD_ROW 1024

// Buffer "vct_arguments" of a set of voxels.
struct vct_voxel_counts {
    uint32_t groups[3]; // x, y, z of a dispatch over all
    uint32_t listed;
    uint32_t left_out;        // for want of room
    uint32_t again_groups[3]; // over those whose sums are added up
    uint32_t again;
};

// Levels of the clip map: grids, of which the first one has the whole scene.
#define VCT_MAX_CLIPS 6

// Uniform block "vct_grid".
struct vct_params {
    vec3s origin_m;                    // corner of voxel 0, world space
    float cell_m;                      // side of a voxel
    int32_t cells_x, cells_y, cells_z; // in use; beyond them is the outside
    int32_t dim;                       // voxels along a side, with which they are numbered
    float cells_per_m;
    uint32_t capacity;     // voxels with attributes
    float emission_fixed;  // whole numbers per cd/m²
    float emission_scaled; // scaled cd/m² per whole number
    float shadow_size;     // texels
    int32_t shadow_radius; // texels
    int32_t volume_dim;    // texels of the light volume along a side
    uint32_t light_count;  // of the frame's lights that are injected
    uint32_t brought;      // whether light that voxels got from others is injected
    float light_scale;     // the frame's unit over that of the light volume
    uint32_t lamps_shown;  // whether lamps are part of the light volume
    float decay_per_m;     // of occlusion: see cones/trace.glsl
    float offset; // along the normal at which the pixels' cones start, texels of the light volume
    vec3s scene_low, scene_high; // the whole scene's grid, in these voxels
    int32_t volume_first; // texel of the light volume along z at which this grid's part begins
    int32_t level;        // of the clip map, as vct_clipmap counts them
};

// What cones know of a grid. Texels of the finest grid are the unit, the corner of the scene's grid
// is the origin.
struct vct_clip_level {
    vec3s corner;    // of its first texel
    vec3s size;      // texels of its own that are in use
    vec3s low, high; // the box in which it is looked into
};

// Uniform block "vct_clipmap".
struct vct_clip_table {
    vec3s origin_m; // corner of the scene's grid, world space
    vec3s size;     // of the scene's grid
    float fade; // texels of a grid, within its box, over which it gives way to the next coarser one
    AG_STRUCT(vct_clip_level) levels[VCT_MAX_CLIPS]; // the finest one first
};

#define VCT_MAX_CONES      25
#define VCT_MAX_INTERLEAVE 5
#define VCT_GATHER_ROW     4 // pixels that one invocation gathers for

// Uniform block "vct_cones".
struct vct_cone_params {
    vec4s cones[VCT_MAX_CONES]; // direction; weight: of voxels about +z, in sr, Σ = π; of pixels in
                                // the world, Σ = 1
    uint32_t cone_count;
    uint32_t interleave;
    uint32_t step;          // pixels of the frame, across and down, to each that traces cones
    uint32_t width, height; // those that do
    float width_per_m;      // width of the texels that a cone meets over the distance
    float offset;           // texels of the light volume
    float gain;
    float texel_m; // of the light volume, of the finest grid
    uint32_t last_mip;
    float pixel; // width of a pixel over the distance
};

// Of the light volume: enough for resolution 256.
#define VCT_MAX_LEVELS 8

// Buffer "vct_texel_state": dispatches over the lists of texels, how many there are in each.
struct vct_texel_levels {
    uint32_t groups[3 * VCT_MAX_LEVELS]; // x, y, z; of coarser levels for each way
    uint32_t block_groups[3];            // of VCT_BOUNCE_LOCAL blocks
    uint32_t count[VCT_MAX_LEVELS];
};

struct vct_texels_push {
    uint32_t levels;
    uint32_t ways;                       // volumes side by side
    uint32_t block_level;                // of which a texel is a block: see lighting/bounce.comp
    uint32_t first[VCT_MAX_LEVELS];      // of each level in the buffer of lists
    uint32_t mask_first[VCT_MAX_LEVELS]; // its first bit
};

// Storage block "vct_lamps", one for each.
#define VCT_LAMPS_MAX   16
#define VCT_LAMP_POINTS 12
struct vct_lamp {
    vec3s radiance; // scaled
    float area_m2;  // that each of its points stands for
    uint32_t both_sides;
    vec3s positions[VCT_LAMP_POINTS]; // world space
    vec3s normals[VCT_LAMP_POINTS];   // unit, of the front
};

// Uniform block "vct_history": the last frame's picture, of which the pixel (x, y) shows what lies
// at forward + x · right + y · down from its eye, per distance along the view axis; world space.
struct vct_history_params {
    vec3s right, down, forward;
    float pixel;    // width of a pixel over the distance
    float most;     // weight of the history at most, in frames
    float clamp;    // standard deviations; 0: none
    float scale;    // this frame's unit over the last one's
    uint32_t known; // 0: there is no last frame
};

// Uniform block "vct_specular".
struct vct_specular_params {
    float tan_half; // of each cone's half-angle; 0: as the roughness says
    float stride;
    float offset; // texels of the light volume
    float gain;
    float texel_m; // of the light volume, of the finest grid
    uint32_t last_mip;
};

// Uniform block "vct_shares": what GGX reflects of even light is F0 · first + second; nodes evenly
// in n·v, then roughness.
#define VCT_SHARE_NODES 16
struct vct_share_table {
    float pairs[VCT_SHARE_NODES * VCT_SHARE_NODES * 2];
};

struct vct_mip_push {
    int32_t source_x, source_y, source_z; // of the level that is read
    int32_t source_tile, target_tile;     // texels between directions
    uint32_t level;
    uint32_t first; // of the list of texels
};

// Sparse voxel octree.
#define VCT_SVO_BLOCK 32  // nodes that one invocation counts and divides
#define VCT_SVO_LOCAL 128 // invocations of a workgroup over bricks

// Uniform block "vct_svo".
struct vct_svo_params {
    uint32_t depths; // levels of nodes, the root's and the leaves' included
    uint32_t bricks; // that there is room for
    uint32_t tiles;  // of eight children each, that there is room for
    int32_t row;     // bricks along x and y of the pool
};

// Storage block "vct_svo_levels", one for each depth.
struct vct_svo_level {
    uint32_t first, count;    // bricks, which are numbered from the root down
    uint32_t left_out;        // for want of room
    uint32_t node_groups[3];  // of a dispatch over blocks of the children
    uint32_t texel_groups[3]; // over 32 invocations a brick
    uint32_t side_groups[3];  // over 16
};

struct vct_svo_push {
    uint32_t depth;
    uint32_t axis; // along which neighbours are joined
};

#define VCT_VIEW_REFLECTANCE 0
#define VCT_VIEW_NORMAL      1
#define VCT_VIEW_RADIANCE    2
#define VCT_VIEW_ROOM        3
#define VCT_VIEW_LEVELS      4

#define VCT_MARCH_INTO  1 // up to the next finer grid, or to the end
#define VCT_MARCH_OUT   2 // from there on
#define VCT_MARCH_FIRST 4 // nothing is in the picture yet
#define VCT_MARCH_LAST  8

struct vct_view_push {
    uint32_t view;
    uint32_t march;          // of those bits
    float reflectance_shown; // scaled radiance that a reflectance of 1 is shown as
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct vct_voxel_counts) == 9 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_params) == 29 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_clip_table) == (7 + 12 * VCT_MAX_CLIPS) * 4,
               "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_cone_params) == VCT_MAX_CONES * 16 + 11 * 4,
               "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_lamp) == (5 + 6 * VCT_LAMP_POINTS) * 4,
               "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_texel_levels) == (4 * VCT_MAX_LEVELS + 3) * 4,
               "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_texels_push) == 12 + 2 * VCT_MAX_LEVELS * 4,
               "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_history_params) == 14 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_specular_params) == 6 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_mip_push) == 28, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_svo_params) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_svo_level) == 12 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_svo_push) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_view_push) == 12, "layout is shared with GLSL");
#endif

#endif
