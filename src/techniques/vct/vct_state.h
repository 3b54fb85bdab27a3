// The private state of voxel cone tracing, shared by its stages.
#pragma once

#include "techniques/technique.h"
#include "techniques/vct/cones/cone_sets.h"
#include "techniques/vct/clipmap/grid.h"
#include "techniques/vct/vct_small_emitters.h"
#include "techniques/vct/vct_names.h"
#include "techniques/vct/vct_shared.h"
#include "techniques/vct/cones/temporal.h"

// Of both techniques. What one of them lacks is as vct.c fills it in.
struct vct_options {
#define OPTION       OPTION_FIELD
#define VCT_OPTION   OPTION_FIELD
#define VCTAO_OPTION OPTION_FIELD
#include "techniques/vct/vct_options.def"
#undef VCTAO_OPTION
#undef VCT_OPTION
#undef OPTION
    bool occlusion; // vctao: cones find how open it is about a surface, and no light
};

enum vct_storage { VCT_MIPS, VCT_SVO }; // the option's choices

enum { VCT_LOCAL_2D = 8 }; // of shaders over pixels or texels, in x and y

// Voxels of a part of the scene: which, in what order, what they are, what they send out.
struct vct_set {
    gpu_buffer mask, before, blocks, list, arguments;
    gpu_buffer again, again_list,
        sums; // of those where several triangles, or small ones, are added up
    gpu_image surfaces, records, brought; // RGBA32U
};

// A level of the clip map: a grid and what is in its voxels. The first one has the whole scene.
struct vct_clip {
    struct vct_grid grid, lit;                  // now; as it was when its light was filled in
    struct box3 used;                           // in which cones look into it: see vct_grid_used
    struct vct_set rest, moving;                // what stands still; what has moved
    gpu_buffer texels, texel_mask, texel_state; // of the light volume: which hold something
    bool rest_valid;                            // `rest` is of the scene as it stands
};

// For lists of bindings: the voxels of both sets, as volume/prefilter.glsl reads them.
#define VCT_BOTH_SETS(clip)                                                                        \
    { .name = "static_mask", .buffer = (clip)->rest.mask },                                        \
        { .name = "static_before", .buffer = (clip)->rest.before },                                \
        { .name = "static_records", .image = (clip)->rest.records },                               \
        { .name = "dynamic_mask", .buffer = (clip)->moving.mask },                                 \
        { .name = "dynamic_before", .buffer = (clip)->moving.before },                             \
    {                                                                                              \
        .name = "dynamic_records", .image = (clip)->moving.records                                 \
    }

// Draws by what their materials read; maps that one of a kind lacks are white. Those with
// maps may glow, too.
enum vct_kind { VCT_PLAIN, VCT_GLOWING, VCT_LAMP, VCT_MAPPED, VCT_MASKED, VCT_KINDS };

enum vct_voxels { VCT_BY_COMPUTE, VCT_BY_RASTER };

struct vct_walk { // pipelines for small and for large triangles; by raster one for all
    gpu_pipeline small, large;
};

// The sparse voxel octree: see octree/octree.glsl.
struct vct_svo {
    gpu_buffer nodes, places, blocks, levels;
    gpu_pipeline mark, count, scan, divide, join, mip;
    gpu_pipeline fill[2]; // without what moves, and with it
    struct vct_svo_params params;
};

// What light that glowing surfaces and the sky bring to voxels depends on besides these.
struct vct_brought_by {
    vec3s sky; // scaled
    float radiance_scale;
};

struct vct {
    const char *name; // of the technique
    struct gpu *gpu;
    struct vct_options options;
    struct vct_walk mark, add[VCT_KINDS];
    gpu_pipeline fill[2];             // without and with what moves
    gpu_pipeline inject[2];           // without and with lights
    gpu_pipeline cones[2], bounce[2]; // without and with lamps
    gpu_pipeline count, scan, list, zero, surfaces, texel_lists, mip, edges, gather_rows,
        gather_columns, blur, fit, specular, debug;
    struct vct_lamps lamps;
    struct vct_clip clips[VCT_MAX_CLIPS];
    int clip_count;
    gpu_buffer queue, queue_state;
    gpu_sampler linear;
    struct vct_svo svo; // with storage=svo
    gpu_image light; // six volumes side by side with mips, or the pool of bricks: RGBA16F; mips of
                     // occlusion R16F
    gpu_image edge_image;             // R8: where surfaces end
    gpu_image start_image;            // RG16F: octahedral, the normal that cones start along
    gpu_image traced[3], gathered[3]; // RGBA16F: what cones found as vectors, of each colour
    gpu_image found;                  // RGBA16F: irradiance, share of the cones
    vec3s lines[VCT_MAX_CONES];       // along which the picture's cones point
    struct vct_share_table shares;    // with specular
    struct vct_temporal temporal;     // empty without the option
    uint32_t width, height;           // of these images

    struct vct_params
        params;          // of the frame being recorded; vct_grid_binding adds the place of a grid
    bool ready;          // there is something to voxelise
    bool remade;         // voxels have come anew in this frame
    bool light_valid;    // `light` is last frame's, of this grid
    bool light_outdated; // it has texels that hold nothing any more
    bool brought_valid;  // so is what the voxels got from each other
    struct vct_brought_by brought_by;
    int rounds_left; // of frames that bring what was sent out in the last one, until all is as it
                     // stays
    const struct scene *scene; // that voxels are of
    int moving_draws;          // then
};

int vct_clip_count(const struct vct_options *options);
uint32_t vct_capacity(const struct vct_options *options); // voxels of a set
uint32_t vct_volume_dim(const struct vct_options *options);
uint32_t vct_volume_mips(const struct vct_options *options);
uint32_t
vct_step(const struct vct_options *options); // pixels, across and down, to each that traces cones
uint32_t vct_ways(const struct vct_options *options); // volumes side by side: 6, or 1 for all ways

// Lists of texels of the light volume, one for each level; see volume/texels.comp.
struct vct_texels_push vct_texels_push(const struct vct_options *options, uint32_t levels);
// Of which a texel is a block that gets one irradiance: 8 voxels along a side, not 4, where they
// are no larger than those of the default resolution.
uint32_t vct_block_level(const struct vct_options *options);
size_t vct_texel_words(const struct vct_options *options);
size_t vct_texel_mask_words(const struct vct_options *options);
size_t vct_level_groups(uint32_t level); // where a level's dispatch is in texel_state
bool vct_has_svo(const struct vct_options *options);
struct vct_svo_params vct_svo_params(const struct vct_options *options);
size_t vct_svo_nodes(const struct vct_options *options); // with room for
struct gpu_image_desc vct_svo_pool(const struct vct_options *options);
struct gpu_image_desc vct_light_desc(const struct vct_options *options); // mips, or that pool

// What there is on the GPU. Each may stop half-way; vct_destroy_resources takes what there is.
bool vct_create_images(struct vct *vct, uint32_t width, uint32_t height); // of that many pixels
bool vct_create_resources(struct vct *vct);                               // buffers, light volume
bool vct_create_pipelines(struct vct *vct);
void vct_destroy_resources(struct vct *vct);
void vct_destroy_pipelines(struct vct *vct);
uint64_t vct_resource_bytes(const struct vct_options *options, uint32_t width, uint32_t height);

// Places the grids; false where there is nothing to voxelise.
bool vct_prepare(struct vct *vct, const struct frame_view *view);
struct gpu_binding vct_grid_binding(const struct vct *vct, const struct vct_clip *clip,
                                    struct gpu_cmd *cmd);
// The grids for cones: of pixels, about the eye; of voxels, as far as they reach and as they were
// when light was filled in.
struct gpu_binding vct_clipmap_binding(const struct vct *vct, struct gpu_cmd *cmd);
struct gpu_binding vct_lit_clipmap_binding(const struct vct *vct, struct gpu_cmd *cmd);
// The cones of a voxel, about its normal.
struct vct_cone_params vct_voxel_cones(const struct vct *vct, const struct frame_view *view);
// The stages, in order. Each reads vct->params.
void vct_record_voxels(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view);
void vct_record_bounce(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view);
void vct_record_texels(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd);
void vct_record_light(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view);
void vct_record_fill(struct vct *vct,
                     struct gpu_cmd *cmd); // its last part: with lit voxels as they are
// In place of fill and mips: the tree, where voxels have come anew; and the light in it.
void vct_svo_record_tree(struct vct *vct, struct gpu_cmd *cmd);
void vct_svo_record_light(struct vct *vct, struct gpu_cmd *cmd);
// For shaders that trace cones, which ignore them where there is no octree.
struct gpu_binding vct_svo_binding(struct vct *vct, struct gpu_cmd *cmd);
void vct_record_cones(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view);
// The layer that the last stage fills: irradiance or visibility.
gpu_image vct_result(const struct vct *vct, const struct frame_view *view);
void vct_fill_shares(struct vct_share_table *out); // once
void vct_record_specular(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view);
void vct_record_debug(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                      uint32_t what, gpu_image out);
