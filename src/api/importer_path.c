// Finds the importer program: beside the library or the program that contains it, below libexec of
// the same prefix, and where it is installed.
#include "api/objects.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const NAME = "afterglow-import";

// The part of a path before its last slash; false for a relative path, whose folder may be another
// one by now.
static bool folder_of(const char *path, char *out, size_t size)
{
    const char *slash = path[0] == '/' ? strrchr(path, '/') : NULL;
    return slash && (size_t)snprintf(out, size, "%.*s", (int)(slash - path), path) < size;
}

// NULL if there is no such program.
static char *find_in(struct host *host, const char *folder, const char *relative)
{
    char *path = host_sprintf(host, "%s/%s", folder, relative);
    if (path && access(path, X_OK) == 0) return path;
    host_free(host, path);
    return NULL;
}

static char *find_near(struct host *host, const char *file, const char *installed)
{
    char folder[4096];
    if (!folder_of(file, folder, sizeof folder)) return NULL;
    char *path = find_in(host, folder, NAME);
    return path ? path : find_in(host, folder, installed);
}

char *api_find_importer(struct host *host)
{
    char program[4096];
    Dl_info library;
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = 0;
    char *path = NULL;
    if (dladdr((void *)(uintptr_t)&api_find_importer, &library) != 0 && library.dli_fname)
        path = find_near(host, library.dli_fname, AG_IMPORTER_FROM_LIBRARY);
    if (!path) path = find_near(host, program, AG_IMPORTER_FROM_PROGRAM);
    return path ? path : find_in(host, AG_IMPORTER_FOLDER, NAME);
}
