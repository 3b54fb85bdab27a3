// Processor time of a moved instance: of the calling thread, for a frame whose scene stays as it
// was and for one in which an instance has moved.
//
//     moving [--gi SPEC]… [--instance N] [--copies N] [--frames N] [--size WxH] [--device NAME]
//     [SCENE]…
//
// Frames of both kinds alternate; the times are minima, since other load on the machine only adds
// to them. The GPU's time is not in them (a software driver works on threads of its own).
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { MAX_SPECS = 8 };

struct moving_bench {
    struct bench bench;
    const char *specs[MAX_SPECS];
    int spec_count;
    int instance; // -1: the one in the middle of the list
    int copies;   // instances that are added
};

struct least_ms {
    double still, moved, call;
};

static double thread_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static void keep_least(double *least, double value)
{
    if (value < *least) *least = value;
}

// Moves it to and fro by a hundredth of its distance from the origin, at least 1 mm.
static enum ag_result move(struct ag_scene *scene, int instance, const float rest[16], int step)
{
    float matrix[16];
    memcpy(matrix, rest, sizeof matrix);
    matrix[12] += (step % 2 ? 0.01f : -0.01f) * (0.1f + (rest[12] < 0 ? -rest[12] : rest[12]));
    return ag_scene_set_instance_transform(scene, instance, matrix);
}

static enum ag_result render(struct ag_renderer *renderer, const struct ag_frame_desc *frame,
                             double *ms)
{
    const double begun = thread_ms();
    const enum ag_result result = ag_renderer_render(renderer, frame);
    *ms = thread_ms() - begun;
    return result == AG_OK ? ag_renderer_wait(renderer) : result;
}

static enum ag_result measure_frames(struct ag_scene *scene, int instance, int frames,
                                     struct ag_renderer *renderer,
                                     const struct ag_frame_desc *frame, struct least_ms *least)
{
    struct ag_instance_info info;
    enum ag_result result = ag_scene_get_instance(scene, instance, 0, 0.0, &info);
    double ms;
    *least = (struct least_ms){ INFINITY, INFINITY, INFINITY };
    for (int i = 0; i < 4 && result == AG_OK; i++) { // it becomes movable, caches are filled
        result = move(scene, instance, info.world_from_mesh, i);
        if (result == AG_OK) result = render(renderer, frame, &ms);
    }
    for (int i = 0; i < frames && result == AG_OK; i++) {
        result = render(renderer, frame, &ms); // the previous position, of motion, settles
        if (result == AG_OK) result = render(renderer, frame, &ms);
        keep_least(&least->still, ms);
        const double begun = thread_ms();
        if (result == AG_OK) result = move(scene, instance, info.world_from_mesh, i);
        keep_least(&least->call, thread_ms() - begun);
        if (result == AG_OK) result = render(renderer, frame, &ms);
        keep_least(&least->moved, ms);
    }
    return result;
}

static enum ag_result measure_spec(const struct moving_bench *b, struct ag_scene *scene,
                                   int instance, const struct ag_frame_desc *frame, const char *gi)
{
    struct ag_renderer *renderer = NULL;
    struct least_ms least;
    enum ag_result result = bench_create_renderer(&b->bench, scene, gi, NULL, &renderer);
    if (result == AG_OK)
        result = measure_frames(scene, instance, b->bench.frames, renderer, frame, &least);
    ag_renderer_destroy(renderer);
    if (result != AG_OK) return result;
    printf("  %-24s  %7.3f  %7.3f  %7.3f  %7.3f\n", gi, least.still, least.moved, least.call,
           least.moved - least.still + least.call);
    fflush(stdout);
    return AG_OK;
}

// Copies of all instances, each a hundredth of its size, around their places.
static enum ag_result add_copies(struct ag_scene *scene, int instances, int count)
{
    enum ag_result result = AG_OK;
    for (int i = 0; i < count && result == AG_OK; i++) {
        struct ag_instance_info info;
        result = ag_scene_get_instance(scene, i % instances, 0, 0.0, &info);
        if (result != AG_OK || info.mesh < 0 || info.skinned) continue;
        for (int k = 0; k < 12; k++) info.world_from_mesh[k] *= 0.01f;
        info.world_from_mesh[12] += 0.1f * (float)(i / instances);
        result = ag_scene_add_instance(scene, info.mesh, info.world_from_mesh, NULL);
    }
    return result;
}

static enum ag_result measure_scene(void *user, const char *name)
{
    struct moving_bench *b = user;
    struct ag_scene *scene = NULL;
    struct ag_scene_info info = { 0 };
    struct ag_frame_desc frame;
    enum ag_result result = bench_open_scene(&b->bench, name, &scene, &frame);
    if (result == AG_OK) result = ag_scene_get_info(scene, 0, 0.0, &info);
    if (result == AG_OK) result = add_copies(scene, info.instances, b->copies);
    const int instance = b->instance >= 0 ? b->instance : info.instances / 2;
    if (result == AG_OK)
        printf("%s: %d instances and %d copies, number %d moves\n  %-24s  %7s  %7s  %7s  %7s\n",
               name, info.instances, b->copies, instance, "ms of the thread", "still", "moved",
               "call", "more");
    for (int s = 0; s < b->spec_count && result == AG_OK; s++)
        result = measure_spec(b, scene, instance, &frame, b->specs[s]);
    ag_scene_destroy(scene);
    return result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct moving_bench *b = user;
    if (strcmp(name, "--instance") == 0) return parse_int(value, 0, 1 << 24, &b->instance);
    if (strcmp(name, "--copies") == 0) return parse_int(value, 0, 1 << 20, &b->copies);
    return strcmp(name, "--gi") == 0 && append_text(value, b->specs, &b->spec_count, MAX_SPECS);
}

static bool set_defaults(void *user)
{
    static const char *const specs[] = { "none", "lpv", "vct" };
    struct moving_bench *b = user;
    default_texts(specs, 3, b->specs, &b->spec_count);
    default_scenes(&b->bench.scenes, "@atrium", "@cornell:light=point");
    return true;
}

int main(int argc, char **argv)
{
    static struct moving_bench b = { .bench = { .width = 160, .height = 90, .frames = 30 },
                                     .instance = -1 };
    const struct bench_program program = { .name = "moving",
                                           .usage = "[--gi SPEC]... [--instance N] [--copies N]",
                                           .options = BENCH_SIZE | BENCH_SCENES,
                                           .parse_option = parse_option,
                                           .set_defaults = set_defaults,
                                           .measure_scene = measure_scene };
    return bench_main(&program, &b.bench, &b, argc, argv);
}
