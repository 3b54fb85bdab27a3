#include "frame/kept_map.h"

#include <string.h>

// What of a light shapes its maps: all but how strong it is and where its maps lie.
static struct frame_light shape_of(const struct frame_light *light)
{
    struct frame_light shape = *light;
    shape.intensity = vec3_of(0, 0, 0);
    shape.shadow_first = shape.shadow_count = 0;
    return shape;
}

bool kept_map_stands(struct kept_map *map, const struct scene_gpu *scene,
                     const struct frame_light *light, mat4s clip_from_world)
{
    const struct kept_map now = { shape_of(light), clip_from_world, scene->updates };
    // A map that was left out in the last frame does not know what moved then.
    const bool stands =
        map->updates + 1 == now.updates && memcmp(&map->light, &now.light, sizeof now.light) == 0 &&
        memcmp(&map->clip_from_world, &clip_from_world, sizeof clip_from_world) == 0 &&
        scene_gpu_still_in(scene, clip_from_world);
    *map = now;
    return stands;
}
