// In place of the readers of scene files and encoded images, in a library without them.
#include "scene/images/image_source.h"
#include "scene/import/import.h"

static struct scene *refuse(struct host *host, const char *name)
{
    host_fail(host, FAIL_UNSUPPORTED,
              "cannot load %s: the library was built without scene files (AFTERGLOW_FILES=OFF); "
              "built-in scenes begin with @",
              name);
    return NULL;
}

struct scene *import_file(struct host *host, const char *path, float scale)
{
    (void)scale;
    return refuse(host, path);
}

struct scene *import_memory(struct host *host, const struct import_bytes *from)
{
    return refuse(host, from->name);
}

int scene_add_encoded_image(struct scene *scene, const char *name, const void *data, size_t size,
                            bool linear)
{
    (void)data;
    (void)size;
    (void)linear;
    host_fail(scene->host, FAIL_UNSUPPORTED,
              "image \"%s\" in %s: the library was built without image files "
              "(AFTERGLOW_FILES=OFF); give its pixels",
              name, scene->name);
    return -1;
}
