// Standard error: errors, notes and progress.
#pragma once

#include <afterglow/context.h>

enum status { DONE = 0, FAILED = 1, WRONG_USAGE = 2 }; // exit statuses; scripts rely on them

// --quiet prints only errors; --verbose adds details and log messages of the library.
void messages_init(bool quiet, bool verbose);

// Prints one line "afterglow: <what> <where>: <why>" and returns the status. Control characters
// (from file names) are escaped.
enum status fail(const char *format, ...) __attribute__((format(printf, 1, 2)));
enum status wrong_usage(const char *format, ...) __attribute__((format(printf, 1, 2)));
// Prints the library's last error. AG_ERROR_ARGUMENT is wrong usage, since arguments are passed
// on unchanged.
enum status fail_library(const struct ag_context *context, enum ag_result result);
// A line that --quiet omits.
void note(const char *format, ...) __attribute__((format(printf, 1, 2)));
// A line that only --verbose prints.
void detail(const char *format, ...) __attribute__((format(printf, 1, 2)));
// Lines show `shown`, which the user named, instead of `internal`; NULL: unchanged. Both stay
// valid.
void messages_show(const char *internal, const char *shown);
// A path or name for standard output, at most 4096 bytes of it: printf("%s", printable(path).s).
struct printable {
    char s[4096];
};
struct printable printable(const char *text);
// Errors of this thread go to `out` until the next call with NULL, the newest alone, without the
// name of the program.
void messages_keep(char *out, size_t size);
// The callback of ag_context_desc. Errors are not printed here, but by fail_library.
void log_message(void *user, enum ag_log_level level, const char *message);

// A progress bar with the remaining time on a terminal, otherwise a line every ten seconds.
void progress(const char *what, int done, int total);
// The same for a share of the time, 0…1, and the time left.
void progress_share(const char *what, double share, double left_s);
void progress_end(void);
