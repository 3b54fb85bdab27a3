// Compares techniques with the path-traced reference: reads a .case file (format: README.md), runs
// `afterglow compare`, and checks and prints every expectation.
#include "cli/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_METHODS = 8, MAX_EXPECTATIONS = 16, LINE_SIZE = 512 };

struct quality_case {
    char scene[LINE_SIZE], options[LINE_SIZE], why[LINE_SIZE];
    char methods[MAX_METHODS][LINE_SIZE];
    int method_count;
    char expectations[MAX_EXPECTATIONS][LINE_SIZE];
    int expectation_count;
};

// ---- parsing

static void set_once(char *out, const char *key, const char *value)
{
    if (out[0]) fail_msg("the case has more than one line \"%s\"", key);
    snprintf(out, LINE_SIZE, "%s", value);
}

static void add(char list[][LINE_SIZE], int *count, int capacity, const char *key,
                const char *value)
{
    if (*count == capacity) fail_msg("the case has more than %d lines \"%s\"", capacity, key);
    snprintf(list[(*count)++], LINE_SIZE, "%s", value);
}

static void read_line(struct quality_case *c, const char *key, const char *value)
{
    if (strcmp(key, "scene") == 0)
        set_once(c->scene, key, value);
    else if (strcmp(key, "options") == 0)
        set_once(c->options, key, value);
    else if (strcmp(key, "gi") == 0)
        add(c->methods, &c->method_count, MAX_METHODS, key, value);
    else if (strcmp(key, "expect") == 0)
        add(c->expectations, &c->expectation_count, MAX_EXPECTATIONS, key, value);
    else if (strcmp(key, "why") == 0) {
        size_t length = strlen(c->why);
        snprintf(c->why + length, sizeof c->why - length, "%s ", value);
    } else
        fail_msg("the case has an unknown line \"%s\"", key);
}

static struct quality_case read_case(const char *path)
{
    struct quality_case c = { 0 };
    char line[LINE_SIZE];
    FILE *file = fopen(path, "r");
    if (!file) fail_msg("cannot read %s", path);
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "#\n")] = 0;
        char *key = line + strspn(line, " ");
        if (!key[0]) continue;
        char *value = key + strcspn(key, " ");
        if (value[0]) *value++ = 0;
        value += strspn(value, " ");
        for (size_t n = strlen(value); n > 0 && value[n - 1] == ' '; n--) value[n - 1] = 0;
        read_line(&c, key, value);
    }
    fclose(file);
    if (!c.scene[0] || !c.method_count || !c.expectation_count || !c.why[0])
        fail_msg("%s: a case needs scene, gi, expect and why", path);
    return c;
}

// ---- running

// A built-in scene ("@cornell") or a file of the scenes folder ("sponza.glb"), which may be absent.
static const char *scene_of(const struct quality_case *c)
{
    return c->scene[0] == '@' ? c->scene : test_scene_path(c->scene);
}

static json_t *compare(const struct quality_case *c)
{
    char command[16384];
    int length = snprintf(command, sizeof command, "compare %s --json %s", scene_of(c), c->options);
    for (int i = 0; i < c->method_count; i++)
        length +=
            snprintf(command + length, sizeof command - (size_t)length, " --gi %s", c->methods[i]);
    const struct run *run = run_expect(0, command, "-o", test_path("out"), NULL);
    if (strstr(run->err, "gpu validation")) fail_msg("%s", run->err);
    return run_json(run);
}

// ---- expectations

// A number, or a figure of the report: "indirect.relmse" of the first method, "none/flip" of a
// named method, "reference.noise" of the reference.
static double value_of(const struct quality_case *c, json_t *report, const char *term)
{
    char *end;
    double number = strtod(term, &end);
    if (end != term && !*end) return number;

    json_t *node = json_array_get(json_object_get(report, "methods"), 0);
    const char *path = term, *slash = strrchr(term, '/');
    if (strncmp(term, "reference.", 10) == 0) node = report;
    if (slash) {
        int i = 0;
        while (i < c->method_count && (strlen(c->methods[i]) != (size_t)(slash - term) ||
                                       strncmp(c->methods[i], term, (size_t)(slash - term)) != 0))
            i++;
        node = json_array_get(json_object_get(report, "methods"), (size_t)i);
        path = slash + 1;
    }
    char keys[LINE_SIZE], *rest = keys;
    snprintf(keys, sizeof keys, "%s", path);
    for (char *key; (key = strsep(&rest, "."));) node = json_object_get(node, key);
    if (!json_is_number(node)) fail_msg("the report has no number \"%s\"", term);
    return json_number_value(node);
}

static bool holds(double a, const char *relation, double b)
{
    if (strcmp(relation, "<") == 0) return a < b;
    if (strcmp(relation, "<=") == 0) return a <= b;
    if (strcmp(relation, ">=") == 0) return a >= b;
    if (strcmp(relation, ">") == 0) return a > b;
    fail_msg("an expectation compares with <, <=, >= or >, not \"%s\"", relation);
    return false;
}

static bool expect(const struct quality_case *c, json_t *report, const char *expectation)
{
    char left[LINE_SIZE], relation[LINE_SIZE], right[LINE_SIZE];
    if (sscanf(expectation, "%511s %511s %511s", left, relation, right) != 3)
        fail_msg("\"expect %s\" is not a term, a relation and a term", expectation);
    double a = value_of(c, report, left), b = value_of(c, report, right);
    bool ok = holds(a, relation, b);
    print_message("%s: %s is %.5g, expected %s %s (%.5g)\n", ok ? "holds" : "DOES NOT HOLD", left,
                  a, relation, right, b);
    return ok;
}

TEST(the_case_holds)
{
    const char *path = getenv("AFTERGLOW_QUALITY_CASE");
    if (!path) fail_msg("AFTERGLOW_QUALITY_CASE names no .case file");
    require_device();
    struct quality_case c = read_case(path);
    json_t *report = compare(&c);
    int broken = 0;
    for (int i = 0; i < c.expectation_count; i++) broken += !expect(&c, report, c.expectations[i]);
    json_decref(report);
    if (broken)
        fail_msg("%d of %d expectations do not hold; the bounds were set because: %s", broken,
                 c.expectation_count, c.why);
}
