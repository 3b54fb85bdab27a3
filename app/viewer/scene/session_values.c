#include "session_values.h"

#include "changes.h"
#include "members.h"
#include "viewer/operations.h"
#include "viewer/methods/tone.h"

#include <string.h>

enum { VERSION = 1 };

struct read {
    struct members m;
    struct session_values *s;
};

#define KNOWN(r, object, names)                                                                    \
    member_known(&(r)->m, object, names, (int)(sizeof names / sizeof *names))

static bool read_camera(struct read *r, json_t *camera)
{
    static const char *const names[] = { "name",    "eye",      "yaw",  "pitch",
                                         "fov_deg", "distance", "speed" };
    const char *name = NULL;
    if (!camera) return true;
    r->m.where = "camera";
    if (!KNOWN(r, camera, names) || !member_text(&r->m, camera, "name", &name)) return false;
    r->s->scene_camera = -1;
    r->s->look.moved = json_object_get(camera, "name") == NULL;
    const int count = name ? ag_scene_camera_count(r->s->v->desc->scene) : 0;
    for (int i = 0; i < count; i++)
        if (strcmp(ag_scene_camera_name(r->s->v->desc->scene, i), name) == 0)
            r->s->scene_camera = i;
    if (name && r->s->scene_camera < 0)
        return member_wrong(&r->m, "the scene has no camera %.100s", name);
    const bool done = member_floats(&r->m, camera, "eye", -1e9f, 3, r->s->look.eye) &&
                      member_float(&r->m, camera, "yaw", -1e3f, 1e3f, &r->s->look.yaw) &&
                      member_float(&r->m, camera, "pitch", -1.56f, 1.56f, &r->s->look.pitch) &&
                      member_float(&r->m, camera, "fov_deg", 1.0f, 170.0f, &r->s->look.fov_deg) &&
                      member_float(&r->m, camera, "distance", 1e-4f, 1e9f, &r->s->look.distance) &&
                      member_float(&r->m, camera, "speed", 1e-4f, 1e6f, &r->s->look.speed);
    r->m.where = "";
    return done;
}

static bool read_light(struct read *r, json_t *object)
{
    static const char *const names[] = { "index",     "type",      "on",
                                         "position",  "direction", "intensity",
                                         "inner_rad", "outer_rad", "removed" };
    struct edits_lights *lights = &r->s->edits.lights;
    int index = lights->count;
    const char *type = NULL;
    if (!KNOWN(r, object, names) || !member_text(&r->m, object, "type", &type) ||
        !member_integer(&r->m, object, "index", 0, EDITS_LIGHTS - 1, &index))
        return false;
    if (index > lights->count) return member_wrong(&r->m, "the scene has no light %d", index - 1);
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
    if (type) return member_wrong(&r->m, "type is sun, point or spot, not %.100s", type);
    r->s->edits.light_touched[index] = true;
    return member_boolean(&r->m, object, "on", &light->enabled) &&
           member_boolean(&r->m, object, "removed", &lights->removed[index]) &&
           member_floats(&r->m, object, "position", -1e9f, 3, light->position) &&
           member_floats(&r->m, object, "direction", -1e9f, 3, light->direction) &&
           member_floats(&r->m, object, "intensity", 0.0f, 3, light->intensity) &&
           member_float(&r->m, object, "inner_rad", 0.0f, 1.6f, &light->inner_rad) &&
           member_float(&r->m, object, "outer_rad", 0.0f, 1.6f, &light->outer_rad);
}

static bool read_instance(struct read *r, json_t *object)
{
    static const char *const names[] = { "index", "world_from_mesh" };
    const struct edits_moment at = viewer_moment(r->s->v);
    struct edits_instance *instance;
    int index = -1;
    if (!KNOWN(r, object, names) || !member_integer(&r->m, object, "index", 0, 1 << 30, &index))
        return false;
    if (edits_find_instance(&r->s->edits, &at, index, &instance) != AG_OK)
        return member_wrong(&r->m, "the scene has no instance %d", index);
    return member_floats(&r->m, object, "world_from_mesh", -1e9f, 16, instance->world_from_mesh);
}

static bool read_material(struct read *r, json_t *object)
{
    static const char *const names[] = { "index", "base_color", "metallic", "roughness",
                                         "emissive" };
    const struct edits_moment at = viewer_moment(r->s->v);
    struct edits_material *edit;
    int index = -1;
    if (!KNOWN(r, object, names) || !member_integer(&r->m, object, "index", 0, 1 << 30, &index))
        return false;
    if (edits_find_material(&r->s->edits, &at, index, &edit) != AG_OK)
        return member_wrong(&r->m, "the scene has no material %d", index);
    struct ag_material_desc *m = &edit->material;
    return member_floats(&r->m, object, "base_color", 0.0f, 4, m->base_color) &&
           member_float(&r->m, object, "metallic", 0.0f, 1.0f, &m->metallic) &&
           member_float(&r->m, object, "roughness", 0.0f, 1.0f, &m->roughness) &&
           member_floats(&r->m, object, "emissive", 0.0f, 3, m->emissive);
}

static bool read_environment(struct read *r, json_t *object)
{
    static const char *const names[] = { "source", "file", "strength", "rotation" };
    struct environment_choice *choice = &r->s->edits.environment;
    const char *source = environment_sources[choice->source], *file = choice->path;
    if (!object) return true;
    r->m.where = "environment";
    if (!KNOWN(r, object, names) || !member_text(&r->m, object, "source", &source) ||
        !member_text(&r->m, object, "file", &file) ||
        !member_float(&r->m, object, "strength", 0.0f, 1e6f, &choice->strength) ||
        !member_float(&r->m, object, "rotation", -1e3f, 1e3f, &choice->rotation))
        return false;
    int found = -1;
    for (int i = 0; source && i < 3; i++)
        if (strcmp(source, environment_sources[i]) == 0) found = i;
    if (found < 0) return member_wrong(&r->m, "source is scene, none or file");
    choice->source = (enum environment_source)found;
    if (choice->source == ENVIRONMENT_FILE && (!file || !file[0]))
        return member_wrong(&r->m, "the file is missing");
    if (file && strlen(file) >= sizeof choice->path)
        return member_wrong(&r->m, "the file's name is too long");
    if (file && file != choice->path) strcpy(choice->path, file);
    r->s->edits.environment_touched = true;
    r->m.where = "";
    return true;
}

static bool read_dab(struct read *r, json_t *object)
{
    static const char *const names[] = { "position", "normal", "radius", "lux" };
    struct dab dab = { .normal = { 0, 1, 0 }, .radius = 0.25f };
    if (!KNOWN(r, object, names) ||
        !member_floats(&r->m, object, "position", -1e9f, 3, dab.position) ||
        !member_floats(&r->m, object, "normal", -1.0f, 3, dab.normal) ||
        !member_float(&r->m, object, "radius", 1e-4f, 1e4f, &dab.radius) ||
        !member_floats(&r->m, object, "lux", 0.0f, 3, dab.lux))
        return false;
    return dabs_add(&r->s->paint, &dab) || member_wrong(&r->m, "out of memory");
}

static bool read_key(struct read *r, json_t *object)
{
    static const char *const names[] = { "eye", "yaw", "pitch", "fov_deg" };
    struct path_key *key = &r->s->camera_path.keys[r->s->camera_path.count++];
    *key = (struct path_key){ .fov_deg = 45.0f };
    return KNOWN(r, object, names) && member_floats(&r->m, object, "eye", -1e9f, 3, key->eye) &&
           member_float(&r->m, object, "yaw", -1e3f, 1e3f, &key->yaw) &&
           member_float(&r->m, object, "pitch", -1.56f, 1.56f, &key->pitch) &&
           member_float(&r->m, object, "fov_deg", 1.0f, 170.0f, &key->fov_deg);
}

static bool read_each(struct read *r, json_t *object, const char *name, size_t most,
                      const char *where, bool (*read)(struct read *r, json_t *object))
{
    json_t *array = json_object_get(object, name);
    if (!member_list(&r->m, object, name, most)) return false;
    r->m.where = where;
    bool right = true;
    for (size_t i = 0; right && i < json_array_size(array); i++)
        right = read(r, json_array_get(array, i));
    if (right) r->m.where = "";
    return right;
}

static bool read_path(struct read *r, json_t *path)
{
    static const char *const names[] = { "keys", "seconds", "fps" };
    if (!path) return true;
    r->m.where = "path";
    r->s->camera_path.count = 0;
    return KNOWN(r, path, names) && read_each(r, path, "keys", PATH_KEYS, "key", read_key) &&
           member_float(&r->m, path, "seconds", 0.01f, 1e4f, &r->s->camera_path.seconds) &&
           member_integer(&r->m, path, "fps", 1, 240, &r->s->camera_path.fps);
}

static bool copy_spec(struct read *r, const char *name, const char *text, char out[METHOD_SPEC])
{
    char copy[METHOD_SPEC];
    if (strlen(text) >= sizeof copy) return member_wrong(&r->m, "%s is too long", name);
    strcpy(copy, text); // `text` may be `out`
    strcpy(out, copy);
    return true;
}

static bool read_shown(struct read *r, json_t *document)
{
    const char *layer = viewer_layers[r->s->layer], *gi = r->s->gi;
    const char *compare = r->s->reference ? "reference" : r->s->other_gi;
    const char *curve = viewer_curves[r->s->tonemap];
    const char *metering = viewer_meterings[r->s->metering];
    const json_t *exposure = json_object_get(document, "exposure_ev");
    if (exposure) r->s->auto_exposure = json_is_null(exposure);
    if (!member_text(&r->m, document, "layer", &layer) ||
        !member_text(&r->m, document, "tonemap", &curve) ||
        !member_text(&r->m, document, "metering", &metering) ||
        !member_text(&r->m, document, "gi", &gi) ||
        !member_text(&r->m, document, "debug_view", &r->s->debug_view) ||
        !member_text(&r->m, document, "compare", &compare))
        return false;
    if (!gi) return member_wrong(&r->m, "gi is a method, \"none\" for direct light alone");
    r->s->reference = compare && strcmp(compare, "reference") == 0;
    if (!copy_spec(r, "gi", gi, r->s->gi) ||
        !copy_spec(r, "compare", compare && !r->s->reference ? compare : "", r->s->other_gi))
        return false;
    r->s->layer = -1;
    for (int i = 0; layer && i < viewer_layer_count; i++)
        if (strcmp(layer, viewer_layers[i]) == 0) r->s->layer = i;
    if (r->s->layer < 0) return member_wrong(&r->m, "unknown layer %.100s", layer ? layer : "null");
    r->s->tonemap = curve ? viewer_curve_of(curve) : -1;
    if (r->s->tonemap < 0)
        return member_wrong(&r->m, "unknown tone curve %.100s", curve ? curve : "null");
    r->s->metering = metering ? viewer_metering_of(metering) : -1;
    if (r->s->metering < 0)
        return member_wrong(&r->m, "unknown metering %.100s", metering ? metering : "null");
    return member_number(&r->m, document, "time_s", 0.0, 1e9, &r->s->time_s) &&
           (r->s->auto_exposure ||
            member_float(&r->m, document, "exposure_ev", -20.0f, 40.0f, &r->s->exposure_ev)) &&
           member_float(&r->m, document, "scale", 0.1f, 2.0f, &r->s->scale) &&
           member_float(&r->m, document, "split_at", 0.0f, 1.0f, &r->s->split_at) &&
           member_boolean(&r->m, document, "side_by_side", &r->s->side_by_side) &&
           member_boolean(&r->m, document, "difference", &r->s->difference) &&
           member_float(&r->m, document, "budget_ms", 0.1f, 1e5f, &r->s->budget_ms);
}

// Indices mean something in the scene of the file alone, as its options load it.
static bool is_of_scene(struct read *r, json_t *document)
{
    const char *scene = r->s->v->desc->scene_name, *options;
    char here[2 * METHOD_SPEC];
    int version = 0;
    viewer_scene_options(r->s->v, here, sizeof here);
    options = here;
    if (!json_is_object(document) || !json_object_get(document, "afterglow_session"))
        return member_wrong(&r->m, "it is no session file");
    if (!member_integer(&r->m, document, "afterglow_session", 0, 1 << 30, &version) ||
        !member_text(&r->m, document, "scene", &scene) ||
        !member_text(&r->m, document, "options", &options))
        return false;
    if (version != VERSION)
        return member_wrong(&r->m, "its format has the version %d, this program reads %d", version,
                            VERSION);
    if (!scene || strcmp(scene, r->s->v->desc->scene_name) != 0 ||
        strcmp(options ? options : "", here) != 0)
        return member_wrong(&r->m, "it belongs to: afterglow view %.200s%.300s --session %.200s",
                            scene ? scene : "SCENE", options ? options : "", r->m.path);
    return true;
}

static bool read_all(struct read *r, json_t *document)
{
    static const char *const names[] = {
        "afterglow_session", "scene",      "options",    "camera",    "time_s",
        "exposure_ev",       "layer",      "gi",         "compare",   "split_at",
        "side_by_side",      "debug_view", "difference", "budget_ms", "lights",
        "instances",         "scale",      "sky",        "materials", "path",
        "environment",       "paint",      "tonemap",    "metering"
    };
    if (!is_of_scene(r, document) || !KNOWN(r, document, names) || !read_shown(r, document) ||
        !read_camera(r, json_object_get(document, "camera")) ||
        !read_each(r, document, "lights", EDITS_LIGHTS, "light", read_light) ||
        !read_each(r, document, "paint", DABS_MOST, "paint", read_dab) ||
        !read_environment(r, json_object_get(document, "environment")) ||
        !read_each(r, document, "instances", EDITS_EACH, "instance", read_instance) ||
        !read_each(r, document, "materials", EDITS_EACH, "material", read_material))
        return false;
    if (json_object_get(document, "sky")) r->s->edits.sky_touched = true;
    return member_floats(&r->m, document, "sky", 0.0f, 3, r->s->edits.lights.sky) &&
           read_path(r, json_object_get(document, "path"));
}

bool session_values_read(struct session_values *s, json_t *document, const char *path)
{
    struct read r = { { s->v, path, "" }, s };
    return read_all(&r, document);
}
