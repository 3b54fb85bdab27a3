// Files of a light map.
#pragma once

#include "lightmap/lightmap.h"

#define LIGHTMAP_SCENE_FILE "scene.glb"
#define LIGHTMAP_FRONT_FILE "irradiance.exr"
#define LIGHTMAP_BACK_FILE  "irradiance_back.exr"

// Facts about the maps: in the extras of the scene's copy, and in attributes of the maps.
struct lightmap_facts {
    int samples; // paths of a texel; 0: of a technique
    bool punctual;
    const char *gi;
};
// Into an existing folder.
bool lightmap_write(const struct lightmap *map, const struct scene *scene,
                    const struct lightmap_facts *facts, const char *folder);
