// Where light is shown: places of the light map and of triangles in it.
#include "techniques/radiosity/radiosity_state.h"

#include "frame/octahedral.h"

uint32_t radiosity_place_word(const struct radiosity *s, size_t place)
{
    const size_t width = s->map.charts.width, line = place / width;
    const size_t side = line / s->map.charts.height, y = line % s->map.charts.height;
    return (uint32_t)(side << 2 * RADIOSITY_PLACE_BITS | y << RADIOSITY_PLACE_BITS | place % width);
}

struct pair {
    uint32_t x, y;
};

// Places that show no texel are not in the table.
bool radiosity_upload_owners(struct radiosity *s, const uint32_t *shown)
{
    const size_t places = (size_t)s->sides * s->map.charts.width * s->map.charts.height;
    struct pair *owners = host_alloc(s->host, radiosity_table_room(places), sizeof *owners);
    for (size_t i = 0; owners && i < places; i++) {
        const uint32_t texel = radiosity_texel_of_place(&s->map, i);
        if (texel == CHART_NONE) continue;
        owners[s->owner_places++] = (struct pair){ radiosity_place_word(s, i), shown[texel] };
    }
    return radiosity_table_upload(s->host, s->gpu, "owners", GPU_RG32U, owners, s->owner_places,
                                  &s->tables.owners);
}

// The affine map from the triangle's plane to one coordinate of the atlas.
static vec4s gradient_of(const struct chart_triangle *t, int axis)
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
    return vec4_of(gradient, t->place[0].raw[axis] - glms_vec3_dot(gradient, t->corner[0]));
}

static void fill_triangle(const struct radiosity *s, uint32_t chart_triangle, vec4s *parts)
{
    const bool mapped = chart_triangle != CHART_NONE;
    for (int axis = 0; axis < RADIOSITY_TRIANGLE_PARTS; axis++)
        parts[axis] = mapped ? gradient_of(&s->map.charts.triangles[chart_triangle], axis)
                             : vec4_of(vec3_of(0.0f, 0.0f, 0.0f), -1.0f);
}

static uint32_t front_of(const struct radiosity *s, uint32_t chart_triangle)
{
    if (chart_triangle == CHART_NONE) return RADIOSITY_ONE_SIDED;
    const struct chart_triangle *t = &s->map.charts.triangles[chart_triangle];
    return s->map.back_of[t->chart] == CHART_NONE ? RADIOSITY_ONE_SIDED
                                                  : octahedral_pack(t->normal);
}

static bool upload_instances(struct radiosity *s)
{
    struct pair *spans = host_alloc(s->host, radiosity_table_room(s->instances), sizeof *spans);
    for (uint32_t i = 0; spans && i < s->instances; i++) {
        spans[i].x = (uint32_t)s->map.triangle_0[i];
        spans[i].y = (uint32_t)(s->map.triangle_0[i + 1] - s->map.triangle_0[i]);
    }
    return radiosity_table_upload(s->host, s->gpu, "instances", GPU_RG32U, spans, s->instances,
                                  &s->tables.instances);
}

static bool upload_fronts(struct radiosity *s, size_t triangles)
{
    uint32_t *fronts = host_alloc(s->host, radiosity_table_room(triangles), sizeof *fronts);
    for (size_t i = 0; fronts && i < triangles; i++)
        fronts[i] = front_of(s, s->map.chart_triangle[i]);
    return radiosity_table_upload(s->host, s->gpu, "fronts", GPU_R32U, fronts, triangles,
                                  &s->tables.fronts);
}

bool radiosity_upload_triangles(struct radiosity *s)
{
    const size_t triangles = s->map.triangle_0[s->instances];
    const size_t count = triangles * RADIOSITY_TRIANGLE_PARTS;
    vec4s *parts = host_alloc(s->host, radiosity_table_room(count), sizeof *parts);
    for (size_t i = 0; parts && i < triangles; i++)
        fill_triangle(s, s->map.chart_triangle[i], parts + RADIOSITY_TRIANGLE_PARTS * i);
    return radiosity_table_upload(s->host, s->gpu, "triangles", GPU_RGBA32F, parts, count,
                                  &s->tables.triangles) &&
           upload_fronts(s, triangles) && upload_instances(s);
}
