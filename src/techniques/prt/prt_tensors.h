// The content of a bake. README.md has units and axes.
#pragma once

#include "bake/bake.h"

#include "scene/charts/charts.h"
#include "techniques/common/light_map/tensors.h"
#include "techniques/prt/prt_options.h"
#include "techniques/technique.h"

#define PRT_DIRECT  "transfer/direct"  // F16 [coefficients][texels]
#define PRT_BOUNCE  "transfer/bounce"  // F16 [coefficients][texels][3], interreflected
#define PRT_EMITTED "transfer/emitted" // F32 [texels][3]: bounces of emitted light, interreflected

// ---- prt_charts.c
bool prt_charts(const struct scene_pose *statics, const void *options, struct host *host,
                struct charts *out);

// ---- bake/stages.c
bool prt_bake(struct bake_plan *plan, const struct technique_bake *how);
