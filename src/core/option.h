// Options from one X-macro table. A module writes X_options.def with lines
//
//     OPTION(type, name, default, min, max, "unit or choices", EFFECT, "help")
//
// type is int32, float32, bool8, choice (an int32 that indexes the '|'-separated names in the unit
// column) or text (default, min and max are 0; it is empty by default). From the table come the
// struct, the defaults, parsing, printing, documentation and the range tests:
//
//     struct lpv_options {
//     #define OPTION OPTION_FIELD
//     #include "lpv_options.def"
//     #undef OPTION
//     };
//     #define OPTION(...) OPTION_ROW(struct lpv_options, __VA_ARGS__)
//     static const struct option_row rows[] = {
//     #include "lpv_options.def"
//     };
//     static const struct option_table table = OPTION_TABLE(struct lpv_options, rows, NULL);
#pragma once

#include "core/host.h"

#include <stdint.h>

typedef int32_t option_int32;
typedef float option_float32;
typedef bool option_bool8;
typedef int32_t option_choice;

// A text such as a path, without control characters. Where options are written as a list, a comma
// is %2C, a plus sign %2B and a percent sign %25.
enum { OPTION_TEXT_SIZE = 256, OPTION_VALUE_SIZE = 3 * OPTION_TEXT_SIZE };
typedef struct option_text {
    char at[OPTION_TEXT_SIZE];
} option_text;

enum option_type {
    OPTION_TYPE_int32,
    OPTION_TYPE_float32,
    OPTION_TYPE_bool8,
    OPTION_TYPE_choice,
    OPTION_TYPE_text,
};

// The effect of a changed option on a running technique, in ascending order.
enum option_effect { LIVE, INVALIDATE, RESIZE, RECREATE, REBAKE };
// Beside an effect, as in LIVE | EXPERT: the option was measured without gain, compares with a
// paper or tunes a method's inside; lists show it on demand.
enum { EXPERT = 1 << 8 };

struct option_row {
    enum option_type type;
    const char *name;
    double initial, min, max;
    const char *unit; // for choice: "first|second|…"
    enum option_effect effect;
    bool expert;
    const char *help;
    size_t offset;
};

// The name that an option had in the last release. It still works, with a warning.
struct option_alias {
    const char *old_name, *name;
};

enum { OPTION_MAX_ALIASES = 32 };

struct option_table {
    const struct option_row *rows;
    size_t count;
    size_t size;                        // of the options struct
    const struct option_alias *aliases; // ends with a NULL old_name; may be NULL
};

#define OPTION_FIELD(type, name, ...) option_##type name;
#define OPTION_ROW(struct_type, type_, name_, initial_, min_, max_, unit_, effect_, help_)         \
    { .type = OPTION_TYPE_##type_,                                                                 \
      .name = #name_,                                                                              \
      .initial = (initial_),                                                                       \
      .min = (min_),                                                                               \
      .max = (max_),                                                                               \
      .unit = (unit_),                                                                             \
      .effect = (enum option_effect)((effect_) & ~EXPERT),                                         \
      .expert = ((effect_)&EXPERT) != 0,                                                           \
      .help = (help_),                                                                             \
      .offset = offsetof(struct_type, name_) },
#define OPTION_TABLE(struct_type, rows_, aliases_)                                                 \
    {                                                                                              \
        .rows = (rows_), .count = sizeof(rows_) / sizeof(*(rows_)), .size = sizeof(struct_type),   \
        .aliases = (aliases_)                                                                      \
    }

void option_defaults(const struct option_table *table, void *options);
// The row of this name or old name; NULL: none.
const struct option_row *option_find(const struct option_table *table, const char *name);

// Applies "key=value,key=value" to *options; "" changes nothing. Messages name `owner`. Errors name
// the nearest known key or the range of the value, and leave *options unchanged. An old name logs
// one warning.
bool option_parse(struct host *host, const struct option_table *table, const char *owner,
                  const char *text, void *options);
// The value as text that option_parse reads. OPTION_VALUE_SIZE bytes hold any value.
void option_print(const struct option_row *row, const void *options, char *out, size_t out_size);
// The strongest effect of the options that differ; -1: all are equal.
int option_difference(const struct option_table *table, const void *a, const void *b);
// Copies the options that may change while a technique runs: those of effect LIVE and INVALIDATE.
void option_copy_live(const struct option_table *table, const void *from, void *into);

// The known name nearest to `name` by edit distance, NULL when none is near enough to suggest.
const char *nearest_name(const char *name, const char *const *known, size_t count);
