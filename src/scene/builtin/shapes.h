// Building blocks of the built-in scenes. A builder collects triangles of one material; shape_emit
// adds them to the scene as a mesh at a node of the same name. Faces are counter-clockwise from
// outside, normals unit, and solids are closed, so that no light leaks and no ray slips through.
//
// A failure (out of memory) is remembered by the builder and reported by shape_emit, so that the
// code of a scene reads as a list of its parts.
//
// Texture coordinates are metres along the surface unless a function says otherwise; the scale of a
// material's textures is in its texture_use.
#pragma once

#include "scene/scene.h"

struct shape_builder {
    struct scene *scene;
    vec3s *positions, *normals;
    vec2s *uv;
    uint32_t *indices;
    uint32_t vertex_count, vertex_room, index_count, index_room;
    mat4s
        scene_from_shape; // applied to what is added; a rotation, a translation, or a uniform scale
    bool failed;
};

void shape_begin(struct shape_builder *builder, struct scene *scene);
// Frees what the builder collected without adding it; accepts an ended builder.
void shape_discard(struct shape_builder *builder);
// Adds mesh, node and instance; the builder is empty again and keeps its transform. The instance's
// index, -1 on failure.
int shape_emit(struct shape_builder *builder, const char *name, int material);

uint32_t shape_vertex(struct shape_builder *builder, vec3s position, vec3s normal, vec2s uv);
void shape_triangle(struct shape_builder *builder, uint32_t a, uint32_t b, uint32_t c);
// Two triangles a, b, c, d counter-clockwise.
void shape_quad_of(struct shape_builder *builder, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

// A flat quadrilateral, counter-clockwise from outside; the corners need not be a parallelogram's,
// nor quite flat: each triangle of a bent one gets its own normal. Metre coordinates by the main
// axis of the normal.
void shape_quad(struct shape_builder *builder, vec3s a, vec3s b, vec3s c, vec3s d);
// A flat convex polygon of 3…SHAPE_MAX_CORNERS corners, as a fan.
#define SHAPE_MAX_CORNERS 64
void shape_polygon(struct shape_builder *builder, const vec3s *corners, int count);

void shape_box(struct shape_builder *builder, vec3s min, vec3s max);
void shape_sphere(struct shape_builder *builder, vec3s centre, float radius, int segments);
void shape_cylinder(struct shape_builder *builder, vec3s base, float radius, float height,
                    int segments);

// A solid of revolution around +y at `base`. The profile goes (radius, height) from the bottom up,
// starting and ending on the axis; edges sharper than 40 degrees stay sharp.
void shape_lathe(struct shape_builder *builder, vec3s base, const vec2s *profile, int count,
                 int segments);

// A grid with planes at x[0…nx], y[0…ny], z[0…nz] whose cells are solid or empty. part(user, i, j,
// k) is 0 for an empty cell and says which part a solid one belongs to; it is asked for cells
// inside the grid only, all outside is empty. shape_blocks adds the faces of one part's cells
// towards empty ones: all parts together are closed.
struct shape_grid {
    const float *x, *y, *z;
    int nx, ny, nz; // cells
    int (*part)(const void *user, int i, int j, int k);
    const void *user;
};
void shape_blocks(struct shape_builder *builder, const struct shape_grid *grid, int part);

// A wall panel with a round arch: a box from min to max, extruded along z, with an opening of
// half-width `radius` whose vertical sides rise to `spring` and whose top is a half circle around
// the middle of x. The opening reaches down to min.y. The arch must fit: spring + radius < max.y.
void shape_arch(struct shape_builder *builder, vec3s min, vec3s max, float radius, float spring,
                int segments);

// A closed pipe along a path: rings of `radius` around each frame's origin, in the plane of its x
// and y axes, walked along its z axis. Outside is outwards, or inwards when `inside_out`. Ends get
// caps where asked for.
struct shape_pipe {
    const mat4s *frames;
    int count; // frames, at least 2
    float radius;
    int segments;
    bool inside_out, start_cap, end_cap;
};
void shape_sweep(struct shape_builder *builder, const struct shape_pipe *pipe);

// Cloth of `thickness` hung between two heights: at (s, t) in 0…1 the middle surface lies where
// `at` says, s along the width, t downwards. Front towards (d/dt × d/ds). uv = (s, t) times
// `uv_size`.
struct shape_sheet {
    vec3s (*at)(const void *user, float s, float t);
    const void *user;
    int columns, rows;
    float thickness;
    vec2s uv_size;
};
void shape_cloth(struct shape_builder *builder, const struct shape_sheet *sheet);
