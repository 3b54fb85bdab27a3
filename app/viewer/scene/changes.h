// Changes of the scene by panels, handles and scripts: shown at once, remembered for undo.
#pragma once

#include "viewer/state.h"

struct edits_moment viewer_moment(const struct viewer *v);
// False, with a message, if the scene refuses.
bool viewer_move_instance(struct viewer *v, int instance, const float world_from_mesh[16]);
bool viewer_set_material(struct viewer *v, int material, const struct ag_material_desc *desc);
bool viewer_set_light(struct viewer *v, int light, const struct ag_light_desc *desc);
bool viewer_add_light(struct viewer *v, const struct ag_light_desc *desc);
bool viewer_remove_light(struct viewer *v, int light);
bool viewer_set_sky(struct viewer *v, const float radiance[3]); // cd/m²
bool viewer_set_environment(struct viewer *v, const struct environment_choice *choice);
// All changes become those of an earlier or later copy.
bool viewer_restore(struct viewer *v, const struct edits *values);
