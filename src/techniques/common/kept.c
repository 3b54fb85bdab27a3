#include "techniques/common/kept.h"

void kept_update(struct kept *k, const struct frame_view *view, uint64_t light)
{
    k->follows = k->known && view->index > 0 && view->index == k->index + 1;
    k->still = k->follows && !view->geometry_moved;
    k->same = k->still && k->lit && light == k->light;
    if (!k->same) k->since = view->index;
    k->known = k->lit = true;
    k->index = view->index;
    k->light = light;
}
