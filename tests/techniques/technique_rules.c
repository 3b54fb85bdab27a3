#include "techniques/technique_rules.h"

#include "techniques/gi_preset.h"

#include <string.h>

const struct technique *technique_find(const char *name)
{
    for (size_t i = 0; techniques[i]; i++)
        if (strcmp(techniques[i]->name, name) == 0) return techniques[i];
    return NULL;
}

static bool aliases_are_sound(const struct option_table *options)
{
    const struct option_alias *alias = options->aliases;
    for (int i = 0; alias && alias[i].old_name; i++) {
        const struct option_row *row = option_find(options, alias[i].name);
        if (i >= OPTION_MAX_ALIASES || !row || strcmp(row->name, alias[i].name) != 0) return false;
        for (size_t k = 0; k < options->count; k++)
            if (strcmp(options->rows[k].name, alias[i].old_name) == 0) return false;
    }
    return true;
}

// gi.c draws the view of probes.
static bool views_are_sound(const struct technique *technique)
{
    const struct technique_debug_view *view = technique->debug_views;
    for (; view && view->name && !technique->debug_view; view++)
        if (strcmp(view->name, PROBES_VIEW) != 0 || !technique->probes) return false;
    return true;
}

bool technique_is_sound(const struct technique *technique)
{
    if (!technique->name || !technique->name[0] || !technique->title || !technique->paper)
        return false;
    if (strspn(technique->name, "abcdefghijklmnopqrstuvwxyz0123456789") != strlen(technique->name))
        return false;
    if (!technique->record || technique->state_size < technique->options.size) return false;
    if (!views_are_sound(technique)) return false;
    if ((technique->bake_version != 0) != ((technique->capabilities & NEEDS_BAKE) != 0))
        return false;
    for (size_t i = 0; i < technique->options.count; i++)
        if (strcmp(technique->options.rows[i].name, GI_QUALITY) == 0) return false;
    if (!aliases_are_sound(&technique->options)) return false;
    return technique->bake_version == 0 || (technique->bake && technique->load);
}

const char *technique_of_one_frame(const struct technique *technique)
{
    return strcmp(technique->name, "vct") == 0 ? "vct:temporal=false" : technique->name;
}

const char *technique_additive(const struct technique *technique)
{
    if (strcmp(technique->name, "lpv") == 0) return "lpv:closure=linear";
    if (strcmp(technique->name, "holpv") == 0) return "holpv:closure=linear";
    if (strcmp(technique->name, "mrt") == 0) return "mrt:bright=false";
    if (strcmp(technique->name, "drt") == 0) return "drt:bright=false";
    return technique_of_one_frame(technique);
}
