// A image of the scene by one method: a renderer, and how its image comes into the window.
#pragma once

#include "viewer/window/swapchain.h"

#include <afterglow/afterglow.h>

struct rendering {
    const struct gpu *gpu;
    struct ag_context *context;
    struct ag_renderer *renderer;
    int width, height;
    struct ag_layer_handle shown; // the layer display of the newest frame; without an image: none
};

struct rendering_desc {
    const struct gpu *gpu;
    struct ag_context *context;
    struct ag_device *device;
    struct ag_scene *scene;
    int width, height;
    const char *gi, *frame_options;
    const struct ag_bake *const *bakes;
    int bake_count;
};

enum ag_result rendering_open(struct rendering *rendering, const struct rendering_desc *desc);
void rendering_close(struct rendering *rendering); // accepts zero
enum ag_result rendering_resize(struct rendering *rendering, int width, int height);
// Renders a frame, which rendering_draw then shows.
enum ag_result rendering_render(struct rendering *rendering, const struct ag_frame_desc *frame);
// Draws the part from `left` to `right`, 0…1 of the width, to the same part of a rectangle of the
// window, in pixels: x0, y0, x1, y1. Outside of the window's pass.
void rendering_draw(const struct rendering *rendering, struct swapchain *swapchain,
                    const float rectangle[4], float left, float right);
