#include "techniques/common/light_map/surface.h"

#include "frame/octahedral.h"

// The affine map from the triangle's plane to one coordinate of the atlas.
static vec3s axis_of(const struct chart_triangle *t, int axis, float *offset)
{
    const vec3s a = glms_vec3_sub(t->corner[1], t->corner[0]);
    const vec3s b = glms_vec3_sub(t->corner[2], t->corner[0]);
    const vec3s normal = glms_vec3_cross(a, b);
    const float per_area2 = 1.0f / glms_vec3_norm2(normal);
    const float to_a = t->place[1].raw[axis] - t->place[0].raw[axis];
    const float to_b = t->place[2].raw[axis] - t->place[0].raw[axis];
    vec3s gradient = glms_vec3_scale(glms_vec3_cross(b, normal), to_a);
    gradient = glms_vec3_muladds(glms_vec3_cross(normal, a), to_b, gradient);
    gradient = glms_vec3_scale(gradient, per_area2);
    *offset = t->place[0].raw[axis] - glms_vec3_dot(gradient, t->corner[0]);
    return gradient;
}

struct gpu_image_desc light_map_image(const struct charts *charts, const char *name,
                                      uint32_t layers)
{
    return (struct gpu_image_desc){ .name = name,
                                    .dimension = GPU_2D_ARRAY,
                                    .format = GPU_RGBA16F,
                                    .width = charts->width,
                                    .height = charts->height,
                                    .depth = layers * charts_sides(charts),
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

void light_map_fill_triangles(const struct charts *charts, const uint32_t *chart_triangle,
                              size_t count, struct light_map_triangle *out)
{
    for (size_t i = 0; i < count; i++) {
        struct light_map_triangle *to = &out[i];
        *to = (struct light_map_triangle){ .offset = { { -1.0f, 0.0f } },
                                           .front = LIGHT_MAP_ONE_SIDED };
        if (chart_triangle[i] == CHART_NONE) continue;
        const struct chart_triangle *t = &charts->triangles[chart_triangle[i]];
        to->u_axis = axis_of(t, 0, &to->offset.x);
        to->v_axis = axis_of(t, 1, &to->offset.y);
        if (charts->charts[t->chart].first_back != CHART_NONE)
            to->front = octahedral_pack(t->normal);
    }
}
