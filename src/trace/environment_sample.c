#include "trace/environment_sample.h"

#include "scene/environment/environment_map.h"
#include "scene/environment/equirect.h"

#include <math.h>

// Cells of at least 0.35°: light that varies within one is found with a density that is a little
// off, which costs noise alone.
enum { MOST_WIDTH = 1024, LEAST_WIDTH = 64 };

static int width_of(const struct image *image)
{
    const int width = image->width < MOST_WIDTH ? image->width : MOST_WIDTH;
    return width > LEAST_WIDTH ? width : LEAST_WIDTH;
}

// Mean luminance of a cell, from points of a lattice that skips no texel.
static double cell_luminance(const struct environment_table *t, const struct environment_map *map,
                             int x, int y)
{
    const int across = 1 + map->radiance.width / t->width;
    const int down = 1 + map->radiance.height / t->height;
    double sum = 0.0;
    for (int j = 0; j < down; j++)
        for (int i = 0; i < across; i++) {
            const float u = ((float)x + ((float)i + 0.5f) / (float)across) / (float)t->width;
            const float v = ((float)y + ((float)j + 0.5f) / (float)down) / (float)t->height;
            const vec3s d = equirect_direction((vec2s){ { u, v } });
            sum += (double)luminance(environment_map_radiance(map, d));
        }
    return sum / (across * down);
}

// Turns values 1 … count, each a weight, into cumulative shares. Returns their sum.
static double accumulate(float *values, int count, const double *weights)
{
    double sum = 0.0, so_far = 0.0;
    for (int i = 0; i < count; i++) sum += weights[i];
    for (int i = 0; i < count; i++) {
        so_far += weights[i];
        values[i + 1] = sum > 0.0 ? (float)(so_far / sum) : (float)(i + 1) / (float)count;
    }
    values[0] = 0.0f;
    values[count] = 1.0f;
    return sum;
}

static bool fill(struct environment_table *t, struct host *host, const struct environment_map *map)
{
    double *row = host_alloc(host, (size_t)t->width, sizeof *row);
    double *rows = host_alloc(host, (size_t)t->height, sizeof *rows);
    const bool ok = row && rows;
    for (int y = 0; ok && y < t->height; y++) {
        for (int x = 0; x < t->width; x++) row[x] = cell_luminance(t, map, x, y);
        rows[y] = accumulate(t->columns + (size_t)y * ((size_t)t->width + 1), t->width, row) *
                  equirect_solid_angle(t->width, t->height, y);
    }
    if (ok && !(accumulate(t->rows, t->height, rows) > 0.0)) t->width = t->height = 0;
    host_free(host, row);
    host_free(host, rows);
    return ok;
}

bool environment_table_init(struct environment_table *t, struct host *host,
                            const struct environment *environment)
{
    *t = (struct environment_table){ 0 };
    if (!environment->map || !(environment->strength > 0.0f)) return true;
    t->width = width_of(&environment->map->radiance);
    t->height = t->width / 2;
    t->rows = host_alloc(host, (size_t)t->height + 1, sizeof *t->rows);
    t->columns = host_alloc(host, (size_t)t->height * ((size_t)t->width + 1), sizeof *t->columns);
    return t->rows && t->columns && fill(t, host, environment->map);
}

void environment_table_finish(struct environment_table *t, struct host *host)
{
    host_free(host, t->rows);
    host_free(host, t->columns);
    *t = (struct environment_table){ 0 };
}

// The interval of cumulative shares that contains u, and the place in it, 0…1.
static int find(const float *shares, int count, float u, float *within)
{
    int low = 0, high = count - 1;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (u < shares[middle + 1])
            high = middle;
        else
            low = middle + 1;
    }
    const float width = shares[low + 1] - shares[low];
    *within = width > 0.0f ? fminf(fmaxf((u - shares[low]) / width, 0.0f), 1.0f) : 0.5f;
    return low;
}

static const float *columns_of(const struct environment_table *t, int y)
{
    return t->columns + (size_t)y * ((size_t)t->width + 1);
}

// Uniform by solid angle within a cell: along the height of its band.
static float cell_pdf(const struct environment_table *t, int x, int y)
{
    const float *columns = columns_of(t, y);
    return (t->rows[y + 1] - t->rows[y]) * (columns[x + 1] - columns[x]) /
           (float)equirect_solid_angle(t->width, t->height, y);
}

vec3s environment_sample(const struct environment_table *t, const struct environment *environment,
                         vec2s u, float *pdf)
{
    float along, across;
    const int y = find(t->rows, t->height, u.y, &along);
    const int x = find(columns_of(t, y), t->width, u.x, &across);
    const float top = cosf(GLM_PIf * (float)y / (float)t->height);
    const float bottom = cosf(GLM_PIf * (float)(y + 1) / (float)t->height);
    const float height = top + along * (bottom - top);
    const float radius = sqrtf(fmaxf(1.0f - height * height, 0.0f));
    const float azimuth = (((float)x + across) / (float)t->width - 0.5f) * 2.0f * GLM_PIf;
    *pdf = cell_pdf(t, x, y);
    return environment_world_direction(
        environment, vec3_of(radius * sinf(azimuth), height, -radius * cosf(azimuth)));
}

float environment_pdf(const struct environment_table *t, const struct environment *environment,
                      vec3s direction)
{
    if (!environment_table_has_light(t)) return 0.0f;
    const vec2s uv = equirect_uv(environment_map_direction(environment, direction));
    const int x = (int)(uv.x * (float)t->width), y = (int)(uv.y * (float)t->height);
    return cell_pdf(t, x < t->width ? x : t->width - 1, y < t->height ? y : t->height - 1);
}
