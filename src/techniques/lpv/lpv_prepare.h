// Placement of the grids and the parameters of a frame.
#pragma once

#include <stdbool.h>

struct frame_view;
struct lpv_cascade;
struct lpv_options;

// Fills grid, steps and params of all cascades; false where there is no light or no extent.
bool lpv_prepare(const struct lpv_options *options, struct lpv_cascade *finest,
                 const struct frame_view *view);

// lpv_cascades.c: gives each cascade its grid and steps; false: the scene has no extent.
bool lpv_cascades_place(const struct lpv_options *options, struct lpv_cascade *finest,
                        const struct frame_view *view);
