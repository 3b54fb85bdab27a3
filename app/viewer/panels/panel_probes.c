// The switch of the balls that show probes, and why there are none.
#include "panel.h"

#include "viewer/methods/bakes.h"
#include "viewer/operations.h"
#include "viewer/inspect/probe_balls.h"
#include "viewer/methods/running.h"

#include <stdio.h>
#include <string.h>

static bool publishes(int technique)
{
    struct ag_technique_info info;
    return ag_technique_get(technique, &info) && info.publishes_probes;
}

// The technique of the method that can publish probes; -1: none.
static int publisher(const struct viewer *v)
{
    for (int i = 0; i < ROLE_COUNT; i++)
        if (publishes(v->method.chosen[i])) return v->method.chosen[i];
    return -1;
}

static void say_who_publishes(const struct viewer *v)
{
    struct ag_technique_info source = { .name = "none" };
    char list[256];
    ag_technique_get(v->method.chosen[ROLE_SOURCE], &source);
    panel_list_techniques(publishes, list, sizeof list);
    ui_faint("%s publishes no probes; these do: %s.", source.name, list);
}

// The method publishes probes from now on.
static bool publish(struct viewer *v, int technique)
{
    struct ag_option_info option;
    char gi[METHOD_SPEC];
    for (int k = 0; k < METHOD_OPTIONS && ag_technique_option_get(technique, k, &option); k++)
        if (strcmp(option.name, "probes") == 0)
            snprintf(v->method.values[technique][k], METHOD_VALUE, "true");
    method_print(&v->method, gi);
    return viewer_set_gi(v, gi);
}

static void show_counts(const struct probe_balls *b)
{
    if (b->count < b->in_view)
        ui_faint("The nearest %d of %d probes in view.", b->count, b->in_view);
    else
        ui_faint("%d probes in view.", b->count);
    if (b->dark > 0) ui_faint("Violet: %d without light, as inside geometry.", b->dark);
}

void panel_probes(struct viewer *v)
{
    struct probe_balls *b = &v->probe_balls;
    const int technique = publisher(v);
    if (!ui_section("Probes", true)) return;
    if (technique < 0) {
        say_who_publishes(v);
        return;
    }
    if (ui_switch("probes as balls", &b->shown)) b->version = 0;
    ui_tooltip("A white ball at each probe, lit by the irradiance that the probe has for each "
               "direction. Sets the option probes=true of the method.");
    if (!b->shown) return;
    if (!probe_balls_published(v) && !bakes_running(v) && !publish(v, technique)) b->shown = false;
    show_counts(b);
}
