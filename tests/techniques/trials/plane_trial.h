// Trials of an open plane with a tilt in radians, single- and double-sided, for each source. Both
// print their figures.
#pragma once

struct gpu;

// The plane in the sun gets nothing of its own light.
void plane_trial_own_light(struct gpu *gpu, float tilt);
// The plane gets the whole sky.
void plane_trial_sky(struct gpu *gpu, float tilt);
