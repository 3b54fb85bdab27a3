// Contents of instances: meshes, triangles, emission.
#include "scene/scene.h"

#include <math.h>

const struct mesh *scene_mesh_of(const struct scene *scene, int instance)
{
    static const struct mesh none = { .name = "",
                                      .bounds = { { { INFINITY, INFINITY, INFINITY } },
                                                  { { -INFINITY, -INFINITY, -INFINITY } } } };
    const int mesh = scene->instances[instance].mesh;
    return mesh < 0 ? &none : &scene->meshes[mesh];
}

size_t scene_triangle_count(const struct scene *scene)
{
    size_t count = 0;
    for (int i = 0; i < scene->instance_count; i++)
        count += scene_mesh_of(scene, i)->index_count / 3;
    return count;
}

bool scene_has_emission(const struct scene *scene)
{
    for (int i = 0; i < scene->instance_count; i++) {
        const struct mesh *mesh = scene_mesh_of(scene, i);
        if (mesh->index_count > 0 && luminance(scene->materials[mesh->material].emissive) > 0.0f)
            return true;
    }
    return false;
}
