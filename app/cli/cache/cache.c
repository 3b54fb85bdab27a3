// Cached files: $CACHE/references/KEY.exr and $CACHE/bakes/KEY.safetensors.
#include "cache.h"
#include "cli/files/interrupt.h"

#include "core/files/temporary.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const long long MAX_BYTES = 2LL << 30;

static const struct {
    const char *name, *folder, *ending;
} kinds[CACHE_KINDS] = { [CACHE_REFERENCE] = { "reference", "references", ".exr" },
                         [CACHE_BAKE] = { "bake", "bakes", ".safetensors" } };

// ---- location

static bool join(char out[PATH_SIZE], const char *folder, const char *name)
{
    const int wrote = snprintf(out, PATH_SIZE, "%s/%s", folder, name);
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

__attribute__((format(printf, 2, 3))) static bool no_cache(char why[CACHE_WHY_SIZE],
                                                           const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (why) vsnprintf(why, CACHE_WHY_SIZE, format, arguments);
    va_end(arguments);
    return false;
}

bool cache_folder(enum cache_kind kind, char out[PATH_SIZE], char why[CACHE_WHY_SIZE])
{
    char root[PATH_SIZE];
    if (!cache_root(root, sizeof root) || !join(out, root, kinds[kind].folder))
        return no_cache(why, "neither AFTERGLOW_CACHE, XDG_CACHE_HOME nor HOME names a folder");
    return make_folder(out) || no_cache(why, "%s: %s", out, strerror(errno));
}

bool cache_file(enum cache_kind kind, const char *key, char out[PATH_SIZE],
                char why[CACHE_WHY_SIZE])
{
    char folder[PATH_SIZE];
    const char *ending = kinds[kind].ending;
    if (!cache_folder(kind, folder, why)) return false;
    int used = snprintf(out, PATH_SIZE, "%s/", folder);
    for (const char *c = key; *c && used < PATH_SIZE - 16; c++)
        out[used++] = isalnum((unsigned char)*c) ? *c : '-';
    return snprintf(out + used, (size_t)(PATH_SIZE - used), "%s", ending) < PATH_SIZE - used ||
           no_cache(why, "%s: the path is too long", folder);
}

void cache_touch(const char *path)
{
    if (utimensat(AT_FDCWD, path, NULL, AT_SYMLINK_NOFOLLOW) != 0)
        detail("cannot touch %s: %s", path, strerror(errno));
}

const char *cache_entry_kind(const struct cache_entry *entry)
{
    return entry->left_over ? "left-over" : kinds[entry->kind].name;
}

long long cache_limit(void)
{
    return MAX_BYTES;
}

// ---- files

// A reference is named "reference-1-0123456789abcdef.exr", a bake by 32 digits; an interrupted one
// has a checkpoint beside it, and the tasks after that.
static bool is_ours(enum cache_kind kind, const char *name)
{
    char hash[33], rest[32] = "";
    if (kind == CACHE_REFERENCE)
        return sscanf(name, "reference-%*d-%16[0-9a-f]%31s", hash, rest) == 2 &&
               strlen(hash) == 16 && strcmp(rest, ".exr") == 0;
    return sscanf(name, "%32[0-9a-f]%31s", hash, rest) == 2 && strlen(hash) == 32 &&
           (strcmp(rest, ".safetensors") == 0 || strcmp(rest, ".safetensors.checkpoint") == 0 ||
            strcmp(rest, ".safetensors.checkpoint.tasks") == 0);
}

struct list {
    struct cache_entry *entries;
    int count, capacity;
};

static struct cache_entry *append(struct list *list)
{
    if (list->count == list->capacity) {
        const int capacity = list->capacity ? 2 * list->capacity : 16;
        struct cache_entry *entries =
            realloc(list->entries, (size_t)capacity * sizeof *list->entries);
        if (!entries) return NULL;
        list->entries = entries;
        list->capacity = capacity;
    }
    return &list->entries[list->count++];
}

static bool add_file(struct list *list, enum cache_kind kind, const char *folder, const char *name)
{
    struct stat info;
    char path[PATH_SIZE], target[NAME_MAX + 1];
    const size_t stem = temporary_stem(name);
    snprintf(target, sizeof target, "%.*s", (int)(stem > 0 ? stem : strlen(name)), name);
    if (!is_ours(kind, target) || !join(path, folder, name)) return true;
    if (lstat(path, &info) != 0 || !S_ISREG(info.st_mode)) return true;
    if (stem > 0 && temporary_is_held(path)) return true;
    struct cache_entry *entry = append(list);
    if (!entry) return false;
    *entry = (struct cache_entry){ .kind = kind,
                                   .left_over = stem > 0,
                                   .bytes = (long long)info.st_size,
                                   .used_s = (long long)info.st_mtim.tv_sec,
                                   .used_ns = (long long)info.st_mtim.tv_nsec };
    memcpy(entry->path, path, sizeof path);
    return true;
}

static bool add_folder(struct list *list, enum cache_kind kind, const char *root)
{
    char folder[PATH_SIZE];
    if (!join(folder, root, kinds[kind].folder)) return true;
    DIR *dir = opendir(folder);
    bool ok = true;
    for (struct dirent *file; ok && dir && (file = readdir(dir));)
        ok = add_file(list, kind, folder, file->d_name);
    if (dir) closedir(dir);
    return ok;
}

static int by_use(const void *a, const void *b)
{
    const struct cache_entry *x = a, *y = b;
    if (x->used_s != y->used_s) return x->used_s < y->used_s ? -1 : 1;
    if (x->used_ns != y->used_ns) return x->used_ns < y->used_ns ? -1 : 1;
    return strcmp(x->path, y->path);
}

int cache_list(const char *root, struct cache_entry **out)
{
    struct list list = { 0 };
    bool ok = true;
    *out = NULL;
    for (int kind = 0; kind < CACHE_KINDS && ok; kind++)
        ok = add_folder(&list, (enum cache_kind)kind, root);
    if (!ok) {
        free(list.entries);
        return -1;
    }
    if (list.count > 1) qsort(list.entries, (size_t)list.count, sizeof *list.entries, by_use);
    *out = list.entries;
    return list.count;
}

bool cache_remove(const struct cache_entry *entry)
{
    const bool removed =
        entry->left_over ? temporary_remove(entry->path) : unlink(entry->path) == 0;
    return removed || access(entry->path, F_OK) != 0;
}

// ---- size limit

// The parent folder, in place.
static bool go_up(char *path)
{
    char *slash = strrchr(path, '/');
    if (!slash || slash == path) return false;
    *slash = 0;
    return true;
}

void cache_trim(const char *path)
{
    char root[PATH_SIZE];
    struct cache_entry *entries = NULL;
    long long sum = 0;
    snprintf(root, sizeof root, "%s", path);
    if (!go_up(root) || !go_up(root)) return;
    const int count = cache_list(root, &entries);
    for (int i = 0; i < count; i++) sum += entries[i].bytes;
    for (int i = 0; i < count && sum > MAX_BYTES; i++) {
        if (strcmp(entries[i].path, path) == 0 || !cache_remove(&entries[i])) continue;
        detail("cache: %s (%.1f MB) made room", entries[i].path, (double)entries[i].bytes * 1e-6);
        sum -= entries[i].bytes;
    }
    free(entries);
}
