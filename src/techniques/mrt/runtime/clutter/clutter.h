// Clutter of a level on the GPU: direct light of its texels, c of its faces.
#pragma once

#include "techniques/mrt/runtime/runtime.h"

// Without openings that are clutter nothing is created.
bool mrt_clutter_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
// ---- direct.c: direct light of its faces
bool mrt_clutter_direct_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
// ---- map.c: its light map
bool mrt_clutter_map_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);

// Radiosity of direct light of the faces; runtime->level has the parameters of direct light.
void mrt_record_clutter_direct(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                               const struct frame_view *view);
// Its light map, from the newest b and r; pixels that it lights, before `apply`. Returns whether
// the alpha of irradiance tells which these are.
void mrt_record_clutter_map(struct mrt_runtime *runtime, struct gpu_cmd *cmd);
bool mrt_record_clutter_pixels(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                               const struct frame_view *view);
// T_b→r of each bounce and c, where there is clutter.
void mrt_record_clutter_couple(struct mrt_runtime *runtime, struct gpu_cmd *cmd);
