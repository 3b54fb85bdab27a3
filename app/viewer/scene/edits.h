// Changes that the user made to the scene, with what was there at first: for undo, for files and
// for copies of the scene on other threads.
#pragma once

#include "environments.h"

enum { EDITS_EACH = 64, EDITS_LIGHTS = 128 };

struct edits_lights {
    int count; // with those that were removed: indices of the others stay
    struct ag_light_desc lights[EDITS_LIGHTS];
    bool removed[EDITS_LIGHTS];
    float sky[3]; // cd/m²
};

struct edits_instance {
    int index;
    enum ag_mobility first_mobility;
    float first[16], world_from_mesh[16]; // metres
};

struct edits_material {
    int index;
    struct ag_material_desc first, material;
};

// Entries stay where they are: an undone one has its first value again.
struct edits {
    int instance_count, material_count;
    struct edits_instance instances[EDITS_EACH];
    struct edits_material materials[EDITS_EACH];
    struct edits_lights first_lights, lights;
    bool light_touched[EDITS_LIGHTS]; // no animation moves it any more
    bool sky_touched;
    struct environment_choice first_environment, environment; // environments_set applies it
    bool environment_touched;
};

// The moment of an animation at which values are read.
struct edits_moment {
    struct ag_scene *scene;
    int animation;
    double time_s;
};

// Takes the lights as those at first; the environment is the caller's.
void edits_begin(struct edits *edits, const struct edits_moment *at);
// Each changes the scene and remembers it. AG_ERROR_MEMORY where as many others are changed
// already.
enum ag_result edits_move(struct edits *edits, const struct edits_moment *at, int instance,
                          const float world_from_mesh[16]);
enum ag_result edits_set_material(struct edits *edits, const struct edits_moment *at, int material,
                                  const struct ag_material_desc *desc);
enum ag_result edits_set_light(struct edits *edits, struct ag_scene *scene, int light,
                               const struct ag_light_desc *desc);
// Its index is edits->lights.count before.
enum ag_result edits_add_light(struct edits *edits, struct ag_scene *scene,
                               const struct ag_light_desc *desc);
// A scene cannot lose one light: it is off from then on, and its index is not given again unless it
// is the last.
enum ag_result edits_remove_light(struct edits *edits, struct ag_scene *scene, int light);
bool edits_has_light(const struct edits *edits, int light); // false also for one that was removed
enum ag_result edits_set_sky(struct edits *edits, struct ag_scene *scene, const float radiance[3]);

bool edits_moved(const struct edits_instance *edit);
bool edits_changed(const struct edits_material *edit);
bool edits_changed_instances(const struct edits *edits);
bool edits_changed_materials(const struct edits *edits);
bool edits_changed_lights(const struct edits *edits); // or the sky
bool edits_changed_environment(const struct edits *edits);

// The entry of an object, a new one with its present value if need be.
enum ag_result edits_find_instance(struct edits *edits, const struct edits_moment *at, int index,
                                   struct edits_instance **out);
enum ag_result edits_find_material(struct edits *edits, const struct edits_moment *at, int index,
                                   struct edits_material **out);
// All values are those at first. Changes nothing in the scene: see edits_restore.
void edits_forget(struct edits *edits);
// Takes the values of an earlier or later copy, and makes the scene agree.
enum ag_result edits_restore(struct edits *edits, const struct edits *values,
                             struct ag_scene *scene);
// Makes the same changes in a scene that was loaded alike, also a second time, but for the
// environment, which bakes do not depend on.
enum ag_result edits_apply(const struct edits *edits, struct ag_scene *scene);
