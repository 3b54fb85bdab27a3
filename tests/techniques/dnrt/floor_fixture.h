// Irradiance of a floor beside objects of dnrt.
#pragma once

#include "frame/frame_fixture.h"

enum { FLOOR_VALUES = 32 * 32 * 3 };

// Irradiance at the time of an animation, of what was baked at bake_time; 0 at pixels of other
// instances than the first. The caller frees it. The fixture has want_id_layer, and is opened here.
float *floor_irradiance(struct frame_fixture *s, struct gpu *gpu, const char *gi, float bake_time,
                        float time);
double floor_difference(const float *a, const float *b); // sum over all values
