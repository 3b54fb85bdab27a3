// afterglow cache: lists and removes cached references and bakes.
#include "cli/cache/cache.h"
#include "commands.h"
#include "cli/files/json.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

struct listing {
    char root[PATH_SIZE];
    struct cache_entry *entries;
    int count;
    long long bytes;
};

// Local time for people, UTC for programs.
static void print_time(long long seconds, bool utc, char out[32])
{
    const time_t when = (time_t)seconds;
    struct tm parts;
    out[0] = 0;
    if (utc ? gmtime_r(&when, &parts) : localtime_r(&when, &parts))
        strftime(out, 32, utc ? "%Y-%m-%dT%H:%M:%SZ" : "%Y-%m-%d %H:%M", &parts);
}

static json_t *listing_json(const struct listing *l)
{
    json_t *files = json_array();
    for (int i = 0; i < l->count; i++) {
        const struct cache_entry *entry = &l->entries[i];
        char used[32];
        print_time(entry->used_s, true, used);
        json_array_append_new(files,
                              json_pack("{s:s, s:o, s:I, s:s}", "kind", cache_entry_kind(entry),
                                        "path", json_text(entry->path), "bytes",
                                        (json_int_t)entry->bytes, "used", used));
    }
    return json_pack("{s:o, s:I, s:I, s:o}", "folder", json_text(l->root), "bytes",
                     (json_int_t)l->bytes, "limit_bytes", (json_int_t)cache_limit(), "files",
                     files);
}

static void print_listing(const struct listing *l)
{
    for (int i = 0; i < l->count; i++) {
        const struct cache_entry *entry = &l->entries[i];
        char used[32];
        print_time(entry->used_s, false, used);
        printf("%-10s %9.1f MB  %s  %s\n", cache_entry_kind(entry), (double)entry->bytes * 1e-6,
               used, strrchr(entry->path, '/') + 1);
    }
    printf("%d files, %.1f MB of at most %.0f MB in %s\n", l->count, (double)l->bytes * 1e-6,
           (double)cache_limit() * 1e-6, printable(l->root).s);
}

static enum status clear(struct listing *l)
{
    int removed = 0;
    for (int i = 0; i < l->count; i++) {
        if (!cache_remove(&l->entries[i]))
            return fail("cannot remove %s: it may belong to another user", l->entries[i].path);
        removed++;
    }
    note("removed %d files, %.1f MB, from %s", removed, (double)l->bytes * 1e-6, l->root);
    l->count = 0;
    l->bytes = 0;
    return DONE;
}

static enum status cache(const struct arguments *a)
{
    struct listing l = { .count = 0 };
    if (!cache_root(l.root, sizeof l.root))
        return fail("cannot find the cache: neither AFTERGLOW_CACHE, XDG_CACHE_HOME nor HOME names "
                    "a folder");
    l.count = cache_list(l.root, &l.entries);
    if (l.count < 0) return fail("cannot list %s: out of memory", l.root);
    for (int i = 0; i < l.count; i++) l.bytes += l.entries[i].bytes;
    enum status status = a->clear ? clear(&l) : DONE;
    if (status == DONE && a->json)
        status = json_print(listing_json(&l));
    else if (status == DONE && !a->clear)
        print_listing(&l);
    free(l.entries);
    return status;
}

const struct command command_cache = {
    .name = "cache",
    .bit = CACHE,
    .positional_count = 0,
    .usage = "[options]",
    .summary = "list or remove cached references and bakes",
    .text = "Lists the files that compare, render and bake keep between runs, the least\n"
            "recently used first. Beyond the size limit these are removed by themselves.\n",
    .examples = "  afterglow cache\n"
                "      kind, size, last use and name of each file\n"
                "  afterglow cache --clear\n"
                "      remove them; later runs compute them again\n",
    .run = cache,
};
