// Reads into memory and atomic writes (temporary file, then rename).
#include "core/files/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const uint64_t MAX_BYTES_DEFAULT = UINT64_C(4) << 30;

static bool fail_read(struct host *host, const char *path, const char *why)
{
    return host_fail(host, FAIL_FILE, "cannot read %s: %s", path, why);
}

static bool fail_write(struct host *host, const char *path, const char *why)
{
    return host_fail(host, FAIL_FILE, "cannot write %s: %s", path, why);
}

static bool links_are_followed(const struct host *host, const char *path)
{
    const size_t length = host->no_links_in ? strlen(host->no_links_in) : 0;
    return length == 0 || strncmp(path, host->no_links_in, length) != 0 ||
           (host->no_links_in[length - 1] != '/' && path[length] != '/');
}

// Opens with O_NONBLOCK, so that a pipe without a writer is refused instead of blocking.
static bool open_regular(struct host *host, const char *path, uint64_t max_bytes, int *out_fd,
                         size_t *out_size)
{
    const bool follow = links_are_followed(host, path);
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | (follow ? 0 : O_NOFOLLOW));
    if (fd < 0 && errno == ELOOP && !follow) return fail_read(host, path, "it is a symbolic link");
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

// Reads the first bytes and closes the file.
static bool read_first(struct host *host, const char *path, int fd, size_t size,
                       struct file_bytes *out)
{
    size_t padded = 0;
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

bool file_read(struct host *host, const char *path, size_t max_bytes, struct file_bytes *out)
{
    int fd = -1;
    size_t size = 0;
    *out = (struct file_bytes){ 0 };
    return open_regular(host, path, max_bytes ? max_bytes : MAX_BYTES_DEFAULT, &fd, &size) &&
           read_first(host, path, fd, size, out);
}

bool file_read_start(struct host *host, const char *path, size_t bytes, struct file_bytes *out)
{
    int fd = -1;
    size_t size = 0;
    *out = (struct file_bytes){ 0 };
    return open_regular(host, path, UINT64_MAX, &fd, &size) &&
           read_first(host, path, fd, size < bytes ? size : bytes, out);
}

bool file_bytes_copy(struct host *host, const void *data, size_t size, struct file_bytes *out)
{
    *out = (struct file_bytes){ 0 };
    if (size > MAX_BYTES_DEFAULT)
        return host_fail(host, FAIL_MEMORY, "%zu bytes in memory: the largest file has %zu", size,
                         MAX_BYTES_DEFAULT);
    out->data = host_alloc(host, size + 1, 1);
    if (!out->data) return false;
    if (size > 0) memcpy(out->data, data, size);
    out->size = size;
    return true;
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
    const bool follow = links_are_followed(host, path);
    const bool exists = (follow ? stat(path, &info) : lstat(path, &info)) == 0;
    if (exists && !S_ISREG(info.st_mode) && !S_ISLNK(info.st_mode))
        return fail_write(host, path,
                          S_ISDIR(info.st_mode) ? "it is a folder" : "not a regular file");
    bool is_link = follow && exists && lstat(path, &info) == 0 && S_ISLNK(info.st_mode);
    char *real = is_link ? realpath(path, NULL) : NULL;
    *out = host_strdup(host, real ? real : path);
    free(real);
    return *out != NULL;
}

static void writer_release(struct file_writer *writer)
{
    temporary_release(&writer->temporary);
    host_free(writer->host, writer->display_path);
    host_free(writer->host, writer->path);
    *writer = (struct file_writer){ 0 };
}

static void warn_of_stale(void *user, const char *path)
{
    const struct file_writer *writer = user;
    host_log(writer->host, LOG_WARNING, "%s: removed %s, left by an interrupted write",
             writer->display_path, path);
}

// The lock outlives the stream: a second descriptor holds it.
static bool open_stream(struct file_writer *writer)
{
    const int fd = fcntl(writer->temporary.lock, F_DUPFD_CLOEXEC, 0);
    writer->stream = fd >= 0 ? fdopen(fd, "wb") : NULL;
    if (writer->stream) return true;
    fail_write(writer->host, writer->display_path, strerror(errno));
    if (fd >= 0) close(fd);
    return false;
}

bool file_begin(struct file_writer *writer, struct host *host, const char *path)
{
    *writer = (struct file_writer){ .host = host };
    if (!resolve_target(host, path, &writer->path)) goto fail;
    writer->display_path = host_strdup(host, path);
    if (!writer->display_path) goto fail;
    temporary_remove_stale(writer->path, warn_of_stale, writer);
    if (!temporary_file(&writer->temporary, writer->path)) {
        fail_write(host, path, errno == ENOENT ? "no such folder" : strerror(errno));
        goto fail;
    }
    if (!open_stream(writer)) goto fail;
    return true;
fail:
    file_abort(writer);
    return false;
}

bool file_write(struct file_writer *writer, const void *data, size_t bytes)
{
    if (writer->why == 0 && fwrite(data, 1, bytes, writer->stream) != bytes)
        writer->why = errno ? errno : EIO;
    return writer->why == 0;
}

// 0, or errno. After a failed write outside file_write the stream knows that, but not its errno.
static int stream_close(struct file_writer *writer)
{
    int why = writer->why;
    if (why == 0 && ferror(writer->stream)) why = EIO;
    if (fclose(writer->stream) != 0 && (why == 0 || why == EIO)) why = errno;
    writer->stream = NULL;
    return why;
}

bool file_commit(struct file_writer *writer)
{
    if (!writer->path) return false;
    int why = stream_close(writer);
    if (why == 0 && rename(writer->temporary.path, writer->path) != 0) why = errno;
    if (why == 0) {
        writer_release(writer);
        return true;
    }
    fail_write(writer->host, writer->display_path, strerror(why));
    file_abort(writer);
    return false;
}

void file_abort(struct file_writer *writer)
{
    if (writer->stream) fclose(writer->stream);
    if (writer->temporary.path[0]) unlink(writer->temporary.path);
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
