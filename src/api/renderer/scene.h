// Changes of a renderer's scene, and its lights.
#pragma once

#include <stdint.h>

struct ag_renderer;

// technique_change bits of the changes since the last call.
uint32_t renderer_scene_changes(struct ag_renderer *renderer);
// Fills renderer->lights from its pose; their number. Lights that are off have intensity 0, so that
// their shadow maps stay, and give way where there are more lights than a frame has.
int renderer_scene_lights(struct ag_renderer *renderer);
