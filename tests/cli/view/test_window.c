// The viewer's window: minimised, resized and closed under a window manager, where there is one; on
// a display of high density.
#include "cli/view/window.h"

#include "image/png_file.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __linux__
#include <sys/prctl.h>
#endif

#define WORDS                                                                                      \
    "view @cornell:light=point --quiet --size 400x300 --scale 0.1 --gi lpv:dim=8,cascades=1"
enum { WAIT_MS = 60000, STEP_MS = 100, REST_MS = 1000, MEASURE_MS = 3000, RESIZES = 40 };
static const double MOST_SHARE = 0.15;      // of one processor, while nothing is shown
static const double MOST_DIFFERENCE = 0.02; // of linear pixels, in the mean

static pid_t manager, viewer;

static bool stop(void)
{
    if (viewer > 0) kill(viewer, SIGKILL);
    if (viewer > 0) waitpid(viewer, NULL, 0);
    if (manager > 0) kill(manager, SIGTERM);
    if (manager > 0) waitpid(manager, NULL, 0);
    viewer = manager = 0;
    return true;
}

// Ends with this program, even if that is killed.
static pid_t start(char *const *words, const char *output)
{
    const pid_t child = fork();
    if (child < 0) fail_msg("cannot fork");
    if (child > 0) return child;
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    if (!freopen(output, "w", stdout) || !freopen(output, "a", stderr)) _exit(126);
    execvp(words[0], words);
    _exit(127);
}

static bool runs(const char *format, ...) __attribute__((format(printf, 1, 2)));
static bool runs(const char *format, ...)
{
    char command[512];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(command, sizeof command - 16, format, arguments);
    va_end(arguments);
    strcpy(command + length, " 2>/dev/null");
    return system(command) == 0;
}

// Whether the command succeeds within a while.
static bool appears(const char *command)
{
    for (int i = 0; i < WAIT_MS / STEP_MS; i++) {
        if (runs("%s >found.txt", command)) return true;
        test_pause_ms(STEP_MS * test_time_factor());
    }
    return false;
}

static void require_manager(void)
{
    static char *const words[] = { (char *)"openbox", (char *)"--sm-disable", NULL };
    require_display();
    if (!runs("command -v openbox xdotool >/dev/null")) test_skip("no openbox or xdotool");
    if (access("/proc/self/stat", R_OK) != 0) test_skip("no /proc");
    if (manager > 0) return;
    test_register_end(stop);
    manager = start(words, "/dev/null");
    if (!appears("xdotool get_desktop")) test_skip("openbox does not start");
}

static const char *said_by_viewer(void)
{
    static char text[4096];
    FILE *file = fopen("viewer.txt", "r");
    const size_t got = file ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file) fclose(file);
    text[got] = 0;
    return text;
}

static void start_viewer(void)
{
    static char text[] = AFTERGLOW_PROGRAM " " WORDS;
    static char copy[sizeof text];
    char *words[32] = { NULL }, *rest = memcpy(copy, text, sizeof text);
    for (int i = 0; i < 31 && rest; i++) words[i] = strsep(&rest, " ");
    char search[128];
    viewer = start(words, "viewer.txt");
    snprintf(search, sizeof search, "xdotool search --all --onlyvisible --pid %d --name Afterglow",
             (int)viewer);
    if (!appears(search)) fail_msg("no window: %s", said_by_viewer());
    test_pause_ms(REST_MS * test_time_factor());
}

// By the keyboard. The viewer ends in silence.
static void close_viewer(void)
{
    int status = -1;
    CHECK(runs("xdotool windowactivate --sync $(cat found.txt) key alt+F4"));
    for (int i = 0; i < WAIT_MS / STEP_MS && waitpid(viewer, &status, WNOHANG) == 0; i++)
        test_pause_ms(STEP_MS * test_time_factor());
    const char *said = said_by_viewer();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || said[0])
        fail_msg("the viewer ends with %d: %s", status, said);
    viewer = 0;
}

static double processor_s(void)
{
    char path[64], text[1024] = "";
    unsigned long user = 0, system_ticks = 0;
    snprintf(path, sizeof path, "/proc/%d/stat", (int)viewer);
    FILE *file = fopen(path, "r");
    if (!file || !fgets(text, sizeof text, file)) fail_msg("the viewer has ended");
    fclose(file);
    const char *after_name = strrchr(text, ')');
    sscanf(after_name + 1, " %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &user,
           &system_ticks);
    return (double)(user + system_ticks) / (double)sysconf(_SC_CLK_TCK);
}

static double processor_share(void)
{
    const double before_s = processor_s();
    test_pause_ms(MEASURE_MS);
    return 1000.0 * (processor_s() - before_s) / MEASURE_MS;
}

// Play, which draws each frame, is on in between.
TEST(a_minimised_window_takes_no_processor_time)
{
    require_manager();
    start_viewer();
    CHECK(runs("xdotool windowactivate --sync $(cat found.txt) key space"));
    test_pause_ms(REST_MS);
    const double shown = processor_share();
    CHECK(runs("xdotool windowminimize --sync $(cat found.txt)"));
    test_pause_ms(REST_MS);
    const double hidden = processor_share();
    CHECK(runs("xdotool windowactivate --sync $(cat found.txt)"));
    test_pause_ms(REST_MS);
    const double again = processor_share();
    close_viewer();
    printf("processors: %.2f shown, %.2f minimised, %.2f shown again\n", shown, hidden, again);
    if (hidden > MOST_SHARE) fail_msg("minimised, it takes %.2f processors", hidden);
    CHECK(shown > 2 * MOST_SHARE && again > 2 * MOST_SHARE);
}

TEST(a_storm_of_sizes_is_silent)
{
    require_manager();
    start_viewer();
    for (int i = 0; i < RESIZES; i++)
        CHECK(runs("xdotool windowsize $(cat found.txt) %d %d", 320 + i * 211 % 900,
                   240 + i * 137 % 600));
    for (int i = 0; i < 4; i++) {
        CHECK(runs("xdotool windowminimize $(cat found.txt)"));
        CHECK(runs("xdotool windowsize $(cat found.txt) %d 300", 400 + 50 * i));
        CHECK(runs("xdotool windowactivate $(cat found.txt)"));
    }
    test_pause_ms(REST_MS);
    close_viewer();
}

// ---- density

static struct image read_window(const char *prefix, const char *tab)
{
    char path[64];
    struct image image;
    snprintf(path, sizeof path, "%s-%s.png", prefix, tab);
    CHECK(png_read(test_host(), path, &image));
    return image;
}

// The panels, 350 units wide, in windows of 640x480 units, one with four pixels for each of the
// other's.
static double panel_difference(const struct image *once, const struct image *twice)
{
    enum { LEFT = 290, WIDTH = 640, HEIGHT = 480 };
    double sum = 0;
    CHECK(once->width == WIDTH && once->height == HEIGHT);
    CHECK(twice->width == 2 * WIDTH && twice->height == 2 * HEIGHT);
    for (int y = 0; y < HEIGHT; y++)
        for (int i = 3 * LEFT; i < 3 * WIDTH; i++) {
            const int x = i / 3, c = i % 3;
            double four = 0;
            for (int k = 0; k < 4; k++)
                four +=
                    (double)twice->pixels[3 * ((2 * y + k / 2) * 2 * WIDTH + 2 * x + k % 2) + c];
            sum += fabs((double)once->pixels[3 * (y * WIDTH + x) + c] - 0.25 * four);
        }
    return sum / (3.0 * (WIDTH - LEFT) * HEIGHT);
}

static void shoot_tabs(const char *prefix, const char *const *tabs, int count, const char *words)
{
    char script[2048] = "settle\n";
    for (int i = 0; i < count; i++) {
        const size_t used = strlen(script);
        snprintf(script + used, sizeof script - used, "tab %s\nscreenshot %s-%s.png\n", tabs[i],
                 prefix, tabs[i]);
    }
    view(words, script);
}

// Text and elements of half the size, or rows that overlap, differ by more.
TEST(the_interface_has_the_size_of_the_display)
{
    static const char *const tabs[] = { "View", "Light", "Method", "Compare", "Cost", "Inspect" };
    enum { TABS = sizeof tabs / sizeof *tabs };
    require_display_of(192);
    shoot_tabs("dense", tabs, TABS,
               "view @cornell:light=point --quiet --size 640x480 --scale 0.1 --gi lpv:dim=8");
    require_display();
    shoot_tabs("usual", tabs, TABS,
               "view @cornell:light=point --quiet --size 640x480 --scale 0.2 --gi lpv:dim=8");
    for (int i = 0; i < TABS; i++) {
        struct image usual = read_window("usual", tabs[i]), dense = read_window("dense", tabs[i]);
        const double difference = panel_difference(&usual, &dense);
        image_finish(&usual, test_host());
        image_finish(&dense, test_host());
        printf("%s: %.4f\n", tabs[i], difference);
        if (difference > MOST_DIFFERENCE) fail_msg("%s differs by %.4f", tabs[i], difference);
    }
}

TEST(random_events_end_without_a_message)
{
    require_display();
    view("view @cornell:light=point --quiet --size 640x480 --scale 0.25 --gi lpv:dim=16",
         "settle\nrandom 3 120\nwait 2\n");
}
