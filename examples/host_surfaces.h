// The surfaces of the host of host.c: boxes, in the library's scene and in a G-buffer of its own.
#ifndef HOST_SURFACES_H
#define HOST_SURFACES_H

#include <afterglow/scene.h>

enum { BOXES = 7, BLOCK = BOXES - 1 }; // the last one moves

struct box {
    float center[3], size[3]; // metres
    float color[3];           // linear Rec. 709
    int instance;             // of the scene
};

// A room without a front wall, and two blocks in it.
void boxes_begin(struct box *boxes);
// Adds them to a scene, each as an instance of a mesh of its colour.
enum ag_result boxes_add(struct box *boxes, struct ag_scene *scene);
// Tells the scene where a box is.
enum ag_result box_move(const struct box *box, struct ag_scene *scene);

// A G-buffer as struct ag_gbuffer describes it: 4 bytes a pixel in each image.
enum surface_image { SURFACE_DEPTH, SURFACE_NORMAL, SURFACE_ALBEDO, SURFACE_IMAGES };
// Stands for an engine's rasterisation: a ray for each pixel, on the CPU. `mapped`: the images one
// after the other, rows from the top.
void boxes_draw(const struct box *boxes, const struct ag_camera *camera, int width, int height,
                void *mapped);

#endif
