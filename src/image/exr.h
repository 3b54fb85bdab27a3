// OpenEXR files through the C core. Written: scan lines, ZIP, floats or half floats, named layers.
// Read: also unsigned integers and every compression of the library; tiled, deep, multi-part and
// subsampled files are refused (FAIL_UNSUPPORTED). The layer "color" is stored in the channels
// R G B (which any viewer shows), a one-channel layer "depth" as Z, any other layer X as X.R X.G
// X.B (X.A), or as X.Y when it has one channel.
#pragma once

#include "image/image.h"

struct exr_layer {
    const char *name;
    const struct image *image;
};

struct exr_attribute { // a text attribute of the header
    const char *name, *value;
};

// 32-bit floats. All layers have the same size. The file is replaced atomically.
bool exr_write(struct host *host, const char *path, const struct exr_layer *layers, int layer_count,
               const struct exr_attribute *attributes, int attribute_count);
// The same in 16-bit floats, the nearest ones.
bool exr_write_half(struct host *host, const char *path, const struct exr_layer *layers,
                    int layer_count, const struct exr_attribute *attributes, int attribute_count);
// A layer "color" of floats as the bytes of a file, owned by the caller (host_free).
bool exr_encode(struct host *host, const struct image *image, uint8_t **out, size_t *size);
// Its counterpart, of a file in memory; `name` is for messages. Untrusted input.
bool exr_decode(struct host *host, const char *name, const void *bytes, size_t size,
                size_t max_pixels, struct image *out);
// Reads one layer (NULL: "color") over the file's data window. The error for a missing layer lists
// those present. Vectors (X.X X.Y X.Z) and depths (X.Z) of other programs are layers too. Untrusted
// input.
bool exr_read(struct host *host, const char *path, const char *layer, struct image *out);
// Size of the data window, from the header.
bool exr_read_size(struct host *host, const char *path, int *width, int *height);
// Names of all layers, '\n'-separated, owned by the caller; NULL on failure.
char *exr_layer_names(struct host *host, const char *path);
// The text attribute `name`, from the header, owned by the caller; NULL when it is absent (not a
// failure) or the header is invalid.
char *exr_attribute_value(struct host *host, const char *path, const char *name);
