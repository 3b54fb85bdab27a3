// In place of the readers and writers of image files, in a library without them.
#include "image/exr.h"
#include "image/png_file.h"

static bool refuse(struct host *host, const char *path)
{
    return host_fail(host, FAIL_UNSUPPORTED,
                     "cannot open %s: the library was built without image files "
                     "(AFTERGLOW_FILES=OFF)",
                     path);
}

bool png_write(struct host *host, const char *path, const struct image *image)
{
    (void)image;
    return refuse(host, path);
}

bool png_read(struct host *host, const char *path, struct image *out)
{
    (void)out;
    return refuse(host, path);
}

bool png_read_size(struct host *host, const char *path, int *width, int *height)
{
    (void)width;
    (void)height;
    return refuse(host, path);
}

bool exr_write(struct host *host, const char *path, const struct exr_layer *layers, int layer_count,
               const struct exr_attribute *attributes, int attribute_count)
{
    (void)layers;
    (void)layer_count;
    (void)attributes;
    (void)attribute_count;
    return refuse(host, path);
}

bool exr_read(struct host *host, const char *path, const char *layer, struct image *out)
{
    (void)layer;
    (void)out;
    return refuse(host, path);
}

bool exr_read_size(struct host *host, const char *path, int *width, int *height)
{
    (void)width;
    (void)height;
    return refuse(host, path);
}

char *exr_layer_names(struct host *host, const char *path)
{
    (void)refuse(host, path);
    return NULL;
}

char *exr_attribute_value(struct host *host, const char *path, const char *name)
{
    (void)name;
    (void)refuse(host, path);
    return NULL;
}
