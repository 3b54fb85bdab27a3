// In place of api/renderer/bakes.c, in a library without bakes: no technique of it needs one.
#include "api/renderer/bakes.h"
#include "api/without/absent.h"

bool renderer_bakes_find(struct renderer_bakes *bakes, struct host *host,
                         const struct ag_renderer_desc *desc, const struct gi_spec *spec,
                         const struct gi *running, const struct scene_pose *pose)
{
    (void)bakes;
    (void)host;
    (void)desc;
    (void)spec;
    (void)running;
    (void)pose;
    return true;
}

enum ag_result renderer_bakes_check(const char *function, struct ag_context *context,
                                    const struct ag_bake *const *bakes, int count)
{
    (void)bakes;
    return count == 0 ? AG_OK : api_absent(context, function, "bakes", "AFTERGLOW_BAKES");
}

void renderer_bakes_finish(struct renderer_bakes *bakes)
{
    (void)bakes;
}
