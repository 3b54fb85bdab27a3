// afterglow cache: lists and removes cached references and bakes.
#include "cli/cache/cache.h"
#include "cli/cache/cache_content.h"
#include "commands.h"
#include "cli/files/json.h"
#include "session.h"

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
    struct ag_context *context;
    bool verbose;
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

// "3 h": since the last use, in the largest unit of which there is at least one.
static void print_age(long long used_s, char out[32])
{
    static const struct {
        long long seconds;
        const char *name;
    } units[] = { { 86400, "d" }, { 3600, "h" }, { 60, "min" }, { 1, "s" } };
    const long long age = (long long)time(NULL) - used_s;
    snprintf(out, 32, "now");
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        if (age < units[i].seconds) continue;
        snprintf(out, 32, "%lld %s", age / units[i].seconds, units[i].name);
        return;
    }
}

static json_t *text_or_null(const char *text)
{
    return text[0] ? json_text(text) : json_null();
}

static json_t *listing_json(const struct listing *l)
{
    json_t *files = json_array();
    for (int i = 0; i < l->count; i++) {
        const struct cache_entry *entry = &l->entries[i];
        struct cache_content content;
        char used[32];
        cache_describe(l->context, entry, &content);
        print_time(entry->used_s, true, used);
        json_array_append_new(
            files,
            json_pack("{s:s, s:o, s:I, s:s, s:o, s:o, s:o}", "kind", cache_entry_kind(entry),
                      "path", json_text(entry->path), "bytes", (json_int_t)entry->bytes, "used",
                      used, "scene", text_or_null(content.scene), "technique",
                      text_or_null(content.technique), "options", text_or_null(content.options)));
    }
    return json_pack("{s:o, s:I, s:I, s:o}", "folder", json_text(l->root), "bytes",
                     (json_int_t)l->bytes, "limit_bytes", (json_int_t)cache_limit(), "files",
                     files);
}

// "radiosity:texels=2048", or the view of a reference.
static void print_technique(const struct cache_content *content)
{
    char options[CACHE_TEXT];
    if (strcmp(content->technique, CACHE_PATH_TRACING) == 0) {
        printf("%s", printable(content->options).s);
        return;
    }
    cache_set_options(content, options);
    printf("%s%s", printable(content->technique).s, options[0] ? ":" : "");
    printf("%s", printable(options).s);
}

static void print_entry(const struct listing *l, const struct cache_entry *entry)
{
    struct cache_content content;
    char age[32], used[32];
    cache_describe(l->context, entry, &content);
    print_age(entry->used_s, age);
    printf("%-10s %9.1f MB %8s  %-24s  ", cache_entry_kind(entry), (double)entry->bytes * 1e-6, age,
           content.scene[0] ? printable(content.scene).s : "?");
    print_technique(&content);
    printf("\n");
    if (!l->verbose) return;
    print_time(entry->used_s, false, used);
    printf("%24s%s  %s\n", "", used, strrchr(entry->path, '/') + 1);
    if (content.options[0]) printf("%24s%s\n", "", printable(content.options).s);
}

static void print_listing(const struct listing *l)
{
    if (l->count > 0)
        printf("%-10s %12s %8s  %-24s  %s\n", "kind", "size", "used", "scene",
               "technique, or view");
    for (int i = 0; i < l->count; i++) print_entry(l, &l->entries[i]);
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

static enum status list(struct session *session, struct listing *l)
{
    const enum status status = session_begin(session, session->arguments);
    if (status != DONE) return status;
    l->context = session->context;
    l->verbose = session->arguments->verbose;
    if (session->arguments->json) return json_print(listing_json(l));
    print_listing(l);
    return DONE;
}

static enum status cache(const struct arguments *a)
{
    struct listing l = { .count = 0 };
    struct session session = { .arguments = a };
    if (!cache_root(l.root, sizeof l.root))
        return fail("cannot find the cache: neither AFTERGLOW_CACHE, XDG_CACHE_HOME nor HOME names "
                    "a folder");
    l.count = cache_list(l.root, &l.entries);
    if (l.count < 0) return fail("cannot list %s: out of memory", l.root);
    for (int i = 0; i < l.count; i++) l.bytes += l.entries[i].bytes;
    enum status status = a->clear ? clear(&l) : DONE;
    if (status == DONE && (a->json || !a->clear)) status = list(&session, &l);
    session_end(&session);
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
                "      scene, technique, options, size and last use of each file\n"
                "  afterglow cache --verbose\n"
                "      also its name, and all options\n"
                "  afterglow cache --clear\n"
                "      remove them; later runs compute them again\n",
    .run = cache,
};
