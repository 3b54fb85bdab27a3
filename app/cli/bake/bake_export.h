// afterglow bake --export: the data of a bake for other programs, as a folder.
#pragma once

#include "baking.h"
#include "cli/files/folder.h"

#include <jansson.h>

struct bake_export {
    const char *path; // the folder; NULL: none is wanted
    struct folder folder;
    json_t *facts; // {"output", "bins", "bytes", "occupancy"}; NULL: nothing is written yet
};

// Before the scene is loaded: fails where the technique that bakes has no such data, or the folder
// cannot be written.
enum status bake_export_begin(struct bake_export *e, const struct session *session,
                              const char *path, const char *gi);
// Exports a complete bake. The folder appears complete or not at all, and replaces an earlier
// export.
enum status bake_export_write(struct bake_export *e, const struct baking *baking);
void bake_export_end(struct bake_export *e); // accepts zero
