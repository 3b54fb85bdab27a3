// afterglow list: techniques with their options and debug views, built-in scenes, devices.
#include "commands.h"
#include "cli/files/json.h"
#include "cli/options/option_text.h"
#include "session.h"
#include "cli/terminal/wrapped.h"

#include <stdio.h>
#include <string.h>

enum { MAX_DEVICES = 64, HELP_COLUMN = 34 };

// An option list of the catalogue; owner: index of the technique or scene, ignored for the frame.
typedef bool option_getter(int owner, int index, struct ag_option_info *out);

static bool frame_option(int owner, int index, struct ag_option_info *out)
{
    (void)owner;
    return ag_frame_option_get(index, out);
}

// ---- JSON

static json_t *number_json(const struct ag_option_info *option, double value)
{
    if (option_is(option, "bool")) return json_boolean(value != 0.0);
    if (option_is(option, "int")) return json_integer((json_int_t)value);
    return json_double(value);
}

static json_t *choices_json(const char *choices)
{
    json_t *array = json_array();
    char name[64];
    for (int i = 0; array && option_choice(choices, i, name)[0]; i++)
        json_array_append_new(array, json_string(name));
    return array;
}

static json_t *option_json(const struct ag_option_info *option)
{
    json_t *object =
        json_pack("{s:s, s:s, s:s, s:b, s:s}", "name", option->name, "type", option->type, "effect",
                  option->effect, "expert", option->expert, "help", option->help);
    if (!object) return NULL;
    char name[64];
    if (option_is(option, "choice")) {
        const char *initial = option_choice(option->unit, (int)option->initial, name);
        json_object_set_new(object, "default", json_string(initial));
        json_object_set_new(object, "choices", choices_json(option->unit));
        return object;
    }
    if (option_is(option, "text")) {
        json_object_set_new(object, "default", json_string(""));
        json_object_set_new(object, "unit", json_string(option->unit));
        return object;
    }
    json_object_set_new(object, "default", number_json(option, option->initial));
    if (option_is(option, "bool")) return object;
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

static json_t *technique_json(int i, const struct ag_technique_info *t)
{
    return json_pack("{s:s, s:s, s:s, s:s, s:b, s:b, s:b, s:b, s:b, s:b, s:b, s:o, s:o, s:o}",
                     "name", t->name, "title", t->title, "paper", t->paper, "role", t->role,
                     "moving_geometry", t->moving_geometry, "moving_lights", t->moving_lights,
                     "needs_bake", t->needs_bake, "makes_specular", t->makes_specular,
                     "publishes_probes", t->publishes_probes, "has_lightmap", t->has_lightmap,
                     "exports_bake", t->exports_bake, "options",
                     options_json(ag_technique_option_get, i), "presets", presets_json(i),
                     "debug_views", debug_views_json(i));
}

static json_t *scene_json(int i, const struct ag_builtin_scene_info *scene)
{
    return json_pack("{s:s+, s:s, s:o}", "name", "@", scene->name, "title", scene->title, "options",
                     options_json(ag_builtin_scene_option_get, i));
}

static json_t *techniques_json(void)
{
    json_t *array = json_array();
    struct ag_technique_info t;
    for (int i = 0; array && ag_technique_get(i, &t); i++)
        json_array_append_new(array, technique_json(i, &t));
    return array;
}

static json_t *scenes_json(void)
{
    json_t *array = json_array();
    struct ag_builtin_scene_info scene;
    for (int i = 0; array && ag_builtin_scene_get(i, &scene); i++)
        json_array_append_new(array, scene_json(i, &scene));
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

// "name=default  help (range)"
static void print_option(const struct ag_option_info *o)
{
    char text[1024], range[512], value[64];
    option_range(o, range);
    for (char *c = range; *c; c++)
        if (*c == ' ' && c > range) *c = HELP_NO_BREAK;
    snprintf(text, sizeof text, "%s%s", o->help, range);
    int used = printf("    %s=%s", o->name, option_default(o, value));
    printf("%*s", used < HELP_COLUMN ? HELP_COLUMN - used : 1, "");
    print_wrapped(used < HELP_COLUMN ? HELP_COLUMN : used + 1, text);
}

// Returns how many there are.
static int print_options_of(option_getter *get, int owner, bool expert, bool print)
{
    struct ag_option_info option;
    int count = 0;
    for (int i = 0; get(owner, i, &option); i++) {
        if (option.expert != expert) continue;
        if (print) print_option(&option);
        count++;
    }
    return count;
}

// Those for experts come last, or as a count. name: of the owner, for `list`; "": none.
static void print_options(option_getter *get, int owner, const char *name, bool all)
{
    print_options_of(get, owner, false, true);
    const int experts = print_options_of(get, owner, true, all);
    if (experts > 0 && !all)
        printf("    and %d for experts: afterglow list%s%s --all\n", experts, name[0] ? " " : "",
               name);
}

// Two techniques may have the same options with other defaults.
static bool options_are_equal(int a, int b)
{
    struct ag_option_info first, second;
    for (int i = 0;; i++) {
        bool more = ag_technique_option_get(a, i, &first);
        if (more != ag_technique_option_get(b, i, &second)) return false;
        if (!more) return i > 0;
        if (strcmp(first.name, second.name) != 0 || strcmp(first.help, second.help) != 0)
            return false;
    }
}

static bool debug_views_are_equal(int a, int b)
{
    const char *first, *second, *help;
    for (int i = 0;; i++) {
        bool more = ag_technique_debug_view_get(a, i, &first, &help);
        if (more != ag_technique_debug_view_get(b, i, &second, &help)) return false;
        if (!more) return true;
        if (strcmp(first, second) != 0) return false;
    }
}

static int same_options_before(int technique)
{
    for (int i = 0; i < technique; i++)
        if (options_are_equal(i, technique)) return i;
    return -1;
}

static void print_other_defaults(int technique, int before)
{
    struct ag_technique_info other;
    struct ag_option_info own, theirs;
    char value[64];
    ag_technique_get(before, &other);
    printf("    options and debug views as in %s, but", other.name);
    for (int i = 0; ag_technique_option_get(technique, i, &own); i++) {
        ag_technique_option_get(before, i, &theirs);
        if (own.initial != theirs.initial) printf(" %s=%s", own.name, option_default(&own, value));
    }
    printf("\n");
}

static void print_presets(int technique)
{
    const char *name, *options;
    for (int i = 0; ag_technique_preset_get(technique, i, &name, &options); i++) {
        int used = printf("    quality=%s", name);
        printf("%*s%s\n", HELP_COLUMN - used, "", options[0] ? options : "the defaults");
    }
}

static void print_debug_views(int technique)
{
    const char *name, *help;
    for (int i = 0; ag_technique_debug_view_get(technique, i, &name, &help); i++) {
        int used = printf("    --debug-view %s", name);
        printf("%*s", used < HELP_COLUMN ? HELP_COLUMN - used : 1, "");
        print_wrapped(HELP_COLUMN, help);
    }
}

// whole: with the options that an earlier technique has too; all: with those for experts.
static void print_technique(int technique, const struct ag_technique_info *t, bool whole, bool all)
{
    printf("\n%s: %s (%s)\n", t->name, t->title, t->role);
    if (t->paper && t->paper[0] && strcmp(t->paper, "none") != 0) {
        printf("    ");
        print_wrapped(4, t->paper);
    }
    if (!t->moving_geometry) printf("    static geometry only\n");
    if (!t->moving_lights) printf("    static lights only\n");
    if (t->needs_bake) printf("    needs a bake\n");
    if (t->has_lightmap) printf("    has a light map\n");
    if (t->exports_bake) printf("    exports its bake for other programs\n");
    int before = whole ? -1 : same_options_before(technique);
    if (before >= 0)
        print_other_defaults(technique, before);
    else
        print_options(ag_technique_option_get, technique, t->name, all);
    print_presets(technique);
    if (before < 0 || !debug_views_are_equal(before, technique)) print_debug_views(technique);
}

static void print_techniques(bool all)
{
    struct ag_technique_info t;
    printf("Techniques: --gi SOURCE[+VISIBILITY], options as NAME:OPTION=VALUE,OPTION=VALUE\n"
           "Options are listed with their default: OPTION=DEFAULT\n");
    for (int i = 0; ag_technique_get(i, &t); i++) print_technique(i, &t, false, all);
}

static void print_scene(int i, const struct ag_builtin_scene_info *scene, bool all)
{
    printf("\n@%s: %s\n", scene->name, scene->title);
    print_options(ag_builtin_scene_option_get, i, scene->name, all);
}

static void print_scenes(bool all)
{
    struct ag_builtin_scene_info scene;
    printf("\nBuilt-in scenes: @NAME or @NAME:OPTION=VALUE,OPTION=VALUE\n");
    for (int i = 0; ag_builtin_scene_get(i, &scene); i++) print_scene(i, &scene, all);
}

static void print_devices(const struct ag_device_info *devices, int count)
{
    printf("\nDevices: --device NUMBER or a part of the name\n\n");
    for (int i = 0; i < count; i++)
        printf("  %-3d %s, %s%s%s%s\n", i, devices[i].name, devices[i].driver,
               devices[i].software ? " (software)" : "", devices[i].usable ? "" : ": not usable, ",
               devices[i].missing);
    if (count == 0) printf("  none\n");
}

// ---- one technique or scene

enum { MAX_NAMES = 128 };

static enum status unknown_name(const char *wanted)
{
    const char *known[MAX_NAMES];
    int count = 0;
    struct ag_technique_info t;
    struct ag_builtin_scene_info scene;
    for (int i = 0; count < MAX_NAMES && ag_technique_get(i, &t); i++) known[count++] = t.name;
    for (int i = 0; count < MAX_NAMES && ag_builtin_scene_get(i, &scene); i++)
        known[count++] = scene.name;
    const char *nearest = ag_nearest_name(wanted, known, count);
    if (nearest) return wrong_usage("unknown name %s: did you mean %s?", wanted, nearest);
    return wrong_usage(
        "unknown name %s: it is neither a technique nor a built-in scene (afterglow list)", wanted);
}

static enum status list_one(const char *wanted, bool json, bool all)
{
    struct ag_technique_info t;
    struct ag_builtin_scene_info scene;
    const char *name = wanted[0] == '@' ? wanted + 1 : wanted;
    for (int i = 0; name == wanted && ag_technique_get(i, &t); i++) {
        if (strcmp(t.name, name) != 0) continue;
        if (json) return json_print(technique_json(i, &t));
        print_technique(i, &t, true, all);
        return DONE;
    }
    for (int i = 0; ag_builtin_scene_get(i, &scene); i++) {
        if (strcmp(scene.name, name) != 0) continue;
        if (json) return json_print(scene_json(i, &scene));
        print_scene(i, &scene, all);
        return DONE;
    }
    return unknown_name(wanted);
}

static enum status list(const struct arguments *arguments)
{
    if (arguments->positional_count > 0)
        return list_one(arguments->positional[0], arguments->json, arguments->all);
    struct session session;
    struct ag_device_info devices[MAX_DEVICES];
    int count = 0;
    enum status status = session_begin(&session, arguments);
    if (status != DONE) return status;
    // A machine without a device still has a list.
    if (ag_device_list(session.context, devices, MAX_DEVICES, &count) != AG_OK) {
        note("no device: %s", ag_context_last_error(session.context));
        count = 0;
    }
    if (count > MAX_DEVICES) count = MAX_DEVICES;
    if (arguments->json) {
        status = list_json(devices, count);
    } else {
        print_techniques(arguments->all);
        printf("\nFrame options: --frame-options OPTION=VALUE,OPTION=VALUE\n\n");
        print_options(frame_option, 0, "", arguments->all);
        print_scenes(arguments->all);
        print_devices(devices, count);
    }
    session_end(&session);
    return status;
}

const struct command command_list = {
    .name = "list",
    .bit = LIST,
    .optional_count = 1,
    .usage = "[NAME] [options]",
    .summary = "list techniques with their options, built-in scenes and devices",
    .text = "Lists techniques for --gi with options, presets and debug views,\n"
            "built-in scenes with options, frame options, and the devices of this machine.\n"
            "With NAME, of a technique or built-in scene, only that one.\n"
            "Options for experts, such as those measured without gain, need --all.\n",
    .examples = "  afterglow list\n"
                "  afterglow list lpv\n"
                "  afterglow list mrt --all\n"
                "  afterglow list @maze\n"
                "  afterglow list --json | jq '.techniques[].name'\n",
    .run = list,
};
