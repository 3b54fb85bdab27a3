// Changes that the user made to the scene, for copies of it on other threads.
#pragma once

#include <afterglow/afterglow.h>

enum { EDITS_EACH = 64, EDITS_LIGHTS = 128 };

struct edits {
    int instance_count, material_count, light_count;
    struct {
        int index;
        float world_from_mesh[16];
    } instances[EDITS_EACH];
    struct {
        int index;
        struct ag_material_desc material;
    } materials[EDITS_EACH];
    bool lights_changed; // lights and sky
    struct ag_light_desc lights[EDITS_LIGHTS];
    float sky[3];
};

// Changes the scene and remembers it. AG_ERROR_MEMORY where as many others are changed already.
enum ag_result edits_move(struct edits *edits, struct ag_scene *scene, int instance,
                          const float world_from_mesh[16]);
enum ag_result edits_set_material(struct edits *edits, struct ag_scene *scene, int material,
                                  const struct ag_material_desc *desc);
// Takes the scene's lights and sky after a change of theirs.
void edits_take_lights(struct edits *edits, struct ag_scene *scene, int animation, double time_s);
// Makes the same changes in a scene that was loaded alike, also a second time.
enum ag_result edits_apply(const struct edits *edits, struct ag_scene *scene);
