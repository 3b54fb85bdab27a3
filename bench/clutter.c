// Cost in drt of moving an object inside a block: processor time of the update, times of frames
// meanwhile, and the steps in which the light changes.
//
//     clutter [--gi SPEC] [--instance N] [--step CM] [--frames N] [--size WxH] [--device NAME]
//     [SCENE]…
//
// Processor time is that of the process, with update=wait, less that of a frame in which nothing
// moves. The software driver shares the cores with the update, and other programs share them with
// both: wall times are only as good as the machine is idle.
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MAX_MEANWHILE = 4096 };

struct clutter_bench {
    struct bench bench;
    const char *gi;
    int instance; // -1: the last
    int step;     // cm
};

static double seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

struct times {
    double wall_s, cpu_s;
};

static enum ag_result render(struct ag_renderer *renderer, const struct ag_frame_desc *frame,
                             struct times *out)
{
    const double wall = seconds(CLOCK_MONOTONIC), cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    enum ag_result result = ag_renderer_render(renderer, frame);
    if (result == AG_OK) result = ag_renderer_wait(renderer);
    *out =
        (struct times){ seconds(CLOCK_MONOTONIC) - wall, seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu };
    return result;
}

static enum ag_result move(struct ag_scene *scene, int instance, double by_m)
{
    struct ag_instance_info info;
    enum ag_result result = ag_scene_get_instance(scene, instance, 0, 0.0, &info);
    info.world_from_mesh[12] += (float)by_m;
    return result == AG_OK ? ag_scene_set_instance_transform(scene, instance, info.world_from_mesh)
                           : result;
}

static int by_time(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, by_time);
    return count > 0 ? values[count / 2] : 0.0;
}

// Largest difference of a pixel, lux.
static double largest(const struct ag_image *a, const struct ag_image *b)
{
    double most = 0.0;
    for (int i = 0; i < a->width * a->height * a->channels; i++)
        most = fmax(most, fabs((double)a->pixels[i] - (double)b->pixels[i]));
    return most;
}

static enum ag_result open_renderer(const struct clutter_bench *b, struct ag_scene *scene,
                                    const char *update, struct ag_renderer **out)
{
    char spec[BENCH_TEXT];
    snprintf(spec, sizeof spec, "%s%cupdate=%s", b->gi, strchr(b->gi, ':') ? ',' : ':', update);
    return bench_create_renderer(&b->bench, scene, spec, NULL, out);
}

static enum ag_result read_irradiance(const struct clutter_bench *b, struct ag_renderer *renderer,
                                      struct ag_image **out)
{
    ag_image_destroy(b->bench.context, *out);
    *out = NULL;
    return ag_renderer_read(renderer, "irradiance", out);
}

// Frames of a new renderer.
static enum ag_result fresh(const struct clutter_bench *b, struct ag_scene *scene,
                            const struct ag_frame_desc *frame, struct ag_image **out)
{
    struct ag_renderer *renderer = NULL;
    struct times unused;
    enum ag_result result = open_renderer(b, scene, "wait", &renderer);
    if (result == AG_OK) result = render(renderer, frame, &unused);
    if (result == AG_OK) result = read_irradiance(b, renderer, out);
    ag_renderer_destroy(renderer);
    return result;
}

static enum ag_result measure_wait(const struct clutter_bench *b, struct ag_scene *scene,
                                   int instance, const struct ag_frame_desc *frame)
{
    struct ag_renderer *renderer = NULL;
    struct ag_image *now = NULL, *expected = NULL;
    struct times still = { 0 }, moved = { 0 };
    enum ag_result result = open_renderer(b, scene, "wait", &renderer);
    for (int i = 0; i < 4 && result == AG_OK; i++) result = render(renderer, frame, &still);
    if (result == AG_OK) result = move(scene, instance, 0.01 * b->step);
    if (result == AG_OK) result = render(renderer, frame, &moved);
    if (result == AG_OK) result = read_irradiance(b, renderer, &now);
    if (result == AG_OK) result = fresh(b, scene, frame, &expected);
    if (result == AG_OK)
        printf("  update: %.2f s of processor time, of a still frame %.3f\n"
               "  largest difference to a new renderer: %g lux\n",
               moved.cpu_s - still.cpu_s, still.cpu_s, largest(now, expected));
    ag_image_destroy(b->bench.context, now);
    ag_image_destroy(b->bench.context, expected);
    ag_renderer_destroy(renderer);
    return result;
}

struct meanwhile {
    double still_ms[MAX_MEANWHILE], busy_ms[MAX_MEANWHILE];
    int still, busy;
    double until_s;     // the light is that of the new place
    double step, whole; // largest changes of irradiance: in a frame, all in all
    struct ag_image *before, *now, *after;
};

static enum ag_result follow(const struct clutter_bench *b, struct ag_renderer *renderer,
                             const struct ag_frame_desc *frame, struct meanwhile *m)
{
    struct times times;
    enum ag_result result = AG_OK;
    for (double left = INFINITY; result == AG_OK && left > 0.0 && m->busy < MAX_MEANWHILE;) {
        result = render(renderer, frame, &times);
        m->until_s += times.wall_s;
        m->busy_ms[m->busy++] = 1e3 * times.wall_s;
        if (result == AG_OK) result = read_irradiance(b, renderer, &m->now);
        if (result != AG_OK) return result;
        m->step = fmax(m->step, largest(m->before, m->now));
        left = largest(m->now, m->after);
        struct ag_image *last = m->before;
        m->before = m->now;
        m->now = last;
    }
    return result;
}

static enum ag_result measure_background(const struct clutter_bench *b, struct ag_scene *scene,
                                         int instance, const struct ag_frame_desc *frame)
{
    static struct meanwhile m;
    struct ag_renderer *renderer = NULL;
    struct times times;
    m = (struct meanwhile){ 0 };
    enum ag_result result = open_renderer(b, scene, "background", &renderer);
    if (result == AG_OK) result = render(renderer, frame, &times);
    for (int i = 0; i < b->bench.frames && i < MAX_MEANWHILE && result == AG_OK; i++) {
        result = render(renderer, frame, &times);
        m.still_ms[m.still++] = 1e3 * times.wall_s;
        if (result == AG_OK) result = read_irradiance(b, renderer, &m.before);
    }
    if (result == AG_OK) result = move(scene, instance, -0.01 * b->step);
    if (result == AG_OK) result = fresh(b, scene, frame, &m.after);
    // Pixels of the object itself change at once, with the old light.
    if (result == AG_OK) result = render(renderer, frame, &times);
    if (result == AG_OK) result = read_irradiance(b, renderer, &m.before);
    if (result == AG_OK) m.whole = largest(m.before, m.after);
    m.until_s = times.wall_s;
    if (result == AG_OK) result = follow(b, renderer, frame, &m);
    if (result == AG_OK)
        printf("  frames: %.2f ms, meanwhile %.2f ms (medians of %d and %d), for %.2f s\n"
               "  largest change of a pixel: %g lux in a frame, %g in all\n",
               median(m.still_ms, m.still), median(m.busy_ms, m.busy), m.still, m.busy, m.until_s,
               m.step, m.whole);
    ag_image_destroy(b->bench.context, m.before);
    ag_image_destroy(b->bench.context, m.now);
    ag_image_destroy(b->bench.context, m.after);
    ag_renderer_destroy(renderer);
    return result;
}

static enum ag_result measure_scene(void *user, const char *name)
{
    const struct clutter_bench *b = user;
    struct ag_scene *scene = NULL;
    struct ag_scene_info info = { 0 };
    struct ag_frame_desc frame;
    enum ag_result result = bench_open_scene(&b->bench, name, &scene, &frame);
    if (result == AG_OK) result = ag_scene_get_info(scene, 0, 0.0, &info);
    const int instance = b->instance >= 0 ? b->instance : info.instances - 1;
    if (result == AG_OK)
        printf("%s: %s, instance %d of %d moves by %d cm\n", name, b->gi, instance, info.instances,
               b->step);
    if (result == AG_OK) result = measure_wait(b, scene, instance, &frame);
    if (result == AG_OK) result = measure_background(b, scene, instance, &frame);
    ag_scene_destroy(scene);
    return result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct clutter_bench *b = user;
    if (strcmp(name, "--instance") == 0) return parse_int(value, 0, 1 << 24, &b->instance);
    if (strcmp(name, "--step") == 0) return parse_int(value, 1, 1000, &b->step);
    if (strcmp(name, "--gi") != 0) return false;
    b->gi = value;
    return true;
}

static bool set_defaults(void *user)
{
    struct clutter_bench *b = user;
    default_scenes(&b->bench.scenes, "@maze:blocks=4,pillars=4,light=point",
                   "@maze:blocks=9,pillars=1,light=point");
    return true;
}

int main(int argc, char **argv)
{
    static struct clutter_bench b = { .bench = { .width = 160, .height = 90, .frames = 30 },
                                      .gi = "drt",
                                      .instance = -1,
                                      .step = 20 };
    const struct bench_program program = { .name = "clutter",
                                           .usage = "[--gi SPEC] [--instance N] [--step CM]",
                                           .options = BENCH_SIZE | BENCH_SCENES,
                                           .parse_option = parse_option,
                                           .set_defaults = set_defaults,
                                           .measure_scene = measure_scene };
    return bench_main(&program, &b.bench, &b, argc, argv);
}
