// The calls of Open Image Denoise 2 that src/lightmap/denoise.c makes, for machines without that
// library. Its filter is the mean of 5 × 5 pixels, of those inside of the image.
#pragma once

#include <stddef.h>

typedef struct test_denoiser *OIDNDevice;
typedef struct test_denoiser_buffer *OIDNBuffer;
typedef struct test_denoiser_filter *OIDNFilter;
typedef enum { OIDN_DEVICE_TYPE_CPU = 1 } OIDNDeviceType;
typedef enum { OIDN_FORMAT_FLOAT3 = 3 } OIDNFormat;
typedef enum { OIDN_ERROR_NONE = 0, OIDN_ERROR_OUT_OF_MEMORY = 4 } OIDNError;

OIDNDevice oidnNewDevice(OIDNDeviceType type);
void oidnCommitDevice(OIDNDevice device);
OIDNError oidnGetDeviceError(OIDNDevice device, const char **message);
void oidnReleaseDevice(OIDNDevice device);

OIDNBuffer oidnNewBuffer(OIDNDevice device, size_t bytes);
void oidnWriteBuffer(OIDNBuffer buffer, size_t offset, size_t bytes, const void *from);
void oidnReadBuffer(OIDNBuffer buffer, size_t offset, size_t bytes, void *to);
void oidnReleaseBuffer(OIDNBuffer buffer);

OIDNFilter oidnNewFilter(OIDNDevice device, const char *type);
void oidnSetFilterImage(OIDNFilter filter, const char *name, OIDNBuffer buffer, OIDNFormat format,
                        size_t width, size_t height, size_t offset, size_t pixel_stride,
                        size_t row_stride);
void oidnCommitFilter(OIDNFilter filter);
void oidnExecuteFilter(OIDNFilter filter);
void oidnReleaseFilter(OIDNFilter filter);
