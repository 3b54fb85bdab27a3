// Cost and effect of each technique: renders a scene with every source of indirect light, or with
// those given, prints times, memory and the difference from direct light only, and writes the
// layers of the last one.
//
//     measure SCENE OUT.exr [GI...]
#include <afterglow/afterglow.h>

#include <stdio.h>
#include <string.h>

enum { WIDTH = 320, HEIGHT = 180, FRAMES = 3, MAX_ENTRIES = 64 };

struct bench {
    struct ag_context *context;
    struct ag_device *device;
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    struct ag_image *direct; // of the first technique measured
    const char *out;
};

static void print_costs(struct ag_renderer *renderer)
{
    struct ag_timing passes[MAX_ENTRIES];
    struct ag_memory owners[MAX_ENTRIES];
    int count = ag_renderer_timings(renderer, passes, MAX_ENTRIES);
    for (int i = 0; i < count && i < MAX_ENTRIES; i++)
        printf("    %-20s %8.2f ms\n", passes[i].name, passes[i].ms);
    count = ag_renderer_memory(renderer, owners, MAX_ENTRIES);
    for (int i = 0; i < count && i < MAX_ENTRIES; i++)
        printf("    %-20s %8.2f MB\n", owners[i].owner, (double)owners[i].bytes * 1e-6);
}

// Prints the difference of the newest frame from direct light and writes its layers.
static enum ag_result compare(struct bench *bench, struct ag_renderer *renderer)
{
    struct ag_image *color = NULL, *indirect = NULL;
    struct ag_metrics metrics = { 0 };
    enum ag_result result = ag_renderer_read(renderer, "color", &color);
    if (result == AG_OK) result = ag_renderer_read(renderer, "indirect", &indirect);
    if (result == AG_OK && !bench->direct)
        result = ag_renderer_read(renderer, "direct", &bench->direct);
    struct ag_compare_desc desc;
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    if (result == AG_OK) desc.ev = ag_image_auto_exposure(bench->direct);
    if (result == AG_OK)
        result = ag_image_metrics(bench->context, color, bench->direct, &desc, &metrics);
    if (result == AG_OK) {
        const struct ag_image_layer layers[] = { { "color", color }, { "indirect", indirect } };
        const struct ag_attribute how = { "afterglow.gi", ag_renderer_gi(renderer) };
        printf("    mean absolute difference from direct light: %.4g cd/m2, FLIP %.3f\n",
               metrics.mae, metrics.flip);
        result = ag_image_write_exr(bench->context, bench->out, layers, 2, &how, 1);
    }
    ag_image_destroy(bench->context, color);
    ag_image_destroy(bench->context, indirect);
    return result;
}

// Runs the bake of a technique that needs one; NULL for others. A program would save it.
static enum ag_result bake(struct bench *bench, const char *gi, struct ag_bake **out)
{
    struct ag_bake_desc desc;
    ag_bake_desc_default(&desc);
    enum ag_result result = ag_bake_technique(bench->context, gi, 0, &desc.technique);
    if (result != AG_OK || !desc.technique) return result;
    result = ag_bake_create(bench->scene, gi, &desc, out);
    return result == AG_OK ? ag_bake_run(*out, NULL, NULL) : result;
}

static enum ag_result measure(struct bench *bench, const char *gi)
{
    struct ag_renderer_desc desc;
    struct ag_scene_info info;
    ag_renderer_desc_default(&desc);
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.gi = gi;
    desc.indirect_layer = true;
    uint64_t bytes = 0;
    struct ag_renderer *renderer = NULL;
    struct ag_bake *baked = NULL;
    enum ag_result result = bake(bench, gi, &baked);
    desc.bakes = (const struct ag_bake *const *)&baked;
    desc.bake_count = baked ? 1 : 0;
    if (result == AG_OK) result = ag_scene_get_info(bench->scene, 0, 0.0, &info);
    if (result == AG_OK)
        result = ag_renderer_estimate_memory(bench->context, &desc, info.lights, &bytes);
    if (result == AG_OK) printf("%s: at most %.1f MB\n", gi, (double)bytes * 1e-6);
    if (result == AG_OK) result = ag_renderer_create(bench->device, bench->scene, &desc, &renderer);
    for (int i = 0; i < FRAMES && result == AG_OK; i++)
        result = ag_renderer_render(renderer, &bench->frame);
    if (result == AG_OK) result = ag_renderer_wait(renderer);
    if (result == AG_OK) print_costs(renderer);
    if (result == AG_OK) result = compare(bench, renderer);
    ag_renderer_destroy(renderer);
    ag_bake_destroy(baked);
    return result;
}

static enum ag_result measure_all(struct bench *bench)
{
    struct ag_technique_info technique;
    enum ag_result result = AG_OK;
    for (int i = 0; ag_technique_get(i, &technique) && result == AG_OK; i++)
        if (strcmp(technique.role, "source") == 0) result = measure(bench, technique.name);
    return result;
}

static enum ag_result run(struct bench *bench, const char *scene, char *const *gi, int count)
{
    struct ag_device_info device;
    ag_frame_desc_default(&bench->frame);
    enum ag_result result = ag_device_create(bench->context, NULL, &bench->device);
    if (result == AG_OK) result = ag_scene_load(bench->context, scene, &bench->scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(bench->scene, NULL);
    if (result == AG_OK)
        result = ag_scene_default_camera(bench->scene, 0, 0.0, &bench->frame.camera, NULL);
    if (result != AG_OK) return result;
    ag_device_get_info(bench->device, &device);
    printf("%s on %s, %dx%d\n", scene, device.name, WIDTH, HEIGHT);
    if (count == 0) return measure_all(bench);
    for (int i = 0; i < count && result == AG_OK; i++) result = measure(bench, gi[i]);
    return result;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: measure SCENE OUT.exr [GI...]\n");
        return 2;
    }
    struct bench bench = { .out = argv[2] };
    enum ag_result result = ag_context_create(NULL, &bench.context);
    if (result == AG_OK) result = run(&bench, argv[1], argv + 3, argc - 3);
    if (result != AG_OK)
        fprintf(stderr, "measure: %s (%s)\n", ag_context_last_error(bench.context),
                ag_result_string(result));
    ag_image_destroy(bench.context, bench.direct);
    ag_scene_destroy(bench.scene);
    ag_device_destroy(bench.device);
    ag_context_destroy(bench.context);
    return result == AG_OK ? 0 : 1;
}
