// Cameras by name: a program may ask for each of thousands.
#include "api/objects.h"

#include <stdlib.h>
#include <string.h>

struct named_camera {
    const char *name;
    int index;
};

static int by_name_and_index(const void *a, const void *b)
{
    const struct named_camera *first = a, *second = b;
    int order = strcmp(first->name, second->name);
    return order ? order : first->index - second->index;
}

// Cameras are those of the file: none can be added later.
static bool sort_cameras(struct ag_scene *scene)
{
    const struct scene *from = scene->scene;
    size_t count = (size_t)from->camera_count;
    struct named_camera *cameras = host_alloc(&scene->context->host, count, sizeof *cameras);
    if (!cameras) return false;
    for (size_t i = 0; i < count; i++) {
        const char *name = from->cameras[i].name;
        cameras[i] = (struct named_camera){ name ? name : "", (int)i };
    }
    if (count > 0) qsort(cameras, count, sizeof *cameras, by_name_and_index);
    scene->cameras_by_name = cameras;
    return true;
}

bool api_find_camera(struct ag_scene *scene, const char *name, int *index)
{
    if (!scene->cameras_by_name && !sort_cameras(scene)) return false;
    int low = 0, high = scene->scene->camera_count; // the first name that is not less lies within
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (strcmp(scene->cameras_by_name[middle].name, name) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    bool found =
        low < scene->scene->camera_count && strcmp(scene->cameras_by_name[low].name, name) == 0;
    *index = found ? scene->cameras_by_name[low].index : -1;
    return true;
}
