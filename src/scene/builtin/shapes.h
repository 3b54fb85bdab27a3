// Shapes of the built-in scenes. A builder collects triangles of one material; shape_emit adds them
// to the scene as a mesh at a node of the same name. Faces are counter-clockwise from outside,
// normals are unit vectors, solids are watertight.
//
// Out of memory sets `failed`, which shape_emit reports: callers need not check each shape.
//
// Texture coordinates are metres along the surface unless noted otherwise; a material's texture_use
// has the scale of its textures.
#pragma once

#include "scene/scene.h"

struct shape_builder {
    struct scene *scene;
    vec3s *positions, *normals;
    vec2s *uv;
    uint32_t *indices;
    uint32_t vertex_count, vertex_capacity, index_count, index_capacity;
    mat4s scene_from_shape; // applied to new vertices; rotation, translation, uniform scale
    bool failed;
};

void shape_begin(struct shape_builder *builder, struct scene *scene);
// Frees the collected triangles without adding them; accepts an empty builder.
void shape_discard(struct shape_builder *builder);
// Adds mesh, node and instance and empties the builder, which keeps its transform. Returns the
// instance's index, -1 on failure.
int shape_emit(struct shape_builder *builder, const char *name, int material);

uint32_t shape_vertex(struct shape_builder *builder, vec3s position, vec3s normal, vec2s uv);
void shape_triangle(struct shape_builder *builder, uint32_t a, uint32_t b, uint32_t c);
// Two triangles a, b, c, d counter-clockwise.
void shape_quad_of(struct shape_builder *builder, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

// A quadrilateral, counter-clockwise from outside. If it is not planar, each triangle gets its own
// normal. Texture coordinates are projected along the major axis of the normal.
void shape_quad(struct shape_builder *builder, vec3s a, vec3s b, vec3s c, vec3s d);
// A flat convex polygon of 3…SHAPE_MAX_CORNERS corners, as a fan.
#define SHAPE_MAX_CORNERS 64
void shape_polygon(struct shape_builder *builder, const vec3s *corners, int count);

void shape_box(struct shape_builder *builder, vec3s min, vec3s max);
void shape_sphere(struct shape_builder *builder, vec3s centre, float radius, int segments);
void shape_cylinder(struct shape_builder *builder, vec3s base, float radius, float height,
                    int segments);

// A solid of revolution around +y at `base`. The profile is (radius, height) from bottom to top,
// starting and ending on the axis; edges sharper than 40 degrees have split normals.
void shape_lathe(struct shape_builder *builder, vec3s base, const vec2s *profile, int count,
                 int segments);

// A grid with planes at x[0…nx], y[0…ny], z[0…nz] whose cells are solid or empty. part(user, i, j,
// k) is the part of a solid cell, 0 for an empty one; cells outside the grid are empty.
// shape_blocks adds the faces between cells of one part and empty cells: the union of all parts is
// watertight.
struct shape_grid {
    const float *x, *y, *z;
    int nx, ny, nz; // cells
    int (*part)(const void *user, int i, int j, int k);
    const void *user;
};
void shape_blocks(struct shape_builder *builder, const struct shape_grid *grid, int part);

// A wall panel with a round arch: a box from min to max with an opening along z, centred in x, of
// half-width `radius`, from min.y up to the springing line at `spring` with a semicircle above.
// spring + radius < max.y.
void shape_arch(struct shape_builder *builder, vec3s min, vec3s max, float radius, float spring,
                int segments);

// A pipe along a path: rings of `radius` around each frame's origin, in the plane of its x and y
// axes; the path runs along z. Faces point outwards, or inwards when `inside_out`.
struct shape_pipe {
    const mat4s *frames;
    int count; // frames, at least 2
    float radius;
    int segments;
    bool inside_out, start_cap, end_cap;
};
void shape_sweep(struct shape_builder *builder, const struct shape_pipe *pipe);

// A sheet of `thickness`. `at` is its middle surface at (s, t) in 0…1, s along the width, t
// downwards; the front faces d/dt × d/ds. uv = (s, t) times `uv_size`.
struct shape_sheet {
    vec3s (*at)(const void *user, float s, float t);
    const void *user;
    int columns, rows;
    float thickness;
    vec2s uv_size;
};
void shape_cloth(struct shape_builder *builder, const struct shape_sheet *sheet);
