// Checks a caller's camera and converts it for the modules.
#include "api/objects.h"

#include "scene/limits.h"

struct world_camera api_camera(const struct ag_camera *camera)
{
    vec3s eye = api_vec3(camera->eye), up = api_vec3(camera->up);
    vec3s forward = vec3_towards(eye, api_vec3(camera->target));
    vec3s across = glms_vec3_sub(up, glms_vec3_scale(forward, glms_vec3_dot(up, forward)));
    vec3s tangent;
    if (glms_vec3_norm(across) > 1e-6f * glms_vec3_norm(up))
        up = glms_vec3_normalize(across);
    else
        basis_of(forward, &tangent, &up);
    return (struct world_camera){ .eye = eye,
                                  .forward = forward,
                                  .up = up,
                                  .vertical_fov_rad = camera->vertical_fov_rad,
                                  .near_m = camera->near_m };
}

enum ag_result api_camera_check(struct ag_context *context, const char *function,
                                const struct ag_camera *camera)
{
    AG_REQUIRE_FOR(function, context, api_finite(camera->up, 3), "the camera's up is not finite");
    AG_REQUIRE_FOR(function, context,
                   limits_position(api_vec3(camera->eye)) &&
                       limits_position(api_vec3(camera->target)),
                   "the camera's eye or target is not within %g m of the origin",
                   (double)SCENE_MAX_DISTANCE_M);
    vec3s forward = vec3_towards(api_vec3(camera->eye), api_vec3(camera->target));
    AG_REQUIRE_FOR(function, context, glms_vec3_norm(forward) > 0.0f,
                   "the camera's eye and target are the same point");
    AG_REQUIRE_FOR(function, context,
                   camera->vertical_fov_rad > 0.0f && camera->vertical_fov_rad < GLM_PIf,
                   "the camera's vertical_fov_rad %g is not between 0 and pi",
                   (double)camera->vertical_fov_rad);
    AG_REQUIRE_FOR(function, context, camera->near_m > 0.0f && isfinite(camera->near_m),
                   "the camera's near_m %g is not above 0", (double)camera->near_m);
    return AG_OK;
}
