// Scenes in other units of length than the metre.
#pragma once

#include "scene/scene.h"

// Metres per unit of length. Beyond them no scene of a plausible size has coordinates that 32-bit
// floats can hold.
#define SCENE_SCALE_MIN 1e-6f
#define SCENE_SCALE_MAX 1e6f

// Multiplies all lengths of a scene that was just loaded: vertices, morph targets, translations of
// nodes, joints and animations, near planes, ranges of lights. Rotations and scales of nodes stay:
// no node is added. Intensities stay too (candela, lux, cd/m²). A factor of 1 changes nothing.
// False: out of memory.
bool scene_rescale(struct scene *scene, float factor);
