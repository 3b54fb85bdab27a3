#include "framework/test.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { MAX_TESTS = 512, MAX_PATHS = 16, MAX_ENDS = 4, OUTCOMES = 4 };

enum outcome { NOT_RUN, PASSED, FAILED, SKIPPED };

static struct test_case {
    const char *file;
    test_function function;
    enum outcome outcome;
    const char *reason; // of a skipped case
} cases[MAX_TESTS], *current;

static struct CMUnitTest tests[MAX_TESTS];
static size_t test_count;
static bool (*ends[MAX_ENDS])(void);
static size_t end_count;
static char folder[256];
static char last_message[1024];

// A case that fails or is skipped does not return.
static void run_case(void **state)
{
    current = *state;
    current->outcome = FAILED;
    current->function(state);
    current->outcome = PASSED;
}

void test_register(const char *file, const char *name, test_function function)
{
    if (test_count == MAX_TESTS) {
        fprintf(stderr, "more than %d tests in one program\n", MAX_TESTS);
        abort();
    }
    struct test_case *added = &cases[test_count];
    added->file = file;
    added->function = function;
    tests[test_count++] =
        (struct CMUnitTest){ .name = name, .test_func = run_case, .initial_state = added };
}

void test_register_end(bool (*check)(void))
{
    if (end_count == MAX_ENDS) abort();
    ends[end_count++] = check;
}

void test_skip(const char *reason)
{
    print_message("skipped: %s\n", reason);
    current->outcome = SKIPPED;
    current->reason = reason;
    _skip(__FILE__, __LINE__);
    abort();
}

void test_use_decimal_comma(void)
{
    static const char *const names[] = { "de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE" };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (setlocale(LC_ALL, names[i])) return;
    test_skip("no locale with a decimal comma");
}

double test_time_factor(void)
{
    const char *given = getenv("AFTERGLOW_TEST_TIME_FACTOR");
    return given ? fmax(1.0, atof(given)) : 1.0;
}

void test_pause_ms(double ms)
{
    const double s = floor(1e-3 * ms);
    nanosleep(&(struct timespec){ .tv_sec = (time_t)s, .tv_nsec = (long)(1e6 * ms - 1e9 * s) },
              NULL);
}

void test_near(double a, double b, double tolerance, const char *a_text, const char *b_text,
               const char *file, int line)
{
    if (fabs(a - b) <= tolerance || a == b) return;
    print_error("%s:%d: %s = %.9g, %s = %.9g, difference %.3g > %.3g\n", file, line, a_text, a,
                b_text, b, fabs(a - b), tolerance);
    _fail(file, line);
}

void test_relative(double a, double b, double tolerance, const char *a_text, const char *b_text,
                   const char *file, int line)
{
    test_near(a, b, tolerance * fmax(fabs(a), fabs(b)), a_text, b_text, file, line);
}

void test_check(bool condition, const char *text, const char *file, int line)
{
    if (condition) return;
    print_error("%s:%d: check failed: %s (last message: %s)\n", file, line, text, last_message);
    _fail(file, line);
}

static void remember(void *user, enum log_level level, const char *message)
{
    (void)user;
    if (level <= LOG_WARNING) snprintf(last_message, sizeof last_message, "%s", message);
    if (getenv("AFTERGLOW_TEST_VERBOSE")) fprintf(stderr, "[log %d] %s\n", (int)level, message);
}

const char *test_importer(void)
{
    const char *given = getenv("AFTERGLOW_IMPORTER");
    return given ? given : AFTERGLOW_IMPORTER_DEFAULT;
}

struct host *test_host(void)
{
    static struct host host;
    if (!host.log) {
        host = host_default();
        host.log = remember;
        host.log_up_to = getenv("AFTERGLOW_TEST_VERBOSE") ? LOG_DEBUG : LOG_WARNING;
        host.importer = test_importer();
    }
    return &host;
}

const char *test_last_message(void)
{
    return last_message;
}

void test_forget_messages(void)
{
    last_message[0] = 0;
}

static void remove_folder(void)
{
    char command[300];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    if (system(command) != 0) fprintf(stderr, "could not remove %s\n", folder);
}

const char *test_path(const char *name)
{
    static char paths[MAX_PATHS][512];
    static int next;
    if (!folder[0]) {
        const char *base = getenv("TMPDIR");
        snprintf(folder, sizeof folder, "%s/afterglow-test-XXXXXX", base ? base : "/tmp");
        if (!mkdtemp(folder)) fail_msg("cannot make %s", folder);
        atexit(remove_folder);
    }
    char *path = paths[next++ % MAX_PATHS];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

const char *test_bake_path(const char *key)
{
    static char paths[MAX_PATHS][512];
    static int next;
    const char *shared = getenv("AFTERGLOW_TEST_BAKES");
    if (!shared || !shared[0]) return test_path(key);
    char *path = paths[next++ % MAX_PATHS];
    snprintf(path, sizeof paths[0], "%s/%s", shared, key);
    return path;
}

const char *test_scene_path(const char *name)
{
    static char paths[MAX_PATHS][512];
    static int next;
    const char *base = getenv("AFTERGLOW_SCENES");
    if (!base) base = AFTERGLOW_SCENES_DEFAULT;
    char *path = paths[next++ % MAX_PATHS];
    snprintf(path, sizeof paths[0], "%s/%s", base, name);
    if (access(path, R_OK) != 0) {
        print_message("no %s (AFTERGLOW_SCENES names the folder of test scenes)\n", path);
        test_skip("test scene missing");
    }
    return path;
}

// " (reason: 2, reason: 1)"
static void print_reasons(void)
{
    const char *before = " (";
    for (size_t i = 0; i < test_count; i++) {
        int count = 0;
        if (cases[i].outcome != SKIPPED) continue;
        for (size_t j = i; j < test_count; j++) {
            if (cases[j].outcome != SKIPPED || strcmp(cases[j].reason, cases[i].reason) != 0)
                continue;
            count++;
            if (j > i) cases[j].outcome = NOT_RUN;
        }
        printf("%s%s: %d", before, cases[i].reason, count);
        before = ", ";
    }
    if (before[0] == ',') printf(")");
}

// tools/test_totals adds up these lines.
static void print_outcomes(int failed_ends)
{
    int count[OUTCOMES] = { 0 };
    for (size_t i = 0; i < test_count; i++) count[cases[i].outcome]++;
    printf("cases: %d passed, %d failed, %d skipped", count[PASSED], count[FAILED] + failed_ends,
           count[SKIPPED]);
    print_reasons();
    printf("\n");
}

static bool is_of(const struct test_case *c, const char *name)
{
    const char *slash = strrchr(c->file, '/'), *base = slash ? slash + 1 : c->file;
    const size_t length = strlen(name), prefix = strlen("test_");
    return strncmp(base, "test_", prefix) == 0 && strncmp(base + prefix, name, length) == 0 &&
           base[prefix + length] == '.';
}

// Keeps the tests of test_<name>.c alone. False, with a message: there are none.
static bool keep_file(const char *name)
{
    size_t kept = 0;
    for (size_t i = 0; i < test_count; i++) {
        if (!is_of(&cases[i], name)) continue;
        cases[kept] = cases[i];
        tests[kept] = tests[i];
        tests[kept].initial_state = &cases[kept];
        kept++;
    }
    if (kept == 0) fprintf(stderr, "this program has no test_%s.c with tests\n", name);
    test_count = kept;
    return kept > 0;
}

int main(int argc, char **argv)
{
    if (argc > 1 && !keep_file(argv[1])) return EXIT_FAILURE;
    if (argc > 2) cmocka_set_test_filter(argv[2]);
    int failures = _cmocka_run_group_tests("tests", tests, test_count, NULL, NULL), failed_ends = 0;
    for (size_t i = 0; i < end_count; i++) failed_ends += !ends[i]();
    print_outcomes(failed_ends);
    return failures + failed_ends;
}
