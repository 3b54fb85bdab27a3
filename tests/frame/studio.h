// A small scene, a camera, lights and a frame of it, for tests that look at pixels.
//
//     struct studio s;
//     studio_init(&s, gpu);                    // empty scene, camera at the origin looking along
//     −z studio_floor(&s, 4, studio_matte(&s, white)); studio_add_sun(&s, direction, lux);
//     studio_open(&s);                         // from here on the scene is fixed
//     studio_render(&s);
//     CHECK_NEAR(studio_pixel(&s, READ_DIRECT, 8, 8).x, …);
//     studio_finish(&s);
#pragma once

#include "frame/frame.h"
#include "framework/gpu_test.h"

struct studio {
    struct gpu *gpu;
    struct scene *scene;
    struct scene_pose pose;
    struct frame *frame;
    struct frame_options options;
    struct frame_input input;
    struct world_light lights[8];
    struct frame_indirect indirect; // used where `needs` or `record` is set
    uint32_t width, height;
};

void studio_init(struct studio *s, struct gpu *gpu);
void studio_finish(struct studio *s);
void studio_open(struct studio *s);
void studio_render(struct studio *s);
void studio_resize(struct studio *s, uint32_t width, uint32_t height);

// Lambertian but for the 4 % of GGX at full roughness.
int studio_matte(struct studio *s, vec3s albedo);
int studio_material(struct studio *s, const struct material *material);
// Corners counter-clockwise from the front; uv (0,1) (1,1) (1,0) (0,0). Returns the instance.
int studio_quad(struct studio *s, vec3s a, vec3s b, vec3s c, vec3s d, int material);
int studio_instance(struct studio *s, int mesh, const struct node *node);
// y = 0, facing up, from −half to half.
int studio_floor(struct studio *s, float half, int material);
// A closed box; inwards: its faces look to the inside.
void studio_box(struct studio *s, vec3s min, vec3s max, bool inwards, int material);

struct world_light *studio_add_sun(struct studio *s, vec3s direction, vec3s lux);
struct world_light *studio_add_point(struct studio *s, vec3s position, vec3s candela);
struct world_light *studio_add_spot(struct studio *s, vec3s position, vec3s direction,
                                    float inner_rad, float outer_rad, vec3s candela);
void studio_look(struct studio *s, vec3s eye, vec3s target);

// Owned by the caller (free); 3 channels, depth and visibility 1.
float *studio_read(struct studio *s, enum frame_readback what);
vec3s studio_pixel(struct studio *s, enum frame_readback what, uint32_t x, uint32_t y);
// Where the ray of a pixel's centre meets the plane dot(p, normal) = offset.
vec3s studio_ray_on_plane(const struct studio *s, uint32_t x, uint32_t y, vec3s normal,
                          float offset);
