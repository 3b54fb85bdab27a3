// Bindings and dispatches that the stages share.
#pragma once

#include "gpu/gpu.h"

struct lpv_cascade;
struct lpv_frame;

// The uniform block "lpv_grid": grid and parameters of the frame.
struct gpu_binding lpv_grid_binding(const struct lpv_cascade *cascade, struct gpu_cmd *cmd);
// One invocation for each column of `run` cells along z.
void lpv_dispatch_cells(const struct lpv_cascade *cascade, struct gpu_cmd *cmd,
                        gpu_pipeline pipeline, uint32_t run, const struct gpu_binding *bindings,
                        int count);
// The same with push constants, one invocation for each cell.
void lpv_dispatch_cells_push(const struct lpv_cascade *cascade, struct gpu_cmd *cmd,
                             gpu_pipeline pipeline, const struct gpu_binding *bindings, int count,
                             const void *push, uint32_t push_bytes);
// Every triangle of the draws that `wanted` accepts (lpv_history.h). `buffer` is bound by
// `name`, the grid beside it.
struct scene_draw;
void lpv_dispatch_triangles(const struct lpv_cascade *cascade, const struct lpv_frame *frame,
                            gpu_pipeline opaque, gpu_pipeline masked,
                            bool (*wanted)(const struct scene_draw *draw), const char *name,
                            gpu_buffer buffer);
