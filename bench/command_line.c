#include "command_line.h"

#include <string.h>

bool command_line_parse(int argc, char **argv,
                        bool (*option)(void *user, const char *name, const char *value), void *user,
                        struct bench_scenes *scenes)
{
    for (int i = 1; i < argc; i++) {
        if (strncmp(argv[i], "--", 2) == 0) {
            if (i + 1 == argc || !option(user, argv[i], argv[i + 1])) return false;
            i++;
        } else if (scenes->count < BENCH_MAX_SCENES) {
            scenes->names[scenes->count++] = argv[i];
        } else {
            return false;
        }
    }
    return true;
}

void command_line_usual_scenes(struct bench_scenes *scenes, const char *first, const char *second)
{
    if (scenes->count > 0) return;
    scenes->names[scenes->count++] = first;
    scenes->names[scenes->count++] = second;
}
