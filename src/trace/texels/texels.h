// Texels of charts in a trace scene of the same pose: where they are sampled, and the surface
// there. Texels are those of both sides.
#pragma once

#include "scene/charts/charts.h"
#include "trace/surface.h"

// The surface at a point of a chart's triangle, seen from the side of `normal`.
void texel_surface(const struct trace_scene *scene, const struct chart_triangle *of, float u,
                   float v, vec3s normal, struct surface *out);

// Barycentric weights of a place in the atlas. False: it is outside of the triangle.
bool texel_weigh(const struct chart_triangle *triangle, float x, float y, float *u, float *v);

// ---- point.c

// Whether a point of the texel's surface is inside geometry.
bool texel_is_inside(const struct trace_scene *scene, const struct charts *charts, uint32_t texel,
                     vec3s at);

// The sample point of a texel, and the share of the texel that is outside geometry; 0: none is.
struct texel_point {
    vec3s position;
    float share;
};
struct texel_point texel_find_point(const struct trace_scene *scene, const struct charts *charts,
                                    uint32_t texel);

// Whether nothing is between two points of a texel's surface, a quarter of a texel above it: lower
// objects hide no light that a texel could show.
bool texel_sees(const struct trace_scene *scene, const struct charts *charts, uint32_t texel,
                vec3s from, vec3s to);
// A point of the surface at that height.
vec3s texel_above(const struct charts *charts, uint32_t texel, vec3s at);

// ---- reflectance.c

// Mean reflectance of a texel for light that bounces, 0…1 (brdf_bounce_reflectance); w: the mean
// cosine between its shading normals and the normal of its triangle. shading (may be NULL): the
// mean of the former, of length 1 or less.
vec4s texel_reflectance(const struct trace_scene *scene, const struct charts *charts,
                        uint32_t texel, vec3s *shading);

// Means of a texel without the factors of its material, in a trace scene whose factors are 1
// (scene_statics_free_factors): base colour, mean cosine as above, and the maps of metallic,
// roughness, specular weight, and specular colour times weight.
struct texel_factors {
    vec3s base;
    float cosine, metallic, roughness, weight;
    vec3s color;
};
struct texel_factors texel_free_factors(const struct trace_scene *scene,
                                        const struct charts *charts, uint32_t texel);
// Its reflectance with the factors of a material, as texel_reflectance.
vec3s texel_reflectance_with(const struct texel_factors *factors, const struct material *material);
