// Reads session files: all members are checked, then all are applied, or none.
#include "session_file.h"

#include "viewer/methods/bakes.h"
#include "changes.h"
#include "viewer/operations.h"
#include "viewer/methods/running.h"

#include <jansson.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERSION = 1 };

struct values {
    struct viewer *v;
    const char *path;  // of the file
    const char *where; // "light", "material" …; "": the document
    struct look look;
    int scene_camera;
    double time_s;
    bool auto_exposure, difference, reference, side_by_side;
    float exposure_ev, scale, split_at, budget_ms;
    int layer;
    const char *debug_view;                      // NULL: none
    char gi[METHOD_SPEC], other_gi[METHOD_SPEC]; // other_gi: "": none
    struct edits edits;
    struct path camera_path;
};

__attribute__((format(printf, 2, 3))) static bool wrong(struct values *s, const char *format, ...)
{
    char text[700];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    viewer_warn(s->v, "cannot use %s: %s%s%s", s->path, s->where, s->where[0] ? ": " : "", text);
    return false;
}

// ---- members: each keeps *out where there is none, and is false if it is wrong

static bool known(struct values *s, json_t *object, const char *const *names, int count)
{
    const char *name;
    json_t *value;
    if (!json_is_object(object)) return wrong(s, "an object is expected");
    json_object_foreach(object, name, value)
    {
        bool found = false;
        for (int i = 0; i < count; i++) found |= strcmp(names[i], name) == 0;
        if (found) continue;
        const char *nearest = ag_nearest_name(name, names, count);
        return wrong(s, "unknown member %.100s%s%s%s", name, nearest ? ": did you mean " : "",
                     nearest ? nearest : "", nearest ? "?" : "");
    }
    return true;
}
#define KNOWN(s, object, names) known(s, object, names, (int)(sizeof names / sizeof *names))

static bool number(struct values *s, json_t *object, const char *name, double least, double most,
                   double *out)
{
    const json_t *value = json_object_get(object, name);
    if (!value) return true;
    if (!json_is_number(value) || !(json_number_value(value) >= least) ||
        !(json_number_value(value) <= most))
        return wrong(s, "%s is a number, %g to %g", name, least, most);
    *out = json_number_value(value);
    return true;
}

static bool floating(struct values *s, json_t *object, const char *name, float least, float most,
                     float *out)
{
    double value = (double)*out;
    if (!number(s, object, name, (double)least, (double)most, &value)) return false;
    *out = (float)value;
    return true;
}

static bool integer(struct values *s, json_t *object, const char *name, int least, int most,
                    int *out)
{
    double value = *out;
    if (!number(s, object, name, least, most, &value)) return false;
    if (value != floor(value)) return wrong(s, "%s is an integer", name);
    *out = (int)value;
    return true;
}

static bool floats(struct values *s, json_t *object, const char *name, float least, int count,
                   float *out)
{
    const json_t *array = json_object_get(object, name);
    if (!array) return true;
    bool right = json_is_array(array) && json_array_size(array) == (size_t)count;
    for (int i = 0; right && i < count; i++) {
        const json_t *value = json_array_get(array, (size_t)i);
        right = json_is_number(value) && json_number_value(value) >= (double)least &&
                json_number_value(value) <= 1e30;
        if (right) out[i] = (float)json_number_value(value);
    }
    return right ||
           wrong(s, "%s is an array of %d numbers, at least %g", name, count, (double)least);
}

static bool boolean(struct values *s, json_t *object, const char *name, bool *out)
{
    const json_t *value = json_object_get(object, name);
    if (!value) return true;
    if (!json_is_boolean(value)) return wrong(s, "%s is true or false", name);
    *out = json_is_true(value);
    return true;
}

// null: NULL.
static bool text(struct values *s, json_t *object, const char *name, const char **out)
{
    const json_t *value = json_object_get(object, name);
    if (!value) return true;
    if (!json_is_string(value) && !json_is_null(value)) return wrong(s, "%s is a text", name);
    *out = json_is_null(value) ? NULL : json_string_value(value);
    return true;
}

static bool list(struct values *s, json_t *object, const char *name, size_t most)
{
    const json_t *value = json_object_get(object, name);
    if (!value || (json_is_array(value) && json_array_size(value) <= most)) return true;
    return wrong(s, "%s is an array of at most %zu", name, most);
}

// ---- parts of the document

static bool read_camera(struct values *s, json_t *camera)
{
    static const char *const names[] = { "name",    "eye",      "yaw",  "pitch",
                                         "fov_deg", "distance", "speed" };
    const char *name = NULL;
    if (!camera) return true;
    s->where = "camera";
    if (!KNOWN(s, camera, names) || !text(s, camera, "name", &name)) return false;
    s->scene_camera = -1;
    s->look.moved = json_object_get(camera, "name") == NULL;
    const int count = name ? ag_scene_camera_count(s->v->desc->scene) : 0;
    for (int i = 0; i < count; i++)
        if (strcmp(ag_scene_camera_name(s->v->desc->scene, i), name) == 0) s->scene_camera = i;
    if (name && s->scene_camera < 0) return wrong(s, "the scene has no camera %.100s", name);
    const bool done = floats(s, camera, "eye", -1e9f, 3, s->look.eye) &&
                      floating(s, camera, "yaw", -1e3f, 1e3f, &s->look.yaw) &&
                      floating(s, camera, "pitch", -1.56f, 1.56f, &s->look.pitch) &&
                      floating(s, camera, "fov_deg", 1.0f, 170.0f, &s->look.fov_deg) &&
                      floating(s, camera, "distance", 1e-4f, 1e9f, &s->look.distance) &&
                      floating(s, camera, "speed", 1e-4f, 1e6f, &s->look.speed);
    s->where = "";
    return done;
}

static bool read_light(struct values *s, json_t *object)
{
    static const char *const names[] = { "index",     "type",      "on",        "position",
                                         "direction", "intensity", "inner_rad", "outer_rad" };
    struct edits_lights *lights = &s->edits.lights;
    int index = lights->count;
    const char *type = NULL;
    if (!KNOWN(s, object, names) || !text(s, object, "type", &type) ||
        !integer(s, object, "index", 0, EDITS_LIGHTS - 1, &index))
        return false;
    if (index > lights->count) return wrong(s, "the scene has no light %d", index - 1);
    struct ag_light_desc *light = &lights->lights[index];
    if (index == lights->count) {
        ag_light_desc_default(light, AG_LIGHT_POINT);
        lights->count++;
    }
    for (int i = 0; type && i < 3; i++)
        if (strcmp(type, viewer_light_types[i]) == 0) {
            light->type = (enum ag_light_type)i;
            type = NULL;
        }
    if (type) return wrong(s, "type is sun, point or spot, not %.100s", type);
    s->edits.light_touched[index] = true;
    return boolean(s, object, "on", &light->enabled) &&
           floats(s, object, "position", -1e9f, 3, light->position) &&
           floats(s, object, "direction", -1e9f, 3, light->direction) &&
           floats(s, object, "intensity", 0.0f, 3, light->intensity) &&
           floating(s, object, "inner_rad", 0.0f, 1.6f, &light->inner_rad) &&
           floating(s, object, "outer_rad", 0.0f, 1.6f, &light->outer_rad);
}

static bool read_instance(struct values *s, json_t *object)
{
    static const char *const names[] = { "index", "world_from_mesh" };
    const struct edits_moment at = viewer_moment(s->v);
    struct edits_instance *instance;
    int index = -1;
    if (!KNOWN(s, object, names) || !integer(s, object, "index", 0, 1 << 30, &index)) return false;
    if (edits_find_instance(&s->edits, &at, index, &instance) != AG_OK)
        return wrong(s, "the scene has no instance %d", index);
    return floats(s, object, "world_from_mesh", -1e9f, 16, instance->world_from_mesh);
}

static bool read_material(struct values *s, json_t *object)
{
    static const char *const names[] = { "index", "base_color", "metallic", "roughness",
                                         "emissive" };
    const struct edits_moment at = viewer_moment(s->v);
    struct edits_material *edit;
    int index = -1;
    if (!KNOWN(s, object, names) || !integer(s, object, "index", 0, 1 << 30, &index)) return false;
    if (edits_find_material(&s->edits, &at, index, &edit) != AG_OK)
        return wrong(s, "the scene has no material %d", index);
    struct ag_material_desc *m = &edit->material;
    return floats(s, object, "base_color", 0.0f, 4, m->base_color) &&
           floating(s, object, "metallic", 0.0f, 1.0f, &m->metallic) &&
           floating(s, object, "roughness", 0.0f, 1.0f, &m->roughness) &&
           floats(s, object, "emissive", 0.0f, 3, m->emissive);
}

static bool read_key(struct values *s, json_t *object)
{
    static const char *const names[] = { "eye", "yaw", "pitch", "fov_deg" };
    struct path_key *key = &s->camera_path.keys[s->camera_path.count++];
    *key = (struct path_key){ .fov_deg = 45.0f };
    return KNOWN(s, object, names) && floats(s, object, "eye", -1e9f, 3, key->eye) &&
           floating(s, object, "yaw", -1e3f, 1e3f, &key->yaw) &&
           floating(s, object, "pitch", -1.56f, 1.56f, &key->pitch) &&
           floating(s, object, "fov_deg", 1.0f, 170.0f, &key->fov_deg);
}

static bool read_each(struct values *s, json_t *object, const char *name, size_t most,
                      const char *where, bool (*read)(struct values *s, json_t *object))
{
    json_t *array = json_object_get(object, name);
    if (!list(s, object, name, most)) return false;
    s->where = where;
    bool right = true;
    for (size_t i = 0; right && i < json_array_size(array); i++)
        right = read(s, json_array_get(array, i));
    if (right) s->where = "";
    return right;
}

static bool read_path(struct values *s, json_t *path)
{
    static const char *const names[] = { "keys", "seconds", "fps" };
    if (!path) return true;
    s->where = "path";
    s->camera_path.count = 0;
    return KNOWN(s, path, names) && read_each(s, path, "keys", PATH_KEYS, "key", read_key) &&
           floating(s, path, "seconds", 0.01f, 1e4f, &s->camera_path.seconds) &&
           integer(s, path, "fps", 1, 240, &s->camera_path.fps);
}

static bool copy_spec(struct values *s, const char *name, const char *text, char out[METHOD_SPEC])
{
    char copy[METHOD_SPEC];
    if (strlen(text) >= sizeof copy) return wrong(s, "%s is too long", name);
    strcpy(copy, text); // `text` may be `out`
    strcpy(out, copy);
    return true;
}

static bool read_shown(struct values *s, json_t *document)
{
    const char *layer = viewer_layers[s->layer], *gi = s->gi;
    const char *compare = s->reference ? "reference" : s->other_gi;
    const json_t *exposure = json_object_get(document, "exposure_ev");
    if (exposure) s->auto_exposure = json_is_null(exposure);
    if (!text(s, document, "layer", &layer) || !text(s, document, "gi", &gi) ||
        !text(s, document, "debug_view", &s->debug_view) || !text(s, document, "compare", &compare))
        return false;
    if (!gi) return wrong(s, "gi is a method, \"none\" for direct light alone");
    s->reference = compare && strcmp(compare, "reference") == 0;
    if (!copy_spec(s, "gi", gi, s->gi) ||
        !copy_spec(s, "compare", compare && !s->reference ? compare : "", s->other_gi))
        return false;
    s->layer = -1;
    for (int i = 0; layer && i < viewer_layer_count; i++)
        if (strcmp(layer, viewer_layers[i]) == 0) s->layer = i;
    if (s->layer < 0) return wrong(s, "unknown layer %.100s", layer ? layer : "null");
    return number(s, document, "time_s", 0.0, 1e9, &s->time_s) &&
           (s->auto_exposure ||
            floating(s, document, "exposure_ev", -20.0f, 40.0f, &s->exposure_ev)) &&
           floating(s, document, "scale", 0.1f, 2.0f, &s->scale) &&
           floating(s, document, "split_at", 0.0f, 1.0f, &s->split_at) &&
           boolean(s, document, "side_by_side", &s->side_by_side) &&
           boolean(s, document, "difference", &s->difference) &&
           floating(s, document, "budget_ms", 0.1f, 1e5f, &s->budget_ms);
}

// Indices mean something in the scene of the file alone, as its options load it.
static bool is_of_scene(struct values *s, json_t *document)
{
    const char *scene = s->v->desc->scene_name, *options;
    char here[2 * METHOD_SPEC];
    int version = 0;
    viewer_scene_options(s->v, here, sizeof here);
    options = here;
    if (!json_is_object(document) || !json_object_get(document, "afterglow_session"))
        return wrong(s, "it is no session file");
    if (!integer(s, document, "afterglow_session", 0, 1 << 30, &version) ||
        !text(s, document, "scene", &scene) || !text(s, document, "options", &options))
        return false;
    if (version != VERSION)
        return wrong(s, "its format has the version %d, this program reads %d", version, VERSION);
    if (!scene || strcmp(scene, s->v->desc->scene_name) != 0 ||
        strcmp(options ? options : "", here) != 0)
        return wrong(s, "it belongs to: afterglow view %.200s%.300s --session %.200s",
                     scene ? scene : "SCENE", options ? options : "", s->path);
    return true;
}

static bool read_all(struct values *s, json_t *document)
{
    static const char *const names[] = {
        "afterglow_session", "scene",      "options",    "camera",    "time_s",
        "exposure_ev",       "layer",      "gi",         "compare",   "split_at",
        "side_by_side",      "debug_view", "difference", "budget_ms", "lights",
        "instances",         "scale",      "sky",        "materials", "path"
    };
    if (!is_of_scene(s, document) || !KNOWN(s, document, names) || !read_shown(s, document) ||
        !read_camera(s, json_object_get(document, "camera")) ||
        !read_each(s, document, "lights", EDITS_LIGHTS, "light", read_light) ||
        !read_each(s, document, "instances", EDITS_EACH, "instance", read_instance) ||
        !read_each(s, document, "materials", EDITS_EACH, "material", read_material))
        return false;
    if (json_object_get(document, "sky")) s->edits.sky_touched = true;
    return floats(s, document, "sky", 0.0f, 3, s->edits.lights.sky) &&
           read_path(s, json_object_get(document, "path"));
}

// ---- applying

static bool apply_methods(struct values *s)
{
    struct viewer *v = s->v;
    if (strcmp(s->gi, v->gi) != 0 && !viewer_set_gi(v, s->gi)) return false;
    if (!s->reference && !viewer_set_reference(v, false)) return false;
    if (s->other_gi[0] ? !viewer_set_split(v, s->other_gi) : v->split && !viewer_set_split(v, NULL))
        return false;
    return !s->reference || viewer_set_reference(v, true);
}

static bool apply(struct values *s)
{
    struct viewer *v = s->v;
    if (!viewer_check(v, edits_restore(&v->edits, &s->edits, v->desc->scene)) || !apply_methods(s))
        return false;
    viewer_set_layer(v, s->layer);
    if (s->debug_view && !bakes_running(v) && !viewer_set_debug_view(v, s->debug_view))
        return false;
    v->time_s = s->time_s;
    if (!s->look.moved) viewer_set_camera(v, s->scene_camera);
    if (s->look.moved) v->look = s->look;
    v->scene_camera = s->scene_camera;
    v->auto_exposure = s->auto_exposure;
    v->exposure_ev = s->exposure_ev;
    v->scale = s->scale;
    v->split_at = s->split_at;
    v->side_by_side = s->side_by_side;
    v->difference = s->difference;
    v->budget_ms = s->budget_ms;
    record_end(v);
    v->path = s->camera_path;
    viewer_change(v);
    return true;
}

static void take(struct viewer *v, struct values *out)
{
    out->v = v;
    out->where = "";
    out->look = v->look;
    out->scene_camera = v->scene_camera;
    out->time_s = v->time_s;
    out->auto_exposure = v->auto_exposure;
    out->difference = v->difference;
    out->exposure_ev = v->exposure_ev;
    out->scale = v->scale;
    out->split_at = v->split_at;
    out->side_by_side = v->side_by_side;
    out->budget_ms = v->budget_ms;
    out->layer = v->layer;
    snprintf(out->gi, sizeof out->gi, "%s", v->gi);
    out->debug_view = v->debug_view;
    snprintf(out->other_gi, sizeof out->other_gi, "%s", v->split ? v->other_gi : "");
    out->reference = v->truth != NULL;
    out->camera_path = v->path;
}

// The scene as it was at first: a session says all changes.
static void forget_edits(const struct viewer *v, struct edits *out)
{
    *out = v->edits;
    out->lights = v->edits.first_lights;
    for (int i = 0; i < out->instance_count; i++)
        memcpy(out->instances[i].world_from_mesh, out->instances[i].first,
               sizeof out->instances[i].first);
    for (int i = 0; i < out->material_count; i++)
        out->materials[i].material = out->materials[i].first;
}

static bool use(struct viewer *v, const char *path, json_t *document)
{
    struct values *now = calloc(1, sizeof *now), *before = calloc(1, sizeof *before);
    bool done = now && before;
    if (!done) viewer_warn(v, "cannot use %s: out of memory", path);
    if (done) {
        take(v, now);
        take(v, before);
        before->edits = v->edits;
        forget_edits(v, &now->edits);
        now->path = before->path = path;
        done = read_all(now, document);
        if (done && !apply(now)) {
            char why[VIEWER_MESSAGE];
            snprintf(why, sizeof why, "%s", v->message);
            apply(before);
            viewer_warn(v, "%s", why);
            done = false;
        }
    }
    free(now);
    free(before);
    return done;
}

bool session_file_scene(const char *path, char *out, size_t size)
{
    json_t *document = json_load_file(path, 0, NULL);
    const char *scene = json_string_value(json_object_get(document, "scene"));
    const bool found = scene && json_object_get(document, "afterglow_session");
    if (found) snprintf(out, size, "%s", scene);
    json_decref(document);
    return found;
}

bool session_file_read(struct viewer *v, const char *path)
{
    json_error_t error;
    json_t *document = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (!document) {
        if (error.line < 0)
            viewer_warn(v, "cannot read %s", path);
        else
            viewer_warn(v, "cannot use %s: line %d: %s", path, error.line, error.text);
        return false;
    }
    const bool done = use(v, path, document);
    json_decref(document);
    if (done) viewer_note(v, "session", -1);
    if (done) viewer_say(v, "read: %s", path);
    return done;
}
