// Writes the block map, and has the method use the file.
#include "block_edit.h"

#include "viewer/methods/running.h"
#include "viewer/operations.h"
#include "viewer/scene/undo.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The index of an option; -1: the technique has none of that name.
static int find_option(int technique, const char *name)
{
    struct ag_option_info option;
    for (int k = 0; k < METHOD_OPTIONS && ag_technique_option_get(technique, k, &option); k++)
        if (strcmp(option.name, name) == 0) return k;
    return -1;
}

// A path as the value of an option; false: it is too long.
static bool encode(const char *path, char out[METHOD_VALUE])
{
    size_t used = 0;
    for (; *path; path++) {
        const bool special = strchr(",+%", *path);
        const size_t length = special ? 3 : 1;
        if (used + length >= METHOD_VALUE) return false;
        snprintf(out + used, METHOD_VALUE - used, special ? "%%%02X" : "%c", *path);
        used += length;
    }
    out[used] = 0;
    return used > 0;
}

// The method with the file in place of its map. *again: it names the file already.
static bool with_file(struct viewer *v, const char *path, char gi[METHOD_SPEC], bool *again)
{
    const int technique = v->method.chosen[ROLE_SOURCE];
    const int option = find_option(technique, "blocks"), map = find_option(technique, "map");
    struct ag_option_info info;
    char value[METHOD_VALUE];
    if (option < 0 || map < 0) {
        viewer_warn(v, "choose mrt or drt as the source: other methods have no block map");
        return false;
    }
    if (!encode(path, value)) {
        viewer_warn(v, "cannot write a block map: the file's name is empty or too long");
        return false;
    }
    struct method *method = malloc(sizeof *method);
    if (!method) {
        viewer_warn(v, "cannot write a block map: out of memory");
        return false;
    }
    *method = v->method;
    *again = strcmp(method->values[technique][option], value) == 0;
    snprintf(method->values[technique][option], METHOD_VALUE, "%s", value);
    ag_technique_option_get(technique, map, &info);
    method_default(&info, method->values[technique][map]);
    method_print(method, gi);
    free(method);
    return true;
}

bool block_edit_write(struct viewer *v, const char *path)
{
    char gi[METHOD_SPEC];
    bool again;
    if (v->block_edit.blocks.count == 0) {
        viewer_warn(v, "there are no blocks to write");
        return false;
    }
    if (!with_file(v, path, gi, &again)) return false;
    struct ag_block_map *map = block_edit_check(v, &v->block_edit.blocks);
    const bool done = map && viewer_write_text(v, path, ag_block_map_json(map));
    ag_block_map_destroy(map);
    undo_step(v, false); // a change of the blocks is a step of its own
    return done && (again ? viewer_begin_gi_again(v, gi) : viewer_set_gi(v, gi));
}
