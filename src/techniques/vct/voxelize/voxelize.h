// Voxelization: which voxels the triangles of the scene touch, and their surface attributes.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/voxelize/voxelize_shared.h"

// The occupied voxels of the static or of the moving draws in one level of the clip map.
struct vct_voxel_set {
    gpu_buffer mask;                // a bit for each voxel
    gpu_buffer word_offsets;        // occupied voxels before each word of the mask
    gpu_buffer blocks;              // the same for blocks of words
    gpu_buffer list;                // indices of the occupied voxels
    gpu_buffer arguments;           // struct vct_voxel_counts
    gpu_buffer accumulated;         // a bit for each voxel whose triangles are summed up
    gpu_buffer accumulated_list;    // slots of those voxels
    gpu_image surfaces, lit_voxels; // RGBA32U, one entry for each occupied voxel
    gpu_image planes;               // RG32U, for rays: see rays/plane.glsl
    gpu_image part_of_face;         // R32U: see lighting/parts.comp
    gpu_image parts, bounced;       // RGBA32U and RGBA16F: parts, irradiance on them
    gpu_buffer part_counts;         // struct vct_part_count
};

// Draws by the maps of their materials; a map that a material lacks is white.
enum vct_draw_kind {
    VCT_PLAIN,
    VCT_EMISSIVE,
    VCT_SMALL_EMITTER,
    VCT_TEXTURED, // with maps, of emission too
    VCT_TEXTURED_SMALL_EMITTER,
    VCT_MASKED,
    VCT_DRAW_KINDS
};

enum vct_voxels { VCT_BY_COMPUTE, VCT_BY_RASTER }; // choices of the option

struct vct_voxelize_pipelines { // for small and large triangles; by raster `small` for all
    gpu_pipeline small, large;
};

struct vct;

// Voxelizes each level of the clip map whose voxels are not kept, and sets its `revoxelized`.
void vct_voxelize(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view);
