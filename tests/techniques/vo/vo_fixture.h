// Volumetric obscurance in a full frame, with access to its unfiltered estimate.
#pragma once

#include "frame/frame_fixture.h"
#include "techniques/vo/vo_state.h"

struct vo_fixture {
    struct frame_fixture *frame_fixture;
    struct vo *vo;
};

// The frame_fixture is open and sized. options: "samples=9,radius=1".
struct vo_fixture vo_fixture_create(struct frame_fixture *frame_fixture, const char *options);
void vo_fixture_destroy(struct vo_fixture *fixture);
// Renders a frame and returns the unfiltered estimate in full precision; the caller frees it.
float *vo_fixture_estimate(struct vo_fixture *fixture);
