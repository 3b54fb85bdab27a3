// Light that bounces between patches.
#pragma once

#include "bake/plan.h"

#include "techniques/ort/bake/patches.h"
#include "techniques/ort/bake/scene.h"

// Adds the stages that make ORT_PATCHES and ORT_BOUNCES: by colour, the irradiance of patch p for
// unit first-order irradiance of patch q, by one bounce and more.
bool ort_add_bounces(struct bake_plan *plan, const struct ort_scene *scene);
