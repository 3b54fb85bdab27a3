#include "scene/environment/environment_map.h"

#include "core/files/file.h"
#include "core/hash.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "scene/environment/equirect.h"
#include "scene/limits.h"

#include <math.h>
#include <string.h>

// ---- lookup

// Columns wrap; rows beyond a pole repeat the last.
static const float *texel_at(const struct image *image, int x, int y)
{
    x = x < 0 ? x + image->width : x >= image->width ? x - image->width : x;
    y = y < 0 ? 0 : y >= image->height ? image->height - 1 : y;
    return image_at(image, x, y);
}

static vec3s lookup(const struct image *image, vec3s direction)
{
    const vec2s uv = equirect_uv(direction);
    const float x = uv.x * (float)image->width - 0.5f;
    const float y = uv.y * (float)image->height - 0.5f;
    const float left = floorf(x), top = floorf(y), u = x - left, v = y - top;
    const int column = (int)left, row = (int)top;
    const float *a = texel_at(image, column, row);
    const float *b = texel_at(image, column + 1, row);
    const float *c = texel_at(image, column, row + 1);
    const float *d = texel_at(image, column + 1, row + 1);
    vec3s out;
    for (int i = 0; i < 3; i++)
        out.raw[i] = (1 - v) * ((1 - u) * a[i] + u * b[i]) + v * ((1 - u) * c[i] + u * d[i]);
    return out;
}

vec3s environment_map_radiance(const struct environment_map *map, vec3s direction)
{
    return lookup(&map->radiance, direction);
}

vec3s environment_map_coarse(const struct environment_map *map, vec3s direction)
{
    return lookup(&map->coarse, direction);
}

// ---- content

// The values of a texel that are finite and at least 0; false where one was not.
static bool clean(const float *from, int channels, float *out)
{
    bool all = true;
    for (int c = 0; c < 3; c++) {
        const float value = from[channels < 3 ? 0 : c];
        const bool valid = value >= 0.0f && value <= SCENE_MAX_RADIANCE;
        out[c] = valid ? value : 0.0f;
        all = all && valid;
    }
    return all;
}

static bool copy_clean(struct environment_map *map, const struct image *from, struct image *out)
{
    size_t wrong = 0;
    if (!image_init(out, map->host, from->width, from->height, 3)) return false;
    for (int y = 0; y < from->height; y++)
        for (int x = 0; x < from->width; x++)
            wrong += !clean(image_at(from, x, y), from->channels, image_at(out, x, y));
    if (wrong > 0)
        host_log(map->host, LOG_WARNING,
                 "environment %s: %zu pixels have values that are negative, not finite or above %g "
                 "cd/m²: these are 0",
                 map->name, wrong, (double)SCENE_MAX_RADIANCE);
    return true;
}

// Adds a share of a row to a shorter row: each value to the texels that it overlaps.
static void add_row(const float *from, int width, double weight, double *to, int to_width)
{
    for (int x = 0; x < width; x++) {
        const double begin = (double)x * to_width / width, end = (double)(x + 1) * to_width / width;
        for (int t = (int)begin; t < to_width && (double)t < end; t++) {
            const double part = fmin(end, t + 1) - fmax(begin, t);
            for (int c = 0; c < 3; c++) to[3 * t + c] += weight * part * (double)from[3 * x + c];
        }
    }
}

// Solid angle of a row between two heights, in rows, over 2π.
static double band(double top, double bottom, int height)
{
    return cos(GLM_PI * top / height) - cos(GLM_PI * bottom / height);
}

// Means over solid angles, which keep the energy.
static bool shrink(struct environment_map *map, const struct image *from, int width, int height,
                   struct image *out)
{
    double *row = host_alloc(map->host, 3 * (size_t)width, sizeof *row);
    const bool ok = row && image_init(out, map->host, width, height, 3);
    const double step = (double)from->height / height;
    for (int y = 0; ok && y < height; y++) {
        const double top = y * step, bottom = (y + 1) * step;
        memset(row, 0, 3 * (size_t)width * sizeof *row);
        for (int k = (int)top; k < from->height && (double)k < bottom; k++)
            add_row(image_at(from, 0, k), from->width,
                    band(fmax(top, k), fmin(bottom, k + 1), from->height) /
                        band(top, bottom, from->height),
                    row, width);
        for (int i = 0; i < 3 * width; i++) image_at(out, 0, y)[i] = (float)row[i];
    }
    host_free(map->host, row);
    return ok;
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

static bool shrink_to(struct environment_map *map, const struct image *from, int most,
                      struct image *out)
{
    return shrink(map, from, least(from->width, most), least(from->height, most / 2), out);
}

// RMS of what a number of bands lacks over RMS of the whole (Parseval's theorem).
static float missing_share(int bands, double sh[3][SH_MAX_COUNT], double squares)
{
    double found = 0.0;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < SH_COUNT(bands); i++) found += sh[c][i] * sh[c][i];
    return squares > 0.0 ? (float)sqrt(fmax(1.0 - found / squares, 0.0)) : 0.0f;
}

// Samples the interpolated image at the centres of cells of at most 0.7°.
static bool project(struct environment_map *map)
{
    enum { WIDTH = 512, HEIGHT = WIDTH / 2 };
    struct environment_map small = { .host = map->host };
    double sum[3][SH_MAX_COUNT] = { 0 }, squares = 0.0;
    const bool ok = shrink_to(map, &map->radiance, WIDTH, &small.radiance);
    for (int y = 0; ok && y < HEIGHT; y++) {
        const double sr = equirect_solid_angle(WIDTH, HEIGHT, y);
        for (int x = 0; x < WIDTH; x++) {
            const vec2s uv = equirect_texel_uv(WIDTH, HEIGHT, x, y);
            const vec3s direction = equirect_direction(uv);
            const vec3s radiance = environment_map_radiance(&small, direction);
            float basis[SH_MAX_COUNT];
            sh_eval(SH_MAX_BANDS, direction, basis);
            squares += sr * (double)glms_vec3_norm2(radiance);
            for (int c = 0; c < 3; c++)
                for (int i = 0; i < SH_MAX_COUNT; i++)
                    sum[c][i] += sr * (double)radiance.raw[c] * (double)basis[i];
        }
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < SH_MAX_COUNT; i++) map->sh[c][i] = (float)sum[c][i];
    for (int bands = 2; bands <= 5; bands++)
        map->sh_error[bands - 2] = missing_share(bands, sum, squares);
    image_finish(&small.radiance, map->host);
    return ok;
}

static float peak_of(const struct image *image)
{
    float peak = 0.0f;
    const size_t values = (size_t)image->width * (size_t)image->height * 3;
    for (size_t i = 0; i < values; i++) peak = fmaxf(peak, image->pixels[i]);
    return peak;
}

static uint64_t key_of(const struct environment_map *map)
{
    const struct image *image = &map->radiance;
    const int size[] = { image->width, image->height };
    uint64_t key = hash_bytes(size, sizeof size, 0);
    key = hash_bytes(&map->sun.to_sun, sizeof(vec3s), key);
    key = hash_bytes(&map->sun.illuminance_lux, sizeof(vec3s), key);
    return hash_bytes(image->pixels,
                      (size_t)image->width * (size_t)image->height * 3 * sizeof(float), key);
}

static bool find_light(struct environment_map *map, const struct image *from)
{
    struct image whole = { 0 };
    bool ok =
        copy_clean(map, from, &whole) && environment_extract_sun(map->host, &whole, &map->sun);
    ok = ok && shrink_to(map, &whole, ENVIRONMENT_MAX_WIDTH, &map->radiance);
    image_finish(&whole, map->host);
    return ok;
}

// Computes the other members from the image and its sun.
static bool complete(struct environment_map *map)
{
    enum { COARSE_WIDTH = 64 };
    if (!shrink_to(map, &map->radiance, COARSE_WIDTH, &map->coarse) || !project(map)) return false;
    map->peak = peak_of(&map->radiance);
    map->key = key_of(map);
    if (!(map->peak > 0.0f) && !map->sun.found)
        host_log(map->host, LOG_WARNING, "environment %s is black", map->name);
    return true;
}

// ---- creation and destruction

static void destroy(struct environment_map *map)
{
    struct host *host = map->host;
    image_finish(&map->radiance, host);
    image_finish(&map->coarse, host);
    host_free(host, (char *)map->name);
    host_free(host, map);
}

static struct environment_map *begin(struct host *host, const char *name)
{
    struct environment_map *map = host_alloc(host, 1, sizeof *map);
    if (!map) return NULL;
    map->host = host;
    atomic_init(&map->users, 1);
    map->name = host_strdup(host, name);
    if (map->name) return map;
    destroy(map);
    return NULL;
}

static struct environment_map *end(struct environment_map *map, bool ok)
{
    if (ok && complete(map)) return map;
    destroy(map);
    return NULL;
}

struct environment_map *environment_map_create(struct host *host, const char *name,
                                               const struct image *equirectangular)
{
    struct environment_map *map = begin(host, name);
    return map ? end(map, find_light(map, equirectangular)) : NULL;
}

struct environment_map *environment_map_restore(struct host *host, const char *name,
                                                const struct image *radiance,
                                                const struct environment_sun *sun)
{
    struct environment_map *map = begin(host, name);
    if (!map) return NULL;
    map->sun = *sun;
    return end(map, copy_clean(map, radiance, &map->radiance));
}

float environment_map_strongest(const struct environment_map *map)
{
    return fmaxf(map->peak, glms_vec3_max(map->sun.illuminance_lux));
}

static bool draw_sky(struct environment_map *map, const struct sun_sky_model *model)
{
    enum { WIDTH = 1024, HEIGHT = WIDTH / 2 };
    if (!image_init(&map->radiance, map->host, WIDTH, HEIGHT, 3)) return false;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const vec2s uv = equirect_texel_uv(WIDTH, HEIGHT, x, y);
            const vec3s radiance = sun_sky_radiance(model, equirect_direction(uv));
            memcpy(image_at(&map->radiance, x, y), radiance.raw, sizeof radiance.raw);
        }
    return true;
}

struct environment_map *environment_map_of_sky(struct host *host, const struct sun_sky *sky)
{
    struct environment_map *map = begin(host, "sun-sky");
    struct sun_sky_model model;
    if (!map) return NULL;
    sun_sky_prepare(sky, &model);
    map->sun.illuminance_lux = sun_sky_sun(&model, &map->sun.to_sun);
    map->sun.found = glms_vec3_max(map->sun.illuminance_lux) > 0.0f;
    map->sun.radius_rad = SUN_SKY_SUN_RADIUS_RAD;
    return end(map, draw_sky(map, &model));
}

static bool read_image(struct host *host, const char *path, struct image *out)
{
    char extension[16];
    file_extension(path, extension);
    if (strcmp(extension, "hdr") == 0 || strcmp(extension, "pic") == 0)
        return hdr_read(host, path, out);
    if (strcmp(extension, "exr") == 0) return exr_read(host, path, NULL, out);
    return host_fail(host, FAIL_UNSUPPORTED,
                     "environment %s: not an image of radiance; use a .hdr or .exr file", path);
}

struct environment_map *environment_map_load(struct host *host, const char *path)
{
    struct image image = { 0 };
    struct environment_map *map = NULL;
    if (read_image(host, path, &image)) map = environment_map_create(host, path, &image);
    image_finish(&image, host);
    return map;
}

static struct environment_map *writable(const struct environment_map *map)
{
    return (struct environment_map *)map; // the count of users alone changes
}

void environment_map_retain(const struct environment_map *map)
{
    if (map) atomic_fetch_add(&writable(map)->users, 1);
}

void environment_map_release(const struct environment_map *map)
{
    if (map && atomic_fetch_sub(&writable(map)->users, 1) == 1) destroy(writable(map));
}

static bool copy_light(struct environment_map *copy, const struct environment_map *map)
{
    const struct image *from = &map->radiance;
    copy->sun = map->sun;
    if (!image_init(&copy->radiance, copy->host, from->width, from->height, 3)) return false;
    memcpy(copy->radiance.pixels, from->pixels,
           (size_t)from->width * (size_t)from->height * 3 * sizeof *from->pixels);
    return true;
}

const struct environment_map *environment_map_move(const struct environment_map *map,
                                                   struct host *host)
{
    if (atomic_load(&writable(map)->users) == 1) {
        writable(map)->host = host;
        return map;
    }
    struct environment_map *copy = begin(host, map->name);
    if (copy) copy = end(copy, copy_light(copy, map));
    if (copy) environment_map_release(map);
    return copy;
}
