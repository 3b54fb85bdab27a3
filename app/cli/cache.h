// Cache of references between runs, in $AFTERGLOW_CACHE, $XDG_CACHE_HOME/afterglow or
// ~/.cache/afterglow. Without such a folder nothing is cached.
#pragma once

#include "output.h"

// Path of the cached file for `key` (letters, digits, blanks). Creates the folder. False: no
// cache; --verbose shows the reason.
bool cache_file(const char *key, char out[PATH_SIZE]);
// Marks a file as recently used.
void cache_touch(const char *path);
// Removes the least recently used files in the folder of `path`, except `path`, until the cache
// is within its size limit.
void cache_trim(const char *path);
