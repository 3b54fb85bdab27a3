// Standard error: one line for an error, notes, and the progress of long work.
#pragma once

#include <afterglow/context.h>

enum status { DONE = 0, FAILED = 1, WRONG_USAGE = 2 }; // exit statuses, a contract with scripts

// --quiet leaves errors alone; --verbose adds the library's own notes.
void messages_init(bool quiet, bool verbose);

// Each prints one line "afterglow: …" and returns its status, so that `return fail(…)` reads well.
// The text is
// "<what> <where>: <why>"; line breaks in it (from file names) become question marks.
enum status fail(const char *format, ...) __attribute__((format(printf, 1, 2)));
enum status wrong_usage(const char *format, ...) __attribute__((format(printf, 1, 2)));
// The library's last error. Wrong arguments are wrong usage: the command line was forwarded as it
// stands.
enum status fail_library(const struct ag_context *context, enum ag_result result);
// A line that --quiet leaves out.
void note(const char *format, ...) __attribute__((format(printf, 1, 2)));
// A line that only --verbose shows.
void detail(const char *format, ...) __attribute__((format(printf, 1, 2)));
// For ag_context_desc.log. Errors wait in the context until a command says that it failed.
void log_message(void *user, enum ag_log_level level, const char *message);

// Progress: a bar with the time left on a terminal, elsewhere a line now and then.
void progress(const char *what, int done, int total);
void progress_end(void);
