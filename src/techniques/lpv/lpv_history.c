#include "techniques/lpv/lpv_history.h"

#include "techniques/lpv/lpv_state.h"

#include "core/hash.h"
#include "frame/scene/scene_gpu.h"

bool lpv_is_static(const struct scene_draw *draw)
{
    return !draw->dynamic;
}

bool lpv_is_moving(const struct scene_draw *draw)
{
    return draw->dynamic && !draw->left;
}

struct lpv_statics lpv_statics_of(const struct lpv *lpv, const struct frame_view *view)
{
    return (struct lpv_statics){ .valid = true,
                                 .grid = lpv->grid,
                                 .first_frame = view->index == 0,
                                 .moving_count = view->scene ? view->scene->dynamic_count : 0,
                                 .set = view->scene ? view->scene->static_set : 0 };
}

// In the first frame of a scene no draw counts as moving yet; a draw that moves later leaves the
// static ones.
bool lpv_statics_equal(const struct lpv_statics *cached, const struct lpv_statics *now)
{
    return cached->valid && !now->first_frame && cached->moving_count == now->moving_count &&
           cached->set == now->set && lpv_grid_equal(&cached->grid, &now->grid);
}

// Lights that did not change and objects that did not move have equal reflective shadow maps. Their
// surfels of the camera's view (geometry=maps) may still differ. A frame without light is not
// recorded, nor its moving draws.
bool lpv_is_kept(struct lpv *lpv, const struct frame_view *view)
{
    const uint64_t steps = hash_bytes(&lpv->options.steps, sizeof(int32_t), view->light_hash);
    kept_update(&lpv->kept, view, hash_bytes(&lpv->params, sizeof lpv->params, steps));
    return view->keep && lpv->kept.same && lpv->options.geometry != LPV_GEOMETRY_MAPS;
}
