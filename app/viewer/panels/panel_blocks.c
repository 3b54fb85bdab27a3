// The block map of mrt and drt, and for drt the objects inside blocks.
#include "panel.h"

#include "viewer/operations.h"

#include <stdio.h>
#include <string.h>

enum { MOST_LISTED = 32, TAB_INSPECT = 5 };

static bool has_option(int technique, const char *name)
{
    struct ag_option_info option;
    for (int k = 0; ag_technique_option_get(technique, k, &option); k++)
        if (strcmp(option.name, name) == 0) return true;
    return false;
}

static void show_blocks(struct viewer *v)
{
    bool shown = v->debug_view && strcmp(v->debug_view, "blocks") == 0;
    if (ui_switch("show the blocks", &shown)) viewer_set_debug_view(v, shown ? "blocks" : NULL);
    ui_tooltip("A colour for each block, squares for its texels: the debug view blocks.");
    ui_faint(
        "Rooms are made of blocks. They are those of the scene's nodes (afterglow_block in their "
        "extras), else found in its free space. The option map chooses (auto, single), the "
        "option blocks reads a file: docs/block-maps.md.");
    panel_block_edit(v);
}

static void list_movable(struct viewer *v)
{
    struct ag_scene_info info = { 0 };
    struct ag_instance_info instance;
    int listed = 0;
    ag_scene_get_info(v->desc->scene, v->desc->animation, v->time_s, &info);
    for (int i = 0; i < info.instances && listed < MOST_LISTED; i++) {
        if (ag_scene_get_instance(v->desc->scene, i, v->desc->animation, v->time_s, &instance) !=
                AG_OK ||
            instance.mesh < 0 || instance.mobility != AG_MOBILITY_MOVABLE)
            continue;
        char label[96];
        snprintf(label, sizeof label, "%d %.80s", i, instance.name ? instance.name : "");
        if (ui_selectable(label, v->picked_instance == i)) {
            v->picked_instance = i;
            v->show_tab = TAB_INSPECT;
        }
        listed++;
    }
    if (listed == 0) ui_faint("No instance is marked as movable, or has moved yet.");
    if (listed == MOST_LISTED) ui_faint("The first %d are listed.", MOST_LISTED);
}

void panel_blocks(struct viewer *v)
{
    const int technique = v->method.chosen[ROLE_SOURCE];
    if (!block_edit_possible(v)) return;
    if (ui_section("Blocks", true)) show_blocks(v);
    if (!has_option(technique, "occlusion") || !ui_section("Objects in blocks", true)) return;
    ui_faint(
        "Objects inside blocks that no wall stands for shadow and reflect light, and may move: "
        "click one in the tab Inspect and change its position (m). Its light follows "
        "within a second. Movable instances:");
    list_movable(v);
}
