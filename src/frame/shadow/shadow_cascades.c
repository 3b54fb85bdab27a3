// Stable cascaded shadow maps for suns.
//
// Splits: the practical scheme, C_i = ρ n (f/n)^(i/m) + (1−ρ)(n + (f−n) i/m) (Zhang et al. 2007, as
// in Hong 2015, sec. 2.3.2). Stability (Valient 2007; Hong 2015, sec. 2.3.3): a cascade covers the
// bounding sphere of its frustum slice, so that its size does not depend on the camera's
// orientation, and moves by whole texels. Differs: a cascade is never wider than the scene's
// bounding sphere, and its depth range is that of the scene, so that it contains all casters.
#include "frame/shadow/shadow.h"

#include "frame/light_projection.h"

#include <math.h>

static const float NEAR_SHARE = 1e-3f;   // minimum near distance of the splits over the far one
static const float CONSTANT_BIAS = 0.1f; // texels
static const float RADIUS_STEP = 64.0f;  // radii are multiples of 1/64 of their power of two

struct sphere {
    vec3s centre;
    float radius;
};

// Far distance of the last split: the scene's diagonal, doubled until the scene is inside. Constant
// under camera motion except for these steps.
static float far_end(const struct shadow_view *view)
{
    float diagonal = fmaxf(light_diagonal(view->bounds), 1e-3f);
    if (box3_is_empty(view->bounds)) return 1.0f;
    float farthest = 0.0f;
    for (int i = 0; i < 8; i++) {
        vec3s corner = vec3_of((i & 1 ? view->bounds.max : view->bounds.min).x,
                               (i & 2 ? view->bounds.max : view->bounds.min).y,
                               (i & 4 ? view->bounds.max : view->bounds.min).z);
        farthest = fmaxf(farthest, glms_vec3_norm(glms_vec3_sub(corner, view->camera.eye)));
    }
    float end = diagonal;
    while (end < farthest * 0.9999f && end < 1e30f) end *= 2.0f;
    return end;
}

static float split(float near_m, float far_m, float blend, int i, int count)
{
    float t = (float)i / (float)count;
    float logarithmic = near_m * powf(far_m / near_m, t);
    float uniform = near_m + (far_m - near_m) * t;
    return blend * logarithmic + (1.0f - blend) * uniform;
}

// Minimal bounding sphere of a frustum slice. Its centre lies on the view axis, equidistant from
// the near and the far corners, or on the far plane if that is nearer.
static struct sphere slice_sphere(const struct shadow_view *view, float near_m, float far_m)
{
    float tan_y = tanf(view->camera.vertical_fov_rad * 0.5f), tan_x = tan_y * view->aspect;
    float k2 = tan_x * tan_x + tan_y * tan_y;
    float at = fminf(0.5f * (near_m + far_m) * (1.0f + k2), far_m);
    float across = far_m - at;
    struct sphere s = {
        .centre = glms_vec3_muladds(view->camera.forward, at, view->camera.eye),
        .radius = sqrtf(across * across + far_m * far_m * k2),
    };
    // Rounded up, so that rounding errors of the camera do not change the texel size.
    int exponent;
    float mantissa = frexpf(s.radius, &exponent);
    s.radius = ldexpf(ceilf(mantissa * RADIUS_STEP) / RADIUS_STEP, exponent);
    return s;
}

static struct sphere scene_sphere(const struct shadow_view *view)
{
    if (box3_is_empty(view->bounds)) return (struct sphere){ view->camera.eye, 1.0f };
    return (struct sphere){ box3_centre(view->bounds),
                            fmaxf(0.5f * light_diagonal(view->bounds), 1e-3f) };
}

static double snap(double value, double step)
{
    return floor(value / step + 0.5) * step;
}

static struct shadow_face place(const struct shadow *shadow, vec3s direction, struct sphere sphere,
                                const struct shadow_view *view)
{
    // Margin around the sphere for half a texel step, the filter and the receiver's offset.
    float rim = 4.0f * ((float)view->filter_radius + 2.0f);
    float half = sphere.radius / fmaxf(1.0f - rim / (float)shadow->size, 0.25f);
    double texel = 2.0 * (double)half / (double)shadow->size;
    vec3s centre = mat4_direction(light_space(direction), sphere.centre);
    float depth_m;
    struct box3 deep = box3_is_empty(view->bounds)
                           ? (struct box3){ glms_vec3_subs(sphere.centre, sphere.radius),
                                            glms_vec3_adds(sphere.centre, sphere.radius) }
                           : view->bounds;
    struct shadow_face face = {
        .clip_from_world =
            light_orthographic(direction, (float)snap((double)centre.x, texel),
                               (float)snap((double)centre.y, texel), half, deep, &depth_m),
        .texel_m = (float)texel,
        .depth_scale = 1.0f,
    };
    face.depth_offset = CONSTANT_BIAS * face.texel_m / depth_m;
    return face;
}

void shadow_place_sun(const struct shadow *shadow, struct shadow_face *faces, int count,
                      vec3s direction, const struct shadow_view *view)
{
    float far_m = far_end(view);
    float near_m = fminf(fmaxf(view->camera.near_m, NEAR_SHARE * far_m), 0.5f * far_m);
    struct sphere whole = scene_sphere(view);
    for (int i = 0; i < count; i++) {
        struct sphere slice =
            slice_sphere(view, i == 0 ? 0.0f : split(near_m, far_m, view->cascade_blend, i, count),
                         split(near_m, far_m, view->cascade_blend, i + 1, count));
        // The last cascade contains the whole scene: points outside of all others use it.
        bool last = i == count - 1;
        faces[i] =
            place(shadow, direction, last || slice.radius > whole.radius ? whole : slice, view);
    }
}
