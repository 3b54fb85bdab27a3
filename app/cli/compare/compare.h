// Shared state of the parts of compare; cmd_compare.c calls them in order.
#pragma once

#include "cli/arguments.h"
#include "cli/files/folder.h"
#include "cli/session.h"
#include "cli/tracing.h"

#include <jansson.h>

enum { STEM_SIZE = 64, UNLIMITED = -1, NOT_KNOWN = -2 };

// Error of a method's image or of its indirect light.
struct measured {
    struct ag_metrics metrics;
    double energy; // mean luminance over the reference's; NaN if that is 0
};

// One --gi: its frame, costs and errors.
struct method {
    const char *gi;       // as given
    char stem[STEM_SIZE]; // prefix of file names: "2-lpv-steps-8"
    struct ag_image *color, *indirect, *irradiance;
    char *spelled;                                // the GI spec with all options
    json_t *options, *passes, *frame_ms, *memory; // as in --stats
    json_t *bake;                                 // NULL: it needs none
    struct measured image_error;
    struct measured indirect_error, irradiance_error; // where the reference has the layers
};

// The reference: traced, cached, or a given file.
struct reference {
    struct tracing tracing;     // no samples if a file was given
    struct output kept;         // the layers of its files
    char cache_path[PATH_SIZE]; // "": not cached
    struct ag_image *color;
    // Layers indirect_emitters_sky and irradiance_emitters_sky; NULL: absent in the given file.
    struct ag_image *indirect, *irradiance;
    int spp;              // 0: unknown
    int bounces;          // or UNLIMITED, or NOT_KNOWN
    double seconds, rays; // total of all runs; NaN: unknown
    double noise;         // relative standard error; NaN: unknown
    double noise_relmse;  // relmse of a perfect image with this noise; NaN: unknown
    bool cached;          // all samples were cached
};

struct comparison {
    const struct arguments *arguments;
    struct session session;
    struct ag_camera camera;
    struct ag_device *device;
    float exposure_ev; // of all images: --exposure, or the reference's
    float indirect_ev; // of images of indirect light: the same, or lower where that is dim
    struct method methods[MAX_METHODS];
    uint64_t gpu_bytes; // the largest estimate of a method
    int method_count;
    struct ag_image *depth;  // of the first method
    struct ag_image *direct; // its layer direct, which all methods share
    // The reference with the error of that layer: what is wrong where indirect light is exact.
    struct ag_image *direct_error_image;
    struct measured direct_error;
    struct reference reference;
    struct folder folder;
    float full_indirect; // cd/m²: error shown white in maps of indirect light
};

// method.c
// Checks --gi, --size and --frame-options before the work.
enum status methods_plan(struct comparison *c);
// Their memory on the GPU, that of the largest in gpu_bytes.
enum status methods_estimate(struct comparison *c);
// Renders a method and reads its layers, times and memory.
enum status method_render(struct comparison *c, int index);
void methods_finish(struct comparison *c);

// reference.c
// Reads the given file, or cached samples. Fails if the file shows another image.
enum status reference_begin(struct comparison *c);
// Traces missing samples (none with --reference) and fills the rest of c->reference.
enum status reference_complete(struct comparison *c);
// Determines the exposures of all images.
enum status reference_expose(struct comparison *c);
// Writes reference.exr: the traced layers or a copy of the given file.
enum status reference_write_exr(struct comparison *c, const char *path);
void reference_finish(struct comparison *c);

// measure.c
// Measures the layer direct, then each method.
enum status methods_measure(struct comparison *c);

// files.c
// Writes images and EXR files into the new folder.
enum status files_write(struct comparison *c);
// Is this the name of a file that compare writes?
bool files_are_named(const char *name);

// report.c
json_t *report_json(const struct comparison *c); // NULL: out of memory
void report_print(const struct comparison *c);   // the table, on standard output
// Prints a line for each exceeded bound; FAILED if there is one.
enum status report_gates(const struct comparison *c);
