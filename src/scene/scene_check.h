// Checks and copies shared by the files that fill a scene.
#pragma once

#include "scene/scene.h"

#include <math.h>

static inline bool vec2_is_finite(vec2s v)
{
    return isfinite(v.x) && isfinite(v.y);
}

static inline bool vec3_is_finite(vec3s v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static inline bool vec4_is_finite(vec4s v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z) && isfinite(v.w);
}

static inline bool floats_are_finite(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) return false;
    }
    return true;
}

static inline bool index_is_valid(int index, int count)
{
    return index >= 0 && index < count;
}

// Never NULL.
static inline const char *name_or_empty(const char *name)
{
    return name ? name : "";
}

// host_fail with the kind and name of an object: "<kind> "<name>" in <scene>: <why>"; false.
bool scene_refuse(struct scene *scene, const char *kind, const char *name, const char *why);
// NULL: the scene can have this object; else why not.
const char *scene_material_fault(const struct scene *scene, const struct material *material);
const char *scene_light_fault(const struct scene *scene, const struct light *light);
const char *scene_vertices_fault(const struct mesh *mesh); // finite positions, normals and the like

// scene_add_light of a checked light whose name lives as long as the scene.
int scene_append_light(struct scene *scene, const struct light *light);

// Counts a change of a part, a member of scene->revisions, and returns its new revision.
uint64_t scene_changed(struct scene *scene, uint64_t *part);

// The transform of a node whose -z points along `direction`. False: a position that is not finite
// or a direction of length zero.
bool scene_looking(vec3s position, vec3s direction, mat4s *world_from_node);

// A copy of count × size bytes in the scene's arena; NULL when out of memory.
void *scene_copy(struct scene *scene, const void *source, size_t count, size_t size);

// Grows an array of `count` elements so that one more fits. False when out of memory or at the
// maximum length; the array is then unchanged.
bool scene_reserve(struct scene *scene, void **array, int count, int *capacity, size_t size);
