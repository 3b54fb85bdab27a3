// Painted light: checks arguments and forwards to the GI stack.
#include "api/renderer/state.h"

void ag_light_paint_default(struct ag_light_paint *paint)
{
    if (paint) *paint = (struct ag_light_paint){ 0 };
}

static enum ag_result area_check(const char *function, struct ag_context *context,
                                 const struct ag_light_paint *paint)
{
    AG_REQUIRE_FOR(function, context, paint->x >= 0 && paint->y >= 0,
                   "x %d and y %d: the light map begins at 0", paint->x, paint->y);
    AG_REQUIRE_FOR(function, context, paint->width > 0 && paint->height > 0,
                   "width %d and height %d: the rectangle is empty", paint->width, paint->height);
    return AG_OK;
}

enum ag_result ag_renderer_paint_light(struct ag_renderer *r, const struct ag_light_paint *paint)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    AG_REQUIRE_POINTER(context, paint);
    AG_REQUIRE_KNOWN(__func__, context, paint);
    const enum ag_result checked = area_check(__func__, context, paint);
    if (checked != AG_OK) return checked;
    const struct light_map_area area = {
        (uint32_t)paint->x,      (uint32_t)paint->y, (uint32_t)paint->width,
        (uint32_t)paint->height, paint->back,        paint->lux
    };
    renderer_enter(r);
    const bool ok = gi_paint(r->gi, &area);
    if (ok) frame_invalidate(r->main.frame);
    renderer_leave(r);
    return api_done(context, ok);
}
