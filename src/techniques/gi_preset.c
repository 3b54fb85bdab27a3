// Options of a technique in a GI spec: a preset and single options.
#include "techniques/gi_preset.h"

#include <stdio.h>
#include <string.h>

enum { MAX_PRESETS = 8, LIST_SIZE = 256 };

static bool fail_unknown(struct host *host, const struct technique *technique, const char *name)
{
    const char *names[MAX_PRESETS];
    char list[LIST_SIZE] = "";
    size_t count = 0, used = 0;
    for (; count < MAX_PRESETS && technique->presets[count].name; count++) {
        names[count] = technique->presets[count].name;
        const int written =
            snprintf(list + used, sizeof list - used, "%s%s", count ? "|" : "", names[count]);
        if (written > 0 && (size_t)written < sizeof list - used) used += (size_t)written;
    }
    const char *nearest = nearest_name(name, names, count);
    if (nearest)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot set %s:" GI_QUALITY " to \"%s\": did you mean %s? (one of %s)",
                         technique->name, name, nearest, list);
    return host_fail(host, FAIL_ARGUMENT,
                     "cannot set %s:" GI_QUALITY " to \"%s\": it must be one of %s",
                     technique->name, name, list);
}

static bool apply(struct host *host, const struct technique *technique, const char *name,
                  void *values)
{
    if (!technique->presets)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot set %s:" GI_QUALITY ": %s has no presets, only single options",
                         technique->name, technique->name);
    if (!name[0])
        return host_fail(host, FAIL_ARGUMENT, "cannot set %s:" GI_QUALITY ": no value is given",
                         technique->name);
    for (const struct technique_preset *preset = technique->presets; preset->name; preset++)
        if (strcmp(preset->name, name) == 0)
            return option_parse(host, &technique->options, technique->name, preset->options,
                                values);
    return fail_unknown(host, technique, name);
}

// option_parse does not know the key `quality`, so that a misspelt one is found here.
static bool is_misspelt(const struct technique *technique, const char *key)
{
    static const char *const quality[] = { GI_QUALITY };
    return technique->presets && nearest_name(key, quality, 1) &&
           !option_find(&technique->options, key);
}

// Applies an item "quality=NAME" and leaves others unchanged for option_parse.
static bool read_item(struct host *host, const struct technique *technique, char *item, bool *taken,
                      void *values)
{
    char *equals = strchr(item, '=');
    if (equals) *equals = 0;
    *taken = strcmp(item, GI_QUALITY) == 0;
    if (*taken) return apply(host, technique, equals ? equals + 1 : "", values);
    if (is_misspelt(technique, item))
        return host_fail(host, FAIL_ARGUMENT, "unknown option %s:%s: did you mean " GI_QUALITY "?",
                         technique->name, item);
    if (equals) *equals = '=';
    return true;
}

// Applies the presets in order and copies the other items to `rest`, which is longer than the text.
static bool read_presets(struct host *host, const struct technique *technique, char *text,
                         char *rest, void *values)
{
    size_t used = 0;
    bool taken = false, first = true;
    for (char *item = text, *next; item; item = next) {
        next = strchr(item, ',');
        if (next) *next++ = 0;
        if (!read_item(host, technique, item, &taken, values)) return false;
        if (taken) continue;
        const size_t length = strlen(item);
        if (!first || length == 0) rest[used++] = ','; // an empty item stays an error
        memcpy(rest + used, item, length);
        used += length;
        first = false;
    }
    rest[used] = 0;
    return true;
}

bool gi_options_read(struct host *host, const struct technique *technique, const char *text,
                     void *values)
{
    option_defaults(&technique->options, values);
    if (!text[0]) return true;
    char *items = host_strdup(host, text), *rest = host_sprintf(host, "%s,", text);
    const bool ok = items && rest && read_presets(host, technique, items, rest, values) &&
                    option_parse(host, &technique->options, technique->name, rest, values);
    host_free(host, items);
    host_free(host, rest);
    return ok;
}
