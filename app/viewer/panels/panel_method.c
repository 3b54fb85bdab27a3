// The method: techniques of the catalogue, their options, presets and debug views.
#include "panel.h"
#include "viewer/methods/bakes.h"
#include "viewer/operations.h"
#include "viewer/methods/running.h"
#include "viewer/methods/tone.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NAMES = METHOD_TECHNIQUES + 1 };

// Ranges of decades that begin above 0 get a logarithmic slider.
static bool is_wide(const struct ag_option_info *option)
{
    return option->min > 0 && option->max / option->min > 100.0;
}

static bool edit_number(const struct ag_option_info *option, const char *label, char *value)
{
    if (strcmp(option->type, "int") == 0) {
        int number = (int)method_number(value);
        if (!ui_integer(label, &number, (int)option->min, (int)option->max)) return false;
        snprintf(value, METHOD_VALUE, "%d", number);
    } else {
        float number = (float)method_number(value);
        if (!ui_number(label, &number, (float)option->min, (float)option->max, "%.4g",
                       is_wide(option)))
            return false;
        snprintf(value, METHOD_VALUE, "%.6g", (double)number);
    }
    return true;
}

static bool edit_value(const struct ag_option_info *option, const char *label, char *value)
{
    if (strcmp(option->type, "bool") == 0) {
        bool on = strcmp(value, "true") == 0;
        if (!ui_switch(label, &on)) return false;
        snprintf(value, METHOD_VALUE, "%s", on ? "true" : "false");
        return true;
    }
    if (strcmp(option->type, "choice") == 0) {
        char buffer[512];
        const char *names[64];
        const int count = method_choices(option, buffer, sizeof buffer, names, 64);
        int index = method_choice(option, value);
        if (!ui_choice(label, &index, names, count)) return false;
        snprintf(value, METHOD_VALUE, "%s", names[index]);
        return true;
    }
    return strcmp(option->type, "text") == 0 ? ui_line(label, value, METHOD_VALUE)
                                             : edit_number(option, label, value);
}

static bool is_live(const struct ag_option_info *option)
{
    return strcmp(option->effect, "live") == 0 || strcmp(option->effect, "invalidate") == 0;
}

// Returns whether the method is to be run: changes of options that create objects wait until the
// slider is let go.
static bool edit_option(struct method *method, int technique, int k)
{
    struct ag_option_info option;
    char label[96], help[1024], initial[METHOD_VALUE];
    char *value = method->values[technique][k];
    ag_technique_option_get(technique, k, &option);
    const bool unit =
        option.unit[0] && strcmp(option.type, "choice") != 0 && strcmp(option.type, "text") != 0;
    snprintf(label, sizeof label, unit ? "%s (%s)" : "%s", option.name, option.unit);
    ui_push(k);
    const bool changed = edit_value(&option, label, value);
    const bool numeric = strcmp(option.type, "int") == 0 || strcmp(option.type, "float") == 0;
    bool run = numeric && !is_live(&option) ? ui_released() : changed;
    method_default(&option, initial);
    snprintf(help, sizeof help, "%s\ndefault %s; a change is %s", option.help,
             initial[0] ? initial : "empty",
             is_live(&option)                       ? "immediate"
             : strcmp(option.effect, "rebake") == 0 ? "a new bake"
                                                    : "a short wait: objects are created");
    ui_tooltip(help);
    if (strcmp(value, initial) != 0) {
        ui_same_line();
        if (ui_small_button("x")) {
            snprintf(value, METHOD_VALUE, "%s", initial);
            run = true;
        }
        ui_tooltip("Back to the default");
    }
    ui_pop();
    return run;
}

static bool choose_preset(struct method *method, int technique,
                          const struct ag_technique_info *info)
{
    bool changed = false;
    for (int i = 0; i < info->preset_count; i++) {
        const char *name, *options;
        if (!ag_technique_preset_get(technique, i, &name, &options)) break;
        if (i > 0) ui_same_line();
        if (ui_small_button(name)) {
            method_set_preset(method, technique, i);
            changed = true;
        }
        ui_tooltip(options[0] ? options : "the defaults");
    }
    return changed;
}

static bool edit_technique(struct method *method, int technique)
{
    struct ag_technique_info info;
    struct ag_option_info option;
    bool changed = false, expert = false;
    if (!ag_technique_get(technique, &info) || info.option_count == 0) return false;
    ui_push(technique);
    if (ui_section(info.name, true)) {
        ui_faint("%s", info.title);
        changed |= choose_preset(method, technique, &info);
        for (int k = 0; k < METHOD_OPTIONS && ag_technique_option_get(technique, k, &option); k++) {
            expert |= option.expert;
            if (!option.expert) changed |= edit_option(method, technique, k);
        }
        char label[64];
        snprintf(label, sizeof label, "for experts##%s", info.name);
        if (expert && ui_section(label, false))
            for (int k = 0; k < METHOD_OPTIONS && ag_technique_option_get(technique, k, &option);
                 k++)
                if (option.expert) changed |= edit_option(method, technique, k);
    }
    ui_pop();
    return changed;
}

void panel_list_techniques(bool (*has)(int technique), char *out, size_t size)
{
    struct ag_technique_info info;
    size_t used = 0;
    out[0] = 0;
    for (int i = 0; ag_technique_get(i, &info) && used < size; i++)
        if (has(i))
            used += (size_t)snprintf(out + used, size - used, "%s%s", used ? ", " : "", info.name);
}

static bool choose_technique(struct method *method, enum method_role role)
{
    const char *names[MAX_NAMES];
    int techniques[MAX_NAMES], count = 0, index = -1;
    struct ag_technique_info info;
    if (role != ROLE_SOURCE) {
        names[count] = "(none)";
        techniques[count++] = -1;
    }
    for (int i = 0; ag_technique_get(i, &info) && count < MAX_NAMES; i++) {
        if (strcmp(info.role, method_roles[role]) != 0) continue;
        names[count] = info.name;
        techniques[count++] = i;
    }
    for (int i = 0; i < count; i++)
        if (techniques[i] == method->chosen[role]) index = i;
    if (!ui_choice(method_roles[role], &index, names, count)) return false;
    method->chosen[role] = techniques[index];
    return true;
}

// After a failure the panel shows the running method again.
void panel_edit_method(struct viewer *v, bool other)
{
    struct method *method = other ? &v->other_method : &v->method;
    char gi[METHOD_SPEC];
    bool changed = false;
    for (int i = 0; i < ROLE_COUNT; i++) changed |= choose_technique(method, (enum method_role)i);
    for (int i = 0; i < ROLE_COUNT; i++)
        if (method->chosen[i] >= 0) changed |= edit_technique(method, method->chosen[i]);
    if (!changed) return;
    method_print(method, gi);
    const bool done = other ? viewer_set_split(v, gi) : viewer_set_gi(v, gi);
    if (!done) method_parse(method, ag_renderer_gi(other ? v->other.renderer : v->main.renderer));
}

static void choose_debug_view(struct viewer *v)
{
    const char *names[64] = { "(none)" }, *help[64] = { "" };
    int count = 1, index = 0;
    for (int i = 0; i < ROLE_COUNT; i++) {
        const int technique = v->method.chosen[i];
        for (int k = 0; technique >= 0 && count < 64 &&
                        ag_technique_debug_view_get(technique, k, &names[count], &help[count]);
             k++)
            count++;
    }
    for (int i = 1; i < count && v->debug_view; i++)
        if (strcmp(names[i], v->debug_view) == 0) index = i;
    if (count == 1 || !ui_choice("debug view", &index, names, count)) return;
    if (viewer_set_debug_view(v, index ? names[index] : NULL) && index)
        viewer_say(v, "%s: %s", names[index], help[index]);
}

static void show_bytes(struct viewer *v)
{
    struct ag_renderer_desc desc;
    struct ag_scene_info info = { 0 };
    uint64_t bytes;
    ag_scene_get_info(v->desc->scene, v->desc->animation, v->time_s, &info);
    ag_renderer_desc_default(&desc);
    desc.width = v->main.width;
    desc.height = v->main.height;
    desc.gi = v->gi;
    desc.frame_options = viewer_frame_options(v);
    desc.indirect_layer = desc.id_layer = true;
    for (int i = 0; i < 3; i++)
        desc.scene_size_m = fmaxf(desc.scene_size_m, info.bounds_max[i] - info.bounds_min[i]);
    if (ag_renderer_estimate_memory(v->desc->context, &desc, info.lights, &bytes) == AG_OK)
        ui_faint("%.1f MB on the GPU, without the scene", (double)bytes * 1e-6);
}

static void show_bake(struct viewer *v)
{
    char stage[64], text[128];
    double seconds_left = 0;
    if (!bakes_running(v)) return;
    const double done = bakes_progress(v, stage, &seconds_left);
    snprintf(text, sizeof text, "bake: %s, %.0f s left", stage, seconds_left);
    ui_progress(done, text);
    if (ui_button("Cancel bake")) bakes_cancel(v);
}

void panel_method(struct viewer *v)
{
    show_bake(v);
    panel_edit_method(v, false);
    panel_blocks(v);
    choose_debug_view(v);
    show_bytes(v);
}
