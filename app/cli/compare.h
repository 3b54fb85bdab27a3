// What the parts of compare share. cmd_compare.c tells the story; each part has a file of its own.
#pragma once

#include "arguments.h"
#include "folder.h"
#include "session.h"
#include "tracing.h"

#include <jansson.h>

enum { STEM_SIZE = 64, UNLIMITED = -1, NOT_KNOWN = -2 };

// How far a method's image, or its indirect light alone, is from the reference's.
struct measured {
    struct ag_metrics metrics;
    double energy; // mean luminance over the reference's; NaN where that is 0
};

// One --gi: its frame, what it costs, how far it is from the truth.
struct method {
    const char *gi;       // as it was given
    char stem[STEM_SIZE]; // of its files' names: "2-lpv-steps-8"
    struct ag_image *color, *indirect, *irradiance;
    char *spelled;                                // the sum with every option written out
    json_t *options, *passes, *frame_ms, *memory; // as in --stats
    struct measured image_error, indirect_error;  // indirect_error: where the reference has it
};

// The reference: traced, from the cache, or a file that was given.
struct reference {
    struct tracing tracing;     // of the same image; without samples where a file was given
    struct output kept;         // the layers of its files
    char cache_path[PATH_SIZE]; // "": it is not cached
    struct ag_image *color;
    struct ag_image *indirect; // layer indirect_emitters_sky; NULL: absent in the given file
    int spp;                   // 0: not known
    int bounces;               // or UNLIMITED, or NOT_KNOWN
    double seconds, rays;      // of all runs that it took; NaN: not known
    double noise;              // relative standard error; NaN: not known
    double noise_relmse;       // that a perfect image would have for that noise; likewise
    bool cached;               // nothing was left to trace
};

struct comparison {
    const struct arguments *arguments;
    struct session session;
    struct ag_camera camera;
    struct ag_device *device;
    float exposure_ev; // of all images
    struct method methods[MAX_METHODS];
    int method_count;
    struct reference reference;
    struct folder folder;
    float full_indirect; // cd/m²: an error that is white in the maps of indirect light
};

// compare_method.c
// All wrong usage of --gi, --size and --frame-options is found before the work.
enum status methods_plan(struct comparison *c);
// Renders method `index` and takes its layers, times and bytes. The first one finds the exposure.
enum status method_render(struct comparison *c, int index);
void methods_finish(struct comparison *c);

// compare_reference.c
// Reads the file that was given and refuses one of another image, or looks for samples in the
// cache.
enum status reference_begin(struct comparison *c);
// Traces what is missing; --reference: nothing. Fills the rest of c->reference.
enum status reference_complete(struct comparison *c);
// reference.exr: what the tracer has, or a copy of the file that was given.
enum status reference_write_exr(struct comparison *c, const char *path);
void reference_finish(struct comparison *c);

// compare_measure.c
enum status methods_measure(struct comparison *c);

// compare_files.c
// Images and EXR files into the folder that was begun.
enum status files_write(struct comparison *c);
// Is it a name of a file that compare writes?
bool files_are_named(const char *name);

// compare_report.c
json_t *report_json(const struct comparison *c); // NULL: out of memory
void report_print(const struct comparison *c);   // the table, on standard output
// One line for each method and bound that it breaks; FAILED where there is one.
enum status report_gates(const struct comparison *c);
