// Further bounces: surfaces send on what has come to them, while the light is still on its way. All
// of it does nothing where the option `bounces` is 0.
#pragma once

#include "techniques/lpv/lpv_grid.h"

#include "gpu/gpu.h"

struct lpv;
struct lpv_options;
struct frame_view;

struct lpv_bounce {
    gpu_buffer surfaces; // [cell][direction][colour] (lpv_surfaces.comp)
    gpu_image reflected; // what surfaces send on
    gpu_image sent;      // that, and what was injected
    gpu_pipeline opaque, masked, bounce;
    bool kept; // the surfaces are those of `grid`
    struct lpv_grid grid;
};

bool lpv_bounce_create(struct lpv *lpv);
bool lpv_surfaces_create(struct lpv *lpv); // what each cascade has of its own
void lpv_bounce_destroy(struct lpv *lpv);
uint64_t lpv_bounce_bytes(const struct lpv_options *options);
// Makes the surfaces where they have changed.
void lpv_record_surfaces(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
// Whether a bounce follows the step after which `left` more come.
bool lpv_bounces_after(const struct lpv *lpv, int left);
// Fills `reflected` from what has `arrived`, and `sent`.
void lpv_record_bounce(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image arrived);
