#include "core/files/links.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static char *real_folder_of(const char *main)
{
    const char *slash = strrchr(main, '/');
    char *folder = slash ? strndup(main, (size_t)(slash - main) + 1) : strdup(".");
    char *real = folder ? realpath(folder, NULL) : NULL;
    free(folder);
    return real;
}

static bool is_below(const char *path, const char *folder)
{
    size_t length = strlen(folder);
    if (length > 0 && folder[length - 1] == '/') length--; // the root
    return strncmp(path, folder, length) == 0 && path[length] == '/';
}

bool link_leads_out(const char *path, const char *main)
{
    char *real = realpath(path, NULL);
    // Without a target nothing is opened. Other failures, as of too long a path, are no proof.
    if (!real) return errno != ENOENT && errno != ENOTDIR && errno != EACCES && errno != ELOOP;
    char *folder = real_folder_of(main);
    const bool out = !folder || !is_below(real, folder);
    free(folder);
    free(real);
    return out;
}
