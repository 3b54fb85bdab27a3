// view under random scripts: no validation message, no crash, no leak; the first view is back at
// the end, with as many bytes on the device. AFTERGLOW_TEST_VIEW_RANDOM=SECONDS[,SEED[,SCENE]]:
// longer scripts for that time, from that seed on; a script that fails is kept in the folder in
// which the test began.
#include "cli/view/view_random.h"
#include "cli/view/window.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum {
    SHORT_SCRIPT = 30,
    ROUND_SCRIPT = 16,
    LONG_SCRIPT = 60,
    ROUNDS = 7,
    FIRST_ROUNDS = 2,
    GROWTH_ROUNDS = ROUNDS - 2 - FIRST_ROUNDS,
    MOST_RESIDENT = 1000000, // bytes a round, less than an image of the window in floats
    MOST_KEPT = 100000       // a round's steps of undo are 280 kB
};
#define FIRST  "lpv:dim=8,cascades=1"
#define WINDOW " --quiet --size 480x320 --scale 0.1 --gi " FIRST " --script random.txt"

// With the address sanitizer freed memory stays with the process for a while.
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
static const bool sanitized = true;
#else
static const bool sanitized = false;
#endif

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void copy_text(const char *from, const char *to)
{
    FILE *in = fopen(from, "r"), *out = fopen(to, "w");
    for (int c; in && out && (c = fgetc(in)) != EOF;) fputc(c, out);
    if (in) fclose(in);
    if (out) fclose(out);
}

static json_int_t member_of(const char *path, const char *name)
{
    json_t *document = json_load_file(path, 0, NULL);
    if (!document) fail_msg("cannot read %s", path);
    const json_int_t value = json_integer_value(json_object_get(document, name));
    json_decref(document);
    return value;
}

static bool runs_silently(const char *words, const char **why)
{
    const struct run *r = run_program(words, NULL);
    *why = r->err[0] ? r->err : r->out[0] ? r->out : "ended by a signal";
    return r->status == 0 && !r->err[0] && !r->out[0];
}

static void run_script(const struct view_random *desc, const char *kept)
{
    char words[256];
    const char *why;
    FILE *out = fopen("random.txt", "w");
    if (!out) fail_msg("cannot write random.txt");
    fprintf(out, "settle\nsave first.png\nmemory first.json\n");
    view_random_write(desc, out);
    fprintf(out, "save last.png\nmemory last.json\n");
    fclose(out);
    snprintf(words, sizeof words, "view %.100s" WINDOW, desc->scene);
    const bool silent = runs_silently(words, &why);
    const bool equal = silent && files_are_equal("first.png", "last.png");
    const json_int_t before = silent ? member_of("first.json", "device_bytes") : 0;
    const json_int_t after = silent ? member_of("last.json", "device_bytes") : 0;
    if (silent && equal && before == after) return;
    copy_text("random.txt", kept);
    if (!silent) fail_msg("seed %u (%s): %s", (unsigned)desc->seed, kept, why);
    if (!equal) fail_msg("seed %u (%s): another image", (unsigned)desc->seed, kept);
    fail_msg("seed %u (%s): %lld bytes on the device, not %lld", (unsigned)desc->seed, kept,
             (long long)after, (long long)before);
}

TEST(random_scripts_are_silent_and_the_first_view_is_back_after_them)
{
    const char *mode = getenv("AFTERGLOW_TEST_VIEW_RANDOM");
    char folder[4096] = ".", kept[4200], scene[128] = "@cornell:light=point";
    double seconds = 0;
    unsigned seed = 1;
    if (!getcwd(folder, sizeof folder)) fail_msg("no current folder");
    if (mode) sscanf(mode, "%lf,%u,%127s", &seconds, &seed, scene);
    require_display();
    write_file("wrong.json", "{\"afterglow_session\": 1, \"gl\": 1}", 33);
    const double begin_s = now_s();
    do {
        const struct view_random desc = { .seed = seed,
                                          .lines = mode ? LONG_SCRIPT : SHORT_SCRIPT,
                                          .scene = scene,
                                          .gi = FIRST,
                                          .other_scene = "@maze" };
        if (mode) fprintf(stderr, "seed %u after %.0f s\n", seed, now_s() - begin_s);
        snprintf(kept, sizeof kept, "%s/view-random-%u.txt", folder, seed);
        run_script(&desc, kept);
        seed++;
    } while (now_s() - begin_s < seconds);
}

// ---- memory

static void write_round(FILE *out, int round, uint64_t seed)
{
    const struct view_random desc = { .seed = seed,
                                      .lines = ROUND_SCRIPT,
                                      .scene = "@cornell:light=point",
                                      .gi = FIRST,
                                      .other_scene = "@maze" };
    view_random_write(&desc, out);
    fprintf(out, "memory round-%d.json\n", round);
}

static json_int_t least(const json_int_t two[2])
{
    return two[0] < two[1] ? two[0] : two[1];
}

// The same script again and again, without the layers, which keep some of each device. The memory
// that a round needs at most stays with the process after the first ones. The lower of two rounds
// is without work in progress of other threads.
TEST(memory_is_level_after_random_scripts)
{
    char name[32];
    const char *why;
    json_int_t bytes[ROUNDS], heap[ROUNDS];
    require_display();
    setenv("AFTERGLOW_VALIDATION", "0", 1);
    FILE *out = fopen("random.txt", "w");
    if (!out) fail_msg("cannot write random.txt");
    fprintf(out, "settle\nmemory first.json\n");
    for (int i = 0; i < ROUNDS; i++) write_round(out, i, 7);
    fclose(out);
    const bool silent = runs_silently("view @cornell:light=point" WINDOW, &why);
    setenv("AFTERGLOW_VALIDATION", "1", 1);
    if (!silent) fail_msg("%s", why);
    const json_int_t first = member_of("first.json", "device_bytes");
    for (int i = 0; i < ROUNDS; i++) {
        snprintf(name, sizeof name, "round-%d.json", i);
        bytes[i] = member_of(name, "resident_bytes");
        heap[i] = member_of(name, "heap_bytes");
        CHECK(member_of(name, "device_bytes") == first);
    }
    const json_int_t more = least(bytes + ROUNDS - 2) - least(bytes + FIRST_ROUNDS);
    const json_int_t kept = least(heap + ROUNDS - 2) - least(heap + FIRST_ROUNDS);
    printf("%lld bytes resident and %lld allocated more after %d rounds\n", (long long)more,
           (long long)kept, GROWTH_ROUNDS);
    if (sanitized || bytes[0] == 0) return;
    if (more > GROWTH_ROUNDS * MOST_RESIDENT) fail_msg("%lld bytes more resident", (long long)more);
    if (kept > GROWTH_ROUNDS * MOST_KEPT) fail_msg("%lld bytes are not freed", (long long)kept);
}
