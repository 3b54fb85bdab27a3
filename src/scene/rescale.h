// Scenes in other units of length than the metre.
#pragma once

#include "scene/scene.h"

// Metres per unit of length. Beyond them no scene of a plausible size has coordinates that 32-bit
// floats can hold.
#define SCENE_SCALE_MIN 1e-6f
#define SCENE_SCALE_MAX 1e6f

// Multiplies all lengths of a scene that was just loaded: the transforms of root nodes, with their
// animations, near planes and ranges of lights. The space of meshes, skins and other nodes keeps
// the unit of the file, as do lengths in extras. Intensities stay (candela, lux, cd/m²).
void scene_rescale(struct scene *scene, float factor);
