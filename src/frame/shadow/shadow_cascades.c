// Cascaded shadow maps for suns, fitted to the visible part of the scene and kept while it moves.
//
// Splits: the practical scheme, C_i = ρ n (f/n)^(i/m) + (1−ρ)(n + (f−n) i/m) (Zhang et al. 2007, as
// in Hong 2015, sec. 2.3.2). Differs: a cascade covers the intersection of its frustum slice and
// the scene as seen from the light, not the slice's bounding sphere (Valient 2007), which in rooms
// is mostly empty. Sizes and positions come from a fixed lattice: a cascade changes only when its
// slice leaves a cell, and texels never move relative to the scene. The last cascade is the whole
// scene and does not depend on the camera. Depth ranges are the scene's: they contain all casters.
#include "frame/shadow/shadow.h"

#include "frame/light_projection.h"
#include "frame/projection.h"

#include <math.h>

static const float NEAR_SHARE = 1e-3f;   // minimum near distance of the splits over the far one
static const float CONSTANT_BIAS = 0.1f; // texels
enum {
    STEPS = 16,  // lattice steps along an edge of a cascade
    SIZES = 128, // each size is 1/√2 of the one before
};

// A rectangle in light space, m.
struct light_rect {
    float min[2], max[2];
};

// Light space of a sun with the scene in it.
struct sun_space {
    mat4s light_from_world; // a rotation whose −z axis is the light's direction
    struct box3 scene;      // bounds in light space
};

static vec3s corner_of(struct box3 box, int i)
{
    return vec3_of((i & 1 ? box.max : box.min).x, (i & 2 ? box.max : box.min).y,
                   (i & 4 ? box.max : box.min).z);
}

// Rounded outwards, so that moving geometry rarely changes the bounds.
static struct box3 rounded(struct box3 box)
{
    vec3s size = box3_size(box);
    int exponent;
    frexpf(fmaxf(fmaxf(size.x, size.y), fmaxf(size.z, 1e-3f)), &exponent);
    float step = ldexpf(1.0f, exponent - 6); // 1/64 to 1/32 of the longest edge
    for (int k = 0; k < 3; k++) {
        box.min.raw[k] = floorf(box.min.raw[k] / step) * step;
        box.max.raw[k] = ceilf(box.max.raw[k] / step) * step;
    }
    return box;
}

// Turned about the light's direction so that the scene's bounds cover the smallest rectangle. One
// edge of it is the projection of an edge of the box (Freeman & Shapira 1975).
static struct sun_space sun_space_of(vec3s direction, struct box3 bounds)
{
    struct sun_space best = { 0 };
    float smallest = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        vec3s edge = vec3_of(axis == 0, axis == 1, axis == 2);
        vec3s up = glms_vec3_muladds(direction, -glms_vec3_dot(edge, direction), edge);
        if (glms_vec3_norm(up) < 0.1f) continue; // at most one axis
        struct sun_space space = { projection_view_from_world(vec3_of(0, 0, 0), direction,
                                                              glms_vec3_normalize(up)),
                                   { { { 0 } }, { { 0 } } } };
        space.scene = rounded(box3_transform(space.light_from_world, bounds));
        vec3s size = box3_size(space.scene);
        // The margin makes the choice independent of rounding errors.
        if (!(size.x * size.y < 0.999f * smallest)) continue;
        smallest = size.x * size.y;
        best = space;
    }
    return best;
}

static float split(float near_m, float far_m, float blend, int i, int count)
{
    float t = (float)i / (float)count;
    float logarithmic = near_m * powf(far_m / near_m, t);
    float uniform = near_m + (far_m - near_m) * t;
    return blend * logarithmic + (1.0f - blend) * uniform;
}

// Distances along the view axis between which the scene lies.
static void depth_range(const struct shadow_view *view, float *near_m, float *far_m)
{
    float nearest = INFINITY;
    *far_m = 0.0f;
    for (int i = 0; i < 8; i++) {
        vec3s to = glms_vec3_sub(corner_of(view->bounds, i), view->camera.eye);
        float along = glms_vec3_dot(to, view->camera.forward);
        nearest = fminf(nearest, along);
        *far_m = fmaxf(*far_m, along);
    }
    *near_m = fmaxf(fmaxf(view->camera.near_m, nearest), NEAR_SHARE * *far_m);
}

// Bounding rectangle of a frustum slice in light space, inside that of the scene.
static struct light_rect slice_rect(const struct sun_space *space, const struct shadow_view *view,
                                    float near_m, float far_m)
{
    struct light_rect r = { { INFINITY, INFINITY }, { -INFINITY, -INFINITY } };
    for (int i = 0; i < 8; i++) {
        const struct frame_sight sight =
            frame_camera_sight(&view->camera, i & 1 ? 1.0f : -1.0f, i & 2 ? -1.0f : 1.0f);
        vec3s p = glms_vec3_muladds(sight.direction, i & 4 ? far_m : near_m, sight.origin);
        p = mat4_direction(space->light_from_world, p);
        for (int k = 0; k < 2; k++) {
            r.min[k] = fminf(r.min[k], p.raw[k]);
            r.max[k] = fmaxf(r.max[k], p.raw[k]);
        }
    }
    for (int k = 0; k < 2; k++) {
        r.min[k] = fmaxf(r.min[k], space->scene.min.raw[k]);
        r.max[k] = fminf(r.max[k], space->scene.max.raw[k]);
    }
    return r;
}

// The square of the lattice that contains the rectangle; false: it is not smaller than the scene.
static bool fit_to_lattice(const struct sun_space *space, const struct light_rect *needed,
                           struct light_rect *out)
{
    vec3s scene = box3_size(space->scene);
    float edge = fmaxf(scene.x, scene.y);
    float longest = fmaxf(needed->max[0] - needed->min[0], needed->max[1] - needed->min[1]);
    // Positions are rounded down by up to one step.
    float least = longest * STEPS / (STEPS - 1);
    int size = 0;
    while (size < SIZES && edge * sqrtf(0.5f) >= least) {
        edge *= sqrtf(0.5f);
        size++;
    }
    if (size == 0) return false;
    float step = edge / STEPS;
    for (int k = 0; k < 2; k++) {
        out->min[k] = floorf(needed->min[k] / step) * step;
        out->max[k] = out->min[k] + edge;
    }
    return true;
}

static struct shadow_face place(const struct shadow *shadow, const struct sun_space *space,
                                const struct light_rect *rect, const struct shadow_view *view)
{
    // Margin for the filter and the receiver's offset. A lattice step is a whole number of texels.
    float rim = 4.0f * ((float)view->filter_radius + 2.0f), size = (float)shadow->sun_size;
    float widen = size / (STEPS * fmaxf(floorf((size - rim) / STEPS), 1.0f));
    float depth_margin = 1e-3f * (light_diagonal(view->bounds) + 1.0f);
    float near_m = -space->scene.max.z - depth_margin, far_m = -space->scene.min.z + depth_margin;
    mat4s view_from_world = space->light_from_world;
    float longest = 0.0f;
    for (int k = 0; k < 2; k++) {
        float half = 0.5f * (rect->max[k] - rect->min[k]) * widen;
        float centre = 0.5f * (rect->max[k] + rect->min[k]);
        longest = fmaxf(longest, half);
        view_from_world.raw[3][k] -= centre;
        for (int column = 0; column < 4; column++) view_from_world.raw[column][k] /= half;
    }
    float texel_m = 2.0f * longest / size;
    return (struct shadow_face){
        .clip_from_world =
            glms_mat4_mul(projection_orthographic(1.0f, near_m, far_m), view_from_world),
        .texel_m = texel_m,
        .depth_scale = 1.0f,
        .depth_offset = CONSTANT_BIAS * texel_m / (far_m - near_m),
        .depth_texels = (far_m - near_m) / texel_m,
        .size = size,
    };
}

// The scene's rectangle, widened where the scene is flat.
static struct light_rect scene_rect(const struct sun_space *space)
{
    vec3s size = box3_size(space->scene), centre = box3_centre(space->scene);
    float least = fmaxf(1e-3f * fmaxf(size.x, size.y), 1e-3f);
    struct light_rect r;
    for (int k = 0; k < 2; k++) {
        float half = 0.5f * fmaxf(size.raw[k], least);
        r.min[k] = centre.raw[k] - half;
        r.max[k] = centre.raw[k] + half;
    }
    return r;
}

void shadow_place_sun(const struct shadow *shadow, struct shadow_face *faces, int count,
                      vec3s direction, const struct shadow_view *view)
{
    struct shadow_view filled = *view;
    if (box3_is_empty(view->bounds))
        filled.bounds = (struct box3){ glms_vec3_subs(view->camera.eye, 1.0f),
                                       glms_vec3_adds(view->camera.eye, 1.0f) };
    const struct sun_space space = sun_space_of(direction, filled.bounds);
    const struct light_rect whole = scene_rect(&space);
    float near_m, far_m;
    depth_range(&filled, &near_m, &far_m);
    for (int i = 0; i < count; i++) {
        const float blend = view->cascade_blend;
        const struct light_rect slice =
            slice_rect(&space, view, i == 0 ? 0.0f : split(near_m, far_m, blend, i, count),
                       split(near_m, far_m, blend, i + 1, count));
        struct light_rect fitted;
        const bool is_whole = i == count - 1 || !(near_m < far_m) || slice.min[0] >= slice.max[0] ||
                              slice.min[1] >= slice.max[1] ||
                              !fit_to_lattice(&space, &slice, &fitted);
        faces[i] = place(shadow, &space, is_whole ? &whole : &fitted, &filled);
    }
}
