// Directions to the map of an environment, chosen by its luminance (Pharr, Jakob & Humphreys 2023,
// section 12.5).
#pragma once

#include "core/host.h"
#include "scene/environment.h"

struct environment_table {
    int width, height;
    // Cumulative shares: of rows [height + 1], and of the columns of each row [height][width + 1].
    float *rows, *columns;
};

// A table of no size where there is no map, or a black one. environment_table_finish accepts zero.
bool environment_table_init(struct environment_table *table, struct host *host,
                            const struct environment *environment);
void environment_table_finish(struct environment_table *table, struct host *host);

static inline bool environment_table_has_light(const struct environment_table *table)
{
    return table->width > 0;
}

// A unit direction in world space and its density, sr⁻¹. Needs light.
vec3s environment_sample(const struct environment_table *table,
                         const struct environment *environment, vec2s u, float *pdf);
// The density of environment_sample, sr⁻¹; 0 without light.
float environment_pdf(const struct environment_table *table, const struct environment *environment,
                      vec3s direction);
