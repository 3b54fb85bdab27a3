// Atomic writes of files.
#include "whole_file.h"
#include "interrupt.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Shorter than the file name limit of usual file systems.
char *whole_file_beside(const char *path)
{
    enum { SUFFIX_SIZE = 32 };
    const char *slash = strrchr(path, '/');
    size_t folder = slash ? (size_t)(slash + 1 - path) : 0, length = strlen(path);
    if (length - folder > NAME_MAX - SUFFIX_SIZE) length = folder + NAME_MAX - SUFFIX_SIZE;
    char *beside = malloc(length + SUFFIX_SIZE);
    if (beside)
        snprintf(beside, length + SUFFIX_SIZE, "%.*s.tmp-%ld", (int)length, path, (long)getpid());
    return beside;
}

struct destination {
    const char *path;   // as given, for messages
    const char *target; // symbolic links resolved, since a rename would replace them
    const char *beside;
};

static enum status cannot_write(const struct destination *to, int why)
{
    return fail("cannot write %s: %s", to->path, strerror(why));
}

// Creates the temporary file; an existing one is left alone.
static enum status write_beside(const struct destination *to,
                                enum status (*write)(FILE *file, const void *what),
                                const void *what)
{
    FILE *file = fopen(to->beside, "wxe");
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
    if (status == DONE && rename(to->beside, to->target) != 0) status = cannot_write(to, errno);
    if (status != DONE) unlink(to->beside);
    return status;
}

enum status whole_file_write(const char *path, enum status (*write)(FILE *file, const void *what),
                             const void *what)
{
    char *real = realpath(path, NULL);
    char *beside = whole_file_beside(real ? real : path);
    const struct destination to = { path, real ? real : path, beside };
    interrupt_hold();
    enum status status = beside ? write_beside(&to, write, what) : cannot_write(&to, ENOMEM);
    interrupt_release();
    free(beside);
    free(real);
    return status;
}
