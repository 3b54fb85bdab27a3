// Loads a scene by name: "@name" is a built-in scene, everything else a file.
#include "scene/builtin/builtin.h"
#include "scene/import/import.h"
#include "scene/limits.h"
#include "scene/rescale.h"

static struct scene *load_builtin(struct host *host, const char *name, float scale)
{
    struct scene *scene = builtin_load(host, name);
    if (!scene || scale == 1.0f) return scene;
    scene_rescale(scene, scale);
    if (limits_scene(scene)) return scene;
    scene_destroy(scene);
    return NULL;
}

struct scene *scene_load_scaled(struct host *host, const char *name, float scale)
{
    return name[0] == '@' ? load_builtin(host, name, scale) : import_file(host, name, scale);
}

struct scene *scene_load(struct host *host, const char *name)
{
    return scene_load_scaled(host, name, 1.0f);
}
