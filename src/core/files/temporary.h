// Temporary files and folders beside what they will replace: "TARGET.tmp-" and sixteen random
// hexadecimal digits. Their writer holds a lock on them (flock). One without a lock was left by a
// process that was ended, and the next writer of the same target removes it.
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { TEMPORARY_PATH = 4096 };

struct temporary {
    char path[TEMPORARY_PATH];
    int lock; // descriptor that holds the lock; -1: none
};

// Create an empty file or folder. False: see errno. End with temporary_release.
bool temporary_file(struct temporary *temporary, const char *target);
bool temporary_folder(struct temporary *temporary, const char *target);
// Gives up the lock, after the file or folder was renamed or removed. Accepts one that was released
// or never created.
void temporary_release(struct temporary *temporary);

// Removes those of `target` that no process holds, and calls `removed` with the path of each. Of a
// folder only files are removed: one with folders in it stays.
void temporary_remove_stale(const char *target, void (*removed)(void *user, const char *path),
                            void *user);

// Length of the target's name in the name of a temporary file or folder; 0: it is not one.
size_t temporary_stem(const char *name);
bool temporary_is_held(const char *path); // by a process
// Removes one that no process holds, as above. False: it is still there, or was not.
bool temporary_remove(const char *path);
