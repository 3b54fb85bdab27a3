// view with each technique, options at both ends of their ranges: no message of the validation
// layers, and the first method has its image and its bytes on the device again.
// AFTERGLOW_TEST_VIEW_TECHNIQUES=lpv,radiosity tests each option of these alone, with bakes.
#include "cli/view/cheap_bakes.h"
#include "cli/view/view_run.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCRIPT_SIZE = 262144, SPEC_SIZE = 4096, VALUE_SIZE = 64 };
#define MAX_BYTES 60000000u

// Two values that exclude each other are an error only on a device, or in a bake.
static bool excluded(const char *gi)
{
    if (strstr(gi, "prior_modes=8,") && strstr(gi, ",modes=64")) return true;
    const char *levels = strstr(gi, "levels=");
    return levels && levels[7] != '1' && strstr(gi, "storage=svo");
}

static bool fits(struct ag_context *context, const char *gi)
{
    struct ag_renderer_desc desc;
    uint64_t bytes;
    ag_renderer_desc_default(&desc);
    desc.width = 96;
    desc.height = 96;
    desc.gi = gi;
    if (excluded(gi)) return false;
    return ag_renderer_estimate_memory(context, &desc, 1, &bytes) == AG_OK && bytes <= MAX_BYTES;
}

// The least (0) or greatest (1) value; false: a text.
static bool extreme(const struct ag_option_info *option, int which, char out[VALUE_SIZE])
{
    if (strcmp(option->type, "text") == 0) return false;
    if (strcmp(option->type, "bool") == 0)
        snprintf(out, VALUE_SIZE, "%s", which ? "true" : "false");
    else if (strcmp(option->type, "choice") == 0 && which)
        snprintf(out, VALUE_SIZE, "%s",
                 strrchr(option->unit, '|') ? strrchr(option->unit, '|') + 1 : option->unit);
    else if (strcmp(option->type, "choice") == 0)
        snprintf(out, VALUE_SIZE, "%.*s", (int)strcspn(option->unit, "|"), option->unit);
    else
        snprintf(out, VALUE_SIZE, "%.9g", which ? option->max : option->min);
    return true;
}

static void add_method_for(char script[SCRIPT_SIZE], const char *gi, const char *wait)
{
    const size_t used = strlen(script);
    const int wrote = snprintf(script + used, SCRIPT_SIZE - used, "gi %s\n%s\n", gi, wait);
    if (wrote < 0 || used + (size_t)wrote >= SCRIPT_SIZE) fail_msg("the script is too long");
}

static void add_method(char script[SCRIPT_SIZE], const char *gi)
{
    add_method_for(script, gi, "wait 1");
}

// Each option alone, then as it was.
static void add_each_option(char script[SCRIPT_SIZE], struct ag_context *context, int technique,
                            const char *start)
{
    struct ag_option_info option;
    for (int k = 0; ag_technique_option_get(technique, k, &option); k++)
        for (int which = 0; which < 2; which++) {
            char gi[SPEC_SIZE], value[VALUE_SIZE];
            if (!extreme(&option, which, value)) continue;
            snprintf(gi, sizeof gi, "%s:%s=%s", start, option.name, value);
            if (!fits(context, gi)) continue;
            add_method(script, gi);
            add_method(script, start);
        }
}

// All options at once, apart from those that would take too much memory.
static void add_extremes(char script[SCRIPT_SIZE], struct ag_context *context, int technique,
                         const char *start, int which)
{
    struct ag_option_info option;
    char gi[SPEC_SIZE];
    snprintf(gi, sizeof gi, "%s", start);
    for (int k = 0; ag_technique_option_get(technique, k, &option); k++) {
        char value[VALUE_SIZE];
        const size_t used = strlen(gi);
        if (!extreme(&option, which, value)) continue;
        snprintf(gi + used, sizeof gi - used, "%c%s=%s", strchr(gi, ':') ? ',' : ':', option.name,
                 value);
        if (!fits(context, gi)) gi[used] = 0;
    }
    add_method(script, gi);
}

static bool is_listed(const char *list, const char *name)
{
    const size_t length = strlen(name);
    for (; list; list = strchr(list, ',') ? strchr(list, ',') + 1 : NULL)
        if (strncmp(list, name, length) == 0 && strchr(",", list[length])) return true;
    return false;
}

static void add_technique(char script[SCRIPT_SIZE], struct ag_context *context, int technique,
                          const struct ag_technique_info *info)
{
    char start[VALUE_SIZE];
    const bool source = strcmp(info->role, "source") == 0;
    snprintf(start, sizeof start, "%s%s", source ? "" : "ambient+", info->name);
    add_method(script, start);
    for (int which = 0; which < 2; which++) add_extremes(script, context, technique, start, which);
    if (is_listed(getenv("AFTERGLOW_TEST_VIEW_TECHNIQUES"), info->name))
        add_each_option(script, context, technique, start);
}

static void check_bytes(void)
{
    json_t *a = json_load_file("first.json", 0, NULL), *b = json_load_file("last.json", 0, NULL);
    assert_true(a && b);
    json_t *before = json_object_get(a, "owners"), *after = json_object_get(b, "owners");
    json_object_del(before, "gpu"); // its buffers for transfers stay as large as they were needed
    json_object_del(after, "gpu");
    char *text = json_dumps(after, 0), *expected = json_dumps(before, 0);
    if (!json_equal(before, after)) fail_msg("bytes on the device: %s, not %s", text, expected);
    free(text);
    free(expected);
    json_decref(a);
    json_decref(b);
}

TEST(methods_with_extreme_options_leave_the_first_as_it_was)
{
    static char script[SCRIPT_SIZE];
    struct ag_technique_info info;
    struct ag_context *context = NULL;
    require_display();
    CHECK(ag_context_create(NULL, &context) == AG_OK);
    snprintf(script, sizeof script, "settle\nsave first.png\nmemory first.json\n");
    for (int i = 0; ag_technique_get(i, &info); i++)
        if (!info.needs_bake) add_technique(script, context, i, &info);
    ag_context_destroy(context);
    add_method(script, "lpv:dim=16");
    snprintf(script + strlen(script), SCRIPT_SIZE - strlen(script),
             "settle\nsave last.png\nmemory last.json\n");
    view(CORNELL " --size 640x240 --scale 0.12 --gi lpv:dim=16", script);
    check_equal("first.png", "last.png");
    check_bytes();
}

// ---- with bakes

static const char *const before_names = ",:";

// The spec with the option set in its last technique.
static void set_option(const char *spec, const char *name, const char *value, char out[SPEC_SIZE])
{
    char token[VALUE_SIZE];
    snprintf(token, sizeof token, "%s=", name);
    const char *at = strstr(spec, token);
    while (at && !strchr(before_names, at[-1])) at = strstr(at + 1, token);
    const int length = at ? (int)(at - spec) : (int)strlen(spec);
    const char *rest = at ? at + strcspn(at, ",") : "";
    const int wrote =
        snprintf(out, SPEC_SIZE, "%.*s%s%s%s%s", length, spec, at ? "" : ",", token, value, rest);
    if (wrote < 0 || wrote >= SPEC_SIZE) fail_msg("the spec is too long");
}

enum cost { COST_NONE, COST_MOMENTS, COST_LONG, COST_TOO_LARGE, COSTS };

static bool estimate(struct ag_scene *scene, const char *gi, struct ag_bake_estimate *out,
                     struct ag_bake_info *info)
{
    struct ag_bake *bake = NULL;
    const bool done = ag_bake_create(scene, gi, NULL, &bake) == AG_OK &&
                      ag_bake_get_info(bake, info) == AG_OK &&
                      ag_bake_estimate_cost(bake, false, out) == AG_OK;
    ag_bake_destroy(bake);
    return done;
}

// None: it has the key of the first bake. Moments: it takes at most twice as many rays.
static enum cost cost_of(struct ag_scene *scene, const char *gi, const char *start)
{
    static const double least_rays = 5e6;
    static const uint64_t most_bytes = 400000000u;
    struct ag_bake_estimate first = { 0 }, other = { 0 };
    struct ag_bake_info first_info = { 0 }, info = { 0 };
    CHECK(estimate(scene, start, &first, &first_info));
    if (!estimate(scene, gi, &other, &info) || other.peak_memory_bytes > most_bytes ||
        other.file_bytes > most_bytes)
        return COST_TOO_LARGE;
    if (strcmp(first_info.key, info.key) == 0) return COST_NONE;
    return other.rays > fmax(least_rays, 2.0 * first.rays) ? COST_LONG : COST_MOMENTS;
}

// A bake that would take long begins, and ends with the next method.
static void add_each_bake(char script[SCRIPT_SIZE], struct ag_context *context,
                          struct ag_scene *scene, int technique, const char *start)
{
    static const char *const waits[COSTS] = { "wait 1", "settle 900\nsays is shown", "wait 3",
                                              NULL };
    struct ag_option_info option;
    int counts[COSTS] = { 0 };
    for (int k = 0; ag_technique_option_get(technique, k, &option); k++)
        for (int which = 0; which < 2; which++) {
            char gi[SPEC_SIZE], value[VALUE_SIZE];
            if (!extreme(&option, which, value)) continue;
            set_option(start, option.name, value, gi);
            enum cost cost = fits(context, gi) ? COST_NONE : COST_TOO_LARGE;
            if (cost == COST_NONE && strcmp(option.effect, "rebake") == 0)
                cost = cost_of(scene, gi, start);
            counts[cost]++;
            if (cost == COST_TOO_LARGE) continue;
            add_method_for(script, gi, waits[cost]);
            add_method_for(script, start, "wait 2");
        }
    printf("%s: %d values with the same bake, %d baked, %d begun, %d too large\n", start,
           counts[COST_NONE], counts[COST_MOMENTS], counts[COST_LONG], counts[COST_TOO_LARGE]);
}

static void run_bakes(int technique, const struct ag_technique_info *info)
{
    static char script[SCRIPT_SIZE];
    char start[SPEC_SIZE];
    struct ag_context *context = NULL;
    struct ag_scene *scene = NULL;
    const bool source = strcmp(info->role, "source") == 0; // others change the light of probes
    snprintf(start, sizeof start, "%s%s:%s", source ? "" : "lpv:dim=8,cascades=1+", info->name,
             cheap_bake(info->name));
    CHECK(ag_context_create(NULL, &context) == AG_OK);
    CHECK(ag_scene_load(context, "@cornell:light=point", &scene) == AG_OK);
    snprintf(script, sizeof script, "settle\nsave first.png\nmemory first.json\n");
    add_method_for(script, start, "settle\nsave start.png");
    add_each_bake(script, context, scene, technique, start);
    add_method_for(script, start, "settle\nsave again.png");
    add_method_for(script, "lpv:dim=16", "settle\nsave last.png\nmemory last.json");
    ag_scene_destroy(scene);
    ag_context_destroy(context);
    view(CORNELL " --size 640x240 --scale 0.12 --gi lpv:dim=16", script);
    check_equal("start.png", "again.png");
    check_equal("first.png", "last.png");
    check_bytes();
}

TEST(options_of_bakes_leave_the_first_method_as_it_was)
{
    struct ag_technique_info info;
    int count = 0;
    require_display();
    for (int i = 0; ag_technique_get(i, &info); i++) {
        if (!info.needs_bake || !is_listed(getenv("AFTERGLOW_TEST_VIEW_TECHNIQUES"), info.name))
            continue;
        run_bakes(i, &info);
        count++;
    }
    if (count == 0) test_skip("AFTERGLOW_TEST_VIEW_TECHNIQUES names no technique with a bake");
}

// A method without a bake is chosen while another one's bake runs.
TEST(the_method_that_was_chosen_last_is_shown)
{
    require_display();
    view(CORNELL " --size 640x240 --scale 0.12 --gi none",
         "settle\nsave first.png\ngi radiosity:texels=2048,rays=64\nwait 1\ngi none\nsettle\n"
         "save last.png\n");
    check_equal("first.png", "last.png");
}

TEST(the_command_of_a_method_renders_its_image)
{
    require_display();
    check_command("view @atrium --quiet --gi vct:resolution=32,temporal=false+vo" LEAST,
                  "look 2,3,1 -4,1,0\n");
    check_command(CORNELL " --gi vct:resolution=16,temporal=false --size 700x790 --scale 0.1",
                  "tab Method\nclick debug view\nwait 2\nclick radiance\nwait 2\n"
                  "gi vct:resolution=32,temporal=false\n");
}
