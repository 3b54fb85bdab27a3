// Light maps by the path tracer: the bake's bytes, and lookups as another engine would make them,
// through the files alone.
#include "lightmap/lightmap_fixture.h"

#include "lightmap/gather.h"
#include "lightmap/write.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "image/exr.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { SAMPLES = 64 };
static const int TEXELS = 1024;

struct baked {
    struct scene *scene;
    struct scene_pose pose;
    struct bake *bake;
    struct lightmap map;
};

static struct bake *bake_of(const struct scene_pose *pose, int threads)
{
    return fixture_bake(&(struct fixture_bake){
        .pose = pose, .texels = TEXELS, .samples = SAMPLES, .threads = threads });
}

static void open_scene(struct baked *b, const char *name)
{
    *b = (struct baked){ .scene = scene_load(test_host(), name) };
    assert_non_null(b->scene);
    CHECK(pose_init(&b->pose, b->scene, -1, 0));
    b->bake = bake_of(&b->pose, 0);
}

static void make_map(struct baked *b, bool punctual)
{
    struct charts charts;
    lightmap_finish(&b->map);
    CHECK(fixture_charts(&b->pose, &TEXELS, test_host(), NULL, &charts));
    CHECK(lightmap_init(&b->map, &charts, b->scene));
    CHECK(lightmap_set_paths(&b->map, bake_tensors(b->bake), punctual, false));
}

static void close_scene(struct baked *b)
{
    lightmap_finish(&b->map);
    bake_destroy(b->bake);
    pose_finish(&b->pose);
    scene_destroy(b->scene);
}

TEST(light_of_texels_is_the_same_for_any_number_of_threads)
{
    struct baked b;
    open_scene(&b, "@cornell");
    struct bake *one = bake_of(&b.pose, 1);
    const struct tensors *x = bake_tensors(one), *y = bake_tensors(b.bake);
    assert_int_equal(x->count, 2);
    for (size_t i = 0; i < x->count; i++)
        CHECK(memcmp(x->at[i].data, y->at[i].data, x->at[i].bytes) == 0);
    bake_destroy(one);
    close_scene(&b);
}

// ---- in a uniform furnace

// A closed box of emissive and reflecting sides: E = π L / (1 − ρ).
static void add_box(struct scene *scene, float albedo, float emission)
{
    static const uint32_t indices[36] = { 0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                          2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3 };
    vec3s corner[8], at[36];
    uint32_t order[36];
    struct material m = material_default();
    for (int i = 0; i < 8; i++)
        corner[i] = vec3_of(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f);
    for (uint32_t i = 0; i < 36; i++) {
        at[i] = corner[indices[i]];
        order[i] = i;
    }
    m.base_color = vec4_of(vec3_of(albedo, albedo, albedo), 1);
    m.emissive = vec3_of(emission, emission, emission);
    m.metallic = 0;
    m.specular = 0;
    const struct mesh mesh = { .positions = at,
                               .vertex_count = 36,
                               .indices = order,
                               .index_count = 36,
                               .material = scene_add_material(scene, &m) };
    const struct node node = node_default();
    const struct instance instance = { .node = scene_add_node(scene, &node),
                                       .mesh = scene_add_mesh(scene, &mesh),
                                       .skin = -1 };
    CHECK(scene_add_instance(scene, &instance) >= 0);
}

TEST(light_map_of_a_furnace_is_uniform)
{
    struct baked b = { .scene = scene_create(test_host(), "furnace") };
    double sum = 0.0;
    add_box(b.scene, 0.5f, 100);
    CHECK(pose_init(&b.pose, b.scene, -1, 0));
    b.bake = bake_of(&b.pose, 0);
    make_map(&b, true);
    const struct charts *charts = &b.map.charts;
    for (uint32_t i = 0; i < charts->texel_count; i++)
        sum += (double)image_at(&b.map.irradiance[0], (int)charts->texels[i].x,
                                (int)charts->texels[i].y)[1];
    CHECK_RELATIVE(sum / charts->texel_count, 100.0 * GLM_PI / 0.5, 0.01);
    close_scene(&b);
}

// ---- as another engine

struct files {
    struct scene *scene;
    struct image map;
};

static struct files write_files(const struct baked *b, const char *name)
{
    struct files f = { 0 };
    char folder[512], path[600];
    snprintf(folder, sizeof folder, "%s", test_path(name));
    CHECK(mkdir(folder, 0700) == 0);
    const struct lightmap_facts facts = { .samples = SAMPLES, .punctual = true, .gi = "test" };
    CHECK(lightmap_write(&b->map, b->scene, &facts, LIGHTMAP_EXR, folder));
    snprintf(path, sizeof path, "%s/scene.glb", folder);
    f.scene = scene_load(test_host(), path);
    assert_non_null(f.scene);
    snprintf(path, sizeof path, "%s/irradiance.exr", folder);
    CHECK(exr_read(test_host(), path, NULL, &f.map));
    char *unit = exr_attribute_value(test_host(), path, "afterglow.unit");
    CHECK_STRING(unit, "lx");
    host_free(test_host(), unit);
    return f;
}

static void close_files(struct files *f)
{
    image_finish(&f->map, test_host());
    scene_destroy(f->scene);
}

// Irradiance by the path tracer at a point of a chart's triangle; false: it is inside geometry.
static bool traced_at(const struct gather_scene *scene, uint32_t triangle, vec2s uv, uint32_t seed,
                      vec3s *out)
{
    const struct gather_points points = { .at = { { triangle, uv.x, uv.y } },
                                          .count = 1,
                                          .pixel = seed };
    *out = glms_vec3_add(gather_punctual(scene, &points),
                         gather_paths(scene, &points, 4 * SAMPLES, 7));
    return luminance(*out) > 0.0f;
}

struct agreement {
    double map, traced, difference;
    int count;
};

// At one random point of each triangle of the written scene. Its instances are those of the scene.
static struct agreement compare_points(const struct baked *b, const struct files *f)
{
    struct gather_scene scene;
    struct agreement sum = { 0 };
    CHECK(gather_scene_init(&scene, test_host(), &b->pose, &b->map.charts));
    for (uint32_t i = 0; i < 16 * b->map.charts.triangle_count; i++) {
        const uint32_t t = i / 16;
        const struct chart_triangle *of = &b->map.charts.triangles[t];
        const struct mesh *mesh = scene_mesh_of(f->scene, of->instance);
        const vec2s at = sample_triangle(sobol_2d(i, 3));
        vec3s traced;
        assert_non_null(mesh->uv[1]);
        if (!traced_at(&scene, t, at, i, &traced)) continue;
        vec2s uv = { { 0, 0 } };
        const float weight[3] = { 1.0f - at.x - at.y, at.x, at.y };
        for (uint32_t k = 0; k < 3; k++)
            uv = glms_vec2_muladds(mesh->uv[1][mesh->indices[3 * of->triangle + k]], weight[k], uv);
        const float a = luminance(fixture_lookup(&f->map, uv)), e = luminance(traced);
        sum.map += (double)(a * of->area_m2);
        sum.traced += (double)(e * of->area_m2);
        sum.difference += fabs((double)(a - e)) * (double)of->area_m2;
        sum.count++;
    }
    gather_scene_finish(&scene);
    return sum;
}

TEST(map_looked_up_through_the_files_is_the_irradiance_at_surface_points)
{
    struct baked b;
    open_scene(&b, "@cornell");
    make_map(&b, true);
    struct files f = write_files(&b, "cornell-map");
    const struct agreement sum = compare_points(&b, &f);
    CHECK(sum.count > 400);
    print_message("map over path tracer %.4f, mean difference %.4f\n", sum.map / sum.traced,
                  sum.difference / sum.traced);
    CHECK_RELATIVE(sum.map, sum.traced, 0.015);
    CHECK(sum.difference < 0.08 * sum.traced);
    close_files(&f);
    close_scene(&b);
}

TEST(map_without_punctual_lights_is_that_of_their_indirect_light)
{
    struct baked b;
    open_scene(&b, "@cornell:light=point");
    double sum[2] = { 0, 0 };
    for (int punctual = 0; punctual < 2; punctual++) {
        make_map(&b, punctual);
        const size_t count = 3 * (size_t)b.map.charts.width * b.map.charts.height;
        for (size_t i = 0; i < count; i++) sum[punctual] += (double)b.map.irradiance[0].pixels[i];
    }
    CHECK(sum[0] > 0.0 && sum[0] < 0.7 * sum[1]);
    close_scene(&b);
}

TEST(scene_without_static_triangles_is_refused_in_one_sentence)
{
    struct baked b = { .scene = scene_create(test_host(), "empty") };
    struct charts charts;
    CHECK(pose_init(&b.pose, b.scene, -1, 0));
    CHECK(fixture_charts(&b.pose, &TEXELS, test_host(), NULL, &charts));
    CHECK(!lightmap_init(&b.map, &charts, b.scene));
    CHECK_STRING(test_last_message(), "light map of empty: the scene has no static triangles");
    close_scene(&b);
}
