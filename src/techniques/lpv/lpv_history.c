#include "techniques/lpv/lpv_history.h"

#include "techniques/lpv/lpv_frame.h"

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

struct lpv_statics lpv_statics_of(const struct lpv_grid *grid, const struct frame_view *view)
{
    return (struct lpv_statics){ .valid = true,
                                 .grid = *grid,
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
bool lpv_is_kept(struct lpv_cascade *cascade, const struct lpv_options *options,
                 const struct frame_view *view)
{
    const uint64_t steps = hash_bytes(&cascade->steps, sizeof cascade->steps, view->light_hash);
    kept_update(&cascade->kept, view, hash_bytes(&cascade->params, sizeof cascade->params, steps));
    return view->keep && cascade->kept.same && options->geometry != LPV_GEOMETRY_MAPS;
}
