#include "command_line.h"

#include <stdio.h>
#include <string.h>

bool command_line_parse(int argc, char **argv,
                        bool (*parse_option)(void *user, const char *name, const char *value),
                        void *user, struct bench_scenes *scenes)
{
    for (int i = 1; i < argc; i++) {
        if (strncmp(argv[i], "--", 2) == 0) {
            if (i + 1 == argc || !parse_option(user, argv[i], argv[i + 1])) return false;
            i++;
        } else if (!append_text(argv[i], scenes->names, &scenes->count, BENCH_MAX_SCENES)) {
            return false;
        }
    }
    return true;
}

bool parse_int(const char *value, int low, int high, int *out)
{
    char rest;
    return sscanf(value, "%d%c", out, &rest) == 1 && *out >= low && *out <= high;
}

bool parse_size(const char *value, int *width, int *height)
{
    char rest;
    return sscanf(value, "%dx%d%c", width, height, &rest) == 2;
}

bool append_int(const char *value, int low, int high, int *list, int *count, int capacity)
{
    return *count < capacity && parse_int(value, low, high, &list[(*count)++]);
}

bool append_text(const char *value, const char **list, int *count, int capacity)
{
    if (*count == capacity) return false;
    list[(*count)++] = value;
    return true;
}

void default_texts(const char *const *defaults, int default_count, const char **list, int *count)
{
    if (*count > 0) return;
    for (int i = 0; i < default_count; i++) list[(*count)++] = defaults[i];
}

void default_scenes(struct bench_scenes *scenes, const char *first, const char *second)
{
    default_texts((const char *const[]){ first, second }, 2, scenes->names, &scenes->count);
}
