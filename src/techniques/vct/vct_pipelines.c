// The pipelines of voxel cone tracing: what fills and reads the light depends on how it is kept,
// and the voxels may be found by the rasteriser.
#include "techniques/vct/vct_state.h"

#include "technique_shaders.h"

#include <string.h>

// See scene.glsl.
static const struct gpu_constant mapped[] = { { 0, 1 } };
static const struct gpu_constant masked[] = { { 0, 1 }, { 4, 1 } };
static const struct gpu_constant columns[] = { { 0, 1 } };
// See vct_inject.comp.
static const struct gpu_constant unlit[] = { { 0, 0 } };
// See vct_ways.glsl and vct_seen.glsl.
static const struct gpu_constant isotropic[] = { { 10, 0 } };
static const struct gpu_constant still[] = { { 11, 0 }, { 10, 0 } };

struct pipeline_plan {
    gpu_pipeline *out;
    const char *name;
    const struct gpu_shader *shader;
    const struct gpu_constant *constants;
    int constant_count;
};

// Of both walks, which the rasteriser may make as well.
enum { WALKS = 8 };

static void plan_walks(struct vct *vct, struct pipeline_plan out[WALKS])
{
    struct vct_walk *plain = &vct->add[VCT_PLAIN], *maps = &vct->add[VCT_MAPPED],
                    *masks = &vct->add[VCT_MASKED];
    const bool raster = vct->options.voxels == VCT_BY_RASTER;
    const struct gpu_shader *mark = raster ? &shader_vct_mark_frag : &shader_vct_mark_comp,
                            *add = raster ? &shader_vct_add_frag : &shader_vct_add_comp,
                            *mark_large = raster ? NULL : &shader_vct_mark_large_comp,
                            *add_large = raster ? NULL : &shader_vct_add_large_comp;
    const struct pipeline_plan plan[WALKS] = {
        { &vct->mark.small, "mark", mark, NULL, 0 },
        { &vct->mark.large, "mark_large", mark_large, NULL, 0 },
        { &plain->small, "add", add, NULL, 0 },
        { &plain->large, "add_large", add_large, NULL, 0 },
        { &maps->small, "add_mapped", add, mapped, 1 },
        { &maps->large, "add_mapped_large", add_large, mapped, 1 },
        { &masks->small, "add_masked", add, masked, 2 },
        { &masks->large, "add_masked_large", add_large, masked, 2 },
    };
    memcpy(out, plan, sizeof plan);
}

static bool create_compute_pipeline(struct vct *vct, const struct pipeline_plan *plan)
{
    return vct_create_compute(vct->name, vct->gpu, plan->name, plan->shader, plan->constants,
                              plan->constant_count, plan->out);
}

static bool create_raster_pipeline(struct vct *vct, const struct pipeline_plan *plan)
{
    char name[VCT_NAME_SIZE];
    const struct gpu_graphics_desc desc = { .name = vct_name(vct->name, plan->name, name),
                                            .vertex = &shader_vct_raster_vert,
                                            .fragment = plan->shader,
                                            .constants = plan->constants,
                                            .constant_count = plan->constant_count };
    return gpu_graphics_pipeline_create(vct->gpu, &desc, plan->out);
}

enum { PIPELINES = 10, MIP_PIPELINES = 7, MOST_STORAGE_PIPELINES = 12 };

static void plan_pipelines(struct vct *vct, struct pipeline_plan out[PIPELINES])
{
    const struct pipeline_plan plan[PIPELINES] = {
        { &vct->count, "count", &shader_vct_count_comp, NULL, 0 },
        { &vct->scan, "scan", &shader_vct_scan_comp, NULL, 0 },
        { &vct->list, "list", &shader_vct_list_comp, NULL, 0 },
        { &vct->texel_lists, "texels", &shader_vct_texels_comp, NULL, 0 },
        { &vct->inject[0], "inject_unlit", &shader_vct_inject_comp, unlit, 1 },
        { &vct->inject[1], "inject", &shader_vct_inject_comp, NULL, 0 },
        { &vct->edges, "edges", &shader_vct_edges_comp, NULL, 0 },
        { &vct->gather_rows, "gather_rows", &shader_vct_gather_comp, NULL, 0 },
        { &vct->gather_columns, "gather_columns", &shader_vct_gather_comp, columns, 1 },
        { &vct->blur, "blur", &shader_vct_blur_comp, NULL, 0 },
    };
    memcpy(out, plan, sizeof plan);
}

// What fills the light's storage and looks into it. Returns how many.
static int plan_storage_pipelines(struct vct *vct, struct pipeline_plan out[MOST_STORAGE_PIPELINES])
{
    struct vct_svo *svo = &vct->svo;
    const struct gpu_constant *ways = vct->options.anisotropic ? NULL : isotropic;
    const int way_count = vct->options.anisotropic ? 0 : 1;
    const struct pipeline_plan mips[MIP_PIPELINES] = {
        { &vct->bounce, "bounce", &shader_vct_bounce_mips_comp, ways, way_count },
        { &vct->cones, "cones", &shader_vct_cones_mips_comp, ways, way_count },
        { &vct->specular, "specular", &shader_vct_specular_mips_comp, ways, way_count },
        { &vct->fill[0], "fill_still", &shader_vct_fill_comp, still, 1 + way_count },
        { &vct->fill[1], "fill", &shader_vct_fill_comp, ways, way_count },
        { &vct->mip, "mip", &shader_vct_mip_comp, ways, way_count },
        { &vct->debug, "debug", &shader_vct_debug_mips_comp, NULL, 0 },
    };
    const struct pipeline_plan octree[MOST_STORAGE_PIPELINES] = {
        { &vct->bounce, "bounce", &shader_vct_bounce_svo_comp, ways, way_count },
        { &vct->cones, "cones", &shader_vct_cones_svo_comp, ways, way_count },
        { &vct->specular, "specular", &shader_vct_specular_svo_comp, ways, way_count },
        { &svo->mark, "svo_mark", &shader_vct_svo_mark_comp, NULL, 0 },
        { &svo->count, "svo_count", &shader_vct_svo_count_comp, NULL, 0 },
        { &svo->scan, "svo_scan", &shader_vct_svo_scan_comp, NULL, 0 },
        { &svo->divide, "svo_divide", &shader_vct_svo_divide_comp, NULL, 0 },
        { &svo->fill[0], "svo_fill_still", &shader_vct_svo_fill_comp, still, 1 + way_count },
        { &svo->fill[1], "svo_fill", &shader_vct_svo_fill_comp, ways, way_count },
        { &svo->join, "svo_join", &shader_vct_svo_join_comp, ways, way_count },
        { &svo->mip, "svo_mip", &shader_vct_svo_mip_comp, ways, way_count },
        { &vct->debug, "debug", &shader_vct_debug_svo_comp, NULL, 0 },
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
    for (int i = 0; i < count && ok; i++) ok = create_compute_pipeline(vct, &plan[i]);
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
