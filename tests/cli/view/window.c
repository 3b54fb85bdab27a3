#include "cli/view/window.h"

#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __linux__
#include <sys/prctl.h>
#endif

enum { DISPLAY_WAIT_MS = 20000, USUAL_DPI = 96 };

// ---- the display

struct display {
    int dpi;
    pid_t server;
    char name[32];
};
static struct display displays[2];

static bool stop_displays(void)
{
    for (int i = 0; i < 2; i++) {
        if (displays[i].server <= 0) continue;
        kill(displays[i].server, SIGTERM);
        waitpid(displays[i].server, NULL, 0);
        displays[i].server = 0;
    }
    return true;
}

// Writes the number of the display to `fd`. It ends with this program, even if that is killed.
static void run_server(int fd)
{
    char number[16];
    snprintf(number, sizeof number, "%d", fd);
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGTERM);
#endif
    if (!freopen("/dev/null", "w", stderr)) _exit(126);
    execlp("Xvfb", "Xvfb", "-displayfd", number, "-screen", "0", "1280x960x24", "-nolisten", "tcp",
           "-noreset", (char *)NULL);
    _exit(127);
}

static void start(struct display *display)
{
    int ends[2];
    if (pipe(ends) != 0) fail_msg("cannot make a pipe");
    display->server = fork();
    if (display->server < 0) fail_msg("cannot fork");
    if (display->server == 0) {
        close(ends[0]);
        run_server(ends[1]);
    }
    close(ends[1]);
    char number[16] = "";
    size_t used = 0;
    struct pollfd wait = { .fd = ends[0], .events = POLLIN };
    const int limit = (int)(DISPLAY_WAIT_MS * test_time_factor());
    while (used < sizeof number - 1 && !memchr(number, '\n', used) && poll(&wait, 1, limit) == 1) {
        const ssize_t got = read(ends[0], number + used, sizeof number - 1 - used);
        if (got <= 0) break;
        used += (size_t)got;
    }
    close(ends[0]);
    if (used > 0) snprintf(display->name, sizeof display->name, ":%d", atoi(number));
}

// The resource from which desktops and GLFW take the density.
static void set_density(const struct display *display)
{
    char command[128];
    snprintf(command, sizeof command, "echo Xft.dpi: %d | xrdb -display %s -merge 2>/dev/null",
             display->dpi, display->name);
    if (system(command) != 0) test_skip("no xrdb");
}

void enter_folder(void)
{
    static bool entered;
    if (entered) return;
    if (chdir(make_folder("view")) != 0) fail_msg("cannot enter the folder");
    setenv("AFTERGLOW_CACHE", test_path("cache"), 1);
    setenv("AFTERGLOW_VALIDATION", "1", 1);
    unsetenv("WAYLAND_DISPLAY");
    entered = true;
}

void require_display_of(int dots_per_inch)
{
    static bool registered;
    struct display *display = &displays[dots_per_inch == USUAL_DPI ? 0 : 1];
    enter_folder();
    if (!registered) {
        require_device();
        test_register_end(stop_displays);
        registered = true;
    }
    if (display->dpi != dots_per_inch) {
        display->dpi = dots_per_inch;
        start(display);
    }
    if (!display->name[0]) test_skip("no Xvfb");
    if (dots_per_inch != USUAL_DPI) set_density(display);
    setenv("DISPLAY", display->name, 1);
}

void require_display(void)
{
    require_display_of(USUAL_DPI);
}

// ---- runs

static void write_script(const char *script)
{
    write_file(WINDOW_SCRIPT, script, strlen(script));
}

void view(const char *words, const char *script)
{
    write_script(script);
    const struct run *r = run_expect(0, words, "--script", WINDOW_SCRIPT, NULL);
    if (r->err[0] || r->out[0]) fail_msg("%s: not silent: %s%s", words, r->err, r->out);
}

void check_fails(const char *words, const char *script, const char *names)
{
    write_script(script);
    const struct run *r = run_expect(1, words, "--script", WINDOW_SCRIPT, NULL);
    check_one_error_line(r);
    if (!strstr(r->err, names)) fail_msg("does not name \"%s\": %s", names, r->err);
}

void check_equal(const char *a, const char *b)
{
    if (!files_are_equal(a, b)) fail_msg("%s and %s differ", a, b);
}
