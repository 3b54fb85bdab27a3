// OpenEXR files through the C core: scan lines, ZIP, 32-bit float, named layers. Half floats,
// unsigned integers and any compression that the library unpacks are read too; tiled, deep,
// multi-part and subsampled files are refused (FAIL_UNSUPPORTED). A layer "color" is stored in the
// plain channels R G B (so that any viewer shows it), a layer "depth" of one channel as Z, any
// other layer X as X.R X.G X.B (X.A), or X.Y when it has one channel.
#pragma once

#include "image/image.h"

struct exr_layer {
    const char *name;
    const struct image *image;
};

struct exr_attribute { // a text attribute of the header
    const char *name, *value;
};

// All layers have the same size. Written beside and renamed.
bool exr_write(struct host *host, const char *path, const struct exr_layer *layers, int layer_count,
               const struct exr_attribute *attributes, int attribute_count);
// Reads one layer (NULL: "color"). A missing layer is an error that names those present. The image
// is the file's data window. Vectors (X.X X.Y X.Z) and depths (X.Z) of other programs are layers
// too. Untrusted input.
bool exr_read(struct host *host, const char *path, const char *layer, struct image *out);
// Names of all layers, '\n'-separated, owned by the caller; NULL on failure.
char *exr_layer_names(struct host *host, const char *path);
// The text attribute `name`, owned by the caller; NULL when it is absent (no failure) or the file
// is bad.
char *exr_attribute_value(struct host *host, const char *path, const char *name);
