// Loos 2015, table 6.1, with the error beside the time: volumetric obscurance by 5 and 9 lines and by 12 and 33 points, the
// point samples that it is compared with there, and a horizon-based technique, per scene.
//
//     paper-vo [--gi TERM]… [--frames N] [--size WxH] [--radius SHARE] [--spp N] [--device NAME] [SCENE]…
//
// A technique's time is its own passes': the estimate, and all that follows it. Its error is the difference from the traced
// obscurance of the same radius, where there is a surface.
#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_TERMS = 16, MAX_SCENES = 16, MAX_PASSES = 64, TEXT = 256 };

struct result {
    double geometry_ms, estimate_ms, rest_ms; // least of all frames
    double mean_error, rms_error, bias;
};

struct bench {
    const char *terms[MAX_TERMS], *scenes[MAX_SCENES];
    int term_count, scene_count, width, height, frames, spp;
    double radius_share; // of the diagonal of the scene's bounds
    const char *device_name;
    struct ag_context *context;
    struct ag_device *device;
};

struct view {
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    float radius_m;
    struct ag_image *truth, *depth;
};

// ---- the truth

static enum ag_result trace(struct bench *bench, struct view *view)
{
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    desc.width = bench->width;
    desc.height = bench->height;
    desc.camera = view->frame.camera;
    desc.direct_only = true; // the light does not matter
    desc.bounces = 0;
    desc.obscurance_radius_m = view->radius_m;
    struct ag_reference *reference = NULL;
    enum ag_result result = ag_reference_create(view->scene, &desc, &reference);
    if (result == AG_OK) result = ag_reference_render(reference, bench->spp, NULL, NULL);
    if (result == AG_OK) result = ag_reference_read(reference, "obscurance", &view->truth);
    if (result == AG_OK) result = ag_reference_read(reference, "depth", &view->depth);
    ag_reference_destroy(reference);
    return result;
}

static float radius_of(struct bench *bench, struct ag_scene *scene)
{
    struct ag_scene_info info;
    if (ag_scene_get_info(scene, 0, 0.0, &info) != AG_OK) return 1.0f;
    double sum = 0.0;
    for (int i = 0; i < 3; i++) sum += pow((double)(info.bounds_max[i] - info.bounds_min[i]), 2.0);
    return (float)(bench->radius_share * sqrt(sum));
}

static enum ag_result open_view(struct bench *bench, const char *name, struct view *view)
{
    ag_frame_desc_default(&view->frame);
    enum ag_result result = ag_scene_load(bench->context, name, &view->scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(view->scene, NULL);
    if (result == AG_OK)
        result = ag_scene_default_camera(view->scene, 0, 0.0, &view->frame.camera, NULL);
    if (result != AG_OK) return result;
    view->radius_m = radius_of(bench, view->scene);
    return trace(bench, view);
}

static void close_view(struct bench *bench, struct view *view)
{
    ag_image_destroy(bench->context, view->truth);
    ag_image_destroy(bench->context, view->depth);
    ag_scene_destroy(view->scene);
}

// ---- a technique

static void compare(const struct view *view, const struct ag_image *seen, struct result *out)
{
    size_t pixels = (size_t)seen->width * (size_t)seen->height, count = 0;
    double sum = 0.0, squares = 0.0, off = 0.0;
    for (size_t i = 0; i < pixels; i++) {
        if (view->depth->pixels[i] <= 0.0f) continue;
        double d = (double)seen->pixels[i] - (double)view->truth->pixels[i];
        sum += fabs(d);
        squares += d * d;
        off += d;
        count++;
    }
    double n = count ? (double)count : 1.0;
    out->mean_error = sum / n;
    out->rms_error = sqrt(squares / n);
    out->bias = off / n;
}

static double keep_least(double least, double ms)
{
    return least == 0.0 || ms < least ? ms : least;
}

// The technique's first pass but for the pyramid makes the estimate; the others follow it.
static void collect(struct ag_renderer *renderer, const char *technique, struct result *out)
{
    struct ag_timing timings[MAX_PASSES];
    int count = ag_renderer_timings(renderer, timings, MAX_PASSES);
    size_t length = strcspn(technique, ":");
    double estimate = 0.0, rest = 0.0, geometry = 0.0;
    for (int i = 0; i < count && i < MAX_PASSES; i++) {
        const char *name = timings[i].name;
        if (strcmp(name, "gbuffer") == 0) geometry = timings[i].ms;
        if (strncmp(name, technique, length) != 0 || name[length] != '.') continue;
        static const char *const after[] = { "blur", "fit", "temporal" };
        bool is_rest = false;
        for (size_t k = 0; k < sizeof after / sizeof after[0]; k++)
            is_rest |= strcmp(name + length + 1, after[k]) == 0;
        *(is_rest ? &rest : &estimate) += timings[i].ms;
    }
    out->geometry_ms = keep_least(out->geometry_ms, geometry);
    out->estimate_ms = keep_least(out->estimate_ms, estimate);
    out->rest_ms = keep_least(out->rest_ms, rest);
}

static enum ag_result measure(struct bench *bench, const struct view *view, const char *term,
                              struct result *out)
{
    char gi[TEXT];
    snprintf(gi, sizeof gi, "%s%cradius=%.9g", term, strchr(term, ':') ? ',' : ':',
             (double)view->radius_m);
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = bench->width;
    desc.height = bench->height;
    desc.gi = gi;
    desc.frame_options = "shadow_size=256";
    struct ag_renderer *renderer = NULL;
    struct ag_image *seen = NULL;
    *out = (struct result){ 0 };
    enum ag_result result = ag_renderer_create(bench->device, view->scene, &desc, &renderer);
    for (int f = 0; f <= bench->frames && result == AG_OK; f++) {
        result = ag_renderer_render(renderer, &view->frame);
        if (result == AG_OK) result = ag_renderer_wait(renderer);
        if (result == AG_OK && f > 0) collect(renderer, term, out);
    }
    if (result == AG_OK) result = ag_renderer_read(renderer, "visibility", &seen);
    if (result == AG_OK) compare(view, seen, out);
    ag_image_destroy(bench->context, seen);
    ag_renderer_destroy(renderer);
    return result;
}

// ---- the run

static enum ag_result measure_scene(struct bench *bench, const char *name)
{
    struct view view = { 0 };
    enum ag_result result = open_view(bench, name, &view);
    if (result == AG_OK)
        printf("%s, %dx%d, radius %.4g m, %d rays a pixel\n%-44s %9s %9s %9s %9s %9s %9s\n", name,
               bench->width, bench->height, (double)view.radius_m, bench->spp, "", "geometry",
               "estimate", "rest", "mean err", "rms err", "bias");
    for (int t = 0; t < bench->term_count && result == AG_OK; t++) {
        struct result r;
        result = measure(bench, &view, bench->terms[t], &r);
        if (result != AG_OK) break;
        printf("%-44s %9.3f %9.3f %9.3f %9.4f %9.4f %+9.4f\n", bench->terms[t], r.geometry_ms,
               r.estimate_ms, r.rest_ms, r.mean_error, r.rms_error, r.bias);
        fflush(stdout);
    }
    putchar('\n');
    close_view(bench, &view);
    return result;
}

static bool parse_option(struct bench *bench, const char *name, const char *value)
{
    char rest;
    if (strcmp(name, "--gi") == 0 && bench->term_count < MAX_TERMS)
        bench->terms[bench->term_count++] = value;
    else if (strcmp(name, "--frames") == 0)
        return sscanf(value, "%d%c", &bench->frames, &rest) == 1 && bench->frames >= 1;
    else if (strcmp(name, "--spp") == 0)
        return sscanf(value, "%d%c", &bench->spp, &rest) == 1 && bench->spp >= 1;
    else if (strcmp(name, "--size") == 0)
        return sscanf(value, "%dx%d%c", &bench->width, &bench->height, &rest) == 2;
    else if (strcmp(name, "--radius") == 0)
        return sscanf(value, "%lf%c", &bench->radius_share, &rest) == 1 && bench->radius_share > 0.0;
    else if (strcmp(name, "--device") == 0)
        bench->device_name = value;
    else
        return false;
    return true;
}

static bool parse(struct bench *bench, int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strncmp(argv[i], "--", 2) == 0) {
            if (i + 1 == argc || !parse_option(bench, argv[i], argv[i + 1])) return false;
            i++;
        } else if (bench->scene_count < MAX_SCENES) {
            bench->scenes[bench->scene_count++] = argv[i];
        } else {
            return false;
        }
    }
    static const char *const usual[] = { "vo:samples=5", "vo:samples=9" };
    for (int i = 0; bench->term_count < 2 && i < 2; i++)
        bench->terms[bench->term_count++] = usual[i];
    if (bench->scene_count == 0) {
        bench->scenes[bench->scene_count++] = "@atrium";
        bench->scenes[bench->scene_count++] = "@cornell:light=point";
    }
    return true;
}

int main(int argc, char **argv)
{
    static struct bench bench = {
        .width = 640, .height = 360, .frames = 10, .spp = 64, .radius_share = 0.02
    };
    if (!parse(&bench, argc, argv)) {
        fprintf(stderr, "usage: paper-vo [--gi TERM]... [--frames N] [--size WxH] [--radius SHARE] "
                        "[--spp N] [--device NAME] [SCENE]...\n");
        return 2;
    }
    enum ag_result result = ag_context_create(NULL, &bench.context);
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.device = bench.device_name;
    if (result == AG_OK) result = ag_device_create(bench.context, &desc, &bench.device);
    for (int i = 0; i < bench.scene_count && result == AG_OK; i++)
        result = measure_scene(&bench, bench.scenes[i]);
    if (result != AG_OK)
        fprintf(stderr, "paper-vo: %s (%s)\n", ag_context_last_error(bench.context),
                ag_result_string(result));
    ag_device_destroy(bench.device);
    ag_context_destroy(bench.context);
    return result == AG_OK ? 0 : 1;
}
