// Renderers with several views of the Cornell box. A failure fails the test.
#pragma once

#include "api/renderer_fixture.h"

// From the other side of the room.
struct ag_camera view_other_camera(const struct ag_camera *camera);
struct ag_renderer *view_make_renderer(struct renderer_fixture *s, const char *gi, int width,
                                       int height, const struct ag_bake *bake);
struct ag_view *view_create(struct renderer_fixture *s, struct ag_renderer *renderer,
                            const struct ag_view_desc *desc);
// Has all layers, in memory of its own.
struct ag_view *view_make(struct renderer_fixture *s, struct ag_renderer *renderer, int width,
                          int height);
// Shares the memory of its layers, but for color and display, with the other views.
struct ag_view *view_make_lean(struct renderer_fixture *s, struct ag_renderer *renderer, int width,
                               int height);
void view_render(struct renderer_fixture *s, struct ag_renderer *renderer,
                 const struct ag_camera *camera, const struct ag_view_frame *views, int count);
struct ag_view_frame view_in_frame(struct ag_view *view, const struct ag_camera *camera);
// The caller destroys it. view NULL: of the renderer's own camera.
struct ag_image *view_read_layer(struct renderer_fixture *s, struct ag_renderer *renderer,
                                 struct ag_view *view, const char *layer);
// A layer of a view, or of a renderer's own camera, is that of another renderer to the bit.
void view_check_layer(struct renderer_fixture *s, const char *layer, struct ag_renderer *renderer,
                      struct ag_view *view, struct ag_renderer *alone);
