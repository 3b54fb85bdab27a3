// Whole-file reads and atomic writes (temporary file, then rename).
#include "core/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const uint64_t MAX_BYTES_DEFAULT = UINT64_C(4) << 30;
// TEMPORARY_SUFFIX bounds ".tmp-", a process id, a number and the terminating zero.
enum { TEMPORARY_TRIES = 1000, TEMPORARY_SUFFIX = 32 };

static bool fail_read(struct host *host, const char *path, const char *why)
{
    return host_fail(host, FAIL_FILE, "cannot read %s: %s", path, why);
}

static bool fail_write(struct host *host, const char *path, const char *why)
{
    return host_fail(host, FAIL_FILE, "cannot write %s: %s", path, why);
}

// Opens with O_NONBLOCK, so that a pipe without a writer is refused instead of blocking.
static bool open_regular(struct host *host, const char *path, uint64_t max_bytes, int *out_fd,
                         size_t *out_size)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return fail_read(host, path, strerror(errno));
    struct stat info;
    if (fstat(fd, &info) != 0) {
        fail_read(host, path, strerror(errno));
    } else if (!S_ISREG(info.st_mode)) {
        fail_read(host, path, S_ISDIR(info.st_mode) ? "it is a folder" : "not a regular file");
    } else if ((uint64_t)info.st_size > max_bytes) {
        host_fail(host, FAIL_FILE, "cannot read %s: %llu bytes are more than the %llu allowed",
                  path, (unsigned long long)info.st_size, (unsigned long long)max_bytes);
    } else {
        *out_fd = fd;
        *out_size = (size_t)info.st_size;
        return true;
    }
    close(fd);
    return false;
}

bool file_read(struct host *host, const char *path, size_t max_bytes, struct file_bytes *out)
{
    *out = (struct file_bytes){ 0 };
    int fd = -1;
    size_t size = 0, padded = 0;
    if (!open_regular(host, path, max_bytes ? max_bytes : MAX_BYTES_DEFAULT, &fd, &size))
        return false;
    if (!size_add(size, 1, &padded)) padded = SIZE_MAX; // host_alloc fails
    out->data = host_alloc(host, padded, 1);
    if (!out->data) goto fail;
    while (out->size < size) {
        ssize_t got = read(fd, out->data + out->size, size - out->size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            fail_read(host, path, strerror(errno));
            goto fail;
        }
        if (got == 0) break; // truncated while being read: keep the bytes read so far
        out->size += (size_t)got;
    }
    close(fd);
    return true;
fail:
    close(fd);
    file_bytes_finish(host, out);
    return false;
}

void file_bytes_finish(struct host *host, struct file_bytes *bytes)
{
    host_free(host, bytes->data);
    *bytes = (struct file_bytes){ 0 };
}

// Resolves symbolic links, which a rename would replace. Refuses an existing target that is not a
// regular file, so that writing to /dev/null does not replace the device.
static bool resolve_target(struct host *host, const char *path, char **out)
{
    struct stat info;
    bool exists = stat(path, &info) == 0;
    if (exists && !S_ISREG(info.st_mode))
        return fail_write(host, path,
                          S_ISDIR(info.st_mode) ? "it is a folder" : "not a regular file");
    bool is_link = exists && lstat(path, &info) == 0 && S_ISLNK(info.st_mode);
    char *real = is_link ? realpath(path, NULL) : NULL;
    *out = host_strdup(host, real ? real : path);
    free(real);
    return *out != NULL;
}

// Length of the prefix of `target` that temporary names share: all of it, unless the suffix would
// exceed NAME_MAX or PATH_MAX.
static int temporary_stem(const char *target)
{
    const char *slash = strrchr(target, '/');
    size_t folder = slash ? (size_t)(slash + 1 - target) : 0, length = strlen(target);
    size_t longest = folder + NAME_MAX - TEMPORARY_SUFFIX;
    if (longest > PATH_MAX - TEMPORARY_SUFFIX) longest = PATH_MAX - TEMPORARY_SUFFIX;
    if (length <= longest) return (int)length;
    return (int)(longest > folder ? longest : folder);
}

// As mkstemp, but with the file mode that the umask gives. Reading the umask would change it for
// all threads.
static int open_temporary(struct host *host, const char *target, char **out_path)
{
    for (int i = 0; i < TEMPORARY_TRIES; i++) {
        char *path = host_sprintf(host, "%.*s.tmp-%ld-%d", temporary_stem(target), target,
                                  (long)getpid(), i);
        if (!path) return -1;
        int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0) {
            *out_path = path;
            return fd;
        }
        int why = errno;
        host_free(host, path);
        if (why != EEXIST) {
            fail_write(host, target, why == ENOENT ? "no such folder" : strerror(why));
            return -1;
        }
    }
    fail_write(host, target, "too many temporary files beside it");
    return -1;
}

static void writer_release(struct file_writer *writer)
{
    host_free(writer->host, writer->path);
    host_free(writer->host, writer->temporary_path);
    *writer = (struct file_writer){ 0 };
}

bool file_begin(struct file_writer *writer, struct host *host, const char *path)
{
    *writer = (struct file_writer){ .host = host };
    int fd = -1;
    if (!resolve_target(host, path, &writer->path)) goto fail;
    fd = open_temporary(host, writer->path, &writer->temporary_path);
    if (fd < 0) goto fail;
    writer->stream = fdopen(fd, "wb");
    if (!writer->stream) {
        fail_write(host, path, strerror(errno));
        close(fd);
        goto fail;
    }
    return true;
fail:
    file_abort(writer);
    return false;
}

// The stream remembers that an earlier write failed, but not its errno.
static bool stream_close(FILE *stream, const char **why)
{
    bool failed_before = ferror(stream) != 0;
    bool closed = fclose(stream) == 0;
    *why = closed ? "a write failed" : strerror(errno);
    return closed && !failed_before;
}

bool file_commit(struct file_writer *writer)
{
    if (!writer->path) return false;
    const char *why = NULL;
    bool ok = stream_close(writer->stream, &why);
    writer->stream = NULL;
    if (ok && rename(writer->temporary_path, writer->path) != 0) {
        why = strerror(errno);
        ok = false;
    }
    if (ok) {
        writer_release(writer);
        return true;
    }
    fail_write(writer->host, writer->path, why);
    file_abort(writer);
    return false;
}

void file_abort(struct file_writer *writer)
{
    if (writer->stream) fclose(writer->stream);
    if (writer->temporary_path) unlink(writer->temporary_path);
    if (writer->host) writer_release(writer);
}

void file_extension(const char *path, char out[16])
{
    out[0] = 0;
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash ? slash : path, '.');
    if (!dot) return;
    size_t i = 0;
    for (; i < 15 && dot[1 + i]; i++) {
        char c = dot[1 + i];
        out[i] = c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
    }
    out[i] = 0;
}
