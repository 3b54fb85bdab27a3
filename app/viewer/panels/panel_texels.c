// The texels of the method's light map, by a debug view.
#include "panel.h"

#include "viewer/operations.h"

#include <stdio.h>
#include <string.h>

// The debug view that shows texels as squares: of a light map, or of the blocks of mrt and drt.
static const char *view_of(const struct viewer *v, const char **help)
{
    static const char *const names[] = { "texels", "blocks" };
    for (int i = 0; i < (int)(sizeof names / sizeof *names); i++) {
        const int technique = v->method.chosen[ROLE_SOURCE];
        const int view = ag_technique_debug_view_find(technique, names[i]);
        if (view >= 0 && ag_technique_debug_view_get(technique, view, NULL, help)) return names[i];
    }
    return NULL;
}

static bool has_texels(int technique)
{
    return ag_technique_debug_view_find(technique, "texels") >= 0 ||
           ag_technique_debug_view_find(technique, "blocks") >= 0;
}

static void say_who_has_texels(const struct viewer *v)
{
    struct ag_technique_info source = { .name = "none" };
    char list[256];
    ag_technique_get(v->method.chosen[ROLE_SOURCE], &source);
    panel_list_techniques(has_texels, list, sizeof list);
    ui_faint("%s has no texels on surfaces; these have: %s.", source.name, list);
}

void panel_texels(struct viewer *v)
{
    const char *help = NULL;
    const char *name = view_of(v, &help);
    if (!ui_section("Texels", true)) return;
    if (!name) {
        say_who_has_texels(v);
        return;
    }
    bool shown = v->debug_view && strcmp(v->debug_view, name) == 0;
    if (ui_switch("texels on surfaces", &shown)) viewer_set_debug_view(v, shown ? name : NULL);
    ui_tooltip(help);
}
