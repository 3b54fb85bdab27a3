#include "techniques/dnrt/bake/volume.h"

#include "core/half.h"
#include "core/saturate.h"

#include <float.h>
#include <math.h>
#include <string.h>

// ---- samples inside

static int neighbour(int size, int index, int direction)
{
    const int axis = direction / 2, step = direction % 2 ? 1 : -1;
    const int stride = axis == 0 ? 1 : axis == 1 ? size : size * size;
    const int at = index / stride % size + step;
    return at < 0 || at >= size ? -1 : index + step * stride;
}

// layer: 0 for a sample outside, else one more than the layer from which it was filled; −1: not
// yet. Returns whether a neighbour of an earlier layer exists.
static bool fill_sample(int size, int per_sample, const int *layer, int now, int index,
                        float *values)
{
    float *to = values + (size_t)index * (size_t)per_sample;
    int count = 0;
    for (int d = 0; d < 6; d++) {
        const int from = neighbour(size, index, d);
        if (from < 0 || layer[from] < 0 || layer[from] == now) continue;
        if (count++ == 0) memset(to, 0, (size_t)per_sample * sizeof *to);
        for (int i = 0; i < per_sample; i++)
            to[i] += values[(size_t)from * (size_t)per_sample + (size_t)i];
    }
    for (int i = 0; i < per_sample && count > 0; i++) to[i] /= (float)count;
    return count > 0;
}

static bool fill_layer(int size, int per_sample, int *layer, int now, float *values)
{
    bool filled = false;
    for (int i = 0; i < dnrt_grid_count(size); i++) {
        if (layer[i] >= 0 || !fill_sample(size, per_sample, layer, now, i, values)) continue;
        layer[i] = now;
        filled = true;
    }
    return filled;
}

bool dnrt_fill_inside(struct host *host, int size, int per_sample, const uint8_t *is_inside,
                      float *values)
{
    const int count = dnrt_grid_count(size);
    int *layer = host_alloc(host, (size_t)count, sizeof *layer);
    if (!layer) return false;
    for (int i = 0; i < count; i++) layer[i] = is_inside[i] ? -1 : 0;
    int now = 1;
    while (fill_layer(size, per_sample, layer, now, values)) now++;
    host_free(host, layer);
    return true;
}

// ---- encoding

static float largest(const float *from, int samples, int stride)
{
    float most = 0.0f;
    for (int i = 0; i < samples; i++) most = fmaxf(most, fabsf(from[(size_t)i * (size_t)stride]));
    return most;
}

float dnrt_encode_half(const float *from, int samples, int stride, uint16_t *to)
{
    const float scale = largest(from, samples, stride);
    for (int i = 0; i < samples && scale > 0.0f; i++)
        to[i] = half_from_float(from[(size_t)i * (size_t)stride] / scale);
    return scale;
}

float dnrt_encode_byte(const float *from, int samples, int stride, uint8_t *to)
{
    const float scale = largest(from, samples, stride);
    const float steps = scale > 127.0f / FLT_MAX ? 127.0f / scale : 0.0f; // else it overflows
    for (int i = 0; i < samples; i++)
        to[i] = (uint8_t)int_saturated(
            (double)(128.0f + roundf(from[(size_t)i * (size_t)stride] * steps)), 1, 255);
    return scale;
}
