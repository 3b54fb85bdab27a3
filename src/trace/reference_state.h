// The state of a reference and its samples, which its files share.
#pragma once

#include "trace/path.h"
#include "trace/trace.h"

enum { REFERENCE_TILE = 16 }; // pixels: neighbouring rays hit the same triangles

struct pixel_sums {
    double direct[3], indirect[3], indirect_emitters_sky[3];
    double irradiance[3], irradiance_emitters_sky[3];
    double squares[3]; // of direct + indirect
};

struct reference_tile {
    int samples; // per pixel so far
    uint64_t rays;
};

struct obscurance_sums;
struct guide;

struct reference {
    struct host *host;
    struct trace_scene *scene;
    struct path_settings settings;
    struct reference_options options;
    int width, height, tiles_x, tiles_y;
    vec3s camera_position, forward, right, up; // right, up: to the image's edge at distance 1
    float near_m;
    struct pixel_sums *sums;            // [height][width]
    struct reference_tile *tiles;       // [tiles_y][tiles_x]
    struct obscurance_sums *obscurance; // [height][width]; NULL before the first read
    bool trained;
    struct guide *guide; // NULL: not guided
    uint64_t training_rays;
    uint64_t key;
};

static inline size_t reference_tile_count(const struct reference *r)
{
    return (size_t)r->tiles_x * (size_t)r->tiles_y;
}

// Samples of the pixels of the tile that has the pixel.
static inline int reference_samples_of(const struct reference *r, int x, int y)
{
    return r
        ->tiles[(size_t)(y / REFERENCE_TILE) * (size_t)r->tiles_x + (size_t)(x / REFERENCE_TILE)]
        .samples;
}

int reference_min_samples(const struct reference *r);
// The primary hit at an image point in pixels.
struct path_start reference_start_at(const struct reference *r, float x, float y, uint64_t *rays);

// Adjacent pixels of a tile's row, and the samples of each that are traced.
struct reference_row {
    int x, y, width;
    int from, to;
};
// Adds to the sums of its pixels. Requires a trained reference. Any thread, with denormals flushed.
void reference_trace_row(const struct reference *r, const struct reference_row *row,
                         struct pixel_sums *sums, uint64_t *rays);
int reference_layer_channels(enum reference_layer layer);
