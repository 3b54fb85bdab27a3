// The command line of a benchmark: options with one value each, and scenes.
#ifndef AG_BENCH_COMMAND_LINE_H
#define AG_BENCH_COMMAND_LINE_H

#include <stdbool.h>

enum { BENCH_MAX_SCENES = 64 };

struct bench_scenes {
    const char *names[BENCH_MAX_SCENES];
    int count;
};

// parse_option: takes "--name" and its value; false for an unknown name or a wrong value.
// False where the command line has an error.
bool command_line_parse(int argc, char **argv,
                        bool (*parse_option)(void *user, const char *name, const char *value),
                        void *user, struct bench_scenes *scenes);

// Values of options: false where the text is not of that form or out of range.
bool parse_int(const char *value, int low, int high, int *out);
bool parse_size(const char *value, int *width, int *height); // "640x360"
// Options that may be repeated: append to a list, false where it is full.
bool append_int(const char *value, int low, int high, int *list, int *count, int capacity);
bool append_text(const char *value, const char **list, int *count, int capacity);
// Copies the default list into an empty list.
void default_texts(const char *const *defaults, int default_count, const char **list, int *count);
// Two default scenes.
void default_scenes(struct bench_scenes *scenes, const char *first, const char *second);

#endif
