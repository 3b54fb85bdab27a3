// The layers of a checkpoint, and resuming from them.
#include "trace/reference_state.h"

#include <math.h>
#include <string.h>

const enum reference_layer reference_kept_layers[REFERENCE_KEPT_COUNT] = {
    [KEPT_DIRECT] = REFERENCE_DIRECT,
    [KEPT_INDIRECT] = REFERENCE_INDIRECT,
    [KEPT_INDIRECT_EMITTERS_SKY] = REFERENCE_INDIRECT_EMITTERS_SKY,
    [KEPT_IRRADIANCE] = REFERENCE_IRRADIANCE,
    [KEPT_IRRADIANCE_EMITTERS_SKY] = REFERENCE_IRRADIANCE_EMITTERS_SKY,
    [KEPT_ERROR] = REFERENCE_ERROR,
    [KEPT_SAMPLES] = REFERENCE_SAMPLES,
};

// Sample counts must be integers, equal within a tile.
static bool restore_tile(struct reference *r, size_t index, const struct image *samples)
{
    int left = (int)(index % (size_t)r->tiles_x) * REFERENCE_TILE,
        top = (int)(index / (size_t)r->tiles_x) * REFERENCE_TILE;
    float n = image_at(samples, left, top)[0];
    if (!(n >= 0.0f && n < 0x1p24f && n == floorf(n))) return false;
    for (int y = top; y < top + REFERENCE_TILE && y < r->height; y++)
        for (int x = left; x < left + REFERENCE_TILE && x < r->width; x++)
            if (image_at(samples, x, y)[0] != n) return false;
    r->tiles[index].samples = (int)n;
    return true;
}

static bool restore_sums(const struct image *image, int x, int y, int samples, double sums[3])
{
    const float *mean = image_at(image, x, y);
    bool finite = true;
    for (int c = 0; c < 3; c++) {
        sums[c] = (double)mean[c] * samples;
        finite = finite && isfinite(sums[c]);
    }
    return finite;
}

static bool restore_pixel(struct reference *r, int x, int y,
                          const struct image layers[REFERENCE_KEPT_COUNT])
{
    struct pixel_sums *s = &r->sums[(size_t)y * (size_t)r->width + (size_t)x];
    int n = reference_samples_of(r, x, y);
    bool ok =
        restore_sums(&layers[KEPT_DIRECT], x, y, n, s->direct) &&
        restore_sums(&layers[KEPT_INDIRECT], x, y, n, s->indirect) &&
        restore_sums(&layers[KEPT_INDIRECT_EMITTERS_SKY], x, y, n, s->indirect_emitters_sky) &&
        restore_sums(&layers[KEPT_IRRADIANCE], x, y, n, s->irradiance) &&
        restore_sums(&layers[KEPT_IRRADIANCE_EMITTERS_SKY], x, y, n, s->irradiance_emitters_sky);
    const float *error = image_at(&layers[KEPT_ERROR], x, y);
    for (int c = 0; ok && c < 3; c++) {
        double sum = s->direct[c] + s->indirect[c], deviation = (double)error[c];
        s->squares[c] = n > 0 ? sum * sum / n : 0.0;
        if (n > 1) s->squares[c] += deviation * deviation * n * (n - 1.0);
        ok = isfinite(s->squares[c]);
    }
    return ok;
}

bool reference_restore(struct reference *r, const struct image layers[REFERENCE_KEPT_COUNT])
{
    for (int i = 0; i < REFERENCE_KEPT_COUNT; i++)
        if (layers[i].width != r->width || layers[i].height != r->height ||
            layers[i].channels != reference_layer_channels(reference_kept_layers[i]))
            return host_fail(r->host, FAIL_FORMAT, "reference to resume: layer %s is not %dx%d",
                             reference_layer_name((int)reference_kept_layers[i]), r->width,
                             r->height);
    bool ok = true;
    for (size_t i = 0; ok && i < reference_tile_count(r); i++)
        ok = restore_tile(r, i, &layers[KEPT_SAMPLES]);
    for (int y = 0; ok && y < r->height; y++)
        for (int x = 0; ok && x < r->width; x++) ok = restore_pixel(r, x, y, layers);
    if (ok) return true;
    memset(r->sums, 0, (size_t)r->width * (size_t)r->height * sizeof *r->sums);
    memset(r->tiles, 0, reference_tile_count(r) * sizeof *r->tiles);
    return host_fail(r->host, FAIL_FORMAT, "reference to resume: damaged layers");
}
