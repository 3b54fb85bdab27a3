// Bakes of a renderer, in the cache that `afterglow` uses too.
#include "bakes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = 4096 };

// The folder of bakes in the cache, which need not exist; see docs/cli.md.
static bool find_folder(char out[PATH_SIZE])
{
    const char *own = getenv("AFTERGLOW_CACHE"), *xdg = getenv("XDG_CACHE_HOME"),
               *home = getenv("HOME");
    int wrote = 0;
    if (own && own[0])
        wrote = snprintf(out, PATH_SIZE, "%s/bakes", own);
    else if (xdg && xdg[0] == '/')
        wrote = snprintf(out, PATH_SIZE, "%s/afterglow/bakes", xdg);
    else if (home && home[0] == '/')
        wrote = snprintf(out, PATH_SIZE, "%s/.cache/afterglow/bakes", home);
    return wrote > 0 && wrote < PATH_SIZE;
}

// Each folder of a path, without its last part.
static void make_folders(const char *path)
{
    char folder[PATH_SIZE];
    for (const char *at = strchr(path + 1, '/'); at; at = strchr(at + 1, '/')) {
        snprintf(folder, sizeof folder, "%.*s", (int)(at - path), path);
        mkdir(folder, 0777); // writing the file reports an error
    }
}

static bool find_path(const struct ag_bake *bake, int index, char out[PATH_SIZE])
{
    char folder[PATH_SIZE];
    struct ag_bake_part part;
    if (!find_folder(folder) || ag_bake_get_part(bake, index, &part) != AG_OK) return false;
    const int wrote = snprintf(out, PATH_SIZE, "%s/%s.safetensors", folder, part.key);
    return wrote > 0 && wrote < PATH_SIZE;
}

static void load_parts(struct ag_bake *bake, int count)
{
    char path[PATH_SIZE];
    for (int i = 0; i < count; i++)
        if (find_path(bake, i, path) && access(path, R_OK) == 0) ag_bake_load_part(bake, i, path);
}

static void save_parts(struct ag_bake *bake, int count)
{
    for (int i = 0; i < count; i++) {
        struct ag_bake_part part;
        char path[PATH_SIZE];
        if (!find_path(bake, i, path) || ag_bake_get_part(bake, i, &part) != AG_OK || part.loaded)
            continue;
        make_folders(path);
        ag_bake_save_part(bake, i, path, true);
    }
}

// A cache that cannot be used costs time; it is not an error.
static enum ag_result complete(struct ag_bake *bake, bool *run)
{
    struct ag_bake_info info;
    ag_bake_get_info(bake, &info);
    load_parts(bake, info.part_count);
    ag_bake_get_info(bake, &info);
    if (info.complete) return AG_OK;
    fprintf(stderr, "baking %s:%s …\n", info.technique, info.options);
    *run = true;
    const enum ag_result result = ag_bake_run(bake, NULL, NULL);
    if (result == AG_OK) save_parts(bake, info.part_count);
    return result;
}

enum ag_result bench_bakes_prepare(struct bench_bakes *bakes, struct ag_context *context,
                                   struct ag_scene *scene, const char *gi)
{
    *bakes = (struct bench_bakes){ .count = 0 };
    for (int i = 0; i < BENCH_MAX_BAKES; i++) {
        struct ag_bake_desc desc;
        ag_bake_desc_default(&desc);
        enum ag_result result = ag_bake_technique(context, gi, i, &desc.technique);
        if (result != AG_OK || !desc.technique) return result;
        result = ag_bake_create(scene, gi, &desc, &bakes->owned[i]);
        if (result != AG_OK) return result;
        bakes->bakes[bakes->count++] = bakes->owned[i];
        result = complete(bakes->owned[i], &bakes->run);
        if (result != AG_OK) return result;
    }
    return AG_OK;
}

void bench_bakes_finish(struct bench_bakes *bakes)
{
    for (int i = 0; i < bakes->count; i++) ag_bake_destroy(bakes->owned[i]);
    *bakes = (struct bench_bakes){ .count = 0 };
}
