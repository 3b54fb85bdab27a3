// Stages of a bake of transfer maps, wave after wave.
#pragma once

#include "techniques/ort/bake/regions.h"
#include "techniques/ort/bake/scene.h"

bool ort_add_offsets(struct bake_plan *plan, const struct ort_scene *scene);
bool ort_add_areas(struct bake_plan *plan, const struct ort_scene *scene);
bool ort_add_links(struct bake_plan *plan, const struct ort_scene *scene);
bool ort_add_maps(struct bake_plan *plan, const struct ort_scene *scene);

// ---- areas.c
// Regions of the offsets of a group. The task reads ORT_OFFSETS.
bool ort_find_regions(const struct bake_task *task, uint32_t group, struct ort_regions *out);
