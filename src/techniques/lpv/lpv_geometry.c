// The geometry volume: its life, and which way it is filled.
#include "techniques/lpv/lpv_geometry.h"

#include "techniques/lpv/lpv_state.h"

#include "technique_shaders.h"

static const uint32_t CONSTANT_MASKED = 4; // of frame/scene.glsl

static bool create_buffer(struct lpv *lpv, const char *name, size_t bytes, gpu_buffer *out)
{
    const struct gpu_buffer_desc desc = { name, bytes, GPU_BUFFER_STORAGE };
    return gpu_buffer_create(lpv->gpu, &desc, out);
}

static size_t cells_of(const struct lpv_options *options)
{
    const size_t dim = (size_t)options->dim;
    return dim * dim * dim;
}

static bool create_volume(struct lpv *lpv)
{
    const uint32_t dim = (uint32_t)lpv->options.dim;
    const struct gpu_image_desc desc = { .name = lpv->names->of_geometry.volume,
                                         .dimension = GPU_3D,
                                         .format = GPU_RGBA16F,
                                         .width = dim,
                                         .height = dim,
                                         .depth = dim,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    return gpu_image_create(lpv->gpu, &desc, &lpv->geometry.volume);
}

static size_t share_bytes(const struct lpv_options *options)
{
    return 4 * (size_t)(options->neighbours == LPV_SIX ? LPV_WORDS_OF_6 : LPV_WORDS_OF_26);
}

static bool create_shares(struct lpv *lpv)
{
    const struct lpv_options *options = &lpv->options;
    const struct lpv_geometry_names *name = &lpv->names->of_geometry;
    const struct gpu_constant constants[] = {
        { LPV_CONSTANT_GEOMETRY, (uint32_t)options->geometry },
        { LPV_CONSTANT_NEIGHBOURS, options->neighbours == LPV_SIX ? 6 : 26 },
    };
    return create_buffer(lpv, name->shares, cells_of(options) * share_bytes(options),
                         &lpv->geometry.shares) &&
           gpu_compute_pipeline_create(lpv->gpu, name->to_shares, &shader_lpv_geometry_shares_comp,
                                       constants, 2, &lpv->geometry.to_shares);
}

static bool create_maps(struct lpv *lpv)
{
    const struct lpv_geometry_names *name = &lpv->names->of_geometry;
    struct lpv_geometry *g = &lpv->geometry;
    return create_buffer(lpv, name->areas, cells_of(&lpv->options) * LPV_AREA_BYTES, &g->areas) &&
           gpu_compute_pipeline_create(lpv->gpu, name->light, &shader_lpv_geometry_light_comp, NULL,
                                       0, &g->light) &&
           gpu_compute_pipeline_create(lpv->gpu, name->camera, &shader_lpv_geometry_camera_comp,
                                       NULL, 0, &g->camera) &&
           gpu_compute_pipeline_create(lpv->gpu, name->merge, &shader_lpv_geometry_merge_comp, NULL,
                                       0, &g->merge);
}

static bool create_scene(struct lpv *lpv)
{
    const struct lpv_geometry_names *name = &lpv->names->of_geometry;
    struct lpv_geometry *g = &lpv->geometry;
    const size_t bytes = cells_of(&lpv->options) * LPV_LINES_BYTES;
    const struct gpu_constant masked = { CONSTANT_MASKED, 1 };
    return create_buffer(lpv, name->still, bytes, &g->still) &&
           create_buffer(lpv, name->moving, bytes, &g->moving) &&
           gpu_compute_pipeline_create(lpv->gpu, name->lines, &shader_lpv_geometry_lines_comp, NULL,
                                       0, &g->lines) &&
           gpu_compute_pipeline_create(lpv->gpu, name->masked_lines,
                                       &shader_lpv_geometry_lines_comp, &masked, 1,
                                       &g->masked_lines) &&
           gpu_compute_pipeline_create(lpv->gpu, name->faces, &shader_lpv_geometry_faces_comp, NULL,
                                       0, &g->faces);
}

bool lpv_geometry_create(struct lpv *lpv)
{
    if (lpv->options.geometry == LPV_GEOMETRY_OFF) return true;
    return create_volume(lpv) && create_shares(lpv) &&
           (lpv->options.geometry == LPV_GEOMETRY_MAPS ? create_maps(lpv) : create_scene(lpv));
}

void lpv_geometry_destroy(struct lpv *lpv)
{
    struct lpv_geometry *g = &lpv->geometry;
    gpu_pipeline *pipelines[] = { &g->light,        &g->camera, &g->merge,    &g->lines,
                                  &g->masked_lines, &g->faces,  &g->to_shares };
    gpu_buffer *buffers[] = { &g->areas, &g->still, &g->moving, &g->shares };
    for (size_t i = 0; i < sizeof pipelines / sizeof *pipelines; i++)
        gpu_pipeline_destroy(lpv->gpu, pipelines[i]);
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        gpu_buffer_destroy(lpv->gpu, buffers[i]);
    gpu_image_destroy(lpv->gpu, &g->volume);
}

uint64_t lpv_geometry_bytes(const struct lpv_options *options)
{
    const uint64_t volume = (uint64_t)gpu_format_bytes(GPU_RGBA16F) + share_bytes(options);
    switch (options->geometry) {
    case LPV_GEOMETRY_MAPS:
        return cells_of(options) * (volume + LPV_AREA_BYTES);
    case LPV_GEOMETRY_SCENE:
        return cells_of(options) * (volume + 2 * LPV_LINES_BYTES);
    default:
        return 0;
    }
}

void lpv_geometry_forget(struct lpv *lpv)
{
    lpv->geometry.kept = false;
}

static void record_shares(struct lpv *lpv, struct gpu_cmd *cmd)
{
    struct lpv_geometry *g = &lpv->geometry;
    lpv_dispatch_cells(lpv, cmd, g->to_shares, 1,
                       GPU_BIND(lpv_grid_binding(lpv, cmd),
                                { .name = "geometry", .image = g->volume, .sampler = lpv->linear },
                                { .name = "lpv_shares", .buffer = g->shares }));
}

void lpv_record_geometry(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct lpv_geometry *g = &lpv->geometry;
    bool anew = true;
    if (lpv->options.geometry == LPV_GEOMETRY_OFF) return;
    gpu_scope_begin(cmd, lpv->names->geometry);
    if (lpv->options.geometry == LPV_GEOMETRY_MAPS)
        lpv_record_geometry_maps(lpv, cmd, view);
    else
        anew = lpv_record_geometry_scene(lpv, cmd, view);
    if (anew || g->kept_blocking != lpv->options.blocking) record_shares(lpv, cmd);
    g->kept_blocking = lpv->options.blocking;
    gpu_scope_end(cmd);
}
