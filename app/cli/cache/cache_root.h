// The folder of cached references and bakes: $AFTERGLOW_CACHE, $XDG_CACHE_HOME/afterglow or
// ~/.cache/afterglow.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// False: there is none, or its path is longer than `size`.
bool cache_root(char *out, size_t size);
