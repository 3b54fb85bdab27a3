// The reflecting surfaces of each cell, for further bounces. Those of static draws are kept from
// frame to frame, those of moving draws are added while they move.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_volumes.h"

#include "frame/scene/scene_gpu.h"

#include <assert.h>

static size_t surface_bytes(const struct lpv *lpv)
{
    return lpv_cell_count(&lpv->grid) * LPV_SURFACE_BYTES;
}

static void add(struct lpv *lpv, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                bool (*wanted)(const struct scene_draw *draw), gpu_buffer to)
{
    const struct lpv_pipelines *p = &lpv->pipelines;
    lpv_dispatch_triangles(lpv, cmd, scene, p->surfaces, p->masked_surfaces, wanted, "lpv_surfaces",
                           to);
}

static void add_static(struct lpv *lpv, struct gpu_cmd *cmd, const struct scene_gpu *scene)
{
    gpu_fill_buffer(cmd, lpv->volumes.surfaces, 0, surface_bytes(lpv), 0);
    add(lpv, cmd, scene, lpv_is_static, lpv->volumes.surfaces);
}

// Moving draws join the static ones once they rest. While they move, they join a copy; the sums of
// the injection, already resolved, have room for it.
static void add_moving(struct lpv *lpv, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                       bool rest)
{
    const struct lpv_volumes *v = &lpv->volumes;
    assert(lpv_sum_bytes(&lpv->options) >= LPV_SURFACE_BYTES);
    if (!rest) gpu_copy_buffer(cmd, v->sums, 0, v->surfaces, 0, surface_bytes(lpv));
    add(lpv, cmd, scene, lpv_is_moving, rest ? v->surfaces : v->sums);
}

void lpv_record_surfaces(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct lpv_surface_cache *cache = &lpv->surfaces;
    const struct lpv_statics now = lpv_statics_of(lpv, view);
    const bool same_static = lpv_statics_equal(&cache->statics, &now);
    const bool rest = now.moving_count == 0 || lpv->kept.still;
    if (lpv->options.bounces == 0) return;
    cache->statics = now;
    if (same_static && rest && cache->at_rest) return;
    gpu_scope_begin(cmd, "surfaces");
    if (!same_static || cache->at_rest) add_static(lpv, cmd, view->scene);
    if (now.moving_count > 0) add_moving(lpv, cmd, view->scene, rest);
    gpu_scope_end(cmd);
    cache->at_rest = rest;
}

gpu_buffer lpv_surfaces(const struct lpv *lpv)
{
    return lpv->surfaces.at_rest ? lpv->volumes.surfaces : lpv->volumes.sums;
}
