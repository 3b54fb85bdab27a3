// The command line of a bench: options of one value each, and scenes.
#ifndef AG_BENCH_COMMAND_LINE_H
#define AG_BENCH_COMMAND_LINE_H

#include <stdbool.h>

enum { BENCH_MAX_SCENES = 64 };

struct bench_scenes {
    const char *names[BENCH_MAX_SCENES];
    int count;
};

// option: takes "--name" and its value; false where it knows no such name or the value is wrong.
// False for what is not understood, and for more scenes than there is room for.
bool command_line_parse(int argc, char **argv,
                        bool (*option)(void *user, const char *name, const char *value), void *user,
                        struct bench_scenes *scenes);

// The scenes that are measured where none is named.
void command_line_usual_scenes(struct bench_scenes *scenes, const char *first, const char *second);

#endif
