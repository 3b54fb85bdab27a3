// A chart's rectangle is an image whose other texels repeat its border (charts.owner): the denoiser
// sees neither other charts nor black.
#include "lightmap/denoise.h"

#ifdef AG_OPEN_IMAGE_DENOISE
#include <OpenImageDenoise/oidn.h>

#include <string.h>

struct denoiser {
    struct lightmap *map;
    OIDNDevice device;
    OIDNFilter filter; // RTLightmap
};

// Null where the place in the chart's rectangle belongs to no chart, or to another one.
static float *owned_texel(const struct denoiser *d, int side, const struct chart *chart, uint32_t x,
                          uint32_t y)
{
    const struct charts *charts = &d->map->charts;
    const uint32_t column = chart->x + x, row = chart->y + y;
    const uint32_t owner = charts->owner[(size_t)row * charts->width + column];
    if (owner < chart->first_texel || owner - chart->first_texel >= chart->texel_count) return NULL;
    return image_at(&d->map->irradiance[side], (int)column, (int)row);
}

static const float *first_owned(const struct denoiser *d, int side, const struct chart *chart)
{
    const float *texel = NULL;
    for (uint32_t i = 0; !texel && i < chart->width * chart->height; i++)
        texel = owned_texel(d, side, chart, i % chart->width, i / chart->width);
    return texel;
}

// Texels beyond the gutter are not the chart's: they get those of the row before.
static void read_chart(const struct denoiser *d, int side, const struct chart *chart, float *out)
{
    const float *last = first_owned(d, side, chart);
    for (uint32_t i = 0; last && i < chart->width * chart->height; i++) {
        const float *own = owned_texel(d, side, chart, i % chart->width, i / chart->width);
        if (own) last = own;
        memcpy(out + 3 * (size_t)i, last, 3 * sizeof *out);
    }
}

static void write_chart(const struct denoiser *d, int side, const struct chart *chart,
                        const float *in)
{
    for (uint32_t i = 0; i < chart->width * chart->height; i++) {
        float *own = owned_texel(d, side, chart, i % chart->width, i / chart->width);
        if (own) memcpy(own, in + 3 * (size_t)i, 3 * sizeof *in);
    }
}

static bool denoise_chart(const struct denoiser *d, int side, const struct chart *chart)
{
    struct host *host = d->map->host;
    const size_t width = chart->width, height = chart->height, bytes = 3 * sizeof(float);
    OIDNBuffer buffer = oidnNewBuffer(d->device, width * height * bytes);
    float *pixels = host_alloc(host, width * height, bytes);
    const bool ok = buffer && pixels;
    if (ok) {
        read_chart(d, side, chart, pixels);
        oidnWriteBuffer(buffer, 0, width * height * bytes, pixels);
        oidnSetFilterImage(d->filter, "color", buffer, OIDN_FORMAT_FLOAT3, width, height, 0, 0, 0);
        oidnSetFilterImage(d->filter, "output", buffer, OIDN_FORMAT_FLOAT3, width, height, 0, 0, 0);
        oidnCommitFilter(d->filter);
        oidnExecuteFilter(d->filter);
        oidnReadBuffer(buffer, 0, width * height * bytes, pixels);
        write_chart(d, side, chart, pixels);
    }
    if (buffer) oidnReleaseBuffer(buffer);
    host_free(host, pixels);
    return ok;
}

bool lightmap_has_denoiser(void)
{
    return true;
}

bool lightmap_denoise(struct lightmap *map)
{
    struct denoiser d = { .map = map, .device = oidnNewDevice(OIDN_DEVICE_TYPE_CPU) };
    if (!d.device) return host_fail(map->host, FAIL_MEMORY, "light map: no device to denoise");
    oidnCommitDevice(d.device);
    d.filter = oidnNewFilter(d.device, "RTLightmap");
    bool ok = d.filter;
    for (int side = 0; ok && side < (map->has_back ? 2 : 1); side++)
        for (uint32_t c = 0; ok && c < map->charts.count; c++)
            ok = denoise_chart(&d, side, &map->charts.charts[c]);
    const char *why = NULL;
    if (oidnGetDeviceError(d.device, &why) != OIDN_ERROR_NONE)
        ok = host_fail(map->host, FAIL_MEMORY, "light map: cannot denoise it: %s", why);
    if (d.filter) oidnReleaseFilter(d.filter);
    oidnReleaseDevice(d.device);
    return ok;
}
#else
bool lightmap_has_denoiser(void)
{
    return false;
}

bool lightmap_denoise(struct lightmap *map)
{
    host_log(map->host, LOG_WARNING,
             "light map: not denoised: the library was built without Open Image Denoise");
    return true;
}
#endif
