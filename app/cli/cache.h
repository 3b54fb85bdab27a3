// Files that took long to compute, kept from run to run: in $AFTERGLOW_CACHE,
// $XDG_CACHE_HOME/afterglow or
// ~/.cache/afterglow. Without such a folder there is no cache, and work goes on without.
#pragma once

#include "output.h"

// The file that is, or is to be, kept for `key` (letters, digits, blanks), among others whose keys
// begin alike. Makes the folder. False: there is no cache; --verbose says why.
bool cache_file(const char *key, char out[PATH_SIZE]);
// The file was of use: among those to be removed it comes last.
void cache_touch(const char *path);
// Removes the files unused for longest until those of the folder of `path` are no more than the
// cache may hold; never `path` itself.
void cache_trim(const char *path);
