// Volumetric obscurance in the studio, with its estimate open to the tests.
#pragma once

#include "frame/studio.h"
#include "techniques/vo/vo_state.h"

struct vo_rig {
    struct studio *studio;
    struct vo *vo;
};

// The studio is open and has its size. options: "samples=9,radius=1".
struct vo_rig vo_rig_create(struct studio *studio, const char *options);
void vo_rig_destroy(struct vo_rig *rig);
// Renders a frame. What the technique estimates before anything is evened out, in full precision;
// to be freed.
float *vo_rig_estimate(struct vo_rig *rig);
