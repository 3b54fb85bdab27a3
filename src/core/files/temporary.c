// Temporary names with locks: creation, and removal of those that a killed process left.
#include "core/files/temporary.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#define MARK ".tmp-"
enum { DIGITS = 16, SUFFIX = 5 + DIGITS, TRIES = 100 };

// ---- names

// Length of the file's folder with its slash.
static size_t folder_length(const char *target)
{
    const char *slash = strrchr(target, '/');
    return slash ? (size_t)(slash + 1 - target) : 0;
}

// Length of the part of `target` that its temporary names share: all of it, unless the suffix
// would exceed NAME_MAX or the size of a path.
static size_t stem_length(const char *target)
{
    const size_t folder = folder_length(target), length = strlen(target);
    size_t longest = folder + NAME_MAX - SUFFIX;
    if (longest > TEMPORARY_PATH - 1 - SUFFIX) longest = TEMPORARY_PATH - 1 - SUFFIX;
    if (length <= longest) return length;
    return longest > folder ? longest : folder;
}

static bool make_name(char path[TEMPORARY_PATH], const char *target)
{
    uint64_t digits = 0;
    if (getrandom(&digits, sizeof digits, 0) != (ssize_t)sizeof digits) return false;
    const int length = snprintf(path, TEMPORARY_PATH, "%.*s" MARK "%016llx",
                                (int)stem_length(target), target, (unsigned long long)digits);
    if (length < TEMPORARY_PATH) return true;
    errno = ENAMETOOLONG;
    return false;
}

size_t temporary_stem(const char *name)
{
    const size_t length = strlen(name), stem = length > SUFFIX ? length - SUFFIX : 0;
    const bool temporary = strncmp(name + stem, MARK, strlen(MARK)) == 0 &&
                           strspn(name + stem + strlen(MARK), "0123456789abcdef") == DIGITS;
    return temporary ? stem : 0;
}

// Whether the name in a folder is `stem` with the suffix of a temporary one.
static bool is_temporary(const char *name, const char *stem, size_t stem_size)
{
    return temporary_stem(name) == stem_size && strncmp(name, stem, stem_size) == 0;
}

// ---- creation

// False: another process found it without a lock, just after its creation, and removes or has
// removed it. Without locks in the file system nothing is removed.
static bool acquire_lock(int fd, const char *path)
{
    struct stat opened, named;
    if (flock(fd, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;
    return fstat(fd, &opened) == 0 && lstat(path, &named) == 0 && opened.st_ino == named.st_ino;
}

static int open_file(const char *path)
{
    return open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
}

static int open_folder(const char *path)
{
    if (mkdir(path, 0777) != 0) return -1;
    const int fd = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
    if (fd < 0 && errno != ENOENT) rmdir(path);
    return fd;
}

static bool create(struct temporary *t, const char *target, int (*make)(const char *path))
{
    t->path[0] = 0;
    t->lock = -1;
    for (int i = 0; i < TRIES; i++) {
        if (!make_name(t->path, target)) break;
        t->lock = make(t->path);
        if (t->lock >= 0 && acquire_lock(t->lock, t->path)) return true;
        if (t->lock < 0 && errno != EEXIST) break;
        if (t->lock >= 0) close(t->lock);
        t->lock = -1;
        errno = EEXIST;
    }
    t->path[0] = 0;
    return false;
}

bool temporary_file(struct temporary *temporary, const char *target)
{
    return create(temporary, target, open_file);
}

bool temporary_folder(struct temporary *temporary, const char *target)
{
    return create(temporary, target, open_folder);
}

void temporary_release(struct temporary *temporary)
{
    if (temporary->path[0] && temporary->lock >= 0) close(temporary->lock);
    temporary->path[0] = 0;
    temporary->lock = -1;
}

// ---- removal

static void empty_folder(int fd)
{
    const int copy = openat(fd, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *dir = copy >= 0 ? fdopendir(copy) : NULL;
    if (!dir) {
        if (copy >= 0) close(copy);
        return;
    }
    for (struct dirent *entry; (entry = readdir(dir));)
        unlinkat(fd, entry->d_name, 0); // refuses folders
    closedir(dir);
}

// Removes a file or folder that no process holds. It is locked meanwhile, so that its creator does
// not begin to use it.
static bool remove_unlocked(int folder, const char *name)
{
    struct stat info;
    const int fd = openat(folder, name, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0) return false;
    const bool ours = fstat(fd, &info) == 0 && (S_ISREG(info.st_mode) || S_ISDIR(info.st_mode));
    bool removed = false;
    if (ours && flock(fd, LOCK_EX | LOCK_NB) == 0) {
        if (S_ISDIR(info.st_mode)) empty_folder(fd);
        removed = unlinkat(folder, name, S_ISDIR(info.st_mode) ? AT_REMOVEDIR : 0) == 0;
    }
    close(fd);
    return removed;
}

bool temporary_remove(const char *path)
{
    return remove_unlocked(AT_FDCWD, path);
}

bool temporary_is_held(const char *path)
{
    const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    // Shared, so that processes that list a folder do not see each other as writers.
    const bool held = fd >= 0 && flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (fd >= 0) close(fd);
    return held;
}

void temporary_remove_stale(const char *target, void (*removed)(void *user, const char *path),
                            void *user)
{
    char path[TEMPORARY_PATH];
    const size_t folder = folder_length(target), stem = stem_length(target);
    if (folder >= sizeof path) return;
    memcpy(path, target, folder);
    path[folder] = 0;
    DIR *dir = opendir(folder ? path : ".");
    if (!dir) return;
    for (struct dirent *entry; (entry = readdir(dir));) {
        if (!is_temporary(entry->d_name, target + folder, stem - folder)) continue;
        if (!remove_unlocked(dirfd(dir), entry->d_name)) continue;
        snprintf(path + folder, sizeof path - folder, "%s", entry->d_name);
        removed(user, path);
    }
    closedir(dir);
}
