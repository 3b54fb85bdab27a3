// Cached references: $CACHE/references/KEY.exr.
#include "cache.h"
#include "interrupt.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const long long MAX_BYTES = 2LL << 30;
static const char FOLDER[] = "references";

// ---- location

// Per the XDG Base Directory Specification, relative and empty paths are ignored.
static bool find_folder(char out[PATH_SIZE])
{
    const char *own = getenv("AFTERGLOW_CACHE"), *xdg = getenv("XDG_CACHE_HOME"),
               *home = getenv("HOME");
    int wrote = 0;
    if (own && own[0])
        wrote = snprintf(out, PATH_SIZE, "%s/%s", own, FOLDER);
    else if (xdg && xdg[0] == '/')
        wrote = snprintf(out, PATH_SIZE, "%s/afterglow/%s", xdg, FOLDER);
    else if (home && home[0] == '/')
        wrote = snprintf(out, PATH_SIZE, "%s/.cache/afterglow/%s", home, FOLDER);
    return wrote > 0 && wrote < PATH_SIZE;
}

// Creates a folder and its parents. False: see errno.
static bool make_folder(char *path)
{
    for (char *slash = path + 1; (slash = strchr(slash, '/')); slash++) {
        *slash = 0;
        bool made = mkdir(path, 0700) == 0 || errno == EEXIST || access(path, F_OK) == 0;
        *slash = '/';
        if (!made) return false;
    }
    return (mkdir(path, 0700) == 0 || errno == EEXIST) && access(path, W_OK | X_OK) == 0;
}

bool cache_file(const char *key, char out[PATH_SIZE])
{
    char folder[PATH_SIZE];
    if (!find_folder(folder)) {
        detail("no cache: neither AFTERGLOW_CACHE nor HOME names a folder");
        return false;
    }
    if (!make_folder(folder)) {
        detail("no cache: %s: %s", folder, strerror(errno));
        return false;
    }
    int used = snprintf(out, PATH_SIZE, "%s/", folder);
    for (const char *c = key; *c && used < PATH_SIZE - 5; c++)
        out[used++] = isalnum((unsigned char)*c) ? *c : '-';
    return snprintf(out + used, (size_t)(PATH_SIZE - used), ".exr") < PATH_SIZE - used;
}

void cache_touch(const char *path)
{
    if (utimensat(AT_FDCWD, path, NULL, 0) != 0)
        detail("cannot touch %s: %s", path, strerror(errno));
}

// ---- size limit

struct entry {
    char path[PATH_SIZE + NAME_MAX + 2];
    long long bytes;
    struct timespec used;
};

// Cached files are named "reference-1-0123456789abcdef.exr"; a temporary file has a longer name.
static bool is_ours(const char *name)
{
    char hash[17];
    return sscanf(name, "reference-%*d-%16[0-9a-f].exr", hash) == 1 && strlen(hash) == 16;
}

static bool is_older(const struct entry *a, const struct entry *b)
{
    return a->used.tv_sec != b->used.tv_sec ? a->used.tv_sec < b->used.tv_sec
                                            : a->used.tv_nsec < b->used.tv_nsec;
}

// Total size of the cached files, and the least recently used one except `spared` (path "" if
// none).
static long long look_around(const char *folder, const char *spared, struct entry *oldest)
{
    long long sum = 0;
    struct entry entry;
    struct stat info;
    oldest->path[0] = 0;
    DIR *dir = opendir(folder);
    for (struct dirent *file; dir && (file = readdir(dir));) {
        if (!is_ours(file->d_name)) continue;
        snprintf(entry.path, sizeof entry.path, "%s/%s", folder, file->d_name);
        if (lstat(entry.path, &info) != 0 || !S_ISREG(info.st_mode)) continue;
        entry.bytes = (long long)info.st_size;
        entry.used = info.st_mtim;
        sum += entry.bytes;
        if (strcmp(entry.path, spared) == 0) continue;
        if (!oldest->path[0] || is_older(&entry, oldest)) *oldest = entry;
    }
    if (dir) closedir(dir);
    return sum;
}

void cache_trim(const char *path)
{
    char folder[PATH_SIZE];
    struct entry oldest;
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(path, '/') - path), path);
    while (look_around(folder, path, &oldest) > MAX_BYTES && oldest.path[0]) {
        if (unlink(oldest.path) != 0) return;
        detail("cache: %s (%.1f MB) made room", oldest.path, (double)oldest.bytes * 1e-6);
    }
}
