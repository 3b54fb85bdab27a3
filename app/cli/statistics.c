// Medians and percentiles of pass times, as JSON.
#include "statistics.h"
#include "cli/bake/baking.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_OWNERS = 128, GI_SIZE = 4096 };

// ---- samples

static struct pass_times *times_of(struct statistics *statistics, const char *name)
{
    for (int i = 0; i < statistics->pass_count; i++)
        if (strcmp(statistics->passes[i].name, name) == 0) return &statistics->passes[i];
    if (statistics->pass_count == MAX_PASSES) return NULL;
    struct pass_times *times = &statistics->passes[statistics->pass_count++];
    snprintf(times->name, sizeof times->name, "%.*s", (int)sizeof times->name - 1, name);
    return times;
}

static bool times_push(struct pass_times *times, double ms)
{
    if (times->count == times->capacity) {
        int capacity = times->capacity ? 2 * times->capacity : 16;
        double *grown = realloc(times->ms, (size_t)capacity * sizeof *grown);
        if (!grown) return false;
        times->ms = grown;
        times->capacity = capacity;
    }
    times->ms[times->count++] = ms;
    return true;
}

bool statistics_add(struct statistics *statistics, struct ag_renderer *renderer)
{
    struct ag_timing timings[MAX_PASSES];
    int count = ag_renderer_timings(renderer, timings, MAX_PASSES);
    for (int i = 0; i < count && i < MAX_PASSES; i++) {
        struct pass_times *times = times_of(statistics, timings[i].name);
        if (times && !times_push(times, timings[i].ms)) return false;
    }
    statistics->frames++;
    return true;
}

void statistics_finish(struct statistics *statistics)
{
    for (int i = 0; i < statistics->pass_count; i++) free(statistics->passes[i].ms);
    *statistics = (struct statistics){ 0 };
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

json_t *statistics_summary(struct pass_times *times)
{
    int n = times ? times->count : 0;
    if (n == 0) return json_pack("{s:n, s:n}", "median", "p95");
    qsort(times->ms, (size_t)n, sizeof *times->ms, compare);
    double median = 0.5 * (times->ms[(n - 1) / 2] + times->ms[n / 2]);
    int rank = (95 * n + 99) / 100; // nearest rank, from 1
    return json_pack("{s:f, s:f}", "median", median, "p95", times->ms[rank - 1]);
}

// ---- options, from the GI spec with all options: "lpv:steps=8,dim=32+vo:…"

static bool option_info(const char *technique, const char *option, struct ag_option_info *out)
{
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++) {
        if (strcmp(info.name, technique) != 0) continue;
        for (int k = 0; ag_technique_option_get(i, k, out); k++)
            if (strcmp(out->name, option) == 0) return true;
    }
    return false;
}

static json_t *option_value(const char *technique, const char *option, const char *text)
{
    struct ag_option_info info;
    if (!option_info(technique, option, &info) || strcmp(info.type, "choice") == 0 ||
        strcmp(info.type, "text") == 0)
        return json_string(text);
    if (strcmp(info.type, "bool") == 0) return json_boolean(strcmp(text, "true") == 0);
    if (strcmp(info.type, "int") == 0) return json_integer(strtol(text, NULL, 10));
    return json_real(strtod(text, NULL));
}

// Options of one technique: "key=value,key=value".
static json_t *options_of(const char *technique, char *list)
{
    json_t *object = json_object();
    for (char *item; object && list && (item = strsep(&list, ","));) {
        char *equals = strchr(item, '=');
        if (!equals) continue;
        *equals = 0;
        json_object_set_new(object, item, option_value(technique, item, equals + 1));
    }
    return object;
}

// The next term of a GI spec. A plus before a digit belongs to a number (1e+05).
static char *next_term(char **rest)
{
    char *term = *rest, *c = term;
    while (c && *c && !(*c == '+' && !(c[1] >= '0' && c[1] <= '9'))) c++;
    if (!term) return NULL;
    *rest = *c ? c + 1 : NULL;
    *c = 0;
    return term;
}

json_t *statistics_options(const struct ag_renderer *renderer)
{
    const char *gi = ag_renderer_gi(renderer);
    char text[GI_SIZE];
    json_t *object = json_object();
    if (!object || snprintf(text, sizeof text, "%s", gi) >= (int)sizeof text) return object;
    char *rest = text;
    for (char *term; (term = next_term(&rest));) {
        char *list = term, *name = strsep(&list, ":");
        json_object_set_new(object, name, options_of(name, list));
    }
    return object;
}

// ---- the document

json_t *statistics_memory(struct ag_renderer *renderer)
{
    struct ag_memory owners[MAX_OWNERS];
    json_t *object = json_object();
    int count = ag_renderer_memory(renderer, owners, MAX_OWNERS);
    for (int i = 0; object && i < count && i < MAX_OWNERS; i++)
        json_object_set_new(object, owners[i].owner, json_integer((json_int_t)owners[i].bytes));
    return object;
}

json_t *statistics_passes(struct statistics *statistics)
{
    json_t *array = json_array();
    for (int i = 0; array && i < statistics->pass_count; i++) {
        struct pass_times *times = &statistics->passes[i];
        if (strcmp(times->name, "frame") == 0) continue;
        json_array_append_new(array, json_pack("{s:s, s:o}", "name", times->name, "gpu_ms",
                                               statistics_summary(times)));
    }
    return array;
}

json_t *statistics_frame(struct statistics *statistics)
{
    struct pass_times *frame = NULL;
    for (int i = 0; i < statistics->pass_count; i++)
        if (strcmp(statistics->passes[i].name, "frame") == 0) frame = &statistics->passes[i];
    return statistics_summary(frame);
}

json_t *statistics_json(struct statistics *statistics, const struct session *session,
                        struct ag_device *device, struct ag_renderer *renderer,
                        const struct bakes *bakes)
{
    const struct arguments *a = session->arguments;
    struct ag_device_info info;
    ag_device_get_info(device, &info);
    return json_pack("{s:s, s:s, s:[ii], s:i, s:s, s:o, s:o, s:o, s:o, s:{s:o, s:I}}", "device",
                     info.name, "driver", info.driver, "size", a->width, a->height, "frames",
                     a->frames, "gi", ag_renderer_gi(renderer), "options",
                     statistics_options(renderer), "passes", statistics_passes(statistics),
                     "frame_ms", statistics_frame(statistics), "memory_bytes",
                     statistics_memory(renderer), "bake", "seconds", json_double(bakes->seconds),
                     "bytes", (json_int_t)bakes->bytes);
}
