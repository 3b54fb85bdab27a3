// Efficiency of guided rays: variance times processor time of the reference without them over with
// them, for scenes of light_levels.txt.
//
// Each seed renders an image of its own with each method. The variance of a pixel is that between
// the images, so that it holds whatever the samples of one image share.
//
//     guiding [--list FILE] [--scenes REGEX] [--size WxH] [--spp N] [--seeds N] [--bounces N]
#include "command_line.h"
#include "scene_list.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { METHODS = 2 }; // without guided rays, with

struct bench {
    struct ag_context *context;
    const char *list, *scenes;
    int width, height, samples, seeds, bounces;
};

// Statistics over the images of one method.
struct method {
    double *sums, *squares; // [pixels]: luminance
    double mean, mean_square;
    double core_s, rays;
};

static double core_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double luminance_of(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

// ---- images

static void add_image(struct method *m, const struct ag_image *image)
{
    int pixels = image->width * image->height;
    double mean = 0.0;
    for (int i = 0; i < pixels; i++) {
        double l = luminance_of(image->pixels + (size_t)i * (size_t)image->channels);
        m->sums[i] += l;
        m->squares[i] += l * l;
        mean += l / pixels;
    }
    m->mean += mean;
    m->mean_square += mean * mean;
}

static enum ag_result add_run(const struct bench *b, struct ag_scene *scene,
                              const struct ag_reference_desc *desc, struct method *m)
{
    struct ag_reference *reference = NULL;
    struct ag_reference_info info = { 0 };
    struct ag_image *color = NULL;
    enum ag_result result = ag_reference_create(scene, desc, &reference);
    double begun = core_s();
    if (result == AG_OK) result = ag_reference_render(reference, b->samples, NULL, NULL);
    m->core_s += core_s() - begun;
    if (result == AG_OK) result = ag_reference_get_info(reference, &info);
    if (result == AG_OK) result = ag_reference_read(reference, "color", &color);
    if (result == AG_OK) add_image(m, color);
    m->rays += (double)info.rays;
    ag_image_destroy(b->context, color);
    ag_reference_destroy(reference);
    return result;
}

// ---- statistics

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Mean over the pixels of their variance relative to their squared mean; the latter is that of all
// images and at least a tenth of the image's. `robust` leaves out the largest hundredth.
struct variance {
    double all, robust;
};

static struct variance variance_of(const struct bench *b, const struct method methods[METHODS],
                                   int which, double *work)
{
    const struct method *m = &methods[which];
    int pixels = b->width * b->height, n = b->seeds;
    double floor_mean = 0.1 * (methods[0].mean + methods[1].mean) / (2 * n);
    struct variance v = { 0 };
    for (int i = 0; i < pixels; i++) {
        double mean = (methods[0].sums[i] + methods[1].sums[i]) / (2 * n);
        double spread = fmax(0.0, m->squares[i] - m->sums[i] * m->sums[i] / n) / (n - 1);
        work[i] = spread / (mean * mean + floor_mean * floor_mean);
    }
    qsort(work, (size_t)pixels, sizeof *work, by_value);
    int kept = pixels - pixels / 100;
    for (int i = 0; i < pixels; i++) {
        v.all += work[i] / pixels;
        if (i < kept) v.robust += work[i] / kept;
    }
    return v;
}

// Squared standard error of the mean over all pixels and seeds.
static double error2_of(const struct method *m, int n)
{
    return fmax(0.0, m->mean_square - m->mean * m->mean / n) / (n - 1) / n;
}

static void print_row(const struct bench *b, const char *name, const struct method m[METHODS],
                      double *work)
{
    struct variance v[METHODS];
    int n = b->seeds;
    for (int i = 0; i < METHODS; i++) v[i] = variance_of(b, m, i, work);
    double time = m[1].core_s / m[0].core_s, mean = (m[1].mean - m[0].mean) / n;
    double error = sqrt(error2_of(&m[0], n) + error2_of(&m[1], n));
    printf("| %-16s | %6.2f | %5.2f | %5.2f | %8.4f | %6.2f | %6.2f | **%.2f** | %.2f | %+.2f %% "
           "(%+.1f) |\n",
           name, m[0].core_s / n, time, m[1].rays / m[0].rays, v[0].all * b->samples,
           v[0].all / v[1].all, v[0].robust / v[1].robust, v[0].all / v[1].all / time,
           v[0].robust / v[1].robust / time, 100.0 * mean * n / m[0].mean,
           error > 0.0 ? mean / error : 0.0);
    fflush(stdout);
}

// ---- scenes

static bool method_init(struct method *m, size_t pixels)
{
    *m = (struct method){ .sums = calloc(pixels, sizeof *m->sums),
                          .squares = calloc(pixels, sizeof *m->squares) };
    return m->sums && m->squares;
}

static void method_finish(struct method *m)
{
    free(m->sums);
    free(m->squares);
}

static enum ag_result measure(const struct bench *b, const struct listed_scene *listed,
                              struct ag_scene *scene, struct method m[METHODS])
{
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    desc.width = b->width;
    desc.height = b->height;
    desc.bounces = b->bounces;
    enum ag_result result = listed_scene_light(listed, scene);
    if (result == AG_OK) result = listed_scene_camera(listed, scene, &desc.camera);
    for (int seed = 0; seed < b->seeds; seed++)
        for (int i = 0; i < METHODS && result == AG_OK; i++) {
            desc.guiding = i > 0;
            desc.seed = (uint64_t)(METHODS * seed + i);
            result = add_run(b, scene, &desc, &m[i]);
        }
    return result;
}

static enum ag_result measure_scene(void *user, const struct listed_scene *listed)
{
    const struct bench *b = user;
    size_t pixels = (size_t)b->width * (size_t)b->height;
    struct method methods[METHODS] = { 0 };
    struct ag_scene *scene = NULL;
    double *work = malloc(pixels * sizeof *work);
    bool ok = work != NULL;
    for (int i = 0; i < METHODS; i++) ok = method_init(&methods[i], pixels) && ok;
    enum ag_result result = ok ? ag_scene_load(b->context, listed->path, &scene) : AG_ERROR_MEMORY;
    if (result == AG_OK) result = measure(b, listed, scene, methods);
    if (result == AG_OK) print_row(b, listed->name, methods, work);
    ag_scene_destroy(scene);
    for (int i = 0; i < METHODS; i++) method_finish(&methods[i]);
    free(work);
    return result;
}

// ---- main

static bool parse_option(void *user, const char *name, const char *value)
{
    struct bench *b = user;
    if (strcmp(name, "--list") == 0)
        b->list = value;
    else if (strcmp(name, "--scenes") == 0)
        b->scenes = value;
    else if (strcmp(name, "--size") == 0)
        return parse_size(value, &b->width, &b->height);
    else if (strcmp(name, "--spp") == 0)
        return parse_int(value, 1, 1000000, &b->samples);
    else if (strcmp(name, "--seeds") == 0)
        return parse_int(value, 2, 1000000, &b->seeds);
    else if (strcmp(name, "--bounces") == 0)
        return parse_int(value, -1, 1000, &b->bounces);
    else
        return false;
    return true;
}

int main(int argc, char **argv)
{
    struct bench b = { .list = "bench/light_levels.txt",
                       .scenes = "",
                       .width = 160,
                       .height = 90,
                       .samples = 32,
                       .seeds = 8,
                       .bounces = -1 };
    struct bench_scenes none = { 0 };
    if (!command_line_parse(argc, argv, parse_option, &b, &none) || none.count > 0) {
        fprintf(stderr, "usage: guiding [--list FILE] [--scenes REGEX] [--size WxH] [--spp N] "
                        "[--seeds N] [--bounces N]\n");
        return 2;
    }
    if (ag_context_create(NULL, &b.context) != AG_OK) return 1;
    printf("| scene | time (s) | time ratio | rays ratio | variance | variance ratio | robust | "
           "efficiency | robust | mean (errors) |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    enum ag_result result = scene_list_each(b.list, b.scenes, measure_scene, &b);
    if (result != AG_OK)
        fprintf(stderr, "guiding: %s (%s)\n", ag_context_last_error(b.context),
                ag_result_string(result));
    ag_context_destroy(b.context);
    return result == AG_OK ? 0 : 1;
}
