#include "scene/import/import_files.h"

#include "core/hash.h"
#include "core/files/links.h"

#include <string.h>
#include <unistd.h>

// From the callback of a scene in memory.
static bool read_memory(struct import *import, const char *path, struct file_bytes *out,
                        bool *missing)
{
    const struct import_bytes *memory = import->memory;
    const void *data = NULL;
    size_t size = 0;
    *missing = !memory->read || !memory->read(memory->user, path, &data, &size) || !data;
    return *missing || file_bytes_copy(import->host, data, size, out);
}

static bool is_from_memory(const struct import *import)
{
    return import->memory && (import->memory->read || !import->memory->folder);
}

bool import_fail_link(struct import *import, const char *path)
{
    const char *slash = strrchr(import->path, '/');
    const size_t folder = slash ? (size_t)(slash - import->path) + 1 : 0;
    if (strncmp(path, import->path, folder) == 0) path += folder;
    return host_fail(import->host, FAIL_FILE,
                     "%s: refers to %s, which a symbolic link leads out of the scene's folder; "
                     "follow_links (--follow-links) allows it",
                     import->path, import_printable(path).s);
}

bool import_read(struct import *import, const char *path, struct file_bytes *out, bool *missing)
{
    bool absent = false;
    *out = (struct file_bytes){ 0 };
    if (is_from_memory(import)) {
        if (!read_memory(import, path, out, &absent)) return false;
    } else {
        absent = missing && access(path, R_OK) != 0;
        if (!import->host->follow_links && link_leads_out(path, import->path))
            return import_fail_link(import, path);
        if (!absent && !file_read(import->host, path, 0, out)) return false;
    }
    import->source_bytes += out->size;
    if (missing) *missing = absent;
    if (!absent || missing) return true;
    return host_fail(
        import->host, FAIL_FILE, "%s: refers to %s: %s", import->path, import_printable(path).s,
        import->memory->read ? "there is no such file" : "it has neither a folder nor a callback");
}

bool import_files_init(struct import_files *files, struct import *import, size_t count)
{
    *files = (struct import_files){ .import = import, .size = 2 };
    while (files->size < 2 * count) files->size *= 2;
    files->slots = host_alloc(import->host, files->size, sizeof *files->slots);
    return files->slots != NULL;
}

void import_files_finish(struct import_files *files)
{
    for (size_t i = 0; files->slots && i < files->size; i++) {
        host_free(files->import->host, files->slots[i].path);
        file_bytes_finish(files->import->host, &files->slots[i].bytes);
    }
    if (files->slots) host_free(files->import->host, files->slots);
    *files = (struct import_files){ 0 };
}

const struct import_file *import_files_read(struct import_files *files, char *path)
{
    struct host *host = files->import->host;
    size_t at = (size_t)hash_bytes(path, strlen(path), 0) & (files->size - 1);
    struct import_file *file = &files->slots[at];
    while (file->path && strcmp(file->path, path) != 0) {
        at = (at + 1) & (files->size - 1);
        file = &files->slots[at];
    }
    if (file->path) {
        host_free(host, path);
        return file;
    }
    file->path = path;
    return import_read(files->import, path, &file->bytes, &file->missing) ? file : NULL;
}
