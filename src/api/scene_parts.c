#include "api/scene_parts.h"

#include "scene/limits.h"

#include <string.h>

_Static_assert((int)ALPHA_OPAQUE == 0 && (int)ALPHA_MASK == AG_ALPHA_MASK - AG_ALPHA_OPAQUE &&
                   (int)ALPHA_BLEND == AG_ALPHA_BLEND - AG_ALPHA_OPAQUE,
               "modes are converted by value");

static enum ag_result material_check(const char *function, struct ag_context *context,
                                     const struct ag_material_desc *desc)
{
    AG_REQUIRE_KNOWN(function, context, desc);
    AG_REQUIRE_FOR(function, context, api_in_unit_range(desc->base_color, 4),
                   "base_color is not within 0 to 1");
    AG_REQUIRE_FOR(function, context,
                   api_in_unit_range(&desc->metallic, 1) && api_in_unit_range(&desc->roughness, 1),
                   "metallic and roughness must be 0 to 1, not %g and %g", (double)desc->metallic,
                   (double)desc->roughness);
    AG_REQUIRE_FOR(function, context, limits_light(api_vec3(desc->emissive)),
                   "emissive is not within 0 to %g cd/m²", (double)SCENE_MAX_RADIANCE);
    AG_REQUIRE_FOR(function, context, desc->ior == 0 || api_finite_at_least(&desc->ior, 1, 1.0f),
                   "ior must be 0 or at least 1, not %g", (double)desc->ior);
    AG_REQUIRE_FOR(function, context, api_in_unit_range(&desc->specular, 1),
                   "specular must be 0 to 1, not %g", (double)desc->specular);
    AG_REQUIRE_FOR(function, context, api_finite_at_least(desc->specular_color, 3, 0.0f),
                   "specular_color must be 0 or more");
    AG_REQUIRE_FOR(function, context, (unsigned)desc->alpha_mode <= AG_ALPHA_BLEND,
                   "alpha_mode %d is unknown", (int)desc->alpha_mode);
    AG_REQUIRE_FOR(function, context, api_finite_at_least(&desc->alpha_cutoff, 1, 0.0f),
                   "alpha_cutoff must be 0 or more, not %g", (double)desc->alpha_cutoff);
    return AG_OK;
}

enum ag_result parts_material(const char *function, const struct ag_scene *scene,
                              const struct ag_material_desc *desc, struct material *out)
{
    const enum ag_result checked = material_check(function, scene->context, desc);
    if (checked != AG_OK) return checked;
    memcpy(out->base_color.raw, desc->base_color, sizeof desc->base_color);
    out->metallic = desc->metallic;
    out->roughness = desc->roughness;
    out->emissive = api_vec3(desc->emissive);
    out->double_sided = desc->double_sided;
    out->ior = desc->ior;
    out->specular = desc->specular;
    out->specular_color = api_vec3(desc->specular_color);
    out->unlit = desc->unlit;
    if (desc->alpha_mode != AG_ALPHA_DEFAULT) {
        out->alpha_mode = (enum alpha_mode)(desc->alpha_mode - AG_ALPHA_OPAQUE);
        out->alpha_cutoff = desc->alpha_cutoff;
    }
    return AG_OK;
}

static enum ag_result light_check(const char *function, struct ag_context *context,
                                  const struct ag_light_desc *desc)
{
    AG_REQUIRE_KNOWN(function, context, desc);
    AG_REQUIRE_FOR(function, context, (unsigned)desc->type <= AG_LIGHT_SPOT, "type %d is unknown",
                   (int)desc->type);
    AG_REQUIRE_FOR(function, context, limits_light(api_vec3(desc->intensity)),
                   "intensity is not within 0 to %g lux or candela", (double)SCENE_MAX_RADIANCE);
    AG_REQUIRE_FOR(function, context,
                   desc->type == AG_LIGHT_SUN || limits_position(api_vec3(desc->position)),
                   "position is not within %g m of the origin", (double)SCENE_MAX_DISTANCE_M);
    float length = glms_vec3_norm(vec3_unit(api_vec3(desc->direction)));
    AG_REQUIRE_FOR(function, context, desc->type == AG_LIGHT_POINT || length > 0.0f,
                   "direction is zero or not finite");
    if (desc->type == AG_LIGHT_SPOT)
        AG_REQUIRE_FOR(function, context,
                       desc->inner_rad >= 0.0f && desc->inner_rad < desc->outer_rad &&
                           desc->outer_rad <= GLM_PI_2f * (1 + 1e-6f),
                       "inner_rad %g and outer_rad %g are not 0 to half pi, inner below outer",
                       (double)desc->inner_rad, (double)desc->outer_rad);
    return AG_OK;
}

enum ag_result parts_light(const char *function, const struct ag_scene *scene,
                           const struct ag_light_desc *desc, struct placed_light *out)
{
    const enum ag_result checked = light_check(function, scene->context, desc);
    if (checked != AG_OK) return checked;
    const bool sun = desc->type == AG_LIGHT_SUN, point = desc->type == AG_LIGHT_POINT;
    out->position = sun ? vec3_of(0, 0, 0) : api_vec3(desc->position);
    out->direction = point ? vec3_of(0, -1, 0) : api_vec3(desc->direction);
    out->light.type = (enum light_type)desc->type;
    out->light.intensity = api_vec3(desc->intensity);
    out->light.inner_rad = desc->inner_rad;
    out->light.outer_rad = fminf(desc->outer_rad, GLM_PI_2f);
    out->light.off = !desc->enabled;
    return AG_OK;
}

enum ag_result parts_matrix(const char *function, const struct ag_scene *scene, const float *matrix,
                            mat4s *out)
{
    struct ag_context *context = scene->context;
    *out = glms_mat4_identity();
    if (!matrix) return AG_OK;
    AG_REQUIRE_FOR(function, context, api_finite(matrix, 16), "world_from_mesh is not finite");
    AG_REQUIRE_FOR(function, context, limits_position(api_vec3(matrix + 12)),
                   "the position of world_from_mesh is not within %g m of the origin",
                   (double)SCENE_MAX_DISTANCE_M);
    AG_REQUIRE_FOR(function, context,
                   matrix[3] == 0.0f && matrix[7] == 0.0f && matrix[11] == 0.0f &&
                       matrix[15] == 1.0f,
                   "world_from_mesh is not affine: its last row must be 0 0 0 1");
    memcpy(out->raw, matrix, 16 * sizeof *matrix);
    return AG_OK;
}
