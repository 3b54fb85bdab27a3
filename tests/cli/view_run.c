#include "cli/view_run.h"

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

enum { DISPLAY_WAIT_MS = 20000 };
#define SCRIPT "script.txt"

// ---- the display

static pid_t server;
static char display[32];

static bool stop_display(void)
{
    if (server > 0) {
        kill(server, SIGTERM);
        waitpid(server, NULL, 0);
    }
    server = 0;
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
    execlp("Xvfb", "Xvfb", "-displayfd", number, "-screen", "0", "1280x800x24", "-nolisten", "tcp",
           "-noreset", (char *)NULL);
    _exit(127);
}

static void start_display(void)
{
    int ends[2];
    if (pipe(ends) != 0) fail_msg("cannot make a pipe");
    server = fork();
    if (server < 0) fail_msg("cannot fork");
    if (server == 0) {
        close(ends[0]);
        run_server(ends[1]);
    }
    test_register_end(stop_display);
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
    if (used > 0) snprintf(display, sizeof display, ":%d", atoi(number));
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

void require_display(void)
{
    static bool started;
    enter_folder();
    if (!started) require_device();
    if (!started) start_display();
    started = true;
    if (!display[0]) test_skip("no Xvfb");
    setenv("DISPLAY", display, 1);
}

// ---- runs

static void write_script(const char *script)
{
    write_file(SCRIPT, script, strlen(script));
}

void view(const char *words, const char *script)
{
    write_script(script);
    const struct run *r = run_expect(0, words, "--script", SCRIPT, NULL);
    if (r->err[0] || r->out[0]) fail_msg("%s: not silent: %s%s", words, r->err, r->out);
}

void check_fails(const char *words, const char *script, const char *names)
{
    write_script(script);
    const struct run *r = run_expect(1, words, "--script", SCRIPT, NULL);
    check_one_error_line(r);
    if (!strstr(r->err, names)) fail_msg("does not name \"%s\": %s", names, r->err);
}

void check_equal(const char *a, const char *b)
{
    if (!files_are_equal(a, b)) fail_msg("%s and %s differ", a, b);
}

void check_differ(const char *a, const char *b)
{
    if (files_are_equal(a, b)) fail_msg("%s and %s are the same", a, b);
}

void check_size(const char *path, int width, int height)
{
    int w = 0, h = 0;
    CHECK(png_read_size(test_host(), path, &w, &h));
    if (w != width || h != height) fail_msg("%s is %dx%d", path, w, h);
}

double mean_of(const char *path)
{
    struct image image;
    double sum = 0;
    CHECK(png_read(test_host(), path, &image));
    const size_t count = (size_t)image.width * (size_t)image.height * (size_t)image.channels;
    for (size_t i = 0; i < count; i++) sum += (double)image.pixels[i];
    image_finish(&image, test_host());
    return sum / (double)count;
}

// ---- the command of a view

void run_line(const char *path, const char *output)
{
    char line[4096] = "", command[8192];
    FILE *file = fopen(path, "r");
    if (!file || !fgets(line, sizeof line, file)) fail_msg("%s is empty", path);
    fclose(file);
    line[strcspn(line, "\n")] = 0;
    if (strncmp(line, "afterglow ", 10) != 0) fail_msg("no command: %s", line);
    snprintf(command, sizeof command, "'%s' %s --quiet -o %s", AFTERGLOW_PROGRAM, line + 10,
             output);
    if (system(command) != 0) fail_msg("failed: %s", command);
}

void check_command(const char *words, const char *script)
{
    char lines[1024];
    snprintf(lines, sizeof lines, "%ssettle\nsave saved.png\ncommand command.sh\n", script);
    view(words, lines);
    run_line("command.sh", "rendered.png");
    if (!files_are_equal("saved.png", "rendered.png"))
        fail_msg("%s: the command renders another image", words);
}
