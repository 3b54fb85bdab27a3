// The pipelines of voxel cone tracing: what fills and reads the light depends on how it is kept,
// and the voxels may be found by the rasteriser.
#include "techniques/vct/vct_state.h"

#include "technique_shaders.h"

#include <string.h>

// Specialization constants that differ from what shaders take by themselves, as sets of bits.
enum {
    MAPPED = 1, // scene.glsl
    MASKED = 2,
    COLUMNS = 4,         // cones/gather.comp
    UNLIT = 8,           // lighting/inject.comp
    ONE_WAY = 16,        // volume/directions.glsl
    STILL = 32,          // volume/prefilter.glsl
    OCCLUSION = 64,      // volume/directions.glsl
    NO_GLOW = 128,       // voxelize/add.glsl
    GRIDS = 256,         // clipmap/clipmap.glsl
    LAMPS = 512,         // voxelize/add.glsl, cones/small_emitters.glsl
    LARGE_BLOCKS = 1024, // lighting/bounce.comp
    HALF = 2048,         // cones/gather.comp
};
static const struct gpu_constant constant_of_bit[] = { { 0, 1 },  { 4, 1 },  { 0, 1 },  { 0, 0 },
                                                       { 10, 0 }, { 11, 0 }, { 12, 1 }, { 5, 0 },
                                                       { 13, 0 }, { 14, 1 }, { 15, 4 }, { 1, 0 } };
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
        if (1 << i == GRIDS) out[count].value = (uint32_t)vct->clip_count;
        count++;
    }
    return count;
}

// Of both walks, which the rasteriser may make as well.
enum { WALKS = 12 };

static void plan_walks(struct vct *vct, struct pipeline_plan out[WALKS])
{
    struct vct_walk *plain = &vct->add[VCT_PLAIN], *glow = &vct->add[VCT_GLOWING],
                    *lamp = &vct->add[VCT_LAMP], *maps = &vct->add[VCT_MAPPED],
                    *masks = &vct->add[VCT_MASKED];
    const bool raster = vct->options.voxels == VCT_BY_RASTER;
    const struct gpu_shader *mark = raster ? &shader_vct_voxelize_mark_raster_frag
                                           : &shader_vct_voxelize_mark_small_comp,
                            *add = raster ? &shader_vct_voxelize_add_raster_frag
                                          : &shader_vct_voxelize_add_small_comp,
                            *mark_large = raster ? NULL : &shader_vct_voxelize_mark_large_comp,
                            *add_large = raster ? NULL : &shader_vct_voxelize_add_large_comp;
    const struct pipeline_plan plan[WALKS] = {
        { &vct->mark.small, "mark", mark, 0 },
        { &vct->mark.large, "mark_large", mark_large, 0 },
        { &plain->small, "add", add, NO_GLOW },
        { &plain->large, "add_large", add_large, NO_GLOW },
        { &glow->small, "add_glowing", add, 0 },
        { &glow->large, "add_glowing_large", add_large, 0 },
        { &lamp->small, "add_lamp", add, LAMPS },
        { &lamp->large, "add_lamp_large", add_large, LAMPS },
        { &maps->small, "add_mapped", add, MAPPED },
        { &maps->large, "add_mapped_large", add_large, MAPPED },
        { &masks->small, "add_masked", add, MAPPED | MASKED },
        { &masks->large, "add_masked_large", add_large, MAPPED | MASKED },
    };
    memcpy(out, plan, sizeof plan);
}

static bool create_compute_pipeline(struct vct *vct, const struct pipeline_plan *plan)
{
    struct gpu_constant constants[CONSTANT_BITS];
    const int count = constants_of(vct, plan->constants, constants);
    return vct_create_compute(vct->name, vct->gpu, plan->name, plan->shader, constants, count,
                              plan->out);
}

static bool create_raster_pipeline(struct vct *vct, const struct pipeline_plan *plan)
{
    char name[VCT_NAME_SIZE];
    struct gpu_constant constants[CONSTANT_BITS];
    const int count = constants_of(vct, plan->constants, constants);
    const struct gpu_graphics_desc desc = { .name = vct_name(vct->name, plan->name, name),
                                            .vertex = &shader_vct_voxelize_raster_vert,
                                            .fragment = plan->shader,
                                            .constants = constants,
                                            .constant_count = count };
    return gpu_graphics_pipeline_create(vct->gpu, &desc, plan->out);
}

enum { PIPELINES = 13, MIP_PIPELINES = 9, MOST_STORAGE_PIPELINES = 14 };

static void plan_pipelines(struct vct *vct, struct pipeline_plan out[PIPELINES])
{
    const uint32_t kind = vct->options.occlusion ? OCCLUSION : 0,
                   half = vct->options.half ? HALF : 0;
    const struct gpu_shader *inject_lit =
        vct->options.occlusion ? NULL : &shader_vct_lighting_inject_comp;
    const struct pipeline_plan plan[PIPELINES] = {
        { &vct->count, "count", &shader_vct_voxelize_count_comp, 0 },
        { &vct->scan, "scan", &shader_vct_voxelize_scan_comp, 0 },
        { &vct->list, "list", &shader_vct_voxelize_list_comp, 0 },
        { &vct->zero, "zero", &shader_vct_voxelize_zero_comp, 0 },
        { &vct->surfaces, "surfaces", &shader_vct_voxelize_surfaces_comp, 0 },
        { &vct->texel_lists, "texels", &shader_vct_volume_texels_comp, 0 },
        { &vct->inject[0], "inject_unlit", &shader_vct_lighting_inject_comp, UNLIT },
        { &vct->inject[1], "inject", inject_lit, 0 },
        { &vct->edges, "edges", &shader_vct_cones_edges_comp, GRIDS },
        { &vct->gather_rows, "gather_rows", &shader_vct_cones_gather_comp, kind },
        { &vct->gather_columns, "gather_columns", &shader_vct_cones_gather_comp,
          kind | COLUMNS | half },
        { &vct->blur, "blur", &shader_vct_cones_blur_comp, GRIDS },
        { &vct->fit, "fit", half ? &shader_vct_cones_upsample_comp : NULL, kind | GRIDS },
    };
    memcpy(out, plan, sizeof plan);
}

// What fills the light's storage and looks into it. Returns how many.
static int plan_storage_pipelines(struct vct *vct, struct pipeline_plan out[MOST_STORAGE_PIPELINES])
{
    struct vct_svo *svo = &vct->svo;
    const bool lit = !vct->options.occlusion;
    const uint32_t ways = vct->options.anisotropic ? 0 : ONE_WAY,
                   kind = ways | (lit ? 0 : (uint32_t)OCCLUSION),
                   blocks = vct_block_level(&vct->options) == 2 ? (uint32_t)LARGE_BLOCKS : 0;
    const struct pipeline_plan mips[MIP_PIPELINES] = {
        { &vct->bounce[0], "bounce", lit ? &shader_vct_lighting_bounce_mips_comp : NULL,
          ways | blocks | GRIDS },
        { &vct->bounce[1], "bounce_lamps", lit ? &shader_vct_lighting_bounce_mips_comp : NULL,
          ways | blocks | GRIDS | LAMPS },
        { &vct->cones[0], "cones", &shader_vct_cones_mips_comp, kind | GRIDS },
        { &vct->cones[1], "cones_lamps", lit ? &shader_vct_cones_mips_comp : NULL,
          ways | GRIDS | LAMPS },
        { &vct->specular, "specular", lit ? &shader_vct_cones_specular_mips_comp : NULL,
          ways | GRIDS },
        { &vct->fill[0], "fill_still", &shader_vct_volume_fill_comp, kind | STILL },
        { &vct->fill[1], "fill", &shader_vct_volume_fill_comp, kind },
        { &vct->mip, "mip", &shader_vct_volume_mip_comp, kind },
        { &vct->debug, "debug", &shader_vct_debug_mips_comp, GRIDS },
    };
    const struct pipeline_plan octree[MOST_STORAGE_PIPELINES] = {
        { &vct->bounce[0], "bounce", lit ? &shader_vct_lighting_bounce_svo_comp : NULL,
          ways | blocks | GRIDS },
        { &vct->bounce[1], "bounce_lamps", lit ? &shader_vct_lighting_bounce_svo_comp : NULL,
          ways | blocks | GRIDS | LAMPS },
        { &vct->cones[0], "cones", &shader_vct_cones_svo_comp, kind | GRIDS },
        { &vct->cones[1], "cones_lamps", lit ? &shader_vct_cones_svo_comp : NULL,
          ways | GRIDS | LAMPS },
        { &vct->specular, "specular", lit ? &shader_vct_cones_specular_svo_comp : NULL,
          ways | GRIDS },
        { &svo->mark, "svo_mark", &shader_vct_octree_mark_comp, 0 },
        { &svo->count, "svo_count", &shader_vct_octree_count_comp, 0 },
        { &svo->scan, "svo_scan", &shader_vct_octree_scan_comp, 0 },
        { &svo->divide, "svo_divide", &shader_vct_octree_divide_comp, 0 },
        { &svo->fill[0], "svo_fill_still", &shader_vct_octree_fill_comp, ways | STILL },
        { &svo->fill[1], "svo_fill", &shader_vct_octree_fill_comp, ways },
        { &svo->join, "svo_join", &shader_vct_octree_join_comp, ways },
        { &svo->mip, "svo_mip", &shader_vct_octree_mip_comp, ways },
        { &vct->debug, "debug", &shader_vct_debug_svo_comp, GRIDS },
    };
    if (vct_has_svo(&vct->options))
        memcpy(out, octree, sizeof octree);
    else
        memcpy(out, mips, sizeof mips);
    return vct_has_svo(&vct->options) ? MOST_STORAGE_PIPELINES : MIP_PIPELINES;
}

bool vct_create_pipelines(struct vct *vct)
{
    struct pipeline_plan walks[WALKS], plan[PIPELINES + MOST_STORAGE_PIPELINES];
    plan_walks(vct, walks);
    plan_pipelines(vct, plan);
    const int count = PIPELINES + plan_storage_pipelines(vct, plan + PIPELINES);
    bool ok = true;
    for (int i = 0; i < WALKS && ok; i++) {
        if (!walks[i].shader) continue;
        ok = vct->options.voxels == VCT_BY_RASTER ? create_raster_pipeline(vct, &walks[i])
                                                  : create_compute_pipeline(vct, &walks[i]);
    }
    for (int i = 0; i < count && ok; i++)
        ok = !plan[i].shader || create_compute_pipeline(vct, &plan[i]);
    return ok;
}

void vct_destroy_pipelines(struct vct *vct)
{
    struct pipeline_plan walks[WALKS], pipelines[PIPELINES + MOST_STORAGE_PIPELINES];
    plan_walks(vct, walks);
    for (int i = 0; i < WALKS; i++) gpu_pipeline_destroy(vct->gpu, walks[i].out);
    plan_pipelines(vct, pipelines);
    const int count = PIPELINES + plan_storage_pipelines(vct, pipelines + PIPELINES);
    for (int i = 0; i < count; i++) gpu_pipeline_destroy(vct->gpu, pipelines[i].out);
}
