#include "method.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const method_roles[ROLE_COUNT] = { "source", "delta", "visibility", "reflection" };

// ---- options

int method_choices(const struct ag_option_info *option, char *buffer, size_t size,
                   const char **names, int capacity)
{
    int count = 0;
    snprintf(buffer, size, "%s", option->unit);
    for (char *name = buffer, *bar; name && count < capacity; name = bar) {
        bar = strchr(name, '|');
        if (bar) *bar++ = 0;
        names[count++] = name;
    }
    return count;
}

int method_choice(const struct ag_option_info *option, const char *value)
{
    char buffer[512];
    const char *names[64];
    const int count = method_choices(option, buffer, sizeof buffer, names, 64);
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], value) == 0) return i;
    return -1;
}

void method_default(const struct ag_option_info *option, char out[METHOD_VALUE])
{
    out[0] = 0;
    if (strcmp(option->type, "bool") == 0) {
        snprintf(out, METHOD_VALUE, "%s", option->initial != 0 ? "true" : "false");
    } else if (strcmp(option->type, "choice") == 0) {
        char buffer[512];
        const char *names[64];
        const int count = method_choices(option, buffer, sizeof buffer, names, 64);
        if ((int)option->initial < count)
            snprintf(out, METHOD_VALUE, "%s", names[(int)option->initial]);
    } else if (strcmp(option->type, "text") != 0) {
        snprintf(out, METHOD_VALUE, "%.9g", option->initial);
    }
}

double method_number(const char *value)
{
    return strcmp(value, "true") == 0 ? 1.0 : strtod(value, NULL);
}

static bool same(const struct ag_option_info *option, const char *a, const char *b)
{
    const bool numeric = strcmp(option->type, "int") == 0 || strcmp(option->type, "float") == 0;
    return strcmp(a, b) == 0 || (numeric && (float)method_number(a) == (float)method_number(b));
}

// ---- techniques

static int role_of(const struct ag_technique_info *info)
{
    for (int i = 0; i < ROLE_COUNT; i++)
        if (strcmp(method_roles[i], info->role) == 0) return i;
    return ROLE_SOURCE;
}

static int find_technique(const char *name, size_t length)
{
    struct ag_technique_info info;
    for (int i = 0; i < METHOD_TECHNIQUES && ag_technique_get(i, &info); i++)
        if (strlen(info.name) == length && memcmp(info.name, name, length) == 0) return i;
    return -1;
}

static void set_defaults(struct method *method, int technique)
{
    struct ag_option_info option;
    for (int k = 0; k < METHOD_OPTIONS && ag_technique_option_get(technique, k, &option); k++)
        method_default(&option, method->values[technique][k]);
}

void method_init(struct method *method)
{
    struct ag_technique_info info;
    memset(method, 0, sizeof *method);
    for (int i = 0; i < ROLE_COUNT; i++) method->chosen[i] = -1;
    for (int i = 0; i < METHOD_TECHNIQUES && ag_technique_get(i, &info); i++)
        set_defaults(method, i);
    method->chosen[ROLE_SOURCE] = find_technique("none", 4);
}

static void set_option(struct method *method, int technique, const char *text, size_t length)
{
    struct ag_option_info option;
    const char *equals = memchr(text, '=', length);
    if (!equals) return;
    const size_t name = (size_t)(equals - text), value = length - name - 1;
    for (int k = 0; k < METHOD_OPTIONS && ag_technique_option_get(technique, k, &option); k++)
        if (strlen(option.name) == name && memcmp(option.name, text, name) == 0 &&
            value < METHOD_VALUE)
            snprintf(method->values[technique][k], METHOD_VALUE, "%.*s", (int)value, equals + 1);
}

static void set_options(struct method *method, int technique, const char *text, size_t length)
{
    while (length > 0) {
        const char *comma = memchr(text, ',', length);
        const size_t part = comma ? (size_t)(comma - text) : length;
        set_option(method, technique, text, part);
        if (!comma) return;
        text += part + 1;
        length -= part + 1;
    }
}

static void parse_technique(struct method *method, const char *text, size_t length)
{
    struct ag_technique_info info;
    const char *colon = memchr(text, ':', length);
    const size_t name = colon ? (size_t)(colon - text) : length;
    const int technique = find_technique(text, name);
    if (technique < 0 || !ag_technique_get(technique, &info)) return;
    method->chosen[role_of(&info)] = technique;
    set_defaults(method, technique);
    if (colon) set_options(method, technique, colon + 1, length - name - 1);
}

void method_parse(struct method *method, const char *gi)
{
    for (int i = 0; i < ROLE_COUNT; i++) method->chosen[i] = -1;
    for (const char *part = gi; part;) {
        const char *plus = strchr(part, '+');
        parse_technique(method, part, plus ? (size_t)(plus - part) : strlen(part));
        part = plus ? plus + 1 : NULL;
    }
    if (method->chosen[ROLE_SOURCE] < 0) method->chosen[ROLE_SOURCE] = find_technique("none", 4);
}

static void print_options(const struct method *method, int technique, char *out, size_t size)
{
    struct ag_option_info option;
    size_t used = 0;
    for (int k = 0; k < METHOD_OPTIONS && ag_technique_option_get(technique, k, &option); k++) {
        char initial[METHOD_VALUE];
        const char *value = method->values[technique][k];
        method_default(&option, initial);
        if (same(&option, value, initial) || used >= size) continue;
        const int wrote =
            snprintf(out + used, size - used, "%c%s=%s", used ? ',' : ':', option.name, value);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
}

void method_print(const struct method *method, char out[METHOD_SPEC])
{
    struct ag_technique_info info;
    out[0] = 0;
    for (int i = 0; i < ROLE_COUNT; i++) {
        const int technique = method->chosen[i];
        if (technique < 0 || !ag_technique_get(technique, &info)) continue;
        size_t used = strlen(out);
        snprintf(out + used, METHOD_SPEC - used, "%s%s", used ? "+" : "", info.name);
        used = strlen(out);
        print_options(method, technique, out + used, METHOD_SPEC - used);
    }
}

void method_set_preset(struct method *method, int technique, int preset)
{
    const char *name, *options;
    if (!ag_technique_preset_get(technique, preset, &name, &options)) return;
    set_defaults(method, technique);
    set_options(method, technique, options, strlen(options));
}

static bool has_preset(int technique, const char *wanted)
{
    const char *name, *options;
    for (int i = 0; ag_technique_preset_get(technique, i, &name, &options); i++)
        if (strcmp(name, wanted) == 0) return true;
    return false;
}

static bool can_be_lowered(const char *name, size_t length)
{
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++)
        if (strlen(info.name) == length && strncmp(info.name, name, length) == 0)
            return !info.needs_bake && has_preset(i, "low");
    return false;
}

void method_lower(const char *gi, char out[METHOD_SPEC])
{
    size_t used = 0;
    out[0] = 0;
    for (const char *part = gi; *part && used < METHOD_SPEC;) {
        const size_t length = strcspn(part, "+");
        const bool lowered = can_be_lowered(part, length);
        used += (size_t)snprintf(out + used, METHOD_SPEC - used, "%.*s%s%s", (int)length, part,
                                 lowered ? ":quality=low" : "", part[length] ? "+" : "");
        part += length + (part[length] == '+');
    }
}
