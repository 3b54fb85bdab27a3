// The surfaces of the host of host.c: boxes, in the library's scene and in a G-buffer of its own.
#ifndef HOST_SURFACES_H
#define HOST_SURFACES_H

#include "host_gbuffer.h"

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
// Adds a point light below the ceiling.
enum ag_result boxes_add_light(struct ag_scene *scene);
// Tells the scene where a box is.
enum ag_result box_move(const struct box *box, struct ag_scene *scene);

// The nearest face that a ray from `eye` meets.
struct box_hit {
    float distance; // in lengths of the ray; INFINITY: none
    int box, axis;
    bool negative; // the normal points along the axis backwards
};
struct box_hit boxes_hit(const struct box *boxes, const float eye[3], const float ray[3]);

// Stands for an engine's rasterisation, a ray for each pixel on the CPU: images as struct
// ag_gbuffer describes them.
void boxes_draw(const struct box *boxes, const struct ag_camera *camera,
                const struct host_gbuffer *out);
uint8_t srgb_byte(float linear);
float linear_from_srgb(uint8_t byte);

#endif
