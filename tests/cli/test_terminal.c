// Progress on terminals of any width, and on those without escape sequences.
#include "cli/terminal/bar.h"
#include "cli/terminal/messages.h"

#include "framework/test.h"

#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

// ---- The text

TEST(a_bar_fits_any_width)
{
    static const char what[] = "baking radiosity, form factors";
    for (int columns = 1; columns < 200; columns++) {
        char text[256];
        bar_print(columns, what, 0.5, "500/1000", 123, text, sizeof text);
        CHECK((int)strlen(text) < columns);
        if (columns > 8) CHECK(strstr(text, "500/1000"));
        CHECK(!strchr(text, '[') == !strchr(text, ']'));
    }
}

static void check_text(int columns, const char *text)
{
    char out[256];
    bar_print(columns, "path tracing", 0.5, "8/16", 3, out, sizeof out);
    CHECK_STRING(out, text);
}

TEST(a_narrow_bar_is_short_then_absent_then_without_time)
{
    check_text(80, "path tracing [###############...............] 8/16, 3 s left");
    check_text(40, "path tracing [####.....] 8/16, 3 s left");
    check_text(34, "path tracing 8/16, 3 s left");
    check_text(20, "path tracing 8/16");
    check_text(12, "path t 8/16");
    check_text(4, "8/1");
    check_text(0, "");
}

// ---- The terminal

static void set_variable(const char *name, const char *value)
{
    if (value)
        setenv(name, value, 1);
    else
        unsetenv(name);
}

// All that arrives: on a loaded machine the kernel passes it on some time after the write.
static void read_shown(int master, char *out, size_t size)
{
    struct pollfd ready = { .fd = master, .events = POLLIN };
    size_t used = 0;
    while (used + 1 < size && poll(&ready, 1, (int)(100 * test_time_factor())) > 0) {
        const ssize_t got = read(master, out + used, size - 1 - used);
        if (got <= 0) break;
        used += (size_t)got;
    }
    out[used] = 0;
}

// Output to a terminal of that width while half of the work is done, and after its end.
static const char *shown(const char *term, const char *columns, int width)
{
    static char text[4096];
    const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK), kept = dup(STDERR_FILENO);
    const struct winsize size = { .ws_col = (unsigned short)width, .ws_row = 24 };
    assert_true(master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0);
    const int terminal = open(ptsname(master), O_RDWR | O_NOCTTY);
    assert_true(terminal >= 0 && ioctl(terminal, TIOCSWINSZ, &size) == 0);
    dup2(terminal, STDERR_FILENO);
    set_variable("TERM", term);
    set_variable("COLUMNS", columns);
    progress("path tracing", 1, 100);
    test_pause_ms(400); // shorter work shows none
    progress("path tracing", 50, 100);
    const bool possible = bar_is_possible();
    progress_end();
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    read_shown(master, text, sizeof text);
    CHECK(possible == (strchr(text, '\033') != NULL));
    close(kept);
    close(terminal);
    close(master);
    return text;
}

TEST(a_bar_is_as_wide_as_the_terminal)
{
    CHECK_STRING(shown("xterm", NULL, 20), "\r\033[Kpath tracing 50/100\r\033[K");
    CHECK_STRING(shown("xterm", NULL, 24), "\r\033[Kpath tracing 50/100\r\033[K");
    CHECK(strstr(shown("xterm", NULL, 80), "[###############...............] 50/100, "));
    CHECK(strstr(shown("xterm", "20", 80), "\033[Kpath tracing 50/100\r")); // COLUMNS goes first
    CHECK(strstr(shown("xterm", "nonsense", 80), "[#####"));
    CHECK(strstr(shown("xterm", NULL, 0), "[#####")); // a width that is not known
}

TEST(a_terminal_without_escape_sequences_gets_none)
{
    CHECK_STRING(shown("dumb", NULL, 80), "");
    CHECK_STRING(shown("", NULL, 80), "");
    CHECK_STRING(shown(NULL, NULL, 80), "");
}
