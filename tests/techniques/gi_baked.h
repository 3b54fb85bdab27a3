// GI stacks with the bakes that they need, run in memory.
#pragma once

#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"

// The bakes of all terms.
struct gi_baked {
    struct gi_bakes bakes; // for gi_create_baked
    struct bake *owned[GI_MAX_TERMS];
    struct technique_bake how[GI_MAX_TERMS];
};
// Runs them on all cores. spec and pose outlive *out. Finish in any case.
bool gi_bake_all(struct gi_baked *out, struct host *host, const struct gi_spec *spec,
                 const struct scene_pose *pose);
void gi_baked_finish(struct gi_baked *baked);

// A stack without bakes.
struct gi *gi_create(struct host *host, struct gpu *gpu, const struct gi_spec *spec,
                     const struct scene_pose *pose, uint32_t width, uint32_t height);
