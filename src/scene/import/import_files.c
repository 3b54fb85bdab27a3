#include "scene/import/import_files.h"

#include "core/hash.h"

#include <string.h>
#include <unistd.h>

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
    file->missing = access(path, R_OK) != 0;
    if (!file->missing && !file_read(host, path, 0, &file->bytes)) return NULL;
    files->import->source_bytes += file->bytes.size;
    return file;
}
