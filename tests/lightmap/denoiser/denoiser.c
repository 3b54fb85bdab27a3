// As strict as the API's documentation: a filter runs only on a committed device, after its own
// commit, on two images of the buffer's size.
#include "lightmap/denoiser/denoiser.h"

#include <OpenImageDenoise/oidn.h>

#include "framework/test.h"

#include <stdlib.h>
#include <string.h>

struct test_denoiser {
    bool committed;
    OIDNError error;
};

struct test_denoiser_buffer {
    size_t bytes;
    float *data;
};

struct test_denoiser_image {
    OIDNBuffer buffer;
    size_t width, height;
};

struct test_denoiser_filter {
    OIDNDevice device;
    struct test_denoiser_image color, output;
    bool committed;
};

struct test_denoiser_state test_denoiser;

OIDNDevice oidnNewDevice(OIDNDeviceType type)
{
    assert_int_equal(type, OIDN_DEVICE_TYPE_CPU);
    test_denoiser.live++;
    return calloc(1, sizeof(struct test_denoiser));
}

void oidnCommitDevice(OIDNDevice device)
{
    device->committed = true;
}

OIDNError oidnGetDeviceError(OIDNDevice device, const char **message)
{
    const OIDNError error = device->error;
    device->error = OIDN_ERROR_NONE;
    if (message) *message = error == OIDN_ERROR_NONE ? NULL : "out of memory";
    return error;
}

void oidnReleaseDevice(OIDNDevice device)
{
    test_denoiser.live--;
    free(device);
}

OIDNBuffer oidnNewBuffer(OIDNDevice device, size_t bytes)
{
    CHECK(device->committed && bytes > 0);
    if (test_denoiser.buffers_left == 0) {
        device->error = OIDN_ERROR_OUT_OF_MEMORY;
        return NULL;
    }
    if (test_denoiser.buffers_left > 0) test_denoiser.buffers_left--;
    OIDNBuffer buffer = calloc(1, sizeof *buffer);
    *buffer = (struct test_denoiser_buffer){ bytes, calloc(1, bytes) };
    test_denoiser.live++;
    return buffer;
}

void oidnWriteBuffer(OIDNBuffer buffer, size_t offset, size_t bytes, const void *from)
{
    CHECK(offset + bytes <= buffer->bytes);
    memcpy((char *)buffer->data + offset, from, bytes);
}

void oidnReadBuffer(OIDNBuffer buffer, size_t offset, size_t bytes, void *to)
{
    CHECK(offset + bytes <= buffer->bytes);
    memcpy(to, (char *)buffer->data + offset, bytes);
}

void oidnReleaseBuffer(OIDNBuffer buffer)
{
    test_denoiser.live--;
    free(buffer->data);
    free(buffer);
}

OIDNFilter oidnNewFilter(OIDNDevice device, const char *type)
{
    CHECK(device->committed);
    assert_string_equal(type, "RTLightmap");
    OIDNFilter filter = calloc(1, sizeof *filter);
    filter->device = device;
    test_denoiser.live++;
    return filter;
}

void oidnSetFilterImage(OIDNFilter filter, const char *name, OIDNBuffer buffer, OIDNFormat format,
                        size_t width, size_t height, size_t offset, size_t pixel_stride,
                        size_t row_stride)
{
    assert_int_equal(format, OIDN_FORMAT_FLOAT3);
    CHECK(offset == 0 && pixel_stride == 0 && row_stride == 0); // tightly packed
    CHECK(width * height * 3 * sizeof(float) <= buffer->bytes);
    const bool output = strcmp(name, "output") == 0;
    CHECK(output || strcmp(name, "color") == 0);
    *(output ? &filter->output : &filter->color) =
        (struct test_denoiser_image){ buffer, width, height };
    filter->committed = false;
}

void oidnCommitFilter(OIDNFilter filter)
{
    const struct test_denoiser_image *in = &filter->color, *out = &filter->output;
    CHECK(in->buffer && out->buffer && in->width == out->width && in->height == out->height);
    filter->committed = true;
}

static float mean_around(const float *from, long width, long height, long x, long y, int channel)
{
    float sum = 0.0f;
    int count = 0;
    for (long v = y - 2; v <= y + 2; v++)
        for (long u = x - 2; u <= x + 2; u++) {
            if (u < 0 || u >= width || v < 0 || v >= height) continue;
            sum += from[3 * (v * width + u) + channel];
            count++;
        }
    return sum / (float)count;
}

void oidnExecuteFilter(OIDNFilter filter)
{
    CHECK(filter->device->committed && filter->committed);
    const long width = (long)filter->color.width, height = (long)filter->color.height;
    const size_t bytes = (size_t)(width * height) * 3 * sizeof(float);
    float *from = malloc(bytes); // input and output may be one buffer
    assert_non_null(from);
    memcpy(from, filter->color.buffer->data, bytes);
    for (long i = 0; i < 3 * width * height; i++)
        filter->output.buffer->data[i] =
            mean_around(from, width, height, i / 3 % width, i / 3 / width, (int)(i % 3));
    free(from);
    test_denoiser.images++;
}

void oidnReleaseFilter(OIDNFilter filter)
{
    test_denoiser.live--;
    free(filter);
}
