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
// Reads the layers of the newest frame and writes them to a file.
enum status output_write(struct session *session, struct ag_renderer *renderer,
                         const struct output *output, const char *path);
