// Maps of a sun as the camera sees them, for the lookup of blocks.
#include "frame/shadow/shadow.h"

#include <math.h>

// Positions up to this are exact to 1/256 of a texel, which the blocks allow for.
static const float MOST_TEXELS = 32768.0f;

// Row of the transform from world space to texels: x, y and z as in shadow_resolved.glsl.
static vec4s texel_row(const struct shadow_face *face, int row)
{
    const mat4s *m = &face->clip_from_world;
    const float scale = row < 2 ? 0.5f * face->size : face->depth_texels;
    const float centre = row < 2 ? 0.5f * face->size - 0.5f : 0.0f;
    return (vec4s){ { m->raw[0][row] * scale, m->raw[1][row] * scale, m->raw[2][row] * scale,
                      m->raw[3][row] * scale + centre } };
}

static vec3s direction_of(vec4s row)
{
    return vec3_of(row.x, row.y, row.z);
}

// Maps of one sun differ by scale and offset along each axis.
static void relate(const struct shadow_face *face, const struct shadow_face *last, int i,
                   struct shadow_sun_view *out)
{
    for (int k = 0; k < 3; k++) {
        const vec4s own = texel_row(face, k), other = texel_row(last, k);
        const float scale = glms_vec3_norm(direction_of(own)) / glms_vec3_norm(direction_of(other));
        out->scale[i].raw[k] = scale;
        out->offset[i].raw[k] = own.w - scale * other.w;
    }
    out->depth[i] = face->depth_texels;
    out->layer[i] = face->layer;
}

struct shadow_sun_view shadow_view_of_sun(const struct shadow_face *faces, int count, vec3s eye)
{
    const struct shadow_face *last = &faces[count - 1];
    struct shadow_sun_view view = { .size = last->size };
    for (int k = 0; k < 3; k++) {
        const vec4s row = texel_row(last, k);
        view.map_from_world[k] = direction_of(row);
        view.viewer.raw[k] = glms_vec3_dot(direction_of(row), eye) + row.w;
    }
    for (int i = 0; i < count; i++) relate(&faces[i], last, i, &view);
    return view;
}

bool shadow_view_is_precise(const struct shadow_sun_view *view, const struct shadow_face *faces,
                            int count)
{
    const float extent = fmaxf(view->size, faces[count - 1].depth_texels);
    float most = 0.0f;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++)
            most = fmaxf(most, view->scale[i].raw[k] * fmaxf(fabsf(view->viewer.raw[k]), extent));
    }
    return most <= MOST_TEXELS;
}
