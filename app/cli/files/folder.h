// A folder of results that appears complete or not at all and replaces an earlier one.
#pragma once

#include "whole_file.h"

#include "core/files/temporary.h"

struct folder {
    char shown[PATH_SIZE];   // as given
    char path[PATH_SIZE];    // final path, symbolic links resolved
    struct temporary beside; // its path "": none
    bool (*is_ours)(const char *name);
};

// Checks that the folder can be written. An existing one must be empty, or contain `mark` and
// only files of ours.
enum status folder_plan(struct folder *folder, const char *path, const char *mark,
                        bool (*is_ours)(const char *name));
// Creates the temporary folder. A signal that ends the program removes it.
enum status folder_begin(struct folder *folder);
// Path of a file in the temporary folder. False: too long.
bool folder_file(const struct folder *folder, const char *name, char out[PATH_SIZE]);
// Copies a file to `path` in the temporary folder.
enum status folder_copy(const char *from, const char *path);
// Publishes the folder and removes the earlier one.
enum status folder_commit(struct folder *folder, const char *mark);
// Removes an unpublished temporary folder, if any.
void folder_abort(struct folder *folder);
