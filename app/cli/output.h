// Output images: their layers, what a PNG shows of them.
#pragma once

#include "cli/files/whole_file.h"
#include "session.h"

enum { MAX_LAYERS = 32 };

// Layers of an output image, from --aov and --debug-view.
struct output {
    const char *layers[MAX_LAYERS]; // names of the library's layers
    int layer_count;
    bool exr;
    char names[256]; // what `layers` points into
};

// Unknown layers, and several layers in a PNG, are wrong usage. layer_name: valid names, NULL
// past the end; fallback: the list without --aov.
enum status output_plan(const struct arguments *arguments, const char *path,
                        const char *(*layer_name)(int), const char *fallback, struct output *out);
bool output_has_layer(const struct output *output, const char *layer);
// Converts a layer to display values 0…1 for a PNG; ev: exposure of radiance.
enum ag_result layer_to_display(struct session *session, const char *layer, float ev,
                                struct ag_image **image);
// "shots/house.glb" and "@house:lit=1" give "house" + ending.
void output_default(const char *scene, const char *ending, char out[PATH_SIZE]);
// Layers of an output, and the exposure of its display values. Zero: no layer.
struct output_images {
    struct ag_image *layers[MAX_LAYERS];
    struct ag_image *radiance; // summed with the layer display, which is of its mean
    float ev;
};
// Reads the layers of the newest frame. Finish `out` also after a failure.
enum status output_read(struct session *session, struct ag_renderer *renderer,
                        const struct output *output, struct output_images *out);
// Replaces layers of light and reflectance by their mean over frames. For each frame from the
// first, index 0, to the last: the pixels of `out` are the sum so far, and the mean after the last.
// Geometry (depth, position, normal, motion, id) and debug stay as they are.
enum status output_average(struct session *session, struct ag_renderer *renderer,
                           const struct output *output, int index, int count,
                           struct output_images *out);
void output_finish(struct session *session, struct output_images *images);
// Reads the layers of the newest frame and writes them, without a message.
enum ag_result output_try(struct session *session, struct ag_renderer *renderer,
                          const struct output *output, const char *path);
enum status output_write(struct session *session, struct ag_renderer *renderer,
                         const struct output *output, struct output_images *images,
                         const char *path);
