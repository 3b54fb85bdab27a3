// Round shapes: solids of revolution, arches, pipes, cloth. See shapes.h.
#include "scene/builtin/shapes.h"

#include <math.h>

static const float CREASE_COS = 0.7660444f; // cos 40°: sharper edges have split normals

// A point of the profile of a solid of revolution.
struct ring {
    float radius, height;
    vec2s normal; // (outward, up), unit
    float v;      // metres along the profile
};

static void lathe_band(struct shape_builder *builder, vec3s base, struct ring low, struct ring high,
                       int segments)
{
    float around_m = 2.0f * GLM_PIf * fmaxf(low.radius, high.radius);
    uint32_t first = builder->vertex_count;
    for (int i = 0; i <= segments; i++) {
        float turn = (float)i / (float)segments;
        // Exactly the same point on both sides of the seam.
        float angle = i == segments ? 0.0f : 2.0f * GLM_PIf * turn;
        float c = cosf(angle), s = -sinf(angle);
        for (int k = 0; k < 2; k++) {
            struct ring ring = k ? high : low;
            vec3s position =
                vec3_of(base.x + ring.radius * c, base.y + ring.height, base.z + ring.radius * s);
            vec3s normal = vec3_of(ring.normal.x * c, ring.normal.y, ring.normal.x * s);
            shape_vertex(builder, position, normal, (vec2s){ { around_m * turn, -ring.v } });
        }
    }
    for (uint32_t i = 0; i < (uint32_t)segments; i++) {
        uint32_t a = first + 2 * i;
        if (low.radius > 0.0f) shape_triangle(builder, a, a + 2, a + 3);
        if (high.radius > 0.0f) shape_triangle(builder, a, a + 3, a + 1);
    }
}

static vec2s segment_normal(vec2s a, vec2s b)
{
    vec2s along = glms_vec2_sub(b, a);
    return glms_vec2_normalize((vec2s){ { along.y, -along.x } });
}

// The normal at one end of segment k, shared with the neighbour there unless the edge is sharp.
static vec2s profile_normal(const vec2s *profile, int count, int k, int neighbour)
{
    vec2s own = segment_normal(profile[k], profile[k + 1]);
    if (neighbour < 0 || neighbour + 1 >= count) return own;
    vec2s other = segment_normal(profile[neighbour], profile[neighbour + 1]);
    if (glms_vec2_dot(own, other) < CREASE_COS) return own;
    return glms_vec2_normalize(glms_vec2_add(own, other));
}

void shape_lathe(struct shape_builder *builder, vec3s base, const vec2s *profile, int count,
                 int segments)
{
    float v = 0.0f;
    for (int k = 0; k + 1 < count; k++) {
        vec2s a = profile[k], b = profile[k + 1];
        float next_v = v + glms_vec2_norm(glms_vec2_sub(b, a));
        struct ring low = { a.x, a.y, profile_normal(profile, count, k, k - 1), v };
        struct ring high = { b.x, b.y, profile_normal(profile, count, k, k + 1), next_v };
        lathe_band(builder, base, low, high, segments);
        v = next_v;
    }
}

void shape_cylinder(struct shape_builder *builder, vec3s base, float radius, float height,
                    int segments)
{
    const vec2s profile[] = {
        { { 0, 0 } }, { { radius, 0 } }, { { radius, height } }, { { 0, height } }
    };
    shape_lathe(builder, base, profile, 4, segments);
}

// A row of a sphere: latitude from -90 to 90 degrees. Poles are exactly on the axis.
static struct ring sphere_ring(float radius, int row, int rows)
{
    float latitude = GLM_PIf * ((float)row / (float)rows - 0.5f);
    bool pole = row == 0 || row == rows;
    vec2s normal = { { pole ? 0.0f : cosf(latitude),
                       pole ? (row ? 1.0f : -1.0f) : sinf(latitude) } };
    return (struct ring){ radius * normal.x, radius * normal.y, normal,
                          radius * GLM_PIf * (float)row / (float)rows };
}

void shape_sphere(struct shape_builder *builder, vec3s centre, float radius, int segments)
{
    int rows = segments / 2;
    for (int row = 0; row < rows; row++) {
        lathe_band(builder, centre, sphere_ring(radius, row, rows),
                   sphere_ring(radius, row + 1, rows), segments);
    }
}

// A segment from the opening of an arch to the outline of its panel, in x and y.
struct arch_cut {
    vec2s inner, outer;
};

static bool same_point(vec2s a, vec2s b)
{
    return a.x == b.x && a.y == b.y;
}

// The piece of the panel between two cuts: front, back, inner and outer edge. A triangle where the
// cuts share one end.
static void arch_piece(struct shape_builder *builder, float front, float back, struct arch_cut a,
                       struct arch_cut b)
{
    vec2s outline[4] = { a.inner, a.outer };
    int count = 2;
    if (!same_point(a.outer, b.outer)) outline[count++] = b.outer;
    if (!same_point(a.inner, b.inner)) outline[count++] = b.inner;
    vec3s before[4], behind[4];
    for (int i = 0; i < count; i++) {
        before[i] = vec3_of(outline[i].x, outline[i].y, front);
        behind[count - 1 - i] = vec3_of(outline[i].x, outline[i].y, back);
    }
    shape_polygon(builder, before, count);
    shape_polygon(builder, behind, count);
    if (!same_point(a.outer, b.outer)) {
        shape_quad(builder, vec3_of(a.outer.x, a.outer.y, front),
                   vec3_of(a.outer.x, a.outer.y, back), vec3_of(b.outer.x, b.outer.y, back),
                   vec3_of(b.outer.x, b.outer.y, front));
    }
    if (!same_point(a.inner, b.inner)) {
        shape_quad(builder, vec3_of(b.inner.x, b.inner.y, front),
                   vec3_of(b.inner.x, b.inner.y, back), vec3_of(a.inner.x, a.inner.y, back),
                   vec3_of(a.inner.x, a.inner.y, front));
    }
}

static void arch_foot(struct shape_builder *builder, float front, float back, float y, float x0,
                      float x1)
{
    shape_quad(builder, vec3_of(x0, y, back), vec3_of(x1, y, back), vec3_of(x1, y, front),
               vec3_of(x0, y, front));
}

void shape_arch(struct shape_builder *builder, vec3s min, vec3s max, float radius, float spring,
                int segments)
{
    float centre = 0.5f * (min.x + max.x), front = max.z, back = min.z;
    float left = centre - radius, right = centre + radius;
    struct arch_cut before = { { { right, min.y } }, { { max.x, min.y } } };
    struct arch_cut cut = { { { right, spring } }, { { max.x, spring } } };
    arch_piece(builder, front, back, before, cut);
    for (int i = 1; i < segments; i++) {
        float angle = GLM_PIf * (float)i / (float)segments;
        vec2s inner = { { centre + radius * cosf(angle), spring + radius * sinf(angle) } };
        before = cut;
        if (i == 1) { // around the panel's upper right corner
            cut = (struct arch_cut){ inner, { { max.x, max.y } } };
            arch_piece(builder, front, back, before, cut);
            before = cut;
        }
        cut = (struct arch_cut){ inner, { { inner.x, max.y } } };
        arch_piece(builder, front, back, before, cut);
    }
    before = cut;
    cut.outer = (vec2s){ { min.x, max.y } };
    arch_piece(builder, front, back, before, cut);
    before = cut;
    cut = (struct arch_cut){ { { left, spring } }, { { min.x, spring } } };
    arch_piece(builder, front, back, before, cut);
    before = cut;
    cut = (struct arch_cut){ { { left, min.y } }, { { min.x, min.y } } };
    arch_piece(builder, front, back, before, cut);
    arch_foot(builder, front, back, min.y, right, max.x);
    arch_foot(builder, front, back, min.y, min.x, left);
}

// A vertex of a pipe's ring; the last one is at the position of the first.
static void pipe_vertex(struct shape_builder *builder, const struct shape_pipe *pipe, mat4s frame,
                        int i, float along_m)
{
    float turn = (float)i / (float)pipe->segments;
    float angle = i == pipe->segments ? 0.0f : 2.0f * GLM_PIf * turn;
    vec3s outwards = vec3_of(cosf(angle), sinf(angle), 0);
    vec3s position = mat4_point(frame, glms_vec3_scale(outwards, pipe->radius));
    vec3s normal = mat4_direction(frame, outwards);
    if (pipe->inside_out) normal = glms_vec3_negate(normal);
    float around_m = 2.0f * GLM_PIf * pipe->radius * turn;
    shape_vertex(builder, position, normal, (vec2s){ { around_m, along_m } });
}

// A triangle with its winding reversed for inside_out.
static void pipe_triangle(struct shape_builder *builder, bool inside_out, uint32_t a, uint32_t b,
                          uint32_t c)
{
    if (inside_out) {
        shape_triangle(builder, a, c, b);
    } else {
        shape_triangle(builder, a, b, c);
    }
}

static void pipe_cap(struct shape_builder *builder, const struct shape_pipe *pipe, mat4s frame,
                     bool end)
{
    vec3s normal = glms_vec3_scale(vec3_xyz(frame.col[2]), end != pipe->inside_out ? 1.0f : -1.0f);
    uint32_t centre = builder->vertex_count;
    shape_vertex(builder, vec3_xyz(frame.col[3]), normal, (vec2s){ { 0, 0 } });
    for (int i = 0; i <= pipe->segments; i++) {
        float angle =
            i == pipe->segments ? 0.0f : 2.0f * GLM_PIf * (float)i / (float)pipe->segments;
        vec3s at = vec3_of(pipe->radius * cosf(angle), pipe->radius * sinf(angle), 0);
        shape_vertex(builder, mat4_point(frame, at), normal, (vec2s){ { at.x, at.y } });
    }
    for (uint32_t i = 1; i <= (uint32_t)pipe->segments; i++) {
        pipe_triangle(builder, end == pipe->inside_out, centre, centre + i, centre + i + 1);
    }
}

void shape_sweep(struct shape_builder *builder, const struct shape_pipe *pipe)
{
    uint32_t first = builder->vertex_count, stride = (uint32_t)pipe->segments + 1;
    float along_m = 0.0f;
    for (int f = 0; f < pipe->count; f++) {
        if (f > 0) {
            along_m += glms_vec3_norm(glms_vec3_sub(vec3_xyz(pipe->frames[f].col[3]),
                                                    vec3_xyz(pipe->frames[f - 1].col[3])));
        }
        for (int i = 0; i <= pipe->segments; i++) {
            pipe_vertex(builder, pipe, pipe->frames[f], i, along_m);
        }
    }
    for (uint32_t f = 0; f + 1 < (uint32_t)pipe->count; f++) {
        for (uint32_t i = 0; i < (uint32_t)pipe->segments; i++) {
            uint32_t a = first + f * stride + i, b = a + 1, c = b + stride, d = a + stride;
            pipe_triangle(builder, pipe->inside_out, a, b, c);
            pipe_triangle(builder, pipe->inside_out, a, c, d);
        }
    }
    if (pipe->start_cap) pipe_cap(builder, pipe, pipe->frames[0], false);
    if (pipe->end_cap) pipe_cap(builder, pipe, pipe->frames[pipe->count - 1], true);
}

// A point of the middle surface and its normal, by central differences.
struct sheet_point {
    vec3s middle, normal;
};

static struct sheet_point sheet_point(const struct shape_sheet *sheet, float s, float t)
{
    // Scaled to derivatives: some versions of cglm normalise vectors shorter than 1e-7 to zero.
    const float step = 1e-3f, per_step = 0.5f / step;
    vec3s along_s = glms_vec3_scale(
        glms_vec3_sub(sheet->at(sheet->user, s + step, t), sheet->at(sheet->user, s - step, t)),
        per_step);
    vec3s along_t = glms_vec3_scale(
        glms_vec3_sub(sheet->at(sheet->user, s, t + step), sheet->at(sheet->user, s, t - step)),
        per_step);
    return (struct sheet_point){ sheet->at(sheet->user, s, t),
                                 glms_vec3_normalize(glms_vec3_cross(along_t, along_s)) };
}

static vec3s sheet_side(struct sheet_point point, float offset)
{
    return glms_vec3_muladds(point.normal, offset, point.middle);
}

// One side of the cloth: +1 the front, -1 the back.
static void cloth_side(struct shape_builder *builder, const struct shape_sheet *sheet, float side)
{
    uint32_t first = builder->vertex_count, stride = (uint32_t)sheet->columns + 1;
    for (int j = 0; j <= sheet->rows; j++) {
        for (int i = 0; i <= sheet->columns; i++) {
            float s = (float)i / (float)sheet->columns, t = (float)j / (float)sheet->rows;
            struct sheet_point point = sheet_point(sheet, s, t);
            vec2s uv = { { side * s * sheet->uv_size.x, t * sheet->uv_size.y } };
            shape_vertex(builder, sheet_side(point, 0.5f * side * sheet->thickness),
                         glms_vec3_scale(point.normal, side), uv);
        }
    }
    for (uint32_t j = 0; j < (uint32_t)sheet->rows; j++) {
        for (uint32_t i = 0; i < (uint32_t)sheet->columns; i++) {
            uint32_t a = first + j * stride + i, b = a + stride;
            if (side > 0) {
                shape_quad_of(builder, a, b, b + 1, a + 1);
            } else {
                shape_quad_of(builder, a, a + 1, b + 1, b);
            }
        }
    }
}

// One quad of the hem between two points of the border; outside is to the left of a → b, seen from
// the front.
static void cloth_hem(struct shape_builder *builder, const struct shape_sheet *sheet, vec2s a,
                      vec2s b)
{
    struct sheet_point from = sheet_point(sheet, a.x, a.y), to = sheet_point(sheet, b.x, b.y);
    float half = 0.5f * sheet->thickness;
    shape_quad(builder, sheet_side(from, half), sheet_side(to, half), sheet_side(to, -half),
               sheet_side(from, -half));
}

void shape_cloth(struct shape_builder *builder, const struct shape_sheet *sheet)
{
    cloth_side(builder, sheet, 1.0f);
    cloth_side(builder, sheet, -1.0f);
    float columns = (float)sheet->columns, rows = (float)sheet->rows;
    for (int i = 0; i < sheet->columns; i++) {
        float s = (float)i / columns, next = (float)(i + 1) / columns;
        cloth_hem(builder, sheet, (vec2s){ { s, 0 } }, (vec2s){ { next, 0 } });
        cloth_hem(builder, sheet, (vec2s){ { next, 1 } }, (vec2s){ { s, 1 } });
    }
    for (int j = 0; j < sheet->rows; j++) {
        float t = (float)j / rows, next = (float)(j + 1) / rows;
        cloth_hem(builder, sheet, (vec2s){ { 0, next } }, (vec2s){ { 0, t } });
        cloth_hem(builder, sheet, (vec2s){ { 1, t } }, (vec2s){ { 1, next } });
    }
}
