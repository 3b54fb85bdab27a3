#include "bench.h"

#include "csv.h"

#include <string.h>
#include <time.h>

struct command {
    const struct bench_program *program;
    struct bench *bench;
    void *user;
};

static bool parse_option(void *user, const char *name, const char *value)
{
    const struct command *command = user;
    struct bench *bench = command->bench;
    const unsigned options = command->program->options;
    if (strcmp(name, "--device") == 0)
        bench->device_name = value;
    else if (strcmp(name, "--csv") == 0 && (options & BENCH_CSV))
        bench->csv_path = value;
    else if (strcmp(name, "--frames") == 0)
        return parse_int(value, 1, PASSES_MAX_FRAMES, &bench->frames);
    else if (strcmp(name, "--size") == 0 && (options & BENCH_SIZE))
        return parse_size(value, &bench->width, &bench->height);
    else
        return command->program->parse_option(command->user, name, value);
    return true;
}

static void print_usage(const struct bench_program *program, FILE *file)
{
    const unsigned options = program->options;
    fprintf(file, "usage: %s %s [--frames 1..%d]%s [--device NAME]%s%s\n", program->name,
            program->usage, PASSES_MAX_FRAMES, options & BENCH_SIZE ? " [--size WxH]" : "",
            options & BENCH_CSV ? " [--csv FILE]" : "",
            options & BENCH_SCENES ? " [SCENE]..." : "");
}

static bool parse(struct command *command, int argc, char **argv)
{
    struct bench_scenes *scenes = &command->bench->scenes;
    if (!command_line_parse(argc, argv, parse_option, command, scenes)) return false;
    if (scenes->count > 0 && !(command->program->options & BENCH_SCENES)) return false;
    return command->program->set_defaults(command->user);
}

static enum ag_result run(const struct command *command)
{
    struct bench *bench = command->bench;
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.device = bench->device_name;
    enum ag_result result = ag_context_create(NULL, &bench->context);
    if (result == AG_OK) result = ag_device_create(bench->context, &desc, &bench->device);
    if (result == AG_OK) ag_device_get_info(bench->device, &bench->info);
    if (result == AG_OK && command->program->print_header)
        command->program->print_header(command->user);
    for (int i = 0; i < bench->scenes.count && result == AG_OK; i++)
        result = command->program->measure_scene(command->user, bench->scenes.names[i]);
    return result;
}

int bench_main(const struct bench_program *program, struct bench *bench, void *user, int argc,
               char **argv)
{
    struct command command = { program, bench, user };
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        print_usage(program, stdout);
        if (program->help) fputs(program->help, stdout);
        return 0;
    }
    if (!parse(&command, argc, argv)) {
        print_usage(program, stderr);
        return 2;
    }
    if (!csv_open(bench->csv_path, program->csv_header, &bench->csv)) return 1;
    const enum ag_result result = run(&command);
    if (result != AG_OK)
        fprintf(stderr, "%s: %s (%s)\n", program->name, ag_context_last_error(bench->context),
                ag_result_string(result));
    ag_device_destroy(bench->device);
    ag_context_destroy(bench->context);
    const bool written = csv_close(bench->csv, bench->csv_path);
    return result == AG_OK && written ? 0 : 1;
}

enum ag_result bench_open_scene(const struct bench *bench, const char *name,
                                struct ag_scene **scene, struct ag_frame_desc *frame)
{
    ag_frame_desc_default(frame);
    enum ag_result result = ag_scene_load(bench->context, name, scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(*scene, NULL);
    if (result == AG_OK) result = ag_scene_default_camera(*scene, 0, 0.0, &frame->camera, NULL);
    return result;
}

enum ag_result bench_create_baked(const struct bench *bench, struct ag_scene *scene, const char *gi,
                                  const char *frame_options, const struct bench_bakes *bakes,
                                  struct ag_renderer **out)
{
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = bench->width;
    desc.height = bench->height;
    desc.gi = gi;
    if (frame_options) desc.frame_options = frame_options;
    desc.bakes = bakes->bakes;
    desc.bake_count = bakes->count;
    return ag_renderer_create(bench->device, scene, &desc, out);
}

enum ag_result bench_create_renderer(const struct bench *bench, struct ag_scene *scene,
                                     const char *gi, const char *frame_options,
                                     struct ag_renderer **out)
{
    struct bench_bakes bakes;
    *out = NULL;
    enum ag_result result = bench_bakes_prepare(&bakes, bench->context, scene, gi);
    if (result == AG_OK) result = bench_create_baked(bench, scene, gi, frame_options, &bakes, out);
    bench_bakes_finish(&bakes);
    return result;
}

uint64_t bench_memory_of(struct ag_renderer *renderer, const char *owner)
{
    struct ag_memory owners[PASSES_MAX];
    const int count = ag_renderer_memory(renderer, owners, PASSES_MAX);
    uint64_t bytes = 0;
    for (int i = 0; i < count && i < PASSES_MAX; i++)
        if (!owner || strcmp(owners[i].owner, owner) == 0) bytes += owners[i].bytes;
    return bytes;
}

double bench_now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

enum ag_result bench_write_png(const struct bench *bench, const char *folder, const char *scene,
                               const char *variant, const struct ag_image *image)
{
    char path[4 * BENCH_TEXT];
    const char *slash = strrchr(scene, '/');
    snprintf(path, sizeof path, "%s/%s-%s.png", folder, slash ? slash + 1 : scene, variant);
    return ag_image_write_png(bench->context, path, image);
}
