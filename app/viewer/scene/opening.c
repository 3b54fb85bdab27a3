#include "opening.h"

#include "viewer/operations.h"
#include "session_file.h"

#include <stdio.h>
#include <string.h>

bool viewer_open(struct viewer *v, const char *path)
{
    char scene[1024];
    const char *end = strrchr(path, '.');
    const bool session = end && strcmp(end, ".json") == 0;
    if (session && session_file_scene(path, scene, sizeof scene) &&
        strcmp(scene, v->desc->scene_name) == 0) {
        return session_file_read(v, path);
    }
    snprintf(v->opening, sizeof v->opening, "%s", path);
    viewer_say(v, "opening %s …", path);
    return true;
}
