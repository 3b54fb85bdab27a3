#include "candidates.h"
#include "cli/options/option_text.h"

#include <afterglow/afterglow.h>

#include <stdio.h>
#include <string.h>

// ---- one word

static const char *prefix = "";
static int prefix_length;

void candidates_prefix(const char *text, int length)
{
    prefix = text;
    prefix_length = length;
}

void candidate(const struct candidate_word *word, const char *name, const char *suffix,
               const char *help)
{
    char text[256];
    snprintf(text, sizeof text, "%s%s", name, suffix);
    if (strncmp(text, word->typed, strlen(word->typed)) != 0) return;
    printf("%.*s%.*s%s\t%.*s\n", prefix_length, prefix, word->kept_length, word->kept, text,
           (int)strcspn(help, "\n\t"), help);
}

static struct candidate_word after(const char *typed, const char *rest)
{
    return (struct candidate_word){ typed, (int)(rest - typed), rest };
}

static const char *after_last(const char *text, char separator)
{
    const char *last = strrchr(text, separator);
    return last ? last + 1 : text;
}

// ---- "key=value,key=value"

typedef bool option_getter(int owner, int index, struct ag_option_info *out);

static bool is_named(const char *name, const char *text, size_t length)
{
    return strlen(name) == length && memcmp(name, text, length) == 0;
}

// Whether "name" or "name=…" is an item of the list before `end`.
static bool is_used(const char *list, const char *end, const char *name)
{
    for (const char *item = list; item < end; item += strcspn(item, ",") + 1)
        if (is_named(name, item, strcspn(item, "=,"))) return true;
    return false;
}

static void choices(const struct candidate_word *word, const struct ag_option_info *option)
{
    char name[64];
    if (option_is(option, "bool")) {
        candidate(word, "true", "", "");
        candidate(word, "false", "", "");
    }
    if (!option_is(option, "choice")) return;
    for (int i = 0; option_choice(option->unit, i, name)[0]; i++) candidate(word, name, "", "");
}

static void values(const char *typed, const char *item, option_getter *get, int owner)
{
    const char *value = strchr(item, '=') + 1;
    const struct candidate_word word = after(typed, value);
    struct ag_option_info option;
    for (int k = 0; get(owner, k, &option); k++)
        if (is_named(option.name, item, (size_t)(value - 1 - item))) choices(&word, &option);
}

// typed: the whole word; list: the options in it.
static void options(const char *typed, const char *list, option_getter *get, int owner)
{
    const char *item = after_last(list, ',');
    const struct candidate_word word = after(typed, item);
    struct ag_option_info option;
    if (strchr(item, '=')) {
        values(typed, item, get, owner);
        return;
    }
    for (int k = 0; get(owner, k, &option); k++)
        if (!is_used(list, item, option.name)) candidate(&word, option.name, "=", option.help);
}

static bool frame_option(int owner, int index, struct ag_option_info *out)
{
    (void)owner;
    return ag_frame_option_get(index, out);
}

void candidates_frame_options(const char *typed)
{
    options(typed, typed, frame_option, 0);
}

// ---- techniques

static void presets(const char *typed, const char *list, int technique)
{
    static const char QUALITY[] = "quality";
    const char *item = after_last(list, ','), *name, *set;
    struct candidate_word word = after(typed, item);
    const bool has_value = strncmp(item, "quality=", sizeof QUALITY) == 0;
    if (!ag_technique_preset_get(technique, 0, &name, &set)) return;
    if (!has_value && !is_used(list, item, QUALITY)) candidate(&word, QUALITY, "=", "a preset");
    if (has_value) word = after(typed, item + sizeof QUALITY);
    for (int k = 0; has_value && ag_technique_preset_get(technique, k, &name, &set); k++)
        candidate(&word, name, "", set[0] ? set : "the defaults");
}

// Whether a term before the word is of this role: a spec has one of each.
static bool has_role(const struct candidate_word *word, const char *role)
{
    struct ag_technique_info technique;
    const char *end = word->kept + word->kept_length;
    for (const char *term = word->kept; term < end; term += strcspn(term, "+") + 1)
        for (int i = 0; ag_technique_get(i, &technique); i++)
            if (is_named(technique.name, term, strcspn(term, ":+")) &&
                strcmp(technique.role, role) == 0)
                return true;
    return false;
}

static void technique_names(const struct candidate_word *word, bool in_spec)
{
    struct ag_technique_info technique;
    for (int i = 0; ag_technique_get(i, &technique); i++) {
        if (has_role(word, technique.role)) continue;
        candidate(word, technique.name, "", technique.title);
        if (in_spec && technique.option_count > 0)
            candidate(word, technique.name, ":", "with options");
    }
}

void candidates_gi(const char *typed)
{
    const char *term = after_last(typed, '+'), *colon = strchr(term, ':');
    const struct candidate_word word = after(typed, term);
    struct ag_technique_info technique;
    if (!colon) {
        technique_names(&word, true);
        return;
    }
    for (int i = 0; ag_technique_get(i, &technique); i++) {
        if (!is_named(technique.name, term, (size_t)(colon - term))) continue;
        options(typed, colon + 1, ag_technique_option_get, i);
        presets(typed, colon + 1, i);
    }
}

void candidates_debug_views(const char *typed)
{
    const struct candidate_word word = after(typed, typed);
    struct ag_technique_info technique;
    const char *view, *help;
    for (int i = 0; ag_technique_get(i, &technique); i++)
        for (int k = 0; ag_technique_debug_view_get(i, k, &view, &help); k++)
            candidate(&word, view, "", help);
}

// ---- scenes

static void scene_names(const char *typed, bool with_options)
{
    const struct candidate_word word = after(typed, typed);
    struct ag_builtin_scene_info scene;
    char name[64];
    for (int i = 0; ag_builtin_scene_get(i, &scene); i++) {
        snprintf(name, sizeof name, "@%s", scene.name);
        candidate(&word, name, "", scene.title);
        if (with_options && scene.option_count > 0) candidate(&word, name, ":", "with options");
    }
}

void candidates_scene(const char *typed)
{
    const char *colon = strchr(typed, ':');
    struct ag_builtin_scene_info scene;
    if (!colon) scene_names(typed, true);
    for (int i = 0; colon && ag_builtin_scene_get(i, &scene); i++)
        if (typed[0] == '@' && is_named(scene.name, typed + 1, (size_t)(colon - typed - 1)))
            options(typed, colon + 1, ag_builtin_scene_option_get, i);
}

void candidates_names(const char *typed)
{
    const struct candidate_word word = after(typed, typed);
    technique_names(&word, false);
    scene_names(typed, false);
}

// ---- layers

void candidates_layers(const char *typed, const char *(*layer_name)(int index))
{
    const char *item = after_last(typed, ','), *name;
    const struct candidate_word word = after(typed, item);
    for (int i = 0; (name = layer_name(i)); i++)
        if (!is_used(typed, item, name)) candidate(&word, name, "", "");
}
