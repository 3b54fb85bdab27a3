// Finds the bakes that the techniques of a renderer need.
#pragma once

#include "api/objects.h"
#include "bake/bake.h"
#include "techniques/gi.h"

struct renderer_bakes {
    struct gi_bakes found; // for gi_create_baked
    struct bake *own[GI_MAX_TERMS];
    struct technique_bake how[GI_MAX_TERMS];
};
// `bakes` is zeroed. Leaves out techniques that continue in `running`; NULL: none. False: a
// technique needs a bake and there is none; the message says which.
// Finish in any case, after gi_create_baked.
bool renderer_bakes_find(struct renderer_bakes *bakes, struct host *host,
                         const struct ag_renderer_desc *desc, const struct gi_spec *spec,
                         const struct gi *running, const struct scene_pose *pose);
enum ag_result renderer_bakes_check(const char *function, struct ag_context *context,
                                    const struct ag_bake *const *bakes, int count);
void renderer_bakes_finish(struct renderer_bakes *bakes);
