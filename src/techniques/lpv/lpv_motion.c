#include "techniques/lpv/lpv_motion.h"

#include "frame/frame.h"
#include "frame/scene_gpu.h"

bool lpv_is_static(const struct scene_draw *draw)
{
    return !draw->dynamic;
}

bool lpv_is_moving(const struct scene_draw *draw)
{
    return draw->dynamic;
}

struct lpv_motion lpv_motion_of(const struct lpv_grid *grid, const struct frame_view *view)
{
    return (struct lpv_motion){ .valid = true,
                                .grid = *grid,
                                .moving_count = view->scene ? view->scene->dynamic_count : 0,
                                .index = view->index };
}

// In the first frame of a scene no draw counts as moving yet; a draw that moves later leaves the
// static ones.
bool lpv_motion_same_static(const struct lpv_motion *cached, const struct lpv_motion *now)
{
    return cached->valid && now->index > 0 && cached->moving_count == now->moving_count &&
           lpv_grid_equal(&cached->grid, &now->grid);
}

// Motion of a frame without light is not recorded.
bool lpv_motion_at_rest(const struct lpv_motion *cached, const struct lpv_motion *now,
                        const struct frame_view *view)
{
    return now->moving_count == 0 || (!view->geometry_moved && now->index == cached->index + 1);
}
