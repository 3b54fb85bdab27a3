#include "bar.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { LONGEST = 30, SHORTEST = 5, DEFAULT_COLUMNS = 80, MOST_COLUMNS = 1000 };

bool bar_is_possible(void)
{
    const char *term = getenv("TERM");
    return term && term[0] && strcmp(term, "dumb") != 0 && isatty(STDERR_FILENO);
}

int bar_columns(void)
{
    struct winsize size;
    const char *text = getenv("COLUMNS");
    const long columns = text ? strtol(text, NULL, 10) : 0;
    if (columns > 0) return columns < MOST_COLUMNS ? (int)columns : MOST_COLUMNS;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return DEFAULT_COLUMNS;
}

// Characters between the brackets; 0: there is no room for a bar.
static int bar_length(int room, const char *what, const char *count, const char *left)
{
    const int length = room - (int)(strlen(what) + strlen(" [] ") + strlen(count) + strlen(left));
    return length > LONGEST ? LONGEST : length < SHORTEST ? 0 : length;
}

// The beginning of `what` that fits before the count; the time too if there is room for all.
static void print_short(int room, const char *what, const char *count, const char *left, char *out,
                        size_t size)
{
    if ((int)(strlen(what) + 1 + strlen(count) + strlen(left)) > room) left = "";
    const int for_what = room - 1 - (int)strlen(count);
    if (for_what > 0)
        snprintf(out, size, "%.*s %s%s", for_what, what, count, left);
    else
        snprintf(out, size, "%.*s", room > 0 ? room : 0, count);
}

void bar_print(int columns, const char *what, double share, const char *count, double left_s,
               char *out, size_t size)
{
    char left[48], bar[LONGEST + 1];
    const int room = columns - 1;
    snprintf(left, sizeof left, ", %.0f s left", left_s);
    const int length = bar_length(room, what, count, left);
    if (length == 0) {
        print_short(room, what, count, left, out, size);
        return;
    }
    memset(bar, '.', (size_t)length);
    memset(bar, '#', (size_t)((double)length * share));
    bar[length] = 0;
    snprintf(out, size, "%s [%s] %s%s", what, bar, count, left);
}
