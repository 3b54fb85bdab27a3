#include "disk.h"
#include "whole_file.h"

#include <stdio.h>
#include <string.h>
#include <sys/statvfs.h>

static void folder_of(const char *path, char out[PATH_SIZE])
{
    snprintf(out, PATH_SIZE, "%s", path);
    char *slash = strrchr(out, '/');
    if (!slash)
        snprintf(out, PATH_SIZE, ".");
    else if (slash > out)
        *slash = 0;
    else
        slash[1] = 0;
}

bool disk_free(const char *path, uint64_t *bytes)
{
    char folder[PATH_SIZE];
    struct statvfs disk;
    folder_of(path, folder);
    if (statvfs(folder, &disk) != 0 || disk.f_blocks == 0) return false;
    *bytes = (uint64_t)disk.f_bavail * disk.f_frsize;
    return true;
}
