// Voxel cone tracing of light or occlusion in a frame_fixture. Tests can read its voxels and light
// volume.
#pragma once

#include "frame/frame_fixture.h"
#include "techniques/vct/vct.h"
#include "techniques/vct/vct_state.h"

struct vct_fixture {
    struct frame_fixture frame_fixture; // rendered after vct_fixture_open
    const struct technique *technique;  // technique_vct unless set before vct_fixture_open
    struct host *host;                  // for the technique; NULL: test_host()
    struct vct *vct;
};

// Set up the frame_fixture between vct_fixture_init and vct_fixture_open.
void vct_fixture_init(struct vct_fixture *fixture, struct gpu *gpu);
// Before vct_fixture_open: adds a triangle as a mesh of its own; returns its instance.
int vct_fixture_add_triangle(struct vct_fixture *fixture, const vec3s corners[3], int material);
void vct_fixture_open(struct vct_fixture *fixture, const char *options);
void vct_fixture_finish(struct vct_fixture *fixture);
// The next frame voxelizes all geometry, as after a change of it.
void vct_fixture_forget_voxels(struct vct_fixture *fixture);
// Instead of vct_fixture_init: a closed hall, 27 by 12 by 20 m, with pillars, a point light and a
// camera.
void vct_fixture_hall(struct vct_fixture *fixture, struct gpu *gpu);

// Instead of vct_fixture_init: a closed room 11 m wide with a block, a red box and a point light.
// Returns the first of the box's six instances.
int vct_fixture_room(struct vct_fixture *fixture, struct gpu *gpu);
// Moves the box of six instances from the next frame on.
void vct_fixture_move_box(struct vct_fixture *fixture, int first, vec3s by);
// Irradiance after that many more frames. To be freed.
float *vct_fixture_irradiance_after(struct vct_fixture *fixture, int frames);
// Mean absolute difference of two images of irradiance over the mean of b.
double vct_fixture_difference(const float *a, const float *b, size_t count);

// The content of a buffer. To be freed.
uint32_t *vct_fixture_buffer_words(const struct vct_fixture *fixture, gpu_buffer buffer);
// A byte per voxel of a set, a bit per face. To be freed.
uint32_t *vct_fixture_mask(const struct vct_fixture *fixture, const struct vct_voxel_set *set);
bool vct_fixture_occupied(const struct vct_fixture *fixture, const uint32_t *mask, int x, int y,
                          int z);
// Reflectance of a face of a voxel (voxelize/surface.glsl); false where nothing is on it.
bool vct_fixture_reflectance(const struct vct_fixture *fixture, const struct vct_voxel_set *set,
                             const int voxel[3], uint32_t face, vec3s *out);
// As vct_visible_alpha of volume/over.glsl.
double vct_fixture_visible_alpha(double left, double alpha, double sheet);
// A level of the light volume, 4 floats per texel, all directions. To be freed.
float *vct_fixture_light(const struct vct_fixture *fixture, uint32_t level);
