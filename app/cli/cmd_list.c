// afterglow list: techniques with their options and debug views, built-in scenes, devices.
#include "commands.h"
#include "json.h"
#include "session.h"

#include <stdio.h>
#include <string.h>

enum { MAX_DEVICES = 64 };

// Any of the catalogue's option lists: `owner` is the technique's or scene's index, and ignored for
// the frame's.
typedef bool option_getter(int owner, int index, struct ag_option_info *out);

static bool frame_option(int owner, int index, struct ag_option_info *out)
{
    (void)owner;
    return ag_frame_option_get(index, out);
}

// The i-th of "first|second|…" into `out`.
static const char *choice(const char *choices, int index, char out[64])
{
    for (; index > 0 && *choices; index--) {
        choices += strcspn(choices, "|");
        choices += *choices == '|';
    }
    snprintf(out, 64, "%.*s", (int)strcspn(choices, "|"), choices);
    return out;
}

static bool is(const struct ag_option_info *option, const char *type)
{
    return strcmp(option->type, type) == 0;
}

// ---- JSON

static json_t *number_json(const struct ag_option_info *option, double value)
{
    if (is(option, "bool")) return json_boolean(value != 0.0);
    if (is(option, "int")) return json_integer((json_int_t)value);
    return json_double(value);
}

static json_t *choices_json(const char *choices)
{
    json_t *array = json_array();
    char name[64];
    for (int i = 0; array && choice(choices, i, name)[0]; i++)
        json_array_append_new(array, json_string(name));
    return array;
}

static json_t *option_json(const struct ag_option_info *option)
{
    json_t *object = json_pack("{s:s, s:s, s:s, s:s}", "name", option->name, "type", option->type,
                               "effect", option->effect, "help", option->help);
    if (!object) return NULL;
    char name[64];
    if (is(option, "choice")) {
        const char *initial = choice(option->unit, (int)option->initial, name);
        json_object_set_new(object, "default", json_string(initial));
        json_object_set_new(object, "choices", choices_json(option->unit));
        return object;
    }
    json_object_set_new(object, "default", number_json(option, option->initial));
    if (is(option, "bool")) return object;
    json_object_set_new(object, "min", number_json(option, option->min));
    json_object_set_new(object, "max", number_json(option, option->max));
    json_object_set_new(object, "unit", json_string(option->unit));
    return object;
}

static json_t *options_json(option_getter *get, int owner)
{
    json_t *array = json_array();
    struct ag_option_info option;
    for (int i = 0; array && get(owner, i, &option); i++)
        json_array_append_new(array, option_json(&option));
    return array;
}

static json_t *presets_json(int technique)
{
    json_t *array = json_array();
    const char *name, *options;
    for (int i = 0; array && ag_technique_preset_get(technique, i, &name, &options); i++)
        json_array_append_new(array, json_pack("{s:s, s:s}", "name", name, "options", options));
    return array;
}

static json_t *debug_views_json(int technique)
{
    json_t *array = json_array();
    const char *name, *help;
    for (int i = 0; array && ag_technique_debug_view_get(technique, i, &name, &help); i++)
        json_array_append_new(array, json_pack("{s:s, s:s}", "name", name, "help", help));
    return array;
}

static json_t *techniques_json(void)
{
    json_t *array = json_array();
    struct ag_technique_info t;
    for (int i = 0; array && ag_technique_get(i, &t); i++)
        json_array_append_new(
            array,
            json_pack("{s:s, s:s, s:s, s:s, s:b, s:b, s:b, s:b, s:b, s:o, s:o, s:o}", "name",
                      t.name, "title", t.title, "paper", t.paper, "role", t.role, "moving_geometry",
                      t.moving_geometry, "moving_lights", t.moving_lights, "needs_bake",
                      t.needs_bake, "makes_specular", t.makes_specular, "publishes_probes",
                      t.publishes_probes, "options", options_json(ag_technique_option_get, i),
                      "presets", presets_json(i), "debug_views", debug_views_json(i)));
    return array;
}

static json_t *scenes_json(void)
{
    json_t *array = json_array();
    struct ag_builtin_scene_info scene;
    for (int i = 0; array && ag_builtin_scene_get(i, &scene); i++)
        json_array_append_new(array, json_pack("{s:s+, s:s, s:o}", "name", "@", scene.name, "title",
                                               scene.title, "options",
                                               options_json(ag_builtin_scene_option_get, i)));
    return array;
}

static json_t *devices_json(const struct ag_device_info *devices, int count)
{
    json_t *array = json_array();
    for (int i = 0; array && i < count; i++)
        json_array_append_new(array, json_pack("{s:i, s:s, s:s, s:b, s:b, s:s}", "index", i, "name",
                                               devices[i].name, "driver", devices[i].driver,
                                               "software", devices[i].software, "usable",
                                               devices[i].usable, "missing", devices[i].missing));
    return array;
}

static json_t *layers_json(void)
{
    json_t *array = json_array();
    const char *name;
    for (int i = 0; array && (name = ag_layer_name(i)); i++)
        json_array_append_new(array, json_string(name));
    return array;
}

static enum status list_json(const struct ag_device_info *devices, int count)
{
    return json_print(json_pack("{s:o, s:o, s:o, s:o, s:o}", "techniques", techniques_json(),
                                "scenes", scenes_json(), "devices", devices_json(devices, count),
                                "frame_options", options_json(frame_option, 0), "layers",
                                layers_json()));
}

// ---- text

static void print_option(const struct ag_option_info *o)
{
    char range[512], name[64];
    if (is(o, "choice"))
        snprintf(range, sizeof range, "%s (%s)", o->unit, choice(o->unit, (int)o->initial, name));
    else if (is(o, "bool"))
        snprintf(range, sizeof range, "true|false (%s)", o->initial != 0.0 ? "true" : "false");
    else
        snprintf(range, sizeof range, "%g to %g%s%s (%g)", o->min, o->max, o->unit[0] ? " " : "",
                 o->unit, o->initial);
    printf("      %-18s %-28s %s\n", o->name, range, o->help);
}

static void print_options(option_getter *get, int owner)
{
    struct ag_option_info option;
    for (int i = 0; get(owner, i, &option); i++) print_option(&option);
}

static void print_presets(int technique)
{
    const char *name, *options;
    for (int i = 0; ag_technique_preset_get(technique, i, &name, &options); i++)
        printf("      quality=%-10s %s\n", name, options[0] ? options : "the defaults");
}

static void print_techniques(void)
{
    struct ag_technique_info t;
    const char *name, *help;
    printf("Techniques, for --gi source+delta+visibility; options as name:key=value,key=value\n");
    for (int i = 0; ag_technique_get(i, &t); i++) {
        printf("\n  %-10s %s (%s%s%s%s)\n", t.name, t.title, t.role,
               t.moving_geometry ? ", moving geometry" : "",
               t.moving_lights ? ", moving lights" : "", t.needs_bake ? ", needs a bake" : "");
        if (t.paper && t.paper[0]) printf("             %s\n", t.paper);
        print_options(ag_technique_option_get, i);
        print_presets(i);
        for (int k = 0; ag_technique_debug_view_get(i, k, &name, &help); k++)
            printf("      --debug-view %-16s %s\n", name, help);
    }
}

static void print_scenes(void)
{
    struct ag_builtin_scene_info scene;
    printf("\nBuilt-in scenes; options as @name:key=value,key=value\n");
    for (int i = 0; ag_builtin_scene_get(i, &scene); i++) {
        printf("\n  @%-10s %s\n", scene.name, scene.title);
        print_options(ag_builtin_scene_option_get, i);
    }
}

static void print_devices(const struct ag_device_info *devices, int count)
{
    printf("\nDevices, for --device\n\n");
    for (int i = 0; i < count; i++)
        printf("  %-3d %s, %s%s%s%s\n", i, devices[i].name, devices[i].driver,
               devices[i].software ? " (software)" : "", devices[i].usable ? "" : ": not usable, ",
               devices[i].missing);
    if (count == 0) printf("  none\n");
}

static enum status list(const struct arguments *arguments)
{
    struct session session;
    struct ag_device_info devices[MAX_DEVICES];
    int count = 0;
    enum status status = session_begin(&session, arguments);
    if (status != DONE) return status;
    // No device is no failure here: it is what the list says.
    if (ag_device_list(session.context, devices, MAX_DEVICES, &count) != AG_OK) {
        note("no device: %s", ag_context_last_error(session.context));
        count = 0;
    }
    if (count > MAX_DEVICES) count = MAX_DEVICES;
    if (arguments->json) {
        status = list_json(devices, count);
    } else {
        print_techniques();
        printf("\nFrame options, for --frame-options\n\n");
        print_options(frame_option, 0);
        print_scenes();
        print_devices(devices, count);
    }
    session_end(&session);
    return status;
}

const struct command command_list = {
    .name = "list",
    .bit = LIST,
    .positional_count = 0,
    .usage = "[options]",
    .summary = "techniques, their options and debug views, built-in scenes, devices",
    .text = "Lists what there is: techniques for --gi with their options (range and default) and "
            "debug views,\n"
            "built-in scenes and their options, and the devices of this machine.\n",
    .examples = "  afterglow list\n"
                "  afterglow list --json | jq '.techniques[].name'\n",
    .run = list,
};
