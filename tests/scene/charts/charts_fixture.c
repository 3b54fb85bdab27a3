#include "scene/charts/charts_fixture.h"

#include "core/rng.h"

#include <math.h>

struct scene *open_scene(const char *name, struct scene_pose *pose)
{
    struct scene *scene = scene_load(test_host(), name);
    CHECK(scene);
    CHECK(pose_init(pose, scene, -1, 0.0f));
    return scene;
}

void close_scene(struct scene *scene, struct scene_pose *pose)
{
    pose_finish(pose);
    scene_destroy(scene);
}

struct scene *scene_of(const struct mesh *mesh, int instances)
{
    struct scene *scene = scene_create(test_host(), "made");
    CHECK(scene && scene_add_mesh(scene, mesh) == 0);
    for (int i = 0; i < instances; i++) {
        struct node node = node_default();
        node.translation = vec3_of(3.0f * (float)i, 0.0f, 0.0f);
        const struct instance instance = { .node = scene_add_node(scene, &node), .skin = -1 };
        CHECK(scene_add_instance(scene, &instance) == i);
    }
    return scene;
}

struct scene *scene_of_triangles(vec3s *positions, uint32_t vertices, uint32_t *indices,
                                 uint32_t index_count)
{
    const struct mesh mesh = { .vertex_count = vertices,
                               .index_count = index_count,
                               .positions = positions,
                               .indices = indices,
                               .material = -1 };
    struct scene *scene = scene_of(&mesh, 1);
    host_free(test_host(), positions);
    host_free(test_host(), indices);
    return scene;
}

struct scene *two_quads(float u_of_second, float first_u, int instances)
{
    const vec3s positions[8] = {
        { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 1, 1, 0 } }, { { 0, 1, 0 } },
        { { 2, 0, 0 } }, { { 3, 0, 0 } }, { { 3, 1, 0 } }, { { 2, 1, 0 } }
    };
    vec2s uv[8];
    const uint32_t indices[12] = { 0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7 };
    for (int v = 0; v < 8; v++)
        uv[v] = (vec2s){ { 0.3f * (positions[v].x - (v < 4 ? 0.0f : 2.0f)) +
                               (v < 4 ? first_u : u_of_second),
                           0.3f * positions[v].y } };
    const struct mesh mesh = { .vertex_count = 8,
                               .index_count = 12,
                               .positions = (vec3s *)positions,
                               .uv = { NULL, uv },
                               .indices = (uint32_t *)indices,
                               .material = -1 };
    return scene_of(&mesh, instances);
}

void check_each_triangle_is_in_one_chart(const struct charts *charts, const struct scene_pose *pose)
{
    const size_t count = scene_triangle_count(pose->scene);
    size_t *first = host_alloc(test_host(), (size_t)pose->scene->instance_count, sizeof *first);
    bool *met = host_alloc(test_host(), count, sizeof *met);
    CHECK(charts->triangle_count + charts->without_area == count);
    for (int i = 0; i + 1 < pose->scene->instance_count; i++)
        first[i + 1] = first[i] + scene_mesh_of(pose->scene, i)->index_count / 3;
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct chart *chart = &charts->charts[c];
        for (uint32_t i = 0; i < chart->triangle_count; i++) {
            const struct chart_triangle *t = &charts->triangles[chart->first_triangle + i];
            CHECK(t->chart == c && t->instance == chart->instance);
            CHECK(!met[first[t->instance] + t->triangle]);
            met[first[t->instance] + t->triangle] = true;
        }
    }
    host_free(test_host(), first);
    host_free(test_host(), met);
}

void check_gutters_are_own(const struct charts *charts)
{
    const int g = CHART_GUTTER;
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct chart *chart = &charts->charts[c];
        CHECK(chart->x + chart->width <= charts->width);
        CHECK(chart->y + chart->height <= charts->height);
        for (uint32_t i = 0; i < chart->texel_count; i++) {
            const struct chart_texel *t = &charts->texels[chart->first_texel + i];
            CHECK((int)t->x >= g && (int)t->y >= g);
            for (int k = 0; k < (2 * g + 1) * (2 * g + 1); k++) {
                const size_t x = t->x + (size_t)(k % (2 * g + 1)) - (size_t)g;
                const size_t y = t->y + (size_t)(k / (2 * g + 1)) - (size_t)g;
                CHECK(x < charts->width && y < charts->height);
                CHECK(charts->owner[y * charts->width + x] - chart->first_texel <
                      chart->texel_count);
            }
        }
    }
}

static double distance_to_triangle(const struct chart_triangle *t, const struct chart_texel *texel)
{
    vec3s p = glms_vec3_scale(t->corner[0], 1.0f - texel->u - texel->v);
    p = glms_vec3_muladds(t->corner[1], texel->u, p);
    p = glms_vec3_muladds(t->corner[2], texel->v, p);
    return (double)glms_vec3_distance(p, texel->position);
}

double largest_coordinate(const struct chart_triangle *t)
{
    float largest = 0.0f;
    for (int k = 0; k < 3; k++)
        largest = fmaxf(largest, glms_vec3_max(glms_vec3_abs(t->corner[k])));
    return (double)largest;
}

void check_texels_lie_on_triangles(const struct charts *charts)
{
    double area = 0.0, expected = 0.0;
    for (uint32_t i = 0; i < charts->texel_count; i++) {
        const struct chart_texel *texel = &charts->texels[i];
        const struct chart_triangle *t = &charts->triangles[texel->triangle];
        CHECK(texel->u >= 0.0f && texel->v >= 0.0f && texel->u + texel->v <= 1.0f + 1e-6f);
        CHECK(distance_to_triangle(t, texel) <= 1e-6 * (1.0 + largest_coordinate(t)));
        vec2s at = glms_vec2_scale(t->place[0], 1.0f - texel->u - texel->v);
        at = glms_vec2_muladds(t->place[1], texel->u, at);
        at = glms_vec2_muladds(t->place[2], texel->v, at);
        CHECK_NEAR(at.x, texel->x + 0.5, 0.501 + 1e-6 * (double)charts->width);
        CHECK_NEAR(at.y, texel->y + 0.5, 0.501 + 1e-6 * (double)charts->height);
        CHECK(charts->owner[(size_t)texel->y * charts->width + texel->x] == i);
        area += (double)texel->area_m2;
    }
    for (uint32_t i = 0; i < charts->triangle_count; i++)
        expected += (double)charts->triangles[i].area_m2;
    CHECK_RELATIVE(area, expected, 1e-3);
}

void check_lookups_stay_in_the_chart(const struct charts *charts)
{
    struct rng rng = rng_for(7, 0, 0);
    for (uint32_t i = 0; i < charts->triangle_count; i++) {
        const struct chart_triangle *t = &charts->triangles[i];
        const struct chart *chart = &charts->charts[t->chart];
        for (int trial = 0; trial < 4; trial++) {
            const float root = sqrtf(rng_float(&rng)), v = root * rng_float(&rng);
            vec2s at = glms_vec2_scale(t->place[0], 1.0f - root);
            at = glms_vec2_muladds(t->place[1], root - v, at);
            at = glms_vec2_muladds(t->place[2], v, at);
            for (int tap = 0; tap < 4; tap++) {
                const size_t x = (size_t)floorf(at.x - 0.5f) + (size_t)(tap & 1);
                const size_t y = (size_t)floorf(at.y - 0.5f) + (size_t)(tap >> 1);
                const uint32_t owner = charts->owner[y * charts->width + x];
                CHECK(owner >= chart->first_texel);
                CHECK(owner < chart->first_texel + chart->texel_count);
            }
        }
    }
}
