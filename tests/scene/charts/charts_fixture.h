// Scenes to chart, and laws that charts keep.
//
//     struct scene_pose pose;
//     struct scene *scene = open_scene("@cornell", &pose);
//     CHECK(charts_init(&charts, test_host(), &pose, &options));
//     check_gutters_are_own(&charts);
//     charts_finish(&charts);
//     close_scene(scene, &pose);
#pragma once

#include "framework/test.h"

#include "scene/charts/charts.h"

// ---- scenes

// A scene by name, with its pose at the beginning.
struct scene *open_scene(const char *name, struct scene_pose *pose);
void close_scene(struct scene *scene, struct scene_pose *pose);
// Instances of one mesh in a row along x, 3 m apart.
struct scene *scene_of(const struct mesh *mesh, int instances);
// A scene of one mesh; frees the arrays, which are of test_host.
struct scene *scene_of_triangles(vec3s *positions, uint32_t vertices, uint32_t *indices,
                                 uint32_t index_count);
// Two quads side by side; in TEXCOORD_1 the first begins at u = first_u, the second at u_of_second.
struct scene *two_quads(float u_of_second, float first_u, int instances);

// ---- laws

void check_each_triangle_is_in_one_chart(const struct charts *charts,
                                         const struct scene_pose *pose);
void check_gutters_are_own(const struct charts *charts);
void check_texels_lie_on_triangles(const struct charts *charts);
// A bilinear lookup anywhere on a triangle reads texels of its chart alone.
void check_lookups_stay_in_the_chart(const struct charts *charts);

// Largest magnitude of the coordinates of a triangle's corners.
double largest_coordinate(const struct chart_triangle *t);
