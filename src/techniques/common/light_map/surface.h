// Triangles of a scene in the atlas of a light map, as shaders find them (surface.glsl).
#pragma once

#include "gpu/gpu.h"
#include "scene/charts/charts.h"

#include "techniques/common/light_map/surface_shared.h"

struct light_map_surfaces {
    gpu_buffer first, triangles;        // [count + 1] first triangle of an instance; triangles
    uint32_t count;                     // instances of the scene in the map
    const struct light_map_move *moves; // [count] of the frame; NULL: none has moved since
};

// For shaders that include surface.glsl: their bindings, and a member of their push constants.
#define LIGHT_MAP_SURFACE_BINDINGS(surfaces, cmd)                                                  \
    { .name = "light_map_first", .buffer = (surfaces)->first },                                    \
        { .name = "light_map_triangles", .buffer = (surfaces)->triangles },                        \
        gpu_transient(cmd, "light_map_moves", (surfaces)->moves,                                   \
                      (surfaces)->moves ? (surfaces)->count * sizeof *(surfaces)->moves : 0)
static inline struct light_map_instances light_map_instances(const struct light_map_surfaces *s)
{
    return (struct light_map_instances){ s->count, s->moves ? s->count : 0 };
}

// The word in tables of a place of the light map (charts_place_count).
static inline uint32_t light_map_place_word(const struct charts *charts, size_t place)
{
    const size_t line = place / charts->width, side = line / charts->height;
    return (uint32_t)(side << 2 * LIGHT_MAP_PLACE_BITS |
                      line % charts->height << LIGHT_MAP_PLACE_BITS | place % charts->width);
}

// An image of half floats, which shaders write and sample. layers: of a side.
struct gpu_image_desc light_map_image(const struct charts *charts, const char *name,
                                      uint32_t layers);
// A triangle that is not in the map, and one by its corners and their places in the atlas.
static const struct light_map_triangle LIGHT_MAP_ABSENT = { .offset = { { -1.0f, 0.0f } },
                                                            .front = LIGHT_MAP_ONE_SIDED };
struct light_map_triangle light_map_triangle_of(const struct chart_triangle *triangle,
                                                bool has_back);
// Writes `count` triangles of the scene. chart_triangle: [count] in charts->triangles, CHART_NONE:
// not in the map.
void light_map_fill_triangles(const struct charts *charts, const uint32_t *chart_triangle,
                              size_t count, struct light_map_triangle *out);
