// File access for Assimp: the imported file, and others of its folder and below.
#include "importer/importer.h"

#include "core/files/links.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *main_path;
static struct files_options options;

struct open_file {
    struct aiFile file; // first: Assimp's handle
    uint8_t *data;
    size_t size, at;
};

static size_t read_proc(struct aiFile *file, char *out, size_t size, size_t count)
{
    struct open_file *open = (struct open_file *)file;
    if (size == 0) return 0;
    if (count > (open->size - open->at) / size) count = (open->size - open->at) / size;
    memcpy(out, open->data + open->at, size * count);
    open->at += size * count;
    return count;
}

static size_t write_proc(struct aiFile *file, const char *data, size_t size, size_t count)
{
    (void)file;
    (void)data;
    (void)size;
    (void)count;
    return 0;
}

static size_t tell_proc(struct aiFile *file)
{
    return ((struct open_file *)file)->at;
}

static size_t size_proc(struct aiFile *file)
{
    return ((struct open_file *)file)->size;
}

// Backwards from the end: Assimp's readers disagree about the sign of such offsets.
static aiReturn seek_proc(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    struct open_file *open = (struct open_file *)file;
    size_t base = origin == aiOrigin_CUR ? open->at : 0;
    if (offset > open->size - base) return aiReturn_FAILURE;
    open->at = origin == aiOrigin_END ? open->size - offset : base + offset;
    return aiReturn_SUCCESS;
}

static void flush_proc(struct aiFile *file)
{
    (void)file;
}

// Length of the folder of the imported file, with its slash.
static size_t folder_length(void)
{
    const char *slash = strrchr(main_path, '/');
    return slash ? (size_t)(slash - main_path) + 1 : 0;
}

// Absolute paths, drives and ".." are refused.
static bool is_inside(const char *relative)
{
    while (*relative) {
        size_t n = strcspn(relative, "/");
        if (n == 0 || memchr(relative, ':', n)) return false;
        if (n == 2 && relative[0] == '.' && relative[1] == '.') return false;
        relative += n + (relative[n] == '/');
    }
    return true;
}

// The path to open, owned by the caller; NULL for a file that is not in the folder.
static char *path_of(const char *name)
{
    size_t folder = folder_length();
    if (strcmp(name, main_path) == 0) return strdup(name);
    if (options.from_input && folder == 0) return NULL; // a file in memory, without a folder
    if (strncmp(name, main_path, folder) != 0) return NULL;
    char *path = strdup(name);
    for (char *c = path ? path + folder : NULL; c && *c; c++)
        if (*c == '\\') *c = '/';
    if (path && path[folder] && is_inside(path + folder)) return path;
    free(path);
    return NULL;
}

// The imported file itself may be a link to anywhere.
static bool is_allowed(const char *path)
{
    return options.follow_links || strcmp(path, main_path) == 0 || !link_leads_out(path, main_path);
}

// O_NONBLOCK: a pipe is refused instead of waiting for a writer.
static int open_path(const char *path)
{
    if (options.from_input && strcmp(path, main_path) == 0) return dup(STDIN_FILENO);
    return open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
}

static bool read_file(const char *path, struct open_file *open_file)
{
    struct stat info;
    int fd = open_path(path);
    if (fd < 0) return false;
    bool ok = fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_size >= 0;
    size_t size = ok ? (size_t)info.st_size : 0;
    open_file->data = ok ? malloc(size + 1) : NULL;
    while (open_file->data && open_file->size < size) {
        ssize_t got = pread(fd, open_file->data + open_file->size, size - open_file->size,
                            (off_t)open_file->size);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        open_file->size += (size_t)got;
    }
    close(fd);
    return open_file->data != NULL;
}

static struct aiFile *open_proc(struct aiFileIO *io, const char *name, const char *mode)
{
    (void)io;
    char *path = strpbrk(mode, "wa+") ? NULL : path_of(name);
    if (path && !is_allowed(path)) output_fail("link", "%s", path);
    struct open_file *open = path ? calloc(1, sizeof *open) : NULL;
    bool ok = open && read_file(path, open);
    free(path);
    if (!ok) {
        free(open);
        return NULL;
    }
    open->file = (struct aiFile){ .ReadProc = read_proc,
                                  .WriteProc = write_proc,
                                  .TellProc = tell_proc,
                                  .FileSizeProc = size_proc,
                                  .SeekProc = seek_proc,
                                  .FlushProc = flush_proc };
    return &open->file;
}

static void close_proc(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    if (file) free(((struct open_file *)file)->data);
    free(file);
}

struct aiFileIO files_of(const char *path, const struct files_options *how)
{
    main_path = path;
    options = *how;
    return (struct aiFileIO){ .OpenProc = open_proc, .CloseProc = close_proc };
}

const char *files_extension(const char *path)
{
    static char extension[8];
    const char *dot = strrchr(path, '.');
    size_t n = 0;
    for (; dot && dot[1 + n] && n + 1 < sizeof extension; n++)
        extension[n] = (char)tolower((unsigned char)dot[1 + n]);
    extension[n] = 0;
    return extension;
}
