// Passes that fill or sample the light depend on its storage; voxelization may use the rasterizer.
#include "techniques/vct/vct_pipelines.h"

#include "techniques/vct/vct_constants.h"
#include "techniques/vct/vct_state.h"

#include "frame/scene_gpu.h"
#include "technique_shaders.h"

#include <string.h>

// Specialization constants that differ from the defaults of the shaders, as bit sets. The first
// ones are those of frame/scene.glsl, in the same order.
enum {
    MAPPED = 1 << 0,
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
};
enum { SCENE_BASE_COLOR_MAP = 0, SCENE_MASKED = 4 }; // constant_id's of frame/scene.glsl
static const struct gpu_constant constant_of_bit[] = {
    { SCENE_BASE_COLOR_MAP, true },
    { SCENE_MASKED, true },
    { VCT_CONSTANT_COLUMNS, true },
    { VCT_CONSTANT_HAS_LIGHTS, false },
    { VCT_CONSTANT_ANISOTROPIC, false },
    { VCT_CONSTANT_HAS_DYNAMIC, false },
    { VCT_CONSTANT_OCCLUSION, true },
    { VCT_CONSTANT_EMISSIVE, false },
    { VCT_CONSTANT_CLIPS, 0 }, // see constants_of
    { VCT_CONSTANT_SMALL_EMITTERS, true },
    { VCT_CONSTANT_BLOCK, 4 },
    { VCT_CONSTANT_EACH_PIXEL, false },
    { VCT_CONSTANT_RAYS, true },
};
enum { CONSTANT_BITS = sizeof constant_of_bit / sizeof constant_of_bit[0] };

struct pipeline_plan {
    gpu_pipeline *out;
    const char *name;
    const struct gpu_shader *shader;
    uint32_t constants;
};

static int constants_of(const struct vct *vct, uint32_t bits,
                        struct gpu_constant out[CONSTANT_BITS])
{
    int count = 0;
    for (int i = 0; i < CONSTANT_BITS; i++) {
        if (!(bits >> i & 1)) continue;
        out[count] = constant_of_bit[i];
        if (1 << i == CLIPS) out[count].value = (uint32_t)vct->clip_count;
        count++;
    }
    return count;
}

// Passes over triangles, by compute shaders or by the rasterizer.
enum { VOXELIZE_PIPELINES = 18 };

static void plan_voxelize(struct vct *vct, struct pipeline_plan out[VOXELIZE_PIPELINES])
{
    struct vct_voxelize_pipelines *plain = &vct->add[VCT_PLAIN],
                                  *emissive = &vct->add[VCT_EMISSIVE],
                                  *emitter = &vct->add[VCT_SMALL_EMITTER],
                                  *maps = &vct->add[VCT_MAPPED], *masks = &vct->add[VCT_MASKED],
                                  *mapped_emitter = &vct->add[VCT_MAPPED_SMALL_EMITTER];
    const bool raster = vct->options.voxels == VCT_BY_RASTER;
    const struct gpu_shader *mark = raster ? &shader_vct_voxelize_mark_raster_frag
                                           : &shader_vct_voxelize_mark_small_comp,
                            *add = raster ? &shader_vct_voxelize_add_raster_frag
                                          : &shader_vct_voxelize_add_small_comp,
                            *outermost = raster ? &shader_vct_voxelize_outermost_raster_frag
                                                : &shader_vct_voxelize_outermost_small_comp,
                            *mark_large = raster ? NULL : &shader_vct_voxelize_mark_large_comp,
                            *outermost_large =
                                raster ? NULL : &shader_vct_voxelize_outermost_large_comp,
                            *add_large = raster ? NULL : &shader_vct_voxelize_add_large_comp;
    const struct pipeline_plan plan[VOXELIZE_PIPELINES] = {
        { &vct->mark.small, "mark", mark, 0 },
        { &vct->mark.large, "mark_large", mark_large, 0 },
        { &vct->outermost[0].small, "outermost", outermost, 0 },
        { &vct->outermost[0].large, "outermost_large", outermost_large, 0 },
        { &vct->outermost[1].small, "outermost_masked", outermost, MAPPED | MASKED },
        { &vct->outermost[1].large, "outermost_masked_large", outermost_large, MAPPED | MASKED },
        { &plain->small, "add", add, NOT_EMISSIVE },
        { &plain->large, "add_large", add_large, NOT_EMISSIVE },
        { &emissive->small, "add_emissive", add, 0 },
        { &emissive->large, "add_emissive_large", add_large, 0 },
        { &emitter->small, "add_small_emitter", add, SMALL_EMITTERS },
        { &emitter->large, "add_small_emitter_large", add_large, SMALL_EMITTERS },
        { &maps->small, "add_mapped", add, MAPPED },
        { &maps->large, "add_mapped_large", add_large, MAPPED },
        { &mapped_emitter->small, "add_mapped_small_emitter", add, MAPPED | SMALL_EMITTERS },
        { &mapped_emitter->large, "add_mapped_small_emitter_large", add_large,
          MAPPED | SMALL_EMITTERS },
        { &masks->small, "add_masked", add, MAPPED | MASKED },
        { &masks->large, "add_masked_large", add_large, MAPPED | MASKED },
    };
    memcpy(out, plan, sizeof plan);
}

static bool create_compute_pipeline(struct vct *vct, const struct pipeline_plan *plan)
{
    struct gpu_constant constants[CONSTANT_BITS];
    const int count = constants_of(vct, plan->constants, constants);
    return gpu_compute_pipeline_create(vct->gpu, plan->name, plan->shader, constants, count,
                                       plan->out);
}

static bool create_raster_pipeline(struct vct *vct, const struct pipeline_plan *plan)
{
    struct gpu_constant constants[CONSTANT_BITS];
    const int count = constants_of(vct, plan->constants, constants);
    const struct gpu_graphics_desc desc = { .name = plan->name,
                                            .vertex = &shader_vct_voxelize_raster_vert,
                                            .fragment = plan->shader,
                                            .constants = constants,
                                            .constant_count = count };
    return gpu_graphics_pipeline_create(vct->gpu, &desc, plan->out);
}

enum { PIPELINES = 16, MIP_PIPELINES = 9, MOST_STORAGE_PIPELINES = 14 };

static void plan_pipelines(struct vct *vct, struct pipeline_plan out[PIPELINES])
{
    const uint32_t kind = vct->options.occlusion ? OCCLUSION : 0,
                   half = vct->options.half_resolution ? HALF_RESOLUTION : 0;
    const bool rays = vct_has_rays(&vct->options);
    const struct gpu_shader *inject_lit =
        vct->options.occlusion ? NULL : &shader_vct_lighting_inject_comp;
    const struct pipeline_plan plan[PIPELINES] = {
        { &vct->count, "count", &shader_vct_voxelize_count_comp, 0 },
        { &vct->scan, "scan", &shader_vct_voxelize_scan_comp, 0 },
        { &vct->list, "list", &shader_vct_voxelize_list_comp, 0 },
        { &vct->zero, "zero", &shader_vct_voxelize_zero_comp, 0 },
        { &vct->surfaces, "surfaces", &shader_vct_voxelize_surfaces_comp, 0 },
        { &vct->texel_lists, "texels", &shader_vct_volume_texels_comp, 0 },
        { &vct->planes, "planes", rays ? &shader_vct_rays_planes_comp : NULL, 0 },
        { &vct->blocks, "blocks", rays ? &shader_vct_rays_blocks_comp : NULL, 0 },
        { &vct->parts, "parts", vct->options.occlusion ? NULL : &shader_vct_lighting_parts_comp,
          vct_block_level(&vct->options) == 2 ? (uint32_t)LARGE_BLOCKS : 0 },
        { &vct->inject[0], "inject_unlit", &shader_vct_lighting_inject_comp, UNLIT },
        { &vct->inject[1], "inject", inject_lit, 0 },
        { &vct->edges, "edges", &shader_vct_cones_edges_comp, CLIPS },
        { &vct->gather_rows, "gather_rows", &shader_vct_cones_gather_comp, kind },
        { &vct->gather_columns, "gather_columns", &shader_vct_cones_gather_comp,
          kind | COLUMNS | half },
        { &vct->blur, "blur", &shader_vct_cones_blur_comp, CLIPS },
        { &vct->upsample, "upsample", half ? &shader_vct_cones_upsample_comp : NULL, kind | CLIPS },
    };
    memcpy(out, plan, sizeof plan);
}

// Passes that fill or sample the light. Returns how many.
static int plan_storage_pipelines(struct vct *vct, struct pipeline_plan out[MOST_STORAGE_PIPELINES])
{
    struct vct_svo *svo = &vct->svo;
    const bool lit = !vct->options.occlusion;
    const uint32_t directions = vct->options.anisotropic ? 0 : ISOTROPIC,
                   kind = directions | (lit ? 0 : (uint32_t)OCCLUSION),
                   rays = vct_has_rays(&vct->options) ? (uint32_t)RAYS : 0,
                   pixel_rays = vct_pixels_have_rays(&vct->options) ? (uint32_t)RAYS : 0;
    const struct pipeline_plan mips[MIP_PIPELINES] = {
        { &vct->bounce[0], "bounce", lit ? &shader_vct_lighting_bounce_mips_comp : NULL,
          directions | CLIPS | rays },
        { &vct->bounce[1], "bounce_small_emitters",
          lit ? &shader_vct_lighting_bounce_mips_comp : NULL,
          directions | CLIPS | rays | SMALL_EMITTERS },
        { &vct->cones[0], "cones", &shader_vct_cones_mips_comp, kind | CLIPS | pixel_rays },
        { &vct->cones[1], "cones_small_emitters", lit ? &shader_vct_cones_mips_comp : NULL,
          directions | CLIPS | pixel_rays | SMALL_EMITTERS },
        { &vct->specular, "specular", lit ? &shader_vct_cones_specular_mips_comp : NULL,
          directions | CLIPS },
        { &vct->fill[0], "fill_static", &shader_vct_volume_fill_comp, kind | NO_DYNAMIC },
        { &vct->fill[1], "fill", &shader_vct_volume_fill_comp, kind },
        { &vct->mip, "mip", &shader_vct_volume_mip_comp, kind },
        { &vct->debug, "debug", &shader_vct_debug_mips_comp, CLIPS },
    };
    const struct pipeline_plan octree[MOST_STORAGE_PIPELINES] = {
        { &vct->bounce[0], "bounce", lit ? &shader_vct_lighting_bounce_svo_comp : NULL,
          directions | CLIPS },
        { &vct->bounce[1], "bounce_small_emitters",
          lit ? &shader_vct_lighting_bounce_svo_comp : NULL, directions | CLIPS | SMALL_EMITTERS },
        { &vct->cones[0], "cones", &shader_vct_cones_svo_comp, kind | CLIPS },
        { &vct->cones[1], "cones_small_emitters", lit ? &shader_vct_cones_svo_comp : NULL,
          directions | CLIPS | SMALL_EMITTERS },
        { &vct->specular, "specular", lit ? &shader_vct_cones_specular_svo_comp : NULL,
          directions | CLIPS },
        { &svo->mark, "svo_mark", &shader_vct_octree_mark_comp, 0 },
        { &svo->count, "svo_count", &shader_vct_octree_count_comp, 0 },
        { &svo->scan, "svo_scan", &shader_vct_octree_scan_comp, 0 },
        { &svo->divide, "svo_divide", &shader_vct_octree_divide_comp, 0 },
        { &svo->fill[0], "svo_fill_static", &shader_vct_octree_fill_comp, directions | NO_DYNAMIC },
        { &svo->fill[1], "svo_fill", &shader_vct_octree_fill_comp, directions },
        { &svo->join, "svo_join", &shader_vct_octree_join_comp, directions },
        { &svo->mip, "svo_mip", &shader_vct_octree_mip_comp, directions },
        { &vct->debug, "debug", &shader_vct_debug_svo_comp, CLIPS },
    };
    if (vct_has_svo(&vct->options))
        memcpy(out, octree, sizeof octree);
    else
        memcpy(out, mips, sizeof mips);
    return vct_has_svo(&vct->options) ? MOST_STORAGE_PIPELINES : MIP_PIPELINES;
}

bool vct_create_pipelines(struct vct *vct)
{
    struct pipeline_plan voxelize[VOXELIZE_PIPELINES], plan[PIPELINES + MOST_STORAGE_PIPELINES];
    plan_voxelize(vct, voxelize);
    plan_pipelines(vct, plan);
    const int count = PIPELINES + plan_storage_pipelines(vct, plan + PIPELINES);
    bool ok = true;
    for (int i = 0; i < VOXELIZE_PIPELINES && ok; i++) {
        if (!voxelize[i].shader) continue;
        ok = vct->options.voxels == VCT_BY_RASTER ? create_raster_pipeline(vct, &voxelize[i])
                                                  : create_compute_pipeline(vct, &voxelize[i]);
    }
    for (int i = 0; i < count && ok; i++)
        ok = !plan[i].shader || create_compute_pipeline(vct, &plan[i]);
    return ok;
}

void vct_destroy_pipelines(struct vct *vct)
{
    struct pipeline_plan voxelize[VOXELIZE_PIPELINES],
        pipelines[PIPELINES + MOST_STORAGE_PIPELINES];
    plan_voxelize(vct, voxelize);
    for (int i = 0; i < VOXELIZE_PIPELINES; i++) gpu_pipeline_destroy(vct->gpu, voxelize[i].out);
    plan_pipelines(vct, pipelines);
    const int count = PIPELINES + plan_storage_pipelines(vct, pipelines + PIPELINES);
    for (int i = 0; i < count; i++) gpu_pipeline_destroy(vct->gpu, pipelines[i].out);
}
