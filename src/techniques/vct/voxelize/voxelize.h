// Voxelization: which voxels the triangles of the scene touch, and their surface attributes.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/vct_shared.h"
#include "techniques/vct/voxelize/voxelize_shared.h"

// The occupied voxels of the static or of the moving draws in one level of the clip map. Images
// and buffers by face lie here, those of lighting/ too.
struct vct_voxel_set {
    gpu_buffer mask;             // a bit for each voxel
    gpu_buffer word_offsets;     // occupied voxels before each word of the mask
    gpu_buffer blocks;           // the same for blocks of words
    gpu_buffer list;             // indices of the occupied voxels
    gpu_buffer arguments;        // struct vct_voxel_counts
    gpu_buffer accumulated;      // a bit for each voxel whose triangles are summed up
    gpu_buffer accumulated_list; // slots of those voxels
    gpu_image surfaces;          // RGBA32U, two texels for each occupied face
    gpu_image part_of_face;      // R32U: see lighting/parts.comp
    gpu_image parts, bounced;    // RGBA32U and RGBA16F: parts, irradiance on them
    gpu_buffer part_counts;      // struct vct_part_count
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

enum vct_voxelize_by { VCT_BY_COMPUTE, VCT_BY_RASTER }; // choices of the option

struct vct_voxelize_pipelines { // for small and large triangles; by raster `small` for all
    gpu_pipeline small, large;
};

struct vct_level_voxels {                         // of a level of the clip map
    struct vct_voxel_set static_set, dynamic_set; // of draws that have never moved; of the others
    bool static_valid;                            // static_set is that of the scene
    bool revoxelized;                             // in this frame
    bool new_statics;                             // static_set is another one in this frame
};

struct vct_voxels {
    struct vct_voxelize_pipelines mark, outermost[2]; // opaque, masked
    struct vct_voxelize_pipelines add[VCT_DRAW_KINDS];
    gpu_pipeline count, scan, list, zero, surfaces;
    gpu_buffer queue, queue_state; // tiles of large triangles
    gpu_buffer sums;               // over the triangles of the faces of a set
    struct vct_level_voxels levels[VCT_MAX_CLIPS];
    // Faces of the static and of the moving set, all levels one after the other: rays go from level
    // to level.
    gpu_image lit_voxels[2]; // RGBA32U: see volume/lit_face.glsl
    gpu_image planes[2];     // RG32U, for rays: see rays/plane.glsl
    bool revoxelized;        // some level is, in this frame
    int moving_draws;        // of the voxels
    uint64_t static_set;     // of scene_gpu
};

struct vct_frame;

// Voxelizes each level of the clip map whose voxels are not kept. still: no geometry has moved
// since the previous frame.
void vct_voxelize(struct vct_voxels *voxels, const struct vct_frame *frame, bool still);
// All voxels are to be made again.
void vct_voxels_invalidate(struct vct_voxels *voxels);
