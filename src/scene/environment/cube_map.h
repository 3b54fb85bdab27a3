// A cube map of RGBD texels, the environment of EXT_lights_image_based, as an equirectangular
// image.
//
// RGBD: radiance is the colour, decoded from sRGB, over alpha. JPEG images have alpha 1.
//
// The extension names faces by the axes of a cube map, whose coordinates are left-handed, and has
// its images flipped. This reads them as Babylon.js does, the engine of its authors, in
// right-handed scenes: a direction (x, y, z) of the scene is (x, y, −z) of the cube, faces are
// chosen and oriented as in section 8.13 of the OpenGL 4.6 specification, and rows begin at t = 1.
// The face "+Z" is thus at −z, and side faces are stored upside down.
#pragma once

#include "image/image.h"

enum { CUBE_FACES = 6 }; // +X −X +Y −Y +Z −Z

struct cube_map {
    int size;
    const uint8_t *faces[CUBE_FACES]; // [size][size][4]
};

// Columns of the equirectangular image.
int cube_map_width(const struct cube_map *cube);
// world_from_cube: a unit quaternion, which turns the environment.
bool cube_map_to_equirect(struct host *host, const struct cube_map *cube, versors world_from_cube,
                          struct image *out);
