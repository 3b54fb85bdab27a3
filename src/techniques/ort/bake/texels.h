// Surfaces of texels, from the first stage of a bake.
#pragma once

#include "techniques/ort/bake/scene.h"

struct ort_texels {
    const struct ort_scene *scene;
    const float *point, *albedo; // LIGHT_MAP_POINT, LIGHT_MAP_ALBEDO
    const uint32_t *hits;        // ORT_HITS
};
// False: a tensor is missing.
bool ort_find_texels(struct ort_texels *out, const struct bake_task *task);
struct ort_texel ort_texel_of(const struct ort_texels *texels, uint32_t texel);

static inline float ort_texel_area(const struct ort_texels *t, uint32_t texel)
{
    return t->point[4 * (size_t)texel + 3] * chart_texel_of(&t->scene->map.charts, texel)->area_m2;
}

bool ort_add_texels(struct bake_plan *plan, const struct ort_scene *scene);
