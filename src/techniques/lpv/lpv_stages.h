// The stages of a frame, in order. Each reads lpv->params; each records into `cmd`.
#pragma once

#include "techniques/lpv/lpv_state.h"

// lpv_params.c: places the grids and fills the parameters of all cascades; false where there is no
// light or no extent.
bool lpv_prepare(struct lpv *finest, const struct frame_view *view);

// inject/inject.c: virtual lights to integer sums, sums to `injected`.
void lpv_record_injection(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
void lpv_record_resolve(struct lpv *lpv, struct gpu_cmd *cmd); // the second of the two

// lpv_surfaces.c: for further bounces; nothing where the option `bounces` is 0.
// After the injection, whose sums it may overwrite.
void lpv_record_surfaces(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
gpu_buffer lpv_surfaces(const struct lpv *lpv); // of the frame being recorded

// lpv_bounce.c
// Whether a bounce follows a step; `left` steps remain after it.
bool lpv_bounces_after(const struct lpv *lpv, int left);
// Fills `sent` from the injected light and the light `arrived`.
void lpv_record_bounce(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image arrived);

// lpv_cascades.c
// The coarser cascades get what the complete finest one shares.
void lpv_cascades_create(struct lpv_cascades *cascades);
// Gives each cascade its grid; false: the scene has no extent.
bool lpv_cascades_place(struct lpv *finest, const struct frame_view *view);
// Resamples the light of the next coarser cascade into `to`, the input of the first step.
void lpv_record_refinement(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image to);

// lpv_propagate.c
void lpv_record_propagation(struct lpv *lpv, struct gpu_cmd *cmd);

// lpv_apply.c: irradiance of each pixel, from all cascades.
void lpv_record_application(struct lpv *finest, struct gpu_cmd *cmd, const struct frame_view *view);

// lpv_probes.c: the probe volume, a probe in the centre of each cell of the finest cascade that
// covers the scene; nothing where the option `probes` is off.
// Without light: one black probe.
void lpv_record_probes(struct lpv *finest, struct gpu_cmd *cmd);
bool lpv_probes_publish(const struct lpv *finest, struct probe_volume *out);

// lpv_debug.c: draws LPV_VIEW_… into `out` (RGBA16F of the frame's size).
void lpv_record_debug(struct lpv *finest, struct gpu_cmd *cmd, const struct frame_view *view,
                      uint32_t debug_view, gpu_image out);
