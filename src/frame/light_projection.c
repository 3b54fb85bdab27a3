// Projections of shadow maps and reflective shadow maps.
#include "frame/light_projection.h"

#include "frame/projection.h"

#include <math.h>

static const float SPOT_MIN_COS = 0.0871557f; // cos 85°
static const float NEAR_SHARE = 1e-4f;        // near plane over the scene's diagonal
static const float NEAR_MIN_M = 1e-3f;

mat4s light_space(vec3s direction)
{
    vec3s up, unused;
    basis_of(direction, &unused, &up);
    return projection_view_from_world(vec3_of(0, 0, 0), direction, up);
}

mat4s light_orthographic(vec3s direction, float x, float y, float half_m, struct box3 bounds,
                         float *depth_m)
{
    mat4s view = light_space(direction);
    struct box3 box = box3_transform(view, bounds);
    // The margin gives flat scenes a depth and keeps the box's faces inside.
    float margin = 1e-3f * (light_diagonal(bounds) + 1.0f);
    float near_m = -box.max.z - margin, far_m = -box.min.z + margin;
    *depth_m = far_m - near_m;
    view.raw[3][0] -= x;
    view.raw[3][1] -= y;
    return glms_mat4_mul(projection_orthographic(half_m, near_m, far_m), view);
}

mat4s light_cube_face(vec3s position, int face, float tan_half, float near_m)
{
    return glms_mat4_mul(projection_perspective(tan_half, tan_half, near_m),
                         projection_view_from_world(position, projection_cube_forward(face),
                                                    projection_cube_up(face)));
}

mat4s light_spot_face(vec3s position, vec3s direction, float tan_half, float near_m)
{
    vec3s up, unused;
    basis_of(direction, &unused, &up);
    return glms_mat4_mul(projection_perspective(tan_half, tan_half, near_m),
                         projection_view_from_world(position, direction, up));
}

float light_spot_tan(float cos_outer)
{
    float c = fminf(fmaxf(cos_outer, SPOT_MIN_COS), 0.9999f);
    return sqrtf(1.0f - c * c) / c;
}

float light_near(struct box3 bounds)
{
    return fmaxf(NEAR_SHARE * light_diagonal(bounds), NEAR_MIN_M);
}

float light_diagonal(struct box3 bounds)
{
    return box3_is_empty(bounds) ? 0.0f : glms_vec3_norm(box3_size(bounds));
}
