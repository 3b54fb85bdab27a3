#include "changes.h"

#include "viewer/operations.h"

struct edits_moment viewer_moment(const struct viewer *v)
{
    return (struct edits_moment){ v->desc->scene, v->desc->animation, v->time_s };
}

static bool finish(struct viewer *v, enum ag_result result, const char *what, int index)
{
    if (result == AG_ERROR_MEMORY && index >= 0)
        viewer_warn(v, "cannot change %s %d: as many others are changed already", what, index);
    else if (viewer_check(v, result)) {
        viewer_change(v);
        viewer_note(v, what, index);
    }
    return result == AG_OK;
}

bool viewer_move_instance(struct viewer *v, int instance, const float world_from_mesh[16])
{
    const struct edits_moment at = viewer_moment(v);
    return finish(v, edits_move(&v->edits, &at, instance, world_from_mesh), "instance", instance);
}

bool viewer_set_material(struct viewer *v, int material, const struct ag_material_desc *desc)
{
    const struct edits_moment at = viewer_moment(v);
    return finish(v, edits_set_material(&v->edits, &at, material, desc), "material", material);
}

static bool has_light(struct viewer *v, int light)
{
    if (edits_has_light(&v->edits, light)) return true;
    viewer_warn(v, "there is no light %d", light);
    return false;
}

bool viewer_remove_light(struct viewer *v, int light)
{
    if (!has_light(v, light) ||
        !finish(v, edits_remove_light(&v->edits, v->desc->scene, light), "light", light))
        return false;
    if (v->gizmo.light == light) v->gizmo.light = -1;
    return true;
}

bool viewer_set_light(struct viewer *v, int light, const struct ag_light_desc *desc)
{
    if (!has_light(v, light)) return false;
    return finish(v, edits_set_light(&v->edits, v->desc->scene, light, desc), "light", light);
}

bool viewer_add_light(struct viewer *v, const struct ag_light_desc *desc)
{
    const int light = v->edits.lights.count;
    return finish(v, edits_add_light(&v->edits, v->desc->scene, desc), "light", light);
}

bool viewer_set_sky(struct viewer *v, const float radiance[3])
{
    return finish(v, edits_set_sky(&v->edits, v->desc->scene, radiance), "sky", -1);
}

bool viewer_set_environment(struct viewer *v, const struct environment_choice *choice)
{
    const enum ag_result result = environments_set(&v->environments, choice);
    if (result == AG_OK) {
        v->edits.environment = *choice;
        v->edits.environment_touched = true;
    }
    return finish(v, result, "environment", -1);
}

bool viewer_restore(struct viewer *v, const struct edits *values)
{
    const bool other = !environment_choices_same(&v->edits.environment, &values->environment);
    if (other && !viewer_check(v, environments_set(&v->environments, &values->environment)))
        return false;
    return viewer_check(v, edits_restore(&v->edits, values, v->desc->scene));
}
