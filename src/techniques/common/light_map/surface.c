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

struct light_map_triangle light_map_triangle_of(const struct chart_triangle *t, bool has_back)
{
    struct light_map_triangle out = { .front = has_back ? octahedral_pack(t->normal)
                                                        : LIGHT_MAP_ONE_SIDED };
    out.u_axis = axis_of(t, 0, &out.offset.x);
    out.v_axis = axis_of(t, 1, &out.offset.y);
    return out;
}

void light_map_fill_triangles(const struct charts *charts, const uint32_t *chart_triangle,
                              size_t count, struct light_map_triangle *out)
{
    for (size_t i = 0; i < count; i++) {
        out[i] = LIGHT_MAP_ABSENT;
        if (chart_triangle[i] == CHART_NONE) continue;
        const struct chart_triangle *t = &charts->triangles[chart_triangle[i]];
        out[i] = light_map_triangle_of(t, charts->charts[t->chart].first_back != CHART_NONE);
    }
}
