// Files of a light map.
#pragma once

#include "lightmap/lightmap.h"

#define LIGHTMAP_SCENE_FILE "scene.glb"
#define LIGHTMAP_FRONT_FILE "irradiance" // and the number of several pages, and the format's ending
#define LIGHTMAP_BACK_FILE  "irradiance_back"

// Formats of the maps, to be or'ed.
enum lightmap_format {
    LIGHTMAP_EXR = 1,  // lux
    LIGHTMAP_KTX2 = 2, // RGB9E5, lux over a power of two
    LIGHTMAP_PNG = 4,  // 8 bits, linear; also the texture of the materials in the scene's copy
    LIGHTMAP_FORMATS = 7
};

struct lightmap_record;

// Facts about the maps: in the extras of the scene's copy, and in attributes of the maps.
struct lightmap_facts {
    int samples; // paths of a texel; 0: of a technique
    bool punctual;
    const char *gi;
    const struct lightmap_record *record; // for updates; NULL: none is written
};
// Into an existing folder. formats: at least one of enum lightmap_format.
bool lightmap_write(const struct lightmap *map, const struct scene *scene,
                    const struct lightmap_facts *facts, unsigned formats, const char *folder);
