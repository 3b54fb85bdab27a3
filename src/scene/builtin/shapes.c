// Vertex buffers, polygons, boxes and blocks; round shapes are in shapes_round.c.
#include "scene/builtin/shapes.h"

#include <math.h>
#include <string.h>

void shape_begin(struct shape_builder *builder, struct scene *scene)
{
    *builder = (struct shape_builder){ .scene = scene, .scene_from_shape = glms_mat4_identity() };
}

void shape_discard(struct shape_builder *builder)
{
    if (!builder->scene) return;
    struct host *host = builder->scene->host;
    host_free(host, builder->positions);
    host_free(host, builder->normals);
    host_free(host, builder->uv);
    host_free(host, builder->indices);
    mat4s scene_from_shape = builder->scene_from_shape;
    shape_begin(builder, builder->scene);
    builder->scene_from_shape = scene_from_shape;
}

int shape_emit(struct shape_builder *builder, const char *name, int material)
{
    struct scene *scene = builder->scene;
    int added = -1;
    if (builder->failed) goto end;
    struct mesh mesh = {
        .name = name,
        .vertex_count = builder->vertex_count,
        .index_count = builder->index_count,
        .positions = builder->positions,
        .normals = builder->normals,
        .uv = { builder->uv, NULL },
        .indices = builder->indices,
        .material = material,
    };
    struct node node = node_default();
    node.name = name;
    struct instance instance = { .skin = -1 };
    instance.mesh = scene_add_mesh(scene, &mesh);
    if (instance.mesh < 0) goto end;
    instance.node = scene_add_node(scene, &node);
    if (instance.node < 0) goto end;
    added = scene_add_instance(scene, &instance);
end:
    shape_discard(builder);
    return added;
}

static bool grow_array(struct shape_builder *builder, void **array, uint32_t capacity, size_t size)
{
    void *grown = host_realloc(builder->scene->host, *array, capacity, size);
    if (!grown) {
        builder->failed = true;
        return false;
    }
    *array = grown;
    return true;
}

static bool reserve_vertex(struct shape_builder *builder)
{
    if (builder->failed) return false;
    if (builder->vertex_count < builder->vertex_capacity) return true;
    uint32_t capacity = builder->vertex_capacity ? 2 * builder->vertex_capacity : 256;
    if (!grow_array(builder, (void **)&builder->positions, capacity, sizeof *builder->positions) ||
        !grow_array(builder, (void **)&builder->normals, capacity, sizeof *builder->normals) ||
        !grow_array(builder, (void **)&builder->uv, capacity, sizeof *builder->uv)) {
        return false;
    }
    builder->vertex_capacity = capacity;
    return true;
}

uint32_t shape_vertex(struct shape_builder *builder, vec3s position, vec3s normal, vec2s uv)
{
    if (!reserve_vertex(builder)) return 0;
    uint32_t v = builder->vertex_count++;
    builder->positions[v] = mat4_point(builder->scene_from_shape, position);
    builder->normals[v] = glms_vec3_normalize(mat4_direction(builder->scene_from_shape, normal));
    builder->uv[v] = uv;
    return v;
}

void shape_triangle(struct shape_builder *builder, uint32_t a, uint32_t b, uint32_t c)
{
    if (builder->failed) return;
    if (builder->index_count + 3 > builder->index_capacity) {
        uint32_t capacity = builder->index_capacity ? 2 * builder->index_capacity : 768;
        if (!grow_array(builder, (void **)&builder->indices, capacity, sizeof *builder->indices)) {
            return;
        }
        builder->index_capacity = capacity;
    }
    uint32_t *out = builder->indices + builder->index_count;
    out[0] = a;
    out[1] = b;
    out[2] = c;
    builder->index_count += 3;
}

void shape_quad_of(struct shape_builder *builder, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    shape_triangle(builder, a, b, c);
    shape_triangle(builder, a, c, d);
}

// Planar projection in metres: u to the right and v down, seen from outside (for floors, v along
// +z).
static vec2s planar_uv(vec3s normal, vec3s p)
{
    float x = fabsf(normal.x), y = fabsf(normal.y), z = fabsf(normal.z);
    if (y >= x && y >= z) return (vec2s){ { normal.y > 0 ? p.x : -p.x, p.z } };
    if (x >= z) return (vec2s){ { normal.x > 0 ? -p.z : p.z, -p.y } };
    return (vec2s){ { normal.z > 0 ? p.x : -p.x, -p.y } };
}

static vec3s plane_normal(vec3s a, vec3s b, vec3s c)
{
    return glms_vec3_normalize(glms_vec3_cross(glms_vec3_sub(b, a), glms_vec3_sub(c, a)));
}

void shape_polygon(struct shape_builder *builder, const vec3s *corners, int count)
{
    vec3s normal = plane_normal(corners[0], corners[1], corners[2]);
    uint32_t first = builder->vertex_count;
    for (int i = 0; i < count; i++) {
        shape_vertex(builder, corners[i], normal, planar_uv(normal, corners[i]));
    }
    for (int i = 2; i < count; i++) {
        shape_triangle(builder, first, first + (uint32_t)i - 1, first + (uint32_t)i);
    }
}

void shape_quad(struct shape_builder *builder, vec3s a, vec3s b, vec3s c, vec3s d)
{
    vec3s normal = plane_normal(a, b, c), other = plane_normal(a, c, d);
    if (glms_vec3_dot(normal, other) > 0.999999f) {
        shape_polygon(builder, (vec3s[]){ a, b, c, d }, 4);
    } else {
        shape_polygon(builder, (vec3s[]){ a, b, c }, 3);
        shape_polygon(builder, (vec3s[]){ a, c, d }, 3);
    }
}

// One side of a box, towards +axis or -axis, counter-clockwise from outside.
static void box_side(struct shape_builder *builder, const vec3s bounds[2], int axis, int positive)
{
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    static const int around[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    vec3s corner[4];
    for (int i = 0; i < 4; i++) {
        const int *at = around[positive ? i : 3 - i];
        corner[i].raw[axis] = bounds[positive].raw[axis];
        corner[i].raw[u] = bounds[at[0]].raw[u];
        corner[i].raw[v] = bounds[at[1]].raw[v];
    }
    shape_polygon(builder, corner, 4);
}

void shape_box(struct shape_builder *builder, vec3s min, vec3s max)
{
    const vec3s bounds[2] = { min, max };
    for (int axis = 0; axis < 3; axis++) {
        box_side(builder, bounds, axis, 0);
        box_side(builder, bounds, axis, 1);
    }
}

static int grid_part(const struct shape_grid *grid, const int cell[3])
{
    if (cell[0] < 0 || cell[1] < 0 || cell[2] < 0) return 0;
    if (cell[0] >= grid->nx || cell[1] >= grid->ny || cell[2] >= grid->nz) return 0;
    return grid->part(grid->user, cell[0], cell[1], cell[2]);
}

static void block_sides(struct shape_builder *builder, const struct shape_grid *grid,
                        const int cell[3])
{
    const float *planes[3] = { grid->x, grid->y, grid->z };
    vec3s bounds[2];
    for (int axis = 0; axis < 3; axis++) {
        bounds[0].raw[axis] = planes[axis][cell[axis]];
        bounds[1].raw[axis] = planes[axis][cell[axis] + 1];
    }
    for (int axis = 0; axis < 3; axis++) {
        for (int positive = 0; positive < 2; positive++) {
            int beside[3] = { cell[0], cell[1], cell[2] };
            beside[axis] += positive ? 1 : -1;
            if (grid_part(grid, beside) == 0) box_side(builder, bounds, axis, positive);
        }
    }
}

void shape_blocks(struct shape_builder *builder, const struct shape_grid *grid, int part)
{
    for (int k = 0; k < grid->nz; k++) {
        for (int j = 0; j < grid->ny; j++) {
            for (int i = 0; i < grid->nx; i++) {
                const int cell[3] = { i, j, k };
                if (grid_part(grid, cell) == part) block_sides(builder, grid, cell);
            }
        }
    }
}
