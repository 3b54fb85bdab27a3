// Passes that fill or sample the light depend on its storage; voxelization may use the rasterizer.
#include "techniques/vct/vct_pipelines.h"

#include "techniques/vct/vct_constants.h"
#include "techniques/vct/vct_state.h"

#include "frame/scene/scene_gpu.h"
#include "technique_shaders.h"

#include <string.h>

// Specialization constants that differ from the defaults of the shaders, as bit sets. The first
// ones are those of frame/scene/scene.glsl, in the same order.
enum {
    TEXTURED = 1 << 0,
    MASKED = 1 << 1,
    COLUMNS = 1 << 2,
    UNLIT = 1 << 3,
    ISOTROPIC = 1 << 4,
    NO_DYNAMIC = 1 << 5,
    OCCLUSION = 1 << 6,
    NOT_EMISSIVE = 1 << 7,
    CLIPS = 1 << 8,
    SMALL_EMITTERS = 1 << 9,
    LARGE_BLOCKS = 1 << 10,
    HALF_RESOLUTION = 1 << 11,
    RAYS = 1 << 12,
    MAP = 1 << 13,
    CLAMP = 1 << 14,
    LARGEST_INTERLEAVE = 1 << 15,
};
// Constants of variants for light that most scenes lack.
enum { MORE_LIGHT = SMALL_EMITTERS | MAP };
enum { SCENE_BASE_COLOR_MAP = 0, SCENE_MASKED = 4 }; // constant_id's of frame/scene/scene.glsl

static void fill_constants(const struct vct_options *options, struct gpu_constant *out)
{
    const struct gpu_constant of_bit[] = {
        { SCENE_BASE_COLOR_MAP, true },
        { SCENE_MASKED, true },
        { VCT_CONSTANT_COLUMNS, true },
        { VCT_CONSTANT_HAS_LIGHTS, false },
        { VCT_CONSTANT_ANISOTROPIC, false },
        { VCT_CONSTANT_HAS_DYNAMIC, false },
        { VCT_CONSTANT_OCCLUSION, true },
        { VCT_CONSTANT_EMISSIVE, false },
        { VCT_CONSTANT_CLIPS, (uint32_t)vct_clip_count(options) },
        { VCT_CONSTANT_SMALL_EMITTERS, true },
        { VCT_CONSTANT_BLOCK, 4 },
        { VCT_CONSTANT_EACH_PIXEL, false },
        { VCT_CONSTANT_RAYS, true },
        { VCT_CONSTANT_MAP, true },
        { VCT_CONSTANT_CLAMP, true },
        { VCT_CONSTANT_INTERLEAVE, VCT_MAX_INTERLEAVE },
    };
    memcpy(out, of_bit, sizeof of_bit);
}

#define PIPELINE(member_, name_, shader_, bits)                                                    \
    {                                                                                              \
        GPU_PIPELINE, name_, offsetof(struct vct, member_), .shader = (shader_), .consts = (bits)  \
    }

// Passes over triangles, by compute shaders or by the rasterizer.
static void add_voxelize(const struct vct_options *o, struct gpu_objects *out)
{
    const bool raster = o->voxels == VCT_BY_RASTER;
    const struct gpu_shader *vertex = raster ? &shader_vct_voxelize_raster_vert : NULL;
#define VOXELIZE(member_, name_, stage, bits)                                                      \
    PIPELINE(member_.large, name_ "_large",                                                        \
             raster ? NULL : &shader_vct_voxelize_##stage##_large_comp, bits),                     \
        { GPU_PIPELINE,                                                                            \
          name_,                                                                                   \
          offsetof(struct vct, member_.small),                                                     \
          .vertex = vertex,                                                                        \
          .shader = raster ? &shader_vct_voxelize_##stage##_raster_frag                            \
                           : &shader_vct_voxelize_##stage##_small_comp,                            \
          .consts = (bits) }
    GPU_ADD(out, 0, VOXELIZE(voxels.mark, "mark", mark, 0),
            VOXELIZE(voxels.outermost[0], "outermost", outermost, 0),
            VOXELIZE(voxels.outermost[1], "outermost_masked", outermost, TEXTURED | MASKED),
            VOXELIZE(voxels.add[VCT_PLAIN], "add", add, NOT_EMISSIVE),
            VOXELIZE(voxels.add[VCT_EMISSIVE], "add_emissive", add, 0),
            VOXELIZE(voxels.add[VCT_SMALL_EMITTER], "add_small_emitter", add, SMALL_EMITTERS),
            VOXELIZE(voxels.add[VCT_TEXTURED], "add_textured", add, TEXTURED),
            VOXELIZE(voxels.add[VCT_TEXTURED_SMALL_EMITTER], "add_textured_small_emitter", add,
                     TEXTURED | SMALL_EMITTERS),
            VOXELIZE(voxels.add[VCT_MASKED], "add_masked", add, TEXTURED | MASKED));
}

static void add_octree(uint32_t directions, struct gpu_objects *out)
{
    GPU_ADD(out, 0, PIPELINE(svo.mark, "svo_mark", &shader_vct_octree_mark_comp, 0),
            PIPELINE(svo.count, "svo_count", &shader_vct_octree_count_comp, 0),
            PIPELINE(svo.scan, "svo_scan", &shader_vct_octree_scan_comp, 0),
            PIPELINE(svo.subdivide, "svo_subdivide", &shader_vct_octree_subdivide_comp, 0),
            PIPELINE(svo.fill[0], "svo_fill_static", &shader_vct_octree_fill_comp,
                     directions | NO_DYNAMIC),
            PIPELINE(svo.fill[1], "svo_fill", &shader_vct_octree_fill_comp, directions),
            PIPELINE(svo.join, "svo_join", &shader_vct_octree_join_comp, directions),
            PIPELINE(svo.mip, "svo_mip", &shader_vct_octree_mip_comp, directions));
}

// A pass that traces, by vct_light_variant. still: bits of those without moving voxels.
#define VARIANTS(member, name, shader, shader_more, bits, still, more)                             \
    PIPELINE(member[0], name, shader, (bits) | (still)),                                           \
        PIPELINE(member[1], name "_dynamic", shader, bits),                                        \
        PIPELINE(member[2], name "_more", shader_more, (bits) | (still) | (more)),                 \
        PIPELINE(member[3], name "_more_dynamic", shader_more, (bits) | (more))

// Passes that fill or sample the light. An octree has no rays.
static void add_light(const struct vct_options *o, struct gpu_objects *out)
{
    const bool svo = vct_has_svo(o), lit = !o->occlusion;
    const uint32_t directions = o->anisotropic ? 0 : ISOTROPIC,
                   kind = directions | (lit ? 0 : (uint32_t)OCCLUSION),
                   rays = vct_has_rays(o) ? (uint32_t)RAYS : 0,
                   pixel_rays = vct_pixels_have_rays(o) ? (uint32_t)RAYS : 0,
                   still = svo ? 0 : (uint32_t)NO_DYNAMIC;
#define STORED(name) (svo ? &shader_vct_##name##_svo_comp : &shader_vct_##name##_mips_comp)
    const struct gpu_shader *bounce = lit ? STORED(lighting_bounce) : NULL, *cones = STORED(cones),
                            *specular = lit ? STORED(cones_specular) : NULL,
                            *average = o->temporal ? &shader_vct_cones_lobe_average_temporal_comp
                                                   : &shader_vct_cones_lobe_average_frame_comp;
    GPU_ADD(
        out, 0,
        VARIANTS(lighting.bounce, "bounce", bounce, bounce, directions | CLIPS | rays, still,
                 MORE_LIGHT),
        VARIANTS(cones.trace, "cones", cones, lit ? cones : NULL, kind | CLIPS | pixel_rays, still,
                 MORE_LIGHT),
        VARIANTS(specular.trace, "specular", specular, specular, directions | CLIPS | rays, still,
                 MAP),
        PIPELINE(specular.lobe_average, "lobe_average", lit && rays ? average : NULL, 0),
        PIPELINE(specular.reflect, "reflect", lit ? &shader_vct_cones_reflect_comp : NULL, rays),
        PIPELINE(debug, "debug", STORED(debug), CLIPS));
    if (svo)
        add_octree(directions, out);
    else
        GPU_ADD(out, 0,
                PIPELINE(volume.fill[0], "fill_static", &shader_vct_volume_fill_comp,
                         kind | NO_DYNAMIC),
                PIPELINE(volume.fill[1], "fill", &shader_vct_volume_fill_comp, kind),
                PIPELINE(volume.mip, "mip", &shader_vct_volume_mip_comp, kind));
}

static void add_history(const struct vct_options *o, struct gpu_objects *out)
{
    const bool denoises = vct_denoises(o), clamps = o->clamp > 0.0f;
    const uint32_t kind = denoises ? (uint32_t)RAYS : 0;
    GPU_ADD(out, 0,
            PIPELINE(history.first, "temporal_first", &shader_vct_cones_temporal_first_comp, kind),
            PIPELINE(history.keep, "temporal", clamps ? NULL : &shader_vct_cones_temporal_keep_comp,
                     kind),
            PIPELINE(history.follow, "temporal_follow", &shader_vct_cones_temporal_follow_comp,
                     kind | (clamps ? (uint32_t)CLAMP : 0)),
            PIPELINE(history.denoise[0], "denoise",
                     denoises ? &shader_vct_cones_denoise_straight_comp : NULL, 0),
            PIPELINE(history.denoise[1], "denoise_diagonal",
                     denoises ? &shader_vct_cones_denoise_diagonal_comp : NULL, 0));
}

void vct_add_pipelines(const struct vct_options *o, struct gpu_objects *out)
{
    const uint32_t kind = o->occlusion ? OCCLUSION : 0,
                   half = o->half_resolution ? HALF_RESOLUTION : 0,
                   block = vct_block_level(o) == 2 ? LARGE_BLOCKS : 0;
    const bool rays = vct_has_rays(o), lit = !o->occlusion;
    fill_constants(o, out->constants);
    add_voxelize(o, out);
    add_light(o, out);
    GPU_ADD(
        out, 0, PIPELINE(voxels.count, "count", &shader_vct_voxelize_count_comp, 0),
        PIPELINE(voxels.scan, "scan", &shader_vct_voxelize_scan_comp, 0),
        PIPELINE(voxels.list, "list", &shader_vct_voxelize_list_comp, 0),
        PIPELINE(voxels.zero, "zero", &shader_vct_voxelize_zero_comp, 0),
        PIPELINE(voxels.surfaces, "surfaces", &shader_vct_voxelize_surfaces_comp, 0),
        PIPELINE(volume.texels, "texels", &shader_vct_volume_texels_comp, 0),
        PIPELINE(rays.planes, "planes", rays ? &shader_vct_rays_planes_comp : NULL, 0),
        PIPELINE(rays.blocks, "blocks", rays ? &shader_vct_rays_blocks_comp : NULL, 0),
        PIPELINE(lighting.parts, "parts", lit ? &shader_vct_lighting_parts_comp : NULL, block),
        PIPELINE(lighting.inject[0], "inject_unlit", &shader_vct_lighting_inject_comp, UNLIT),
        PIPELINE(lighting.inject[1], "inject", lit ? &shader_vct_lighting_inject_comp : NULL, 0),
        PIPELINE(cones.edges, "edges", &shader_vct_cones_edges_comp, CLIPS),
        PIPELINE(cones.gather_rows[0], "gather_rows", &shader_vct_cones_gather_comp, kind),
        PIPELINE(cones.gather_rows[1], "gather_rows_largest", &shader_vct_cones_gather_comp,
                 kind | LARGEST_INTERLEAVE),
        PIPELINE(cones.gather_columns[0], "gather_columns", &shader_vct_cones_gather_comp,
                 kind | COLUMNS | half),
        PIPELINE(cones.gather_columns[1], "gather_columns_largest", &shader_vct_cones_gather_comp,
                 kind | COLUMNS | half | LARGEST_INTERLEAVE),
        PIPELINE(cones.blur, "blur", &shader_vct_cones_blur_comp, CLIPS),
        PIPELINE(cones.upsample, "upsample", half ? &shader_vct_cones_upsample_comp : NULL,
                 kind | CLIPS));
    if (o->temporal) add_history(o, out);
}
