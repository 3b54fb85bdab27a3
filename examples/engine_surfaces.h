// G-buffers of an engine in two layouts of its own.
#ifndef ENGINE_SURFACES_H
#define ENGINE_SURFACES_H

#include "engine_camera.h"
#include "host_surfaces.h"

struct engine_layout {
    const char *name;
    enum engine_depth depth;
    VkFormat formats[SURFACE_IMAGES];
};
enum { ENGINE_LAYOUTS = 2 };
extern const struct engine_layout engine_layouts[ENGINE_LAYOUTS];
// The same as the library takes it.
void engine_layout_describe(const struct engine_layout *layout, int width, int height,
                            struct ag_gbuffer_layout *out);

// A frame that the engine draws: boxes and camera as they are, and as they were in the last one.
struct engine_frame {
    struct box boxes[BOXES], last_boxes[BOXES];
    struct engine_camera camera, last_camera;
};
// Stands for an engine's rasterisation: a ray for each pixel, on the CPU.
void engine_draw(const struct engine_frame *frame, const struct engine_layout *layout,
                 const struct host_gbuffer *out);

#endif
