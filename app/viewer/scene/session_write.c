// Writes session files.
#include "session_file.h"

#include "viewer/operations.h"
#include "viewer/methods/running.h"

#include "shell/json_values.h"
#include "viewer/methods/tone.h"

static void put(json_t *object, const char *name, json_t *value)
{
    json_object_set_new(object, name, value);
}

static json_t *text_or_null(const char *text)
{
    return text && text[0] ? json_text(text) : json_null();
}

static json_t *camera_of(const struct viewer *v)
{
    const struct look *look = &v->look;
    json_t *camera = json_object();
    if (!look->moved && v->scene_camera >= 0) {
        put(camera, "name", text_or_null(ag_scene_camera_name(v->desc->scene, v->scene_camera)));
        return camera;
    }
    put(camera, "eye", json_floats(look->eye, 3));
    put(camera, "yaw", json_float(look->yaw));
    put(camera, "pitch", json_float(look->pitch));
    put(camera, "fov_deg", json_float(look->fov_deg));
    put(camera, "distance", json_float(look->distance));
    put(camera, "speed", json_float(look->speed));
    return camera;
}

static json_t *light_of(const struct edits *edits, int index)
{
    const struct ag_light_desc *light = &edits->lights.lights[index];
    json_t *object = json_object();
    put(object, "index", json_integer(index));
    put(object, "type", json_string(viewer_light_types[light->type]));
    put(object, "on", json_boolean(light->enabled));
    put(object, "position", json_floats(light->position, 3));
    put(object, "direction", json_floats(light->direction, 3));
    put(object, "intensity", json_floats(light->intensity, 3));
    put(object, "inner_rad", json_float(light->inner_rad));
    put(object, "outer_rad", json_float(light->outer_rad));
    if (edits->lights.removed[index]) put(object, "removed", json_true());
    return object;
}

static json_t *lights_of(const struct edits *edits)
{
    json_t *lights = json_array();
    for (int i = 0; i < edits->lights.count; i++)
        if (edits->light_touched[i]) json_array_append_new(lights, light_of(edits, i));
    return lights;
}

static json_t *instances_of(const struct edits *edits)
{
    json_t *instances = json_array();
    for (int i = 0; i < edits->instance_count; i++) {
        if (!edits_moved(&edits->instances[i])) continue;
        json_t *object = json_object();
        put(object, "index", json_integer(edits->instances[i].index));
        put(object, "world_from_mesh", json_floats(edits->instances[i].world_from_mesh, 16));
        json_array_append_new(instances, object);
    }
    return instances;
}

static json_t *materials_of(const struct edits *edits)
{
    json_t *materials = json_array();
    for (int i = 0; i < edits->material_count; i++) {
        const struct ag_material_desc *m = &edits->materials[i].material;
        if (!edits_changed(&edits->materials[i])) continue;
        json_t *object = json_object();
        put(object, "index", json_integer(edits->materials[i].index));
        put(object, "base_color", json_floats(m->base_color, 4));
        put(object, "metallic", json_float(m->metallic));
        put(object, "roughness", json_float(m->roughness));
        put(object, "emissive", json_floats(m->emissive, 3));
        json_array_append_new(materials, object);
    }
    return materials;
}

static json_t *environment_of(const struct environment_choice *choice)
{
    json_t *object = json_object();
    put(object, "source", json_string(environment_sources[choice->source]));
    if (choice->source == ENVIRONMENT_FILE) put(object, "file", json_text(choice->path));
    put(object, "strength", json_float(choice->strength));
    put(object, "rotation", json_float(choice->rotation));
    return object;
}

static json_t *paint_of(const struct dabs *dabs)
{
    json_t *paint = json_array();
    for (int i = 0; i < dabs->count; i++) {
        const struct dab *dab = &dabs->at[i];
        json_t *object = json_object();
        put(object, "position", json_floats(dab->position, 3));
        put(object, "normal", json_floats(dab->normal, 3));
        put(object, "radius", json_float(dab->radius));
        put(object, "lux", json_floats(dab->lux, 3));
        json_array_append_new(paint, object);
    }
    return paint;
}

static json_t *path_of(const struct path *path)
{
    json_t *object = json_object(), *keys = json_array();
    for (int i = 0; i < path->count; i++) {
        const struct path_key *key = &path->keys[i];
        json_t *at = json_object();
        put(at, "eye", json_floats(key->eye, 3));
        put(at, "yaw", json_float(key->yaw));
        put(at, "pitch", json_float(key->pitch));
        put(at, "fov_deg", json_float(key->fov_deg));
        json_array_append_new(keys, at);
    }
    put(object, "keys", keys);
    put(object, "seconds", json_float(path->seconds));
    put(object, "fps", json_integer(path->fps));
    return object;
}

static json_t *options_of(const struct viewer *v)
{
    char options[2 * METHOD_SPEC];
    viewer_scene_options(v, options, sizeof options);
    return json_text(options);
}

static json_t *document_of(const struct viewer *v)
{
    json_t *document = json_object();
    put(document, "afterglow_session", json_integer(1));
    put(document, "scene", json_text(v->desc->scene_name));
    put(document, "options", options_of(v));
    put(document, "camera", camera_of(v));
    put(document, "time_s", json_real(v->time_s));
    put(document, "exposure_ev", v->auto_exposure ? json_null() : json_float(v->exposure_ev));
    put(document, "metering", json_string(viewer_meterings[v->metering]));
    put(document, "tonemap", json_string(viewer_curves[v->tonemap]));
    put(document, "layer", json_string(viewer_layers[v->layer]));
    put(document, "debug_view", text_or_null(v->debug_view));
    put(document, "scale", json_float(v->scale));
    put(document, "gi", json_text(v->gi));
    put(document, "compare",
        v->truth ? json_string("reference") : text_or_null(v->split ? v->other_gi : NULL));
    put(document, "split_at", json_float(v->split_at));
    put(document, "side_by_side", json_boolean(v->side_by_side));
    put(document, "difference", json_boolean(v->difference));
    put(document, "budget_ms", json_float(v->budget_ms));
    put(document, "lights", lights_of(&v->edits));
    if (v->edits.sky_touched) put(document, "sky", json_floats(v->edits.lights.sky, 3));
    if (v->edits.environment_touched)
        put(document, "environment", environment_of(&v->edits.environment));
    put(document, "instances", instances_of(&v->edits));
    put(document, "materials", materials_of(&v->edits));
    if (v->paint.dabs.count > 0) put(document, "paint", paint_of(&v->paint.dabs));
    put(document, "path", path_of(&v->path));
    return document;
}

bool session_file_write(struct viewer *v, const char *path)
{
    return viewer_write_json(v, path, document_of(v), JSON_INDENT(2));
}
