// Radiance of unlit materials.
#include "scene/unlit.h"

#include <math.h>

static const float TYPICAL_SHARE = 0.25f; // distance to a light over the scene's diagonal
static const float MIN_DISTANCE_M = 0.01f;
static const float DEFAULT_WHITE = 1.2f; // without light: exposes to 1 at EV 0

float unlit_white(const struct world_light *lights, int light_count, vec3s sky, float emitted_flux,
                  struct box3 bounds)
{
    float diagonal = box3_is_empty(bounds) ? 0.0f : glms_vec3_norm(box3_size(bounds));
    float distance = fmaxf(TYPICAL_SHARE * diagonal, MIN_DISTANCE_M);
    // π · radiance is the illuminance under a sky; flux/π is the intensity of a flat emitter.
    float most = GLM_PIf * luminance(sky);
    most = fmaxf(most, emitted_flux / (GLM_PIf * distance * distance));
    for (int i = 0; i < light_count; i++) {
        float strength = luminance(lights[i].intensity);
        most =
            fmaxf(most, lights[i].type == LIGHT_SUN ? strength : strength / (distance * distance));
    }
    return most > 0.0f && isfinite(most) ? most * GLM_1_PIf : DEFAULT_WHITE;
}
