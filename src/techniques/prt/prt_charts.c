// The charts of the light map, for the bake and the frame.
#include "techniques/prt/prt_tensors.h"

bool prt_charts(const struct scene_pose *statics, const void *options, struct host *host,
                struct charts *out)
{
    enum { MOST_CHARTS = 1 << 20 };
    const struct prt_options *o = options;
    const struct charts_wish wish = { .technique = "prt",
                                      .texels = (uint32_t)o->texels,
                                      .density = o->density,
                                      .most_charts = MOST_CHARTS };
    return charts_init_wanted(out, host, statics, &wish);
}
