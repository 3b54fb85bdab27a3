// A program's G-buffer as images of a frame.
#pragma once

#include "api/objects.h"

#include "frame/frame.h"

struct ag_view;

// Whether there is a G-buffer exactly if the view was created for one.
enum ag_result renderer_gbuffer_check(const char *function, const struct ag_view *view,
                                      const struct ag_gbuffer *gbuffer);
// Wraps the images; false: one of them has the wrong size, format, usage or layout. Finish in any
// case, after the frame has been recorded.
bool renderer_gbuffer_open(const struct ag_view *view, const struct ag_gbuffer *gbuffer,
                           struct frame_gbuffer *out);
void renderer_gbuffer_finish(const struct ag_view *view, struct frame_gbuffer *gbuffer);
