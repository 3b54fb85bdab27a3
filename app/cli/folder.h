// A folder of results that appears whole or not at all, in place of one of an earlier run.
#pragma once

#include "output.h"

struct folder {
    char shown[PATH_SIZE];  // as it was named
    char path[PATH_SIZE];   // where it is to be, through symbolic links
    char beside[PATH_SIZE]; // where it is being filled; "": nowhere
    bool (*is_ours)(const char *name);
};

// Could it be written there? What is there already must be an empty folder or one that holds `mark`
// and else nothing but files whose names are ours, so that replacing it loses nothing of anybody
// else's. Says why not.
enum status folder_plan(struct folder *folder, const char *path, const char *mark,
                        bool (*is_ours)(const char *name));
// Makes the folder beside. A signal that ends the program removes it.
enum status folder_begin(struct folder *folder);
// The path of a file in it. False: too long.
bool folder_file(const struct folder *folder, const char *name, char out[PATH_SIZE]);
// A copy of a file at `path`, which is in it.
enum status folder_copy(const char *from, const char *path);
// Puts it in its place and removes the one of before.
enum status folder_commit(struct folder *folder, const char *mark);
// Removes what was begun; accepts a folder that was not, or that is in its place.
void folder_abort(struct folder *folder);
