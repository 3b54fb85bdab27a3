// An image of a scene that scatters light, by ort and by the reference. Both have the same
// highlights, which a black material shows, and the same diffuse reflectance: the ratio of indirect
// light to irradiance under `ambient`.
#pragma once

#include "bench.h"

enum layer { HIGHLIGHT, POSITION, DEPTH, REFLECTED, IRRADIANCE, SUM, OF_ORT, LAYERS };

struct image_pair {
    const struct bench *bench;
    const char *scene_name, *light_name, *folder;
    int points; // of the reference
    char gi[2 * BENCH_TEXT];
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    struct ag_light_desc light;     // the only one
    struct ag_image *layer[LAYERS]; // SUM: of the reference, OF_ORT: of ort
    float ev;
};
enum ag_result image_pair_render(struct image_pair *pair);
// Behind it; also finds the exposure.
enum ag_result image_pair_make_reference(struct image_pair *pair);
enum ag_result image_pair_print_errors(const struct image_pair *pair);
// ort on the left.
enum ag_result image_pair_write(const struct image_pair *pair);
void image_pair_finish(struct image_pair *pair);
