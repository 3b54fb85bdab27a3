// The array of all techniques, and the rules for each entry.
#include "techniques/registry.h"

#include "techniques/ambient/ambient.h"
#include "techniques/dnrt/dnrt.h"
#include "techniques/gi_preset.h"
#include "techniques/hbao/hbao.h"
#include "techniques/lpv/lpv.h"
#include "techniques/mrt/mrt.h"
#include "techniques/none/none.h"
#include "techniques/radiosity/radiosity.h"
#include "techniques/ssao/ssao.h"
#include "techniques/vct/vct.h"
#include "techniques/vo/vo.h"

#include <assert.h>
#include <string.h>

const struct technique *const techniques[] = { &technique_none,  &technique_ambient,
                                               &technique_lpv,   &technique_holpv,
                                               &technique_vct,   &technique_mrt,
                                               &technique_drt,   &technique_radiosity,
                                               &technique_dnrt,  &technique_vo,
                                               &technique_ssao,  &technique_hbao,
                                               &technique_vctao, NULL };

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
    if (!technique->create || !technique->record) return false;
    if (!views_are_sound(technique)) return false;
    if ((technique->bake_version != 0) != ((technique->capabilities & NEEDS_BAKE) != 0))
        return false;
    for (size_t i = 0; i < technique->options.count; i++)
        if (strcmp(technique->options.rows[i].name, GI_QUALITY) == 0) return false;
    if (!aliases_are_sound(&technique->options)) return false;
    return technique->bake_version == 0 || (technique->bake && technique->load);
}

#ifndef NDEBUG
static bool registry_is_sound(void)
{
    for (size_t i = 0; techniques[i]; i++) {
        if (!technique_is_sound(techniques[i])) return false;
        for (size_t k = 0; k < i; k++)
            if (strcmp(techniques[i]->name, techniques[k]->name) == 0) return false;
    }
    return true;
}
#endif

const struct technique *technique_find(const char *name)
{
    assert(registry_is_sound());
    for (size_t i = 0; techniques[i]; i++)
        if (strcmp(techniques[i]->name, name) == 0) return techniques[i];
    return NULL;
}

const struct technique_debug_view *technique_find_view(const struct technique *technique,
                                                       const char *name)
{
    const size_t length = strlen(technique->name);
    if (strncmp(name, technique->name, length) == 0 && name[length] == '.') name += length + 1;
    const struct technique_debug_view *view = technique->debug_views;
    for (; view && view->name; view++)
        if (strcmp(view->name, name) == 0 || (view->old_name && strcmp(view->old_name, name) == 0))
            return view;
    return NULL;
}
