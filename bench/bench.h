// The common part of the benchmarks that use include/afterglow alone: command line, context,
// device, scenes, renderers and the CSV file.
#ifndef AG_BENCH_BENCH_H
#define AG_BENCH_BENCH_H

#include "bakes.h"
#include "command_line.h"
#include "passes.h"

#include <afterglow/afterglow.h>

#include <stdio.h>

enum { BENCH_TEXT = 256 };

// Common parts of every benchmark. The caller sets the defaults of width, height and frames.
struct bench {
    struct ag_context *context;
    struct ag_device *device;
    int width, height;          // --size
    int frames;                 // --frames
    const char *device_name;    // --device
    const char *csv_path;       // --csv
    FILE *csv;                  // NULL: none
    struct bench_scenes scenes; // SCENE…
    struct ag_device_info info; // of the device
};

// Common options beside --frames and --device.
enum { BENCH_SIZE = 1, BENCH_CSV = 2, BENCH_SCENES = 4 };

struct bench_program {
    const char *name, *usage; // usage: the program's own options
    const char *help;         // more lines of --help; may be NULL
    unsigned options;
    const char *csv_header;
    // The program's own options, as in command_line_parse.
    bool (*parse_option)(void *user, const char *name, const char *value);
    // Called after the command line is parsed: fills in defaults. False: the usage is printed.
    bool (*set_defaults)(void *user);
    // Called when there is a device; may be NULL.
    void (*print_header)(void *user);
    enum ag_result (*measure_scene)(void *user, const char *scene);
};

// Runs a benchmark on each scene of the command line; returns the exit status. `bench` is a member
// of the struct at `user`.
int bench_main(const struct bench_program *program, struct bench *bench, void *user, int argc,
               char **argv);

// Loads a scene, adds the default light where it is dark, and takes its first camera.
enum ag_result bench_open_scene(const struct bench *bench, const char *name,
                                struct ag_scene **scene, struct ag_frame_desc *frame);
// A renderer of the benchmark's size. frame_options may be NULL.
enum ag_result bench_create_renderer(const struct bench *bench, struct ag_scene *scene,
                                     const char *gi, const char *frame_options,
                                     struct ag_renderer **out);
// The same with bakes that are there already, for several renderers of one bake.
enum ag_result bench_create_baked(const struct bench *bench, struct ag_scene *scene, const char *gi,
                                  const char *frame_options, const struct bench_bakes *bakes,
                                  struct ag_renderer **out);
// GPU memory of a renderer's owner, as "vct"; NULL: of all.
uint64_t bench_memory_of(struct ag_renderer *renderer, const char *owner);
double bench_now_ms(void);
// Writes "<folder>/<scene>-<variant>.png".
enum ag_result bench_write_png(const struct bench *bench, const char *folder, const char *scene,
                               const char *variant, const struct ag_image *image);

#endif
