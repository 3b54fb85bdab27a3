// A program's G-buffer as images of a frame.
#pragma once

#include "api/renderer/view_matrices.h"

#include "frame/frame.h"

struct ag_view;

// Whether there is a G-buffer exactly if the view was created for one.
enum ag_result renderer_gbuffer_check(const char *function, const struct ag_view *view,
                                      const struct ag_gbuffer *gbuffer);
// Wraps the images; false: one of them has the wrong size, format, usage or layout. matrices: of
// the frame, or NULL. The encoding is that of *out, if the view has a layout, and must live as
// long. Finish in any case, after the frame has been recorded.
bool renderer_gbuffer_open(const struct ag_view *view, const struct ag_gbuffer *gbuffer,
                           const struct api_view *matrices, struct gbuffer_encoding *encoding,
                           struct frame_gbuffer *out);
// Whether the view can read the depth of these matrices.
enum ag_result renderer_depth_check(const char *function, const struct ag_view *view,
                                    const struct api_view *matrices);
// For the layout of a description; NULL: none.
enum ag_result renderer_layout_check(const char *function, struct ag_context *context,
                                     bool host_gbuffer, const struct ag_gbuffer_layout *layout);
void renderer_gbuffer_finish(const struct ag_view *view, struct frame_gbuffer *gbuffer);
