#include "scene/environment/find_sun.h"

#include "scene/environment/equirect.h"

#include <math.h>

#define DEGREES (GLM_PIf / 180.0f)
static const double PI = 3.14159265358979323846;

// The sky about the sun, its aureole, stays below 8 times the ring but for the last degree; the sun
// is a thousand to a million times as bright, and still ten times where the camera clipped it.
static const float CONTRAST = 8.0f;
// The ring is outside of the largest sun, and near enough to have its aureole and clouds.
static const float RING_INNER_RAD = 5.0f * DEGREES, RING_OUTER_RAD = 10.0f * DEGREES;
// The sun has a radius of 0.27°. Glare and the texels of small images make up to 2° of it; windows
// and luminous clouds are larger.
static const float MAX_RADIUS_RAD = 3.0f * DEGREES;
// From one edge of the largest sun to the other. Long shapes, such as tubes, are no suns.
static const float MAX_REACH_RAD = 6.0f * DEGREES;
// Shadows of less light are hardly visible, and each directional light costs shadow maps.
static const double MIN_SHARE = 0.1;

// The texels of a region in the order in which they were reached.
struct region {
    struct host *host;
    const struct image *image;
    uint8_t *is_in; // by texel
    uint32_t *texels;
    size_t count, capacity;
    double solid_angle;
    bool too_large;
    bool has_pole[2]; // the first and the last row have been tried
};

static vec3s texel_direction(const struct image *image, int x, int y)
{
    return equirect_direction(equirect_texel_uv(image->width, image->height, x, y));
}

static double texel_sr(const struct image *image, int y)
{
    return equirect_solid_angle(image->width, image->height, y);
}

static vec3s texel_radiance(const struct image *image, int x, int y)
{
    const float *at = image_at(image, x, y);
    return vec3_of(at[0], at[1], at[2]);
}

static int texel_x(const struct image *image, uint32_t texel)
{
    return (int)(texel % (uint32_t)image->width);
}

static int texel_y(const struct image *image, uint32_t texel)
{
    return (int)(texel / (uint32_t)image->width);
}

// The texel of the largest luminance, and the mean luminance over all directions.
static uint32_t find_brightest(const struct image *image, double *mean)
{
    uint32_t brightest = 0;
    float most = 0.0f;
    *mean = 0.0;
    for (int y = 0; y < image->height; y++) {
        double row = 0.0;
        for (int x = 0; x < image->width; x++) {
            const float value = luminance(texel_radiance(image, x, y));
            row += (double)value;
            if (!(value > most)) continue;
            most = value;
            brightest = (uint32_t)y * (uint32_t)image->width + (uint32_t)x;
        }
        *mean += row * texel_sr(image, y) / (4.0 * PI);
    }
    return brightest;
}

// The columns of a row that can be within `outer_rad` of the centre: `count` of them from `first`,
// which wraps.
struct columns {
    int first, count;
};

static struct columns columns_near(const struct image *image, vec3s centre, int y, float outer_rad)
{
    const float zenith = ((float)y + 0.5f) / (float)image->height * GLM_PIf;
    const float sines = sinf(zenith) * sqrtf(fmaxf(1.0f - centre.y * centre.y, 0.0f));
    const float rest = cosf(outer_rad) - cosf(zenith) * centre.y;
    const float turn = atan2f(centre.x, -centre.z) / (2.0f * GLM_PIf) + 0.5f;
    if (rest > sines) return (struct columns){ 0, 0 };
    if (rest <= -sines) return (struct columns){ 0, image->width };
    const int half = (int)(acosf(rest / sines) / (2.0f * GLM_PIf) * (float)image->width) + 1;
    if (2 * half + 1 >= image->width) return (struct columns){ 0, image->width };
    return (struct columns){ (int)(turn * (float)image->width) - half + image->width,
                             2 * half + 1 };
}

// The mean radiance of the ring, without texels of the region; false where the ring has none.
static bool find_ring(const struct region *region, vec3s centre, double mean[3])
{
    const struct image *image = region->image;
    const float inner = cosf(RING_INNER_RAD), outer = cosf(RING_OUTER_RAD);
    double weight = 0.0;
    for (int c = 0; c < 3; c++) mean[c] = 0.0;
    for (int y = 0; y < image->height; y++) {
        const double solid_angle = texel_sr(image, y);
        const struct columns columns = columns_near(image, centre, y, RING_OUTER_RAD);
        for (int i = 0; i < columns.count; i++) {
            const int x = (columns.first + i) % image->width;
            const float cosine = glms_vec3_dot(centre, texel_direction(image, x, y));
            if (cosine < outer || cosine > inner) continue;
            if (region->is_in[(size_t)y * (size_t)image->width + (size_t)x]) continue;
            for (int c = 0; c < 3; c++) mean[c] += solid_angle * (double)image_at(image, x, y)[c];
            weight += solid_angle;
        }
    }
    for (int c = 0; c < 3 && weight > 0.0; c++) mean[c] /= weight;
    return weight > 0.0;
}

// ---- regions

static bool region_init(struct region *region, struct host *host, const struct image *image)
{
    *region = (struct region){ .host = host, .image = image };
    region->is_in = host_alloc(host, (size_t)image->width * (size_t)image->height, 1);
    return region->is_in != NULL;
}

static void region_finish(struct region *region)
{
    host_free(region->host, region->is_in);
    host_free(region->host, region->texels);
}

static void region_clear(struct region *region)
{
    for (size_t i = 0; i < region->count; i++) region->is_in[region->texels[i]] = 0;
    region->count = 0;
    region->solid_angle = 0.0;
    region->too_large = region->has_pole[0] = region->has_pole[1] = false;
}

static bool region_add(struct region *region, uint32_t texel)
{
    if (region->count == region->capacity) {
        enum { FIRST_CAPACITY = 256 };
        const size_t capacity = region->capacity > 0 ? 2 * region->capacity : FIRST_CAPACITY;
        uint32_t *texels =
            host_realloc(region->host, region->texels, capacity, sizeof *region->texels);
        if (!texels) return false;
        region->texels = texels;
        region->capacity = capacity;
    }
    region->is_in[texel] = 1;
    region->texels[region->count++] = texel;
    region->solid_angle += texel_sr(region->image, texel_y(region->image, texel));
    return true;
}

struct growth {
    vec3s centre; // of the brightest texel
    float least;  // luminance
};

static bool region_try(struct region *region, const struct growth *growth, int x, int y)
{
    const struct image *image = region->image;
    x = (x + image->width) % image->width;
    const uint32_t texel = (uint32_t)y * (uint32_t)image->width + (uint32_t)x;
    if (region->is_in[texel]) return true;
    if (!(luminance(texel_radiance(image, x, y)) > growth->least)) return true;
    const vec3s direction = texel_direction(image, x, y);
    if (glms_vec3_dot(direction, growth->centre) < cosf(MAX_REACH_RAD)) region->too_large = true;
    return region_add(region, texel);
}

// All texels of the first and the last row meet at a pole.
static bool region_try_neighbours(struct region *region, const struct growth *growth,
                                  uint32_t texel)
{
    const int x = texel_x(region->image, texel), y = texel_y(region->image, texel);
    const int last = region->image->height - 1;
    for (int row = y > 0 ? y - 1 : 0; row <= y + 1 && row <= last; row++)
        for (int column = x - 1; column <= x + 1; column++)
            if (!region_try(region, growth, column, row)) return false;
    if ((y > 0 && y < last) || region->has_pole[y > 0]) return true;
    region->has_pole[y > 0] = true;
    for (int column = 0; column < region->image->width; column++)
        if (!region_try(region, growth, column, y)) return false;
    return true;
}

// The texels above `least` that are connected with the brightest one, until they are too many.
static bool region_grow(struct region *region, uint32_t brightest, float least)
{
    const double most = 2.0 * PI * (1.0 - cos((double)MAX_RADIUS_RAD));
    const int x = texel_x(region->image, brightest), y = texel_y(region->image, brightest);
    const struct growth growth = { texel_direction(region->image, x, y), least };
    region_clear(region);
    if (!region_try(region, &growth, x, y)) return false;
    for (size_t i = 0; i < region->count && !region->too_large; i++) {
        if (!region_try_neighbours(region, &growth, region->texels[i])) return false;
        if (region->solid_angle >= most) region->too_large = true;
    }
    return true;
}

// ---- the excess over the ring

static double excess_of(float radiance, double ring)
{
    return fmax((double)radiance - ring, 0.0);
}

static void sum_excess(const struct region *region, const double ring[3],
                       struct environment_sun *out)
{
    const struct image *image = region->image;
    double lux[3] = { 0 }, direction[3] = { 0 }, sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < region->count; i++) {
        const uint32_t texel = region->texels[i];
        const int x = texel_x(image, texel), y = texel_y(image, texel);
        const double solid_angle = texel_sr(image, y);
        const vec3s towards = texel_direction(image, x, y);
        vec3s excess;
        for (int c = 0; c < 3; c++) {
            const double part = excess_of(image_at(image, x, y)[c], ring[c]);
            lux[c] += part * solid_angle;
            excess.raw[c] = (float)part;
        }
        const double value = (double)luminance(excess);
        for (int c = 0; c < 3; c++) direction[c] += (double)towards.raw[c] * value * solid_angle;
        sum += value * solid_angle;
        squares += value * value * solid_angle;
    }
    for (int c = 0; c < 3; c++) {
        out->illuminance_lux.raw[c] = (float)lux[c];
        out->to_sun.raw[c] = sum > 0.0 ? (float)(direction[c] / sum) : 0.0f;
    }
    out->to_sun = vec3_unit(out->to_sun);
    // Ω = sum²/squares; of a cap 2π(1 − cos r) = 4π sin²(r/2).
    out->radius_rad = squares > 0.0
                          ? (float)(2.0 * asin(fmin(sqrt(sum / squares * sum / (4.0 * PI)), 1.0)))
                          : 0.0f;
}

// False: there is no memory. A region about the brightest texel can touch the ring of that texel:
// the second ring has the centre of the first region.
static bool find_sun(struct region *region, uint32_t brightest, double ring[3],
                     struct environment_sun *out)
{
    const struct image *image = region->image;
    vec3s centre = texel_direction(image, texel_x(image, brightest), texel_y(image, brightest));
    for (int pass = 0; pass < 2; pass++) {
        if (!find_ring(region, centre, ring)) return true;
        const vec3s mean = vec3_of((float)ring[0], (float)ring[1], (float)ring[2]);
        if (!region_grow(region, brightest, CONTRAST * luminance(mean))) return false;
        if (region->too_large || region->count == 0) return true;
        sum_excess(region, ring, out);
        centre = out->to_sun;
    }
    out->found = true;
    return true;
}

static void subtract_excess(const struct region *region, const double ring[3], struct image *image)
{
    for (size_t i = 0; i < region->count; i++) {
        const uint32_t texel = region->texels[i];
        float *at = image_at(image, texel_x(image, texel), texel_y(image, texel));
        for (int c = 0; c < 3; c++) at[c] = fminf(at[c], (float)ring[c]);
    }
}

bool environment_extract_sun(struct host *host, struct image *equirect, struct environment_sun *out)
{
    struct environment_sun sun = { 0 };
    struct region region;
    double mean, ring[3];
    *out = sun;
    if (equirect->channels != 3)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot find the sun of an image of %d channels: it must have 3",
                         equirect->channels);
    const uint32_t brightest = find_brightest(equirect, &mean);
    if (!isfinite(mean) || !(mean > 0.0)) return true;
    if (!region_init(&region, host, equirect)) return false;
    const bool ok = find_sun(&region, brightest, ring, &sun);
    if (ok && sun.found && (double)luminance(sun.illuminance_lux) >= MIN_SHARE * PI * mean) {
        subtract_excess(&region, ring, equirect);
        *out = sun;
    }
    region_finish(&region);
    return ok;
}
