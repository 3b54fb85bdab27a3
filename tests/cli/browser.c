#include "cli/browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { COMMAND_FD = 3, ANSWER_FD = 4, HIGH_FD = 16 }; // the first two are Chromium's choice
static const double PATIENCE_S = 60.0;                // for one answer, on an idle machine

struct browser {
    pid_t process;
    int commands, answers;
    char *pending; // bytes of messages that are not whole yet
    size_t size, capacity;
    int last_id;
    char session[128];
    char complaints[8192];
};

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double patience_s(void)
{
    return PATIENCE_S * test_time_factor();
}

// ---- the process

static const char *find_chromium(void)
{
    static const char *const names[] = { "chromium", "chromium-browser", "google-chrome" };
    static char path[1024];
    const char *given = getenv("AFTERGLOW_CHROMIUM"), *folders = getenv("PATH");
    if (given) return given[0] ? given : NULL;
    for (const char *folder = folders; folder && *folder; folder += strspn(folder, ":")) {
        int length = (int)strcspn(folder, ":");
        for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
            snprintf(path, sizeof path, "%.*s/%s", length, folder, names[i]);
            if (access(path, X_OK) == 0) return path;
        }
        folder += length;
    }
    return NULL;
}

static void become_chromium(const char *path, const char *profile, int commands, int answers)
{
    char profile_option[600];
    snprintf(profile_option, sizeof profile_option, "--user-data-dir=%s", profile);
    int nothing = open("/dev/null", O_RDWR);
    for (int fd = 0; fd < 3; fd++) dup2(nothing, fd);
    if (dup2(commands, COMMAND_FD) < 0 || dup2(answers, ANSWER_FD) < 0) _exit(126);
    execl(path, path, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
          "--no-first-run", "--disable-background-networking", "--disable-dev-shm-usage",
          "--force-prefers-reduced-motion", "--remote-debugging-pipe", profile_option,
          "about:blank", (char *)NULL);
    _exit(127);
}

// A pipe with descriptors above those that have a meaning for the browser.
static void open_pipe(int ends[2])
{
    int low[2];
    assert_int_equal(pipe(low), 0);
    for (int i = 0; i < 2; i++) {
        ends[i] = fcntl(low[i], F_DUPFD_CLOEXEC, HIGH_FD);
        assert_true(ends[i] >= 0);
        close(low[i]);
    }
}

static void start(struct browser *browser, const char *path)
{
    int to[2], from[2];
    char profile[512];
    snprintf(profile, sizeof profile, "%s", test_path("browser"));
    open_pipe(to);
    open_pipe(from);
    signal(SIGPIPE, SIG_IGN); // a browser that ended is an answer that does not come
    browser->process = fork();
    assert_true(browser->process >= 0);
    if (browser->process == 0) become_chromium(path, profile, to[0], from[1]);
    close(to[0]);
    close(from[1]);
    browser->commands = to[1];
    browser->answers = from[0];
}

// ---- messages: JSON, each ended by a zero byte

static void complain(struct browser *browser, const char *what, const json_t *params)
{
    size_t used = strlen(browser->complaints);
    char *text = json_dumps(params, JSON_COMPACT);
    snprintf(browser->complaints + used, sizeof browser->complaints - used, "%s: %s\n", what,
             text ? text : "");
    free(text);
}

static void note_event(struct browser *browser, const json_t *message)
{
    const char *method = json_string_value(json_object_get(message, "method"));
    const json_t *params = json_object_get(message, "params");
    if (!method) return;
    if (strcmp(method, "Runtime.exceptionThrown") == 0) complain(browser, "exception", params);
    if (strcmp(method, "Runtime.consoleAPICalled") == 0) complain(browser, "console", params);
    if (strcmp(method, "Log.entryAdded") == 0) complain(browser, "log", params);
    if (strcmp(method, "Network.requestWillBeSent") == 0) {
        const char *url =
            json_string_value(json_object_get(json_object_get(params, "request"), "url"));
        bool own = url && (strncmp(url, "data:", 5) == 0 ||
                           (strncmp(url, "file:", 5) == 0 && strstr(url, "/report.html")));
        if (!own) complain(browser, "request", params);
    }
}

// The next complete message; NULL if there is none yet.
static json_t *take_message(struct browser *browser)
{
    char *end = browser->size ? memchr(browser->pending, 0, browser->size) : NULL;
    if (!end) return NULL;
    json_t *message = json_loads(browser->pending, 0, NULL);
    size_t used = (size_t)(end + 1 - browser->pending);
    memmove(browser->pending, end + 1, browser->size - used);
    browser->size -= used;
    return message;
}

static void receive(struct browser *browser, double deadline_s)
{
    struct pollfd wait = { .fd = browser->answers, .events = POLLIN };
    int left_ms = (int)(1000.0 * (deadline_s - now_s()));
    if (left_ms <= 0 || poll(&wait, 1, left_ms) <= 0)
        fail_msg("the browser did not answer in %g s", patience_s());
    if (browser->capacity - browser->size < 65536) {
        browser->capacity = 2 * browser->capacity + 65536;
        browser->pending = realloc(browser->pending, browser->capacity);
        assert_non_null(browser->pending);
    }
    ssize_t got =
        read(browser->answers, browser->pending + browser->size, browser->capacity - browser->size);
    if (got <= 0) fail_msg("the browser ended");
    browser->size += (size_t)got;
}

static void send_all(int fd, const char *bytes, size_t size)
{
    for (size_t sent = 0; sent < size;) {
        ssize_t wrote = write(fd, bytes + sent, size - sent);
        if (wrote <= 0) fail_msg("the browser takes no commands");
        sent += (size_t)wrote;
    }
}

// Takes ownership of params; the caller releases the result.
static json_t *call(struct browser *browser, const char *method, json_t *params)
{
    int id = ++browser->last_id;
    json_t *command = json_pack("{s:i, s:s, s:o}", "id", id, "method", method, "params", params);
    if (browser->session[0])
        json_object_set_new(command, "sessionId", json_string(browser->session));
    char *text = json_dumps(command, JSON_COMPACT);
    assert_non_null(text);
    send_all(browser->commands, text, strlen(text) + 1);
    free(text);
    json_decref(command);
    double deadline_s = now_s() + patience_s();
    for (;;) {
        json_t *message = take_message(browser);
        if (!message) {
            receive(browser, deadline_s);
            continue;
        }
        note_event(browser, message);
        if (json_integer_value(json_object_get(message, "id")) == id) {
            json_t *error = json_object_get(message, "error"),
                   *result = json_incref(json_object_get(message, "result"));
            if (error)
                fail_msg("%s: %s", method, json_string_value(json_object_get(error, "message")));
            json_decref(message);
            return result;
        }
        json_decref(message);
    }
}

static void command(struct browser *browser, const char *method, json_t *params)
{
    json_decref(call(browser, method, params));
}

// ---- pages

static void attach(struct browser *browser)
{
    json_t *targets = call(browser, "Target.getTargets", json_object()), *target;
    const char *page = NULL;
    size_t i;
    json_array_foreach(json_object_get(targets, "targetInfos"), i, target)
    {
        const char *type = json_string_value(json_object_get(target, "type"));
        if (type && strcmp(type, "page") == 0)
            page = json_string_value(json_object_get(target, "targetId"));
    }
    if (!page) fail_msg("the browser has no page");
    json_t *session = call(browser, "Target.attachToTarget",
                           json_pack("{s:s, s:b}", "targetId", page, "flatten", 1));
    const char *id = json_string_value(json_object_get(session, "sessionId"));
    snprintf(browser->session, sizeof browser->session, "%s", id ? id : "");
    json_decref(session);
    json_decref(targets);
}

struct browser *browser_open(void)
{
    const char *path = find_chromium();
    if (!path) test_skip("no Chromium");
    struct browser *browser = calloc(1, sizeof *browser);
    assert_non_null(browser);
    start(browser, path);
    attach(browser);
    static const char *const domains[] = { "Runtime.enable", "Log.enable", "Network.enable",
                                           "Page.enable" };
    for (size_t i = 0; i < sizeof domains / sizeof *domains; i++)
        command(browser, domains[i], json_object());
    return browser;
}

void browser_close(struct browser *browser)
{
    browser->session[0] = 0;
    command(browser, "Browser.close", json_object());
    double deadline_s = now_s() + 10.0 * test_time_factor();
    while (waitpid(browser->process, NULL, WNOHANG) == 0) {
        if (now_s() > deadline_s) kill(browser->process, SIGKILL);
        usleep(10000);
    }
    close(browser->commands);
    close(browser->answers);
    free(browser->pending);
    free(browser);
}

void browser_load(struct browser *browser, const char *path, int width, int height)
{
    char url[1024];
    browser->complaints[0] = 0;
    snprintf(url, sizeof url, "file://%s", path);
    command(browser, "Emulation.setDeviceMetricsOverride",
            json_pack("{s:i, s:i, s:i, s:b}", "width", width, "height", height, "deviceScaleFactor",
                      1, "mobile", 0));
    command(browser, "Page.navigate", json_pack("{s:s}", "url", url));
    double deadline_s = now_s() + patience_s();
    while (!browser_true(browser,
                         "location.protocol === 'file:' && document.readyState === 'complete'")) {
        if (now_s() > deadline_s) fail_msg("%s was not loaded in %g s", path, patience_s());
        usleep(20000);
    }
}

static json_t *evaluate(struct browser *browser, const char *format, va_list arguments)
{
    char expression[4096];
    CHECK(vsnprintf(expression, sizeof expression, format, arguments) < (int)sizeof expression);
    json_t *answer = call(browser, "Runtime.evaluate",
                          json_pack("{s:s, s:b, s:b}", "expression", expression, "returnByValue", 1,
                                    "awaitPromise", 1));
    if (json_object_get(answer, "exceptionDetails")) fail_msg("%s: an exception", expression);
    json_t *value = json_incref(json_object_get(json_object_get(answer, "result"), "value"));
    json_decref(answer);
    return value;
}

json_t *browser_value(struct browser *browser, const char *expression, ...)
{
    va_list arguments;
    va_start(arguments, expression);
    json_t *value = evaluate(browser, expression, arguments);
    va_end(arguments);
    return value;
}

double browser_number(struct browser *browser, const char *expression, ...)
{
    va_list arguments;
    va_start(arguments, expression);
    json_t *value = evaluate(browser, expression, arguments);
    va_end(arguments);
    if (!json_is_number(value)) fail_msg("%s: no number", expression);
    double number = json_number_value(value);
    json_decref(value);
    return number;
}

bool browser_true(struct browser *browser, const char *expression, ...)
{
    va_list arguments;
    va_start(arguments, expression);
    json_t *value = evaluate(browser, expression, arguments);
    va_end(arguments);
    bool is = json_is_true(value);
    json_decref(value);
    return is;
}

// ---- input

void browser_mouse(struct browser *browser, const char *type, double x, double y, int clicks)
{
    command(browser, "Input.dispatchMouseEvent",
            json_pack("{s:s, s:f, s:f, s:s, s:i, s:i}", "type", type, "x", x, "y", y, "button",
                      clicks ? "left" : "none", "buttons",
                      clicks && strcmp(type, "mouseReleased") != 0, "clickCount", clicks));
}

void browser_wheel(struct browser *browser, double x, double y, double delta)
{
    command(browser, "Input.dispatchMouseEvent",
            json_pack("{s:s, s:f, s:f, s:f, s:f}", "type", "mouseWheel", "x", x, "y", y, "deltaX",
                      0.0, "deltaY", delta));
}

void browser_key(struct browser *browser, const char *key, int code)
{
    static const char *const types[] = { "keyDown", "keyUp" };
    for (int i = 0; i < 2; i++)
        command(browser, "Input.dispatchKeyEvent",
                json_pack("{s:s, s:s, s:s, s:i}", "type", types[i], "key", key, "code", key,
                          "windowsVirtualKeyCode", code));
}

void browser_dark(struct browser *browser, bool dark)
{
    command(browser, "Emulation.setEmulatedMedia",
            json_pack("{s:[{s:s, s:s}]}", "features", "name", "prefers-color-scheme", "value",
                      dark ? "dark" : "light"));
}

const char *browser_complaints(const struct browser *browser)
{
    return browser->complaints;
}
