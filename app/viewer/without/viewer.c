// In place of the viewer, in a build without it.
#include "viewer/scene/session_file.h"
#include "viewer/viewer.h"

#include <stdio.h>

bool viewer_run(const struct viewer_desc *desc, char error[1024])
{
    (void)desc;
    snprintf(error, 1024,
             "cannot open a window: this build is without the viewer (AFTERGLOW_VIEWER)");
    return false;
}

bool session_file_scene(const char *path, char *out, size_t size)
{
    (void)path;
    (void)out;
    (void)size;
    return false;
}
