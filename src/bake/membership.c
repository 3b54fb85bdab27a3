// The identities of ranks, compared.
#include "bake/membership.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ROWS = BAKE_MAX_METADATA + 1, NUMBER = 32 };

struct rows {
    struct identity_text text;
    char tasks[NUMBER];
    struct tensor_metadata at[ROWS];
    size_t count;
};

static void list_rows(const struct bake *bake, struct rows *out)
{
    uint64_t tasks = 0;
    for (int s = 0; s < bake->plan.stage_count; s++) tasks += bake->plan.stages[s].what.task_count;
    identity_print(bake, IDENTITY_BAKE, (double)NAN, &out->text);
    out->count = out->text.count;
    memcpy(out->at, out->text.metadata, out->count * sizeof out->at[0]);
    snprintf(out->tasks, sizeof out->tasks, "%" PRIu64, tasks);
    out->at[out->count++] = (struct tensor_metadata){ "tasks", out->tasks };
}

char *membership_print(struct host *host, const struct bake *bake, size_t *size)
{
    struct rows rows;
    list_rows(bake, &rows);
    *size = 0;
    for (size_t i = 0; i < rows.count; i++)
        *size += strlen(rows.at[i].key) + strlen(rows.at[i].value) + 2;
    char *text = host_alloc(host, *size, 1), *at = text;
    for (size_t i = 0; text && i < rows.count; i++) {
        at = stpcpy(at, rows.at[i].key) + 1;
        at = stpcpy(at, rows.at[i].value) + 1;
    }
    return text;
}

// The name by which users know it.
static const char *name_of(const char *key, bool of_light)
{
    static const char *const names[][2] = {
        { "afterglow.program", "version of the program" },
        { "afterglow.bake_version", "version of the bake" },
        { "afterglow.technique", "technique" },
        { "afterglow.seed", "--seed" },
        { "tasks", "number of tasks" },
    };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(names[i][0], key) == 0) return names[i][1];
    return of_light ? "scene or light" : "scene";
}

static void describe(const struct bake *bake, int rank, const char *key, const char *theirs,
                     const char *ours, char *out, size_t size)
{
    char options[600];
    if (strcmp(key, "afterglow.options") == 0) {
        option_differences(theirs, ours, options, sizeof options);
        snprintf(out, size, "rank %d has other options: %s", rank, options);
    } else if (strcmp(key, "afterglow.scene") == 0) {
        snprintf(out, size, "rank %d has another %s: the content of its file differs", rank,
                 name_of(key, bake->identity.of_light));
    } else {
        snprintf(out, size, "rank %d has another %s: %.100s, not %.100s", rank, name_of(key, false),
                 theirs, ours);
    }
}

// The text after this one; NULL: none ends within the bytes.
static const char *next_text(const char *at, const char *end)
{
    const char *zero = at < end ? memchr(at, 0, (size_t)(end - at)) : NULL;
    return zero ? zero + 1 : NULL;
}

static const char *value_in(const char *text, const char *end, const char *key)
{
    for (const char *at = text; at;) {
        const char *value = next_text(at, end);
        const char *next = value ? next_text(value, end) : NULL;
        if (!next) return NULL;
        if (strcmp(at, key) == 0) return value;
        at = next;
    }
    return NULL;
}

bool membership_difference(const struct bake *bake, int rank, const char *text, size_t size,
                           char *out, size_t out_size)
{
    struct rows rows;
    list_rows(bake, &rows);
    for (size_t i = 0; i < rows.count; i++) {
        const char *theirs = value_in(text, text + size, rows.at[i].key);
        if (theirs && strcmp(theirs, rows.at[i].value) == 0) continue;
        describe(bake, rank, rows.at[i].key, theirs ? theirs : "none", rows.at[i].value, out,
                 out_size);
        return true;
    }
    return false;
}
