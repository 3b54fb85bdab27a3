// Data of all folders' shaders that the host writes. Scalar layout.
#ifndef AG_VCT_SHARED_H
#define AG_VCT_SHARED_H

#include "core/shared.h"

#define VCT_LOCAL      64  // workgroup size over a list
#define VCT_LOCAL_2D   8   // workgroup size over pixels, in x and y
#define VCT_SCAN_LOCAL 256 // workgroup size of a prefix sum
#define VCT_MAX_CLIPS  6   // levels of the clip map; the first one covers the whole scene

// Occupied faces of voxels in a row of the images that store them: two texels each for surfaces,
// one for light and for bounced irradiance.
#define VCT_VOXEL_ROW 1024

// Uniform block "vct_grid".
struct vct_params {
    vec3s origin_m;                    // corner of voxel 0, world space
    float cell_m;                      // side of a voxel
    int32_t cells_x, cells_y, cells_z; // in use
    int32_t dim;                       // voxels along a side of the index space
    float cells_per_m;
    uint32_t capacity;           // occupied voxels that can be stored
    float emission_fixed;        // fixed-point units per cd/m²
    float emission_scaled;       // scaled cd/m² per fixed-point unit
    float shadow_size;           // texels
    int32_t shadow_radius;       // texels
    int32_t volume_dim;          // texels of the light volume along a side
    uint32_t light_count;        // injected lights of the frame
    uint32_t bounced;            // bool: bounced irradiance is injected
    float light_scale;           // radiance scale of the frame over that of the light volume
    uint32_t has_small_emitters; // bool: the light volume holds small emitters
    float decay_per_m;           // of occlusion: see cones/trace.glsl
    float offset;                // of the cones' apex along the normal, texels
    vec3s scene_low, scene_high; // grid of the whole scene, in these voxels
    int32_t volume_first;        // first texel of this level's part of the volume along z
    int32_t level;               // of the clip map, 0 is the finest
    uint32_t level_faces;        // of images that have the faces of all levels
    uint32_t face_first;         // the first of them of this level
};

#define VCT_VIEW_REFLECTANCE 0
#define VCT_VIEW_NORMAL      1
#define VCT_VIEW_RADIANCE    2
#define VCT_VIEW_OVERFLOW    3
#define VCT_VIEW_LEVELS      4

// Parts of a view ray within one level of the clip map, as bits.
#define VCT_MARCH_INTO  1 // up to the next finer level, or to the end
#define VCT_MARCH_OUT   2 // beyond the next finer level
#define VCT_MARCH_FIRST 4 // first dispatch: the image is empty
#define VCT_MARCH_LAST  8

struct vct_view_push {
    uint32_t view;
    uint32_t march;
    float reflectance_scale; // scaled radiance displayed for a reflectance of 1
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct vct_params) == 31 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_view_push) == 12, "layout is shared with GLSL");
#endif

#endif
