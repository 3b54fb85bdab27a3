#include "recent.h"

#include "cache.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool file_of(char out[PATH_SIZE])
{
    char root[PATH_SIZE];
    if (!cache_root(root, sizeof root)) return false;
    const int wrote = snprintf(out, PATH_SIZE, "%s/recent.txt", root);
    return wrote > 0 && wrote < PATH_SIZE;
}

static void append(struct recent *recent, const char *path)
{
    for (int i = 0; i < recent->count; i++)
        if (strcmp(recent->paths[i], path) == 0) return;
    if (path[0] && recent->count < RECENT_SCENES)
        snprintf(recent->paths[recent->count++], PATH_SIZE, "%s", path);
}

void recent_read(struct recent *recent)
{
    char path[PATH_SIZE], line[PATH_SIZE];
    recent->count = 0;
    FILE *file = file_of(path) ? fopen(path, "r") : NULL;
    if (!file) return;
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = 0;
        append(recent, line);
    }
    fclose(file);
}

static enum status write_paths(FILE *file, const void *what)
{
    const struct recent *recent = what;
    for (int i = 0; i < recent->count; i++) fprintf(file, "%s\n", recent->paths[i]);
    return DONE;
}

void recent_add(const char *path)
{
    char file[PATH_SIZE], why[PATH_SIZE];
    struct recent *recents = calloc(2, sizeof *recents);
    if (!recents || !cache_folder(CACHE_BAKE, file, NULL) || !file_of(file) || strchr(path, '\n')) {
        free(recents);
        return;
    }
    char *full = path[0] != '@' ? realpath(path, NULL) : NULL;
    append(&recents[0], full ? full : path);
    free(full);
    recent_read(&recents[1]);
    for (int i = 0; i < recents[1].count; i++) append(&recents[0], recents[1].paths[i]);
    messages_keep(why, sizeof why); // a list that cannot be kept is no error
    whole_file_write(file, write_paths, &recents[0]);
    messages_keep(NULL, 0);
    free(recents);
}
