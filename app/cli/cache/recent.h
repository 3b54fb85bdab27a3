// Scenes that the viewer opened lately: a text file, a path each line, in the folder of the cache.
// Without that folder nothing is remembered.
#pragma once

#include "cli/files/whole_file.h"

enum { RECENT_SCENES = 10 };

struct recent {
    int count;
    char paths[RECENT_SCENES][PATH_SIZE]; // the newest first
};

void recent_read(struct recent *recent);
// Puts a path before the others and writes the file.
void recent_add(const char *path);
