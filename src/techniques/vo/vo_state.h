// The private state of volumetric obscurance, shared by its stages.
#pragma once

#include "techniques/common/sample_sets.h"
#include "techniques/common/screen_ao.h"
#include "techniques/technique.h"
#include "techniques/vo/vo_shared.h"

enum vo_mode { VO_MODE_LINES, VO_MODE_POINTS };

struct vo_options {
#define OPTION OPTION_FIELD
#include "techniques/vo/vo_options.def"
#undef OPTION
};

struct vo {
    struct gpu *gpu;
    struct vo_options options;
    struct screen_ao ao;
    gpu_pipeline estimate;
    struct vo_samples table;
};

const char *vo_estimate_name(const struct vo_options *options); // "vo.lines"
bool vo_create_estimate(struct vo *vo);
void vo_record_estimate(struct vo *vo, struct gpu_cmd *cmd, const struct frame_view *view);
