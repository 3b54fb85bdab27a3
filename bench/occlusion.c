// Ambient occlusion by voxel cones against rays with the same decay (Hong 2015, sec. 2.5.3.3.8),
// and its cost next to screen-space techniques.
//
//     occlusion [--gi SPEC]… [--decay G]… [--frames N] [--size WxH] [--spp N] [--maps DIR]
//     [--device NAME] [SCENE]…
//
// For each scene and decay (1/m), the visibility of each technique is compared with the traced one.
// Only vctao has that decay. The time is that of a technique's own passes, the minimum over frames.
#include "visibility.h"

#include <stdio.h>
#include <string.h>

enum { MAX_SPECS = 24, MAX_DECAYS = 8 };

static const float UNLIMITED_M = 1e6f; // reach of the traced rays

struct occlusion_bench {
    struct bench bench;
    const char *specs[MAX_SPECS], *maps;
    int spec_count, decay_count, spp;
    float decays[MAX_DECAYS];
};

// One technique in one view.
struct method {
    double ms; // minimum over frames
    struct ag_image *visibility;
};

// One scene and decay.
struct view {
    const struct occlusion_bench *b;
    const char *name;
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    float decay;
    struct ag_image *reference, *depth;
    struct ag_renderer *renderers[MAX_SPECS];
    struct method methods[MAX_SPECS];
};

static enum ag_result create_renderer(struct view *view, int s)
{
    char gi[BENCH_TEXT], decay[32] = "";
    const char *spec = view->b->specs[s];
    if (strncmp(spec, "vctao", 5) == 0)
        snprintf(decay, sizeof decay, "%cdecay=%.9g", strchr(spec, ':') ? ',' : ':',
                 (double)view->decay);
    snprintf(gi, sizeof gi, "%s%s", spec, decay);
    return bench_create_renderer(&view->b->bench, view->scene, gi, "shadow_size=256",
                                 &view->renderers[s]);
}

static void add_sample(void *user, int s, const struct ag_timing *timings, int count)
{
    struct view *view = user;
    double sum = 0.0;
    for (int i = 0; i < count; i++)
        if (passes_stage(timings[i].name, view->b->specs[s])) sum += timings[i].ms;
    passes_keep_least(&view->methods[s].ms, sum);
}

static enum ag_result render(struct view *view)
{
    const int count = view->b->spec_count;
    enum ag_result result = passes_alternate(view->renderers, count, &view->frame,
                                             view->b->bench.frames, add_sample, view);
    for (int s = 0; s < count && result == AG_OK; s++)
        result = ag_renderer_read(view->renderers[s], "visibility", &view->methods[s].visibility);
    return result;
}

static void print_view(const struct view *view)
{
    const struct occlusion_bench *b = view->b;
    printf("%s, %dx%d, decay %g 1/m, %d rays a pixel\n  %-36s %8s %8s %8s %8s\n", view->name,
           b->bench.width, b->bench.height, (double)view->decay, b->spp, "", "ms", "error", "rms",
           "bias");
    for (int s = 0; s < b->spec_count; s++) {
        const struct method *m = &view->methods[s];
        const struct visibility_error e =
            visibility_compare(m->visibility, view->reference, view->depth);
        printf("  %-36s %8.3f %8.4f %8.4f %+8.4f\n", b->specs[s], m->ms, e.mean, e.rms, e.bias);
    }
    fflush(stdout);
}

static enum ag_result write_map(const struct view *view, const struct ag_image *image,
                                const char *content)
{
    char variant[2 * BENCH_TEXT];
    snprintf(variant, sizeof variant, "%g-%s", (double)view->decay, content);
    return bench_write_png(&view->b->bench, view->b->maps, view->name, variant, image);
}

static enum ag_result write_maps(const struct view *view)
{
    enum ag_result result = write_map(view, view->reference, "traced");
    for (int s = 0; s < view->b->spec_count && result == AG_OK; s++)
        result = write_map(view, view->methods[s].visibility, view->b->specs[s]);
    return result;
}

static enum ag_result measure_decay(struct view *view)
{
    const struct occlusion_bench *b = view->b;
    struct ag_context *context = b->bench.context;
    const struct visibility_desc desc = { &view->frame.camera, b->spp, UNLIMITED_M, view->decay };
    enum ag_result result =
        visibility_trace(&b->bench, view->scene, &desc, NULL, &view->reference, &view->depth);
    for (int s = 0; s < b->spec_count && result == AG_OK; s++) result = create_renderer(view, s);
    if (result == AG_OK) result = render(view);
    if (result == AG_OK) print_view(view);
    if (result == AG_OK && b->maps) result = write_maps(view);
    for (int s = 0; s < b->spec_count; s++) {
        ag_image_destroy(context, view->methods[s].visibility);
        ag_renderer_destroy(view->renderers[s]);
    }
    ag_image_destroy(context, view->reference);
    ag_image_destroy(context, view->depth);
    return result;
}

static enum ag_result measure_scene(void *user, const char *name)
{
    const struct occlusion_bench *b = user;
    struct view view = { .b = b, .name = name };
    enum ag_result result = bench_open_scene(&b->bench, name, &view.scene, &view.frame);
    for (int i = 0; i < b->decay_count && result == AG_OK; i++) {
        struct view with_decay = view;
        with_decay.decay = b->decays[i];
        result = measure_decay(&with_decay);
    }
    ag_scene_destroy(view.scene);
    return result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct occlusion_bench *b = user;
    char rest;
    if (strcmp(name, "--gi") == 0) return append_text(value, b->specs, &b->spec_count, MAX_SPECS);
    if (strcmp(name, "--decay") == 0 && b->decay_count < MAX_DECAYS)
        return sscanf(value, "%f%c", &b->decays[b->decay_count++], &rest) == 1;
    if (strcmp(name, "--spp") == 0) return parse_int(value, 1, 1000000, &b->spp);
    if (strcmp(name, "--maps") != 0) return false;
    b->maps = value;
    return true;
}

static bool set_defaults(void *user)
{
    static const char *const specs[] = { "vctao", "vo:samples=5", "ssao:samples=12" };
    struct occlusion_bench *b = user;
    default_texts(specs, 3, b->specs, &b->spec_count);
    if (b->decay_count == 0) b->decays[b->decay_count++] = 1.0f;
    default_scenes(&b->bench.scenes, "@cornell", "@atrium");
    return true;
}

int main(int argc, char **argv)
{
    static const struct bench_program program = {
        .name = "occlusion",
        .usage = "[--gi SPEC]... [--decay G]... [--spp N] [--maps DIR]",
        .options = BENCH_SIZE | BENCH_SCENES,
        .parse_option = parse_option,
        .set_defaults = set_defaults,
        .measure_scene = measure_scene,
    };
    static struct occlusion_bench b = { .bench = { .width = 320, .height = 180, .frames = 8 },
                                        .spp = 64 };
    return bench_main(&program, &b.bench, &b, argc, argv);
}
