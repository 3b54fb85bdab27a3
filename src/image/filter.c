// Separable filters: the weighted sums, and the bands that bound their memory.
#include "image/filter.h"

#include "core/parallel.h"

enum { BAND_ROWS = 128, ROWS_AT_ONCE = 4 };

static void add_even(float *restrict out, const float *low, const float *high, int count,
                     float weight)
{
    for (int x = 0; x < count; x++) out[x] += weight * (low[x] + high[x]);
}

static void add_odd(float *restrict out, const float *low, const float *high, int count,
                    float weight)
{
    for (int x = 0; x < count; x++) out[x] += weight * (high[x] - low[x]);
}

static void add_zero_sum(float *restrict out, const float *low, const float *middle,
                         const float *high, int count, float weight)
{
    for (int x = 0; x < count; x++)
        out[x] += weight * ((low[x] - middle[x]) + (high[x] - middle[x]));
}

void filter_apply(const struct filter *filter, const float *in, size_t step, int count, float *out)
{
    float centre = filter->shape == FILTER_EVEN ? filter->weights[0] : 0.0f;
    for (int x = 0; x < count; x++) out[x] = centre * in[x];
    for (int k = 1; k <= filter->radius; k++) {
        const float *low = in - (size_t)k * step, *high = in + (size_t)k * step;
        float weight = filter->weights[k];
        if (filter->shape == FILTER_EVEN)
            add_even(out, low, high, count, weight);
        else if (filter->shape == FILTER_ODD)
            add_odd(out, low, high, count, weight);
        else
            add_zero_sum(out, low, in, high, count, weight);
    }
}

static size_t source_stride(const struct band *band)
{
    return (size_t)band->width + 2 * (size_t)band->pad;
}

static size_t memory_rows(const struct band *band)
{
    int rows = band->height < BAND_ROWS ? band->height : BAND_ROWS;
    return (size_t)rows + 2 * (size_t)band->pad;
}

float *band_source(const struct band *band, int plane, int row)
{
    size_t index = (size_t)plane * memory_rows(band) + (size_t)row;
    return band->sources + index * source_stride(band) + (size_t)band->pad;
}

void band_pad_source(const struct band *band, int plane, int row)
{
    float *values = band_source(band, plane, row);
    float *last = values + band->width - 1;
    for (int k = 1; k <= band->pad; k++) *(values - k) = values[0], last[k] = last[0];
}

float *band_middle(const struct band *band, int plane, int row)
{
    size_t index = (size_t)plane * memory_rows(band) + (size_t)row;
    return band->middles + index * (size_t)band->width;
}

static void run_first(void *user, size_t row)
{
    const struct band *band = user;
    int y = band->first - band->pad + (int)row;
    if (y < 0) y = 0;
    if (y >= band->height) y = band->height - 1;
    band->first_pass(band, (int)row, y);
}

static void run_second(void *user, size_t row)
{
    const struct band *band = user;
    band->second_pass(band, (int)row + band->pad, band->first + (int)row);
}

static bool allocate(struct band *band, struct host *host)
{
    size_t rows = memory_rows(band), sources, middles;
    if (!size_mul(rows * (size_t)band->source_count, source_stride(band), &sources) ||
        !size_mul(rows * (size_t)band->middle_count, (size_t)band->width, &middles))
        return host_fail(host, FAIL_MEMORY, "cannot filter an image of %dx%d: too large",
                         band->width, band->height);
    band->sources = host_alloc(host, sources, sizeof *band->sources);
    band->middles = host_alloc(host, middles, sizeof *band->middles);
    return band->sources && band->middles;
}

bool band_run(struct band *band, struct host *host)
{
    band->sources = band->middles = NULL;
    bool ok = allocate(band, host);
    for (int y = 0; ok && y < band->height; y += BAND_ROWS) {
        band->first = y;
        band->rows = band->height - y < BAND_ROWS ? band->height - y : BAND_ROWS;
        size_t rows = (size_t)band->rows;
        parallel_for(rows + 2 * (size_t)band->pad, ROWS_AT_ONCE, run_first, band);
        parallel_for(rows, ROWS_AT_ONCE, run_second, band);
    }
    host_free(host, band->sources);
    host_free(host, band->middles);
    band->sources = band->middles = NULL;
    return ok;
}
