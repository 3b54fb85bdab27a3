// Voxel cone tracing, of light or of occlusion, in a frame_fixture, with its voxels and its light
// volume open to the tests.
#pragma once

#include "frame/frame_fixture.h"
#include "techniques/vct/vct.h"
#include "techniques/vct/vct_state.h"

struct vct_rig {
    struct frame_fixture frame_fixture; // vct_rig_open takes it over
    const struct technique *technique;  // technique_vct unless it is set before it is opened
    struct host *host;                  // of the technique; NULL: the test's
    struct vct *vct;
};

// Fill the frame_fixture between these two.
void vct_rig_init(struct vct_rig *rig, struct gpu *gpu);
// Between the two: a triangle of its own mesh; returns its instance.
int vct_rig_add_triangle(struct vct_rig *rig, const vec3s corners[3], int material);
void vct_rig_open(struct vct_rig *rig, const char *options);
void vct_rig_finish(struct vct_rig *rig);
// In place of vct_rig_init: a closed hall, 27 by 12 by 20 m, with pillars, a light and an eye in
// it.
void vct_rig_hall(struct vct_rig *rig, struct gpu *gpu);

// All words of a buffer. To be freed.
uint32_t *vct_rig_words(const struct vct_rig *rig, gpu_buffer buffer);
// One word for each 32 voxels of a set, as many as resolution³ need. To be freed.
uint32_t *vct_rig_mask(const struct vct_rig *rig, const struct vct_voxel_set *set);
bool vct_rig_has(const struct vct_rig *rig, const uint32_t *mask, int x, int y, int z);
// As volume/over.glsl says it.
double vct_rig_shown(double left, double alpha, double sheet);
// A level of the light volume, 4 floats a texel, all ways. To be freed.
float *vct_rig_light(const struct vct_rig *rig, uint32_t level);
