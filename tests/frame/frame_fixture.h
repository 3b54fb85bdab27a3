// A small scene, a camera, lights and a rendered frame, for tests of pixels:
//
//     struct frame_fixture s;
//     fixture_init(&s, gpu); // empty scene, camera at the origin along −z
//     fixture_floor(&s, 4, fixture_matte(&s, white));
//     fixture_add_sun(&s, direction, lux);
//     fixture_open(&s); // the scene is fixed from here on
//     fixture_render(&s);
//     CHECK_NEAR(fixture_pixel(&s, READ_DIRECT, 8, 8).x, …);
//     fixture_finish(&s);
#pragma once

#include "frame/frame.h"
#include "framework/gpu_test.h"

struct frame_fixture {
    struct gpu *gpu;
    struct scene *scene;
    struct scene_pose pose;
    struct frame *frame;
    struct frame_options options;
    struct frame_input input;
    struct world_light lights[8];
    struct frame_indirect indirect; // used if `needs` or `record` is set
    uint32_t width, height;
};

void fixture_init(struct frame_fixture *s, struct gpu *gpu);
// Also a closed room of 4 × 3 × 4 m, of one fixture_emissive, viewed from a corner.
void fixture_init_furnace(struct frame_fixture *s, struct gpu *gpu, float albedo, float emission);
void fixture_finish(struct frame_fixture *s);
void fixture_open(struct frame_fixture *s);
void fixture_open_frame(struct frame_fixture *s); // the frame alone: the pose is there
void fixture_render(struct frame_fixture *s);
void fixture_resize(struct frame_fixture *s, uint32_t width, uint32_t height);

// Lambertian plus a 4 % GGX lobe at roughness 1.
int fixture_matte(struct frame_fixture *s, vec3s albedo);
int fixture_material(struct frame_fixture *s, const struct material *material);
// Grey, Lambertian alone, and emissive.
int fixture_emissive(struct frame_fixture *s, float albedo, float emission);
// Corners counter-clockwise from the front; uv (0,1) (1,1) (1,0) (0,0). Returns the instance.
int fixture_quad(struct frame_fixture *s, vec3s a, vec3s b, vec3s c, vec3s d, int material);
// Two walls along the y axis, z = 0 and x = 0, viewed from between them; opens the scene.
void fixture_open_two_walls(struct frame_fixture *s);
int fixture_instance(struct frame_fixture *s, int mesh, const struct node *node);
// y = 0, facing up, from −half to half.
int fixture_floor(struct frame_fixture *s, float half, int material);
// A closed box; inwards: normals point inwards.
void fixture_box(struct frame_fixture *s, vec3s min, vec3s max, bool inwards, int material);

struct world_light *fixture_add_sun(struct frame_fixture *s, vec3s direction, vec3s lux);
struct world_light *fixture_add_point(struct frame_fixture *s, vec3s position, vec3s candela);
struct world_light *fixture_add_spot(struct frame_fixture *s, vec3s position, vec3s direction,
                                     float inner_rad, float outer_rad, vec3s candela);
void fixture_look(struct frame_fixture *s, vec3s position, vec3s target);

// Owned by the caller (free); 3 channels, depth and visibility 1, ids 2.
float *fixture_read(struct frame_fixture *s, enum frame_readback what);
vec3s fixture_pixel(struct frame_fixture *s, enum frame_readback what, uint32_t x, uint32_t y);
// Direction of the camera ray through a point of the image, in pixels; 1 m along the view axis.
vec3s fixture_ray(const struct frame_fixture *s, float x, float y);
// Intersection of a pixel's camera ray with the plane dot(p, normal) = offset.
vec3s fixture_ray_on_plane(const struct frame_fixture *s, uint32_t x, uint32_t y, vec3s normal,
                           float offset);
