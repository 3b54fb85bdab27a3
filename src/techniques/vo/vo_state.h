// The private state of volumetric obscurance, shared by its stages.
#pragma once

#include "techniques/common/sample_sets.h"
#include "techniques/common/screen_ao.h"
#include "techniques/technique.h"
#include "techniques/vo/vo_shared.h"

enum vo_mode { VO_MODE_LINES, VO_MODE_AREAS, VO_MODE_POINTS };

struct vo_options {
#define OPTION OPTION_FIELD
#include "techniques/vo/vo_options.def"
#undef OPTION
};

struct vo {
    struct vo_options options;
    struct screen_ao ao;
    gpu_pipeline estimate;
    gpu_image moments; // areas: RG32F, mean and variance of depth; level 0 is half resolution
    gpu_pipeline pyramid;
    struct vo_samples table;
};

void vo_estimate_objects(const struct vo_options *options, struct gpu_objects *out);
void vo_record_estimate(struct vo *vo, struct gpu_cmd *cmd, const struct frame_view *view);

// The pyramid of depth moments, for mode=areas.
void vo_pyramid_objects(const struct vo_options *options, uint32_t width, uint32_t height,
                        struct gpu_objects *out);
void vo_record_pyramid(struct vo *vo, struct gpu_cmd *cmd, const struct frame_view *view);
