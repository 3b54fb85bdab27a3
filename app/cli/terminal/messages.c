// Standard error. Its state is static, since there is one terminal; the lock of stderr guards it
// against the thread of waiting.c.
#include "messages.h"
#include "bar.h"

#include <stdio.h>
#include <stdarg.h>
#include <string.h>
#include <time.h>

enum { LINE_SIZE = 2048, SHARE_TOTAL = -1 };
static const double BAR_AFTER_S = 0.3;   // shorter work shows none
static const double LINE_EVERY_S = 10.0; // where there is no terminal

static struct {
    bool quiet, verbose;
    bool bar_shown;
    const char *internal, *shown; // messages_show
    int total;                    // of the running work; 0: none
    double begun_s, line_s;       // when it began and when the last line was written
} state;

static _Thread_local struct {
    char *out; // NULL: errors are printed
    size_t size;
} kept;

void messages_init(bool quiet, bool verbose)
{
    state.quiet = quiet;
    state.verbose = verbose;
}

static void clear_bar(void)
{
    if (state.bar_shown) fputs("\r\033[K", stderr);
    state.bar_shown = false;
}

void messages_show(const char *internal, const char *shown)
{
    state.internal = internal;
    state.shown = shown;
}

struct printable printable(const char *text)
{
    struct printable out;
    ag_printable(text, out.s, sizeof out.s);
    return out;
}

// Replaces each `internal` in the text.
static void replace_internal(const char *text, char out[LINE_SIZE])
{
    size_t used = 0;
    for (const char *at; (at = strstr(text, state.internal)); text = at + strlen(state.internal)) {
        const int wrote =
            snprintf(out + used, LINE_SIZE - used, "%.*s%s", (int)(at - text), text, state.shown);
        used += wrote > 0 ? (size_t)wrote : 0;
        if (used >= LINE_SIZE) return;
    }
    snprintf(out + used, LINE_SIZE - used, "%s", text);
}

__attribute__((format(printf, 1, 0))) static void line(const char *format, va_list arguments)
{
    char text[LINE_SIZE], replaced[LINE_SIZE];
    if (vsnprintf(text, sizeof text, format, arguments) < 0) return;
    if (state.internal) replace_internal(text, replaced);
    flockfile(stderr);
    clear_bar();
    fprintf(stderr, "afterglow: %s\n", printable(state.internal ? replaced : text).s);
    funlockfile(stderr);
}

void messages_keep(char *out, size_t size)
{
    kept.out = out;
    kept.size = size;
}

__attribute__((format(printf, 1, 0))) static void line_or_keep(const char *format,
                                                               va_list arguments)
{
    if (kept.out)
        vsnprintf(kept.out, kept.size, format, arguments);
    else
        line(format, arguments);
}

enum status fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    line_or_keep(format, arguments);
    va_end(arguments);
    return FAILED;
}

enum status wrong_usage(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    line_or_keep(format, arguments);
    va_end(arguments);
    return WRONG_USAGE;
}

enum status fail_library(const struct ag_context *context, enum ag_result result)
{
    const char *why = ag_context_last_error(context);
    fail("%s", why[0] ? why : ag_result_string(result));
    return result == AG_ERROR_ARGUMENT ? WRONG_USAGE : FAILED;
}

void note(const char *format, ...)
{
    if (state.quiet) return;
    va_list arguments;
    va_start(arguments, format);
    line(format, arguments);
    va_end(arguments);
}

void detail(const char *format, ...)
{
    if (!state.verbose) return;
    va_list arguments;
    va_start(arguments, format);
    line(format, arguments);
    va_end(arguments);
}

void log_message(void *user, enum ag_log_level level, const char *message)
{
    (void)user;
    if (level == AG_LOG_WARNING)
        note("warning: %s", message);
    else if (level > AG_LOG_WARNING)
        detail("%s", message);
}

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void draw_bar(const char *what, double share, const char *count, double left_s)
{
    char text[LINE_SIZE];
    bar_print(bar_columns(), what, share, count, left_s, text, sizeof text);
    fprintf(stderr, "\r\033[K%s", text);
    fflush(stderr);
    state.bar_shown = true;
}

// When the work began. Another total is other work.
static double passed_s(int total)
{
    const double now = now_s();
    if (state.total != total) {
        state.total = total;
        state.begun_s = state.line_s = now;
    }
    return now - state.begun_s;
}

static bool line_is_due(void)
{
    if (now_s() - state.line_s <= LINE_EVERY_S) return false;
    state.line_s = now_s();
    return true;
}

void progress(const char *what, int done, int total)
{
    if (state.quiet || total <= 0) return;
    const double passed = passed_s(total);
    const double left = done > 0 ? passed / done * (total - done) : 0.0;
    char count[32];
    snprintf(count, sizeof count, "%d/%d", done, total);
    if (bar_is_possible()) {
        if (passed > BAR_AFTER_S && done < total) draw_bar(what, (double)done / total, count, left);
    } else if (done > 0 && done < total && line_is_due()) {
        note("%s: %d of %d, %.0f s left", what, done, total, left);
    }
}

void progress_share(const char *what, double share, double left_s)
{
    if (state.quiet || !(share >= 0.0) || share > 1.0) return;
    const double passed = passed_s(SHARE_TOTAL);
    char count[32];
    snprintf(count, sizeof count, "%.0f %%", 100.0 * share);
    if (bar_is_possible()) {
        if (passed > BAR_AFTER_S) draw_bar(what, share, count, left_s);
    } else if (line_is_due()) {
        note("%s: %s, %.0f s left", what, count, left_s);
    }
}

void progress_end(void)
{
    clear_bar();
    state.total = 0;
}
