// Public descriptions of the parts of a scene: checks, and conversion for scene/.
#pragma once

#include "api/objects.h"

#include "scene/scene_edit.h"

// The steps of a function that changes an existing scene with a description.
#define REQUIRE_CHANGE(scene, desc)                                                                \
    do {                                                                                           \
        AG_REQUIRE_POINTER(parts_context(scene), scene);                                           \
        AG_REQUIRE_POINTER((scene)->context, desc);                                                \
    } while (0)
// The argument checks of ag_scene_add_…, which set *index to -1 unless they succeed.
#define REQUIRE_ADDING(scene, desc, index)                                                         \
    do {                                                                                           \
        if (index) *(index) = -1;                                                                  \
        REQUIRE_CHANGE(scene, desc);                                                               \
    } while (0)
// Element `index` of `member`, as "mesh 3 is not one of 2".
#define REQUIRE_INDEX(scene, what, index, member)                                                  \
    AG_REQUIRE((scene)->context, (index) >= 0 && (index) < (scene)->scene->member,                 \
               what " %d is not one of %d", (index), (scene)->scene->member)
// A bake reads surfaces in each run.
#define REQUIRE_NO_BAKE(scene)                                                                     \
    AG_REQUIRE((scene)->context, (scene)->bakes == 0,                                              \
               "the scene is in use by a bake: only its lights and sky may change")

static inline struct ag_context *parts_context(const struct ag_scene *scene)
{
    return scene ? scene->context : NULL;
}

// The result of scene_add_…: an index, or negative on failure.
static inline enum ag_result parts_added(const struct ag_scene *scene, int index, int *out)
{
    if (out) *out = index;
    return api_done(scene->context, index >= 0);
}

// Each checks a description and replaces the members of *out that it has. The function is named in
// messages.
enum ag_result parts_material(const char *function, const struct ag_scene *scene,
                              const struct ag_material_desc *desc, struct material *out);
enum ag_result parts_light(const char *function, const struct ag_scene *scene,
                           const struct ag_light_desc *desc, struct placed_light *out);
enum ag_result parts_maps(const char *function, const struct ag_scene *scene,
                          const struct ag_material_maps *maps, struct material *out);
// NULL: the identity.
enum ag_result parts_matrix(const char *function, const struct ag_scene *scene, const float *matrix,
                            mat4s *out);
