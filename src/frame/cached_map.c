#include "frame/cached_map.h"

#include <string.h>

// Fields of a light that its maps depend on: all but intensity and layer indices.
static struct frame_light map_inputs(const struct frame_light *light)
{
    struct frame_light inputs = *light;
    inputs.intensity = vec3_of(0, 0, 0);
    inputs.shadow_first = inputs.shadow_count = 0;
    return inputs;
}

bool cached_map_is_valid(struct cached_map *map, const struct scene_gpu *scene,
                         const struct frame_light *light, mat4s clip_from_world, bool materials)
{
    const struct cached_map now = { map_inputs(light), clip_from_world, scene->updates };
    // A map that was not checked in the previous frame may have missed a movement.
    const bool valid =
        map->updates + 1 == now.updates && memcmp(&map->light, &now.light, sizeof now.light) == 0 &&
        memcmp(&map->clip_from_world, &clip_from_world, sizeof clip_from_world) == 0 &&
        scene_gpu_unchanged_in(scene, clip_from_world, materials);
    *map = now;
    return valid;
}
