// The folder of the cache, from the environment.
#include "cache_root.h"

#include <stdio.h>
#include <stdlib.h>

// Per the XDG Base Directory Specification, relative and empty paths are ignored.
bool cache_root(char *out, size_t size)
{
    const char *own = getenv("AFTERGLOW_CACHE"), *xdg = getenv("XDG_CACHE_HOME"),
               *home = getenv("HOME");
    int wrote = 0;
    if (own && own[0])
        wrote = snprintf(out, size, "%s", own);
    else if (xdg && xdg[0] == '/')
        wrote = snprintf(out, size, "%s/afterglow", xdg);
    else if (home && home[0] == '/')
        wrote = snprintf(out, size, "%s/.cache/afterglow", home);
    return wrote > 0 && wrote < (int)size;
}
