// Stages of a bake of transfer maps, wave after wave.
#pragma once

#include "techniques/ort/bake/scene.h"

bool ort_add_offsets(struct bake_plan *plan, const struct ort_scene *scene);
bool ort_add_areas(struct bake_plan *plan, const struct ort_scene *scene);
bool ort_add_links(struct bake_plan *plan, const struct ort_scene *scene);
bool ort_add_maps(struct bake_plan *plan, const struct ort_scene *scene);
