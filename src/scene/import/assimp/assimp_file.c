// File access for Assimp: the imported file from memory, others from its folder only.
#include "scene/import/assimp/assimp.h"

#include <string.h>
#include <unistd.h>

struct open_file {
    struct import *import;
    struct file_bytes owned; // zero for the main file
    const uint8_t *data;
    size_t size, at;
};

static size_t file_read_proc(struct aiFile *file, char *out, size_t size, size_t count)
{
    struct open_file *open = (struct open_file *)file->UserData;
    size_t left = open->size - open->at;
    if (size == 0) return 0;
    if (count > left / size) count = left / size;
    memcpy(out, open->data + open->at, size * count);
    open->at += size * count;
    return count;
}

static size_t file_write_proc(struct aiFile *file, const char *data, size_t size, size_t count)
{
    (void)file;
    (void)data;
    (void)size;
    (void)count;
    return 0;
}

static size_t file_tell_proc(struct aiFile *file)
{
    return ((struct open_file *)file->UserData)->at;
}

static size_t file_size_proc(struct aiFile *file)
{
    return ((struct open_file *)file->UserData)->size;
}

static aiReturn file_seek_proc(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    struct open_file *open = (struct open_file *)file->UserData;
    size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? open->at : open->size;
    // Backwards from the end: Assimp's readers disagree about the sign of such offsets.
    if (origin == aiOrigin_END) {
        if (offset > open->size) return aiReturn_FAILURE;
        open->at = open->size - offset;
        return aiReturn_SUCCESS;
    }
    if (offset > open->size - base) return aiReturn_FAILURE;
    open->at = base + offset;
    return aiReturn_SUCCESS;
}

static void file_flush_proc(struct aiFile *file)
{
    (void)file;
}

// The part of a name after the folder of the imported file; NULL if it is not in that folder.
static const char *name_in_folder(const struct import *import, const char *name)
{
    const char *slash = strrchr(import->path, '/');
    size_t folder = slash ? (size_t)(slash - import->path) + 1 : 0;
    if (strncmp(name, import->path, folder) != 0) return NULL;
    name += folder;
    while (name[0] == '/') name++;
    return name;
}

static bool open_other(struct import *import, const char *name, struct open_file *open)
{
    const char *inside = name_in_folder(import, name);
    char *path = inside ? import_resolve_quietly(import, inside, false) : NULL;
    bool ok = path && access(path, R_OK) == 0 && file_read(import->host, path, 0, &open->owned);
    host_free(import->host, path);
    import->source_bytes += open->owned.size;
    open->data = open->owned.data;
    open->size = open->owned.size;
    return ok;
}

static struct aiFile *files_open_proc(struct aiFileIO *io, const char *name, const char *mode)
{
    struct assimp_files *files = (struct assimp_files *)io->UserData;
    struct host *host = files->import->host;
    if (strpbrk(mode, "wa+")) return NULL;
    struct aiFile *file = host_alloc(host, 1, sizeof *file);
    struct open_file *open = host_alloc(host, 1, sizeof *open);
    if (!file || !open) goto fail;
    open->import = files->import;
    open->data = files->main->data;
    open->size = files->main->size;
    if (strcmp(name, files->import->path) != 0 && !open_other(files->import, name, open)) goto fail;
    *file = (struct aiFile){
        .ReadProc = file_read_proc,
        .WriteProc = file_write_proc,
        .TellProc = file_tell_proc,
        .FileSizeProc = file_size_proc,
        .SeekProc = file_seek_proc,
        .FlushProc = file_flush_proc,
        .UserData = (char *)open,
    };
    return file;
fail:
    host_free(host, file);
    host_free(host, open);
    return NULL;
}

static void files_close_proc(struct aiFileIO *io, struct aiFile *file)
{
    struct host *host = ((struct assimp_files *)io->UserData)->import->host;
    if (!file) return;
    struct open_file *open = (struct open_file *)file->UserData;
    file_bytes_finish(host, &open->owned);
    host_free(host, open);
    host_free(host, file);
}

struct aiFileIO assimp_file_io(struct assimp_files *files)
{
    return (struct aiFileIO){
        .OpenProc = files_open_proc,
        .CloseProc = files_close_proc,
        .UserData = (char *)files,
    };
}
