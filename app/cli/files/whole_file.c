// Atomic writes of files.
#include "whole_file.h"
#include "interrupt.h"

#include "core/files/temporary.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum status whole_file_check(const char *path)
{
    char folder[PATH_SIZE];
    if (strlen(path) >= sizeof folder) return fail("cannot write %s: the path is too long", path);
    const char *slash = strrchr(path, '/');
    size_t length = slash == path ? 1 : slash ? (size_t)(slash - path) : 0;
    memcpy(folder, path, length);
    folder[length] = 0;
    struct stat info;
    if (stat(length ? folder : ".", &info) != 0)
        return fail("cannot write %s: no folder %s", path, folder);
    if (!S_ISDIR(info.st_mode)) return fail("cannot write %s: %s is not a folder", path, folder);
    if (access(length ? folder : ".", W_OK | X_OK) != 0)
        return fail("cannot write %s: %s", path, strerror(errno));
    if (stat(path, &info) != 0)
        return errno == ENOENT ? DONE : fail("cannot write %s: %s", path, strerror(errno));
    if (S_ISDIR(info.st_mode)) return fail("cannot write %s: it is a folder", path);
    if (!S_ISREG(info.st_mode)) return fail("cannot write %s: it is not a regular file", path);
    return access(path, W_OK) == 0 ? DONE : fail("cannot write %s: %s", path, strerror(errno));
}

struct destination {
    const char *path;   // as given, for messages
    const char *target; // symbolic links resolved, since a rename would replace them
};

static enum status cannot_write(const struct destination *to, int why)
{
    return fail("cannot write %s: %s", to->path, strerror(why));
}

void whole_file_removed(void *user, const char *path)
{
    note("warning: %s: removed %s, left by an interrupted run", (const char *)user, path);
}

// The lock outlives the stream: a second descriptor holds it.
static FILE *open_stream(const struct temporary *beside)
{
    const int fd = fcntl(beside->lock, F_DUPFD_CLOEXEC, 0);
    FILE *file = fd >= 0 ? fdopen(fd, "w") : NULL;
    if (!file && fd >= 0) close(fd);
    return file;
}

static enum status write_beside(const struct destination *to, const struct temporary *beside,
                                enum status (*write)(FILE *file, const void *what),
                                const void *what)
{
    FILE *file = open_stream(beside);
    if (!file) return cannot_write(to, errno);
    errno = 0;
    enum status status = write(file, what);
    bool written = !ferror(file);
    int why = errno;
    if (fclose(file) != 0 && written) {
        written = false;
        why = errno;
    }
    if (status == DONE && !written) status = cannot_write(to, why ? why : EIO);
    if (status == DONE && rename(beside->path, to->target) != 0) status = cannot_write(to, errno);
    return status;
}

enum status whole_file_write(const char *path, enum status (*write)(FILE *file, const void *what),
                             const void *what)
{
    struct temporary beside;
    char *real = realpath(path, NULL);
    const struct destination to = { path, real ? real : path };
    interrupt_hold();
    temporary_remove_stale(to.target, whole_file_removed, (void *)(uintptr_t)path);
    enum status status = temporary_file(&beside, to.target)
                             ? write_beside(&to, &beside, write, what)
                             : cannot_write(&to, errno);
    if (status != DONE && beside.path[0]) unlink(beside.path);
    temporary_release(&beside);
    interrupt_release();
    free(real);
    return status;
}
