// The parts of a measurement.
#pragma once

#include "lightmap/quality/quality.h"

// ---- steps.c

// Luminance of a place of the map, (side · height + y) · width + x.
float quality_light(const struct lightmap *map, uint32_t place);
// The place of a texel.
uint32_t quality_place(const struct charts *charts, uint32_t texel);
// Difference over the larger light.
float quality_step_of(const struct lightmap_quality *q, float a, float b);
// near: two steps of the same charts this near are of one place, m.
void quality_add(struct quality_steps *steps, const struct quality_step *step, float near);

// ---- the others, each in the file of its name; false without memory

bool quality_measure_charts(struct quality_charts *out, const struct lightmap *map);
bool quality_measure_overlaps(struct quality_overlaps *out, const struct charts *charts);
void quality_measure_seams(struct lightmap_quality *q, const struct lightmap *map,
                           const struct seam_closing *closing);
bool quality_measure_leaks(struct lightmap_quality *q, const struct lightmap *map,
                           const struct gather_scene *scene);
bool quality_measure_noise(struct lightmap_quality *q, const struct lightmap *map);
