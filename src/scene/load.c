// The one door for scene names: built-in scenes are written "@name", everything else is a file.
#include "scene/builtin/builtin.h"
#include "scene/import/import.h"

struct scene *scene_load(struct host *host, const char *name)
{
    return name[0] == '@' ? builtin_load(host, name) : import_file(host, name);
}
