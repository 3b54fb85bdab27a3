// Memory of a second view: of a renderer with one camera, and with a view of the same size.
//
//     views [--gi SPEC]… [--size WxH] [--device NAME] [--png FOLDER] [SCENE]…
//
// The second view keeps color and display, as ag_view_create does by default. --png writes what
// both cameras see.
#include "bench.h"

#include <stdio.h>
#include <string.h>

enum { MAX_SPECS = 16 };

struct views_bench {
    struct bench bench;
    const char *specs[MAX_SPECS];
    int spec_count;
    const char *folder; // NULL: no images
};

// Nearer to the target and to the side.
static struct ag_camera other_camera(const struct ag_camera *camera)
{
    struct ag_camera other = *camera;
    const float across[2] = { camera->target[2] - camera->eye[2],
                              camera->eye[0] - camera->target[0] };
    for (int i = 0; i < 3; i++) other.eye[i] += 0.2f * (camera->target[i] - camera->eye[i]);
    other.eye[0] += 0.2f * across[0];
    other.eye[2] += 0.2f * across[1];
    return other;
}

static enum ag_result write_png(const struct views_bench *b, const char *scene, const char *gi,
                                const char *which, struct ag_image *image)
{
    char variant[2 * BENCH_TEXT];
    snprintf(variant, sizeof variant, "%s-%s", gi, which);
    enum ag_result result = bench_write_png(&b->bench, b->folder, scene, variant, image);
    ag_image_destroy(b->bench.context, image);
    return result;
}

static enum ag_result write_views(const struct views_bench *b, const char *scene, const char *gi,
                                  struct ag_renderer *renderer, struct ag_view *view)
{
    struct ag_image *image = NULL;
    if (!b->folder) return AG_OK;
    enum ag_result result = ag_renderer_read(renderer, "display", &image);
    if (result == AG_OK) result = write_png(b, scene, gi, "first", image);
    if (result == AG_OK) result = ag_view_read(view, "display", &image);
    return result == AG_OK ? write_png(b, scene, gi, "second", image) : result;
}

static enum ag_result measure_views(const struct views_bench *b, const char *scene, const char *gi,
                                    struct ag_frame_desc frame, struct ag_renderer *renderer)
{
    struct ag_view_desc desc;
    struct ag_view_frame further;
    ag_view_desc_default(&desc);
    ag_view_frame_default(&further);
    desc.width = b->bench.width;
    desc.height = b->bench.height;
    further.camera = other_camera(&frame.camera);
    enum ag_result result = ag_renderer_render(renderer, &frame);
    const double one = 1e-6 * (double)bench_memory_of(renderer, NULL);
    if (result == AG_OK) result = ag_view_create(renderer, &desc, &further.view);
    frame.views = &further;
    frame.view_count = 1;
    for (int i = 0; i < b->bench.frames && result == AG_OK; i++)
        result = ag_renderer_render(renderer, &frame);
    const double two = 1e-6 * (double)bench_memory_of(renderer, NULL);
    if (result == AG_OK) printf("  %-24s  %8.1f  %8.1f  %6.2f\n", gi, one, two, two / one);
    if (result == AG_OK) result = write_views(b, scene, gi, renderer, further.view);
    ag_view_destroy(further.view);
    fflush(stdout);
    return result;
}

static enum ag_result measure_scene(void *user, const char *name)
{
    const struct views_bench *b = user;
    struct ag_scene *scene = NULL;
    struct ag_frame_desc frame;
    enum ag_result result = bench_open_scene(&b->bench, name, &scene, &frame);
    if (result == AG_OK)
        printf("%s at %dx%d\n  %-24s  %8s  %8s  %6s\n", name, b->bench.width, b->bench.height, "MB",
               "one view", "two", "ratio");
    for (int s = 0; s < b->spec_count && result == AG_OK; s++) {
        struct ag_renderer *renderer = NULL;
        result = bench_create_renderer(&b->bench, scene, b->specs[s], NULL, &renderer);
        if (result == AG_OK) result = measure_views(b, name, b->specs[s], frame, renderer);
        ag_renderer_destroy(renderer);
    }
    ag_scene_destroy(scene);
    return result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct views_bench *b = user;
    if (strcmp(name, "--png") == 0) return (b->folder = value) != NULL;
    return strcmp(name, "--gi") == 0 && append_text(value, b->specs, &b->spec_count, MAX_SPECS);
}

static bool set_defaults(void *user)
{
    static const char *const specs[] = { "none",   "ambient",
                                         "lpv",    "holpv",
                                         "vct",    "vct:temporal=false",
                                         "lpv+vo", "lpv+vo:temporal=true" };
    struct views_bench *b = user;
    default_texts(specs, sizeof specs / sizeof *specs, b->specs, &b->spec_count);
    default_scenes(&b->bench.scenes, "@cornell", "@atrium");
    return true;
}

int main(int argc, char **argv)
{
    static struct views_bench b = { .bench = { .width = 1280, .height = 720, .frames = 1 } };
    const struct bench_program program = { .name = "views",
                                           .usage = "[--gi SPEC]... [--png FOLDER]",
                                           .options = BENCH_SIZE | BENCH_SCENES,
                                           .parse_option = parse_option,
                                           .set_defaults = set_defaults,
                                           .measure_scene = measure_scene };
    return bench_main(&program, &b.bench, &b, argc, argv);
}
