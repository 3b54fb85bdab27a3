// Radiance of unlit materials (KHR_materials_unlit).
#pragma once

#include "scene/pose.h"

// An unlit surface has the radiance base colour × this, cd/m²: that of a white diffuse surface
// under the illuminance which the strongest source alone gives at a typical place (docs/units.md).
// Its colour is thus the same under automatic exposure, whatever the unit of the scene's lights.
// emitted_flux: luminous flux of all emissive surfaces, lumen.
float unlit_white(const struct world_light *lights, int light_count, vec3s sky, float emitted_flux,
                  struct box3 bounds);
