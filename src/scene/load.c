// Loads a scene by name: "@name" is a built-in scene, everything else a file.
#include "scene/builtin/builtin.h"
#include "scene/import/import.h"

struct scene *scene_load(struct host *host, const char *name)
{
    return name[0] == '@' ? builtin_load(host, name) : import_file(host, name);
}
