// Light of a whole level against rays through the scene: block map, geometry images, T_b→r and
// solver together, with a baked dictionary.
#include "framework/test.h"
#include "techniques/mrt/mrt_bake_fixture.h"
#include "techniques/mrt/mrt_map_fixture.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/sampling.h"

#include "techniques/mrt/level/geometry.h"
#include "techniques/mrt/level/map/make_map.h"
#include "techniques/mrt/level/solver.h"

#include <math.h>
#include <stdio.h>

enum { RAYS = 256, STRIDE = 3 }; // STRIDE: every third texel is compared

struct lit_scene {
    struct scene *scene;
    struct scene_pose pose;
    struct trace_scene *trace;
    struct world_light light;
    struct mrt_block_map map;
    struct mrt_atlas atlas;
    struct mrt_geometry_texel *geometry;
    float *radiosity, *irradiance, *reference; // RGB per texel
};

static struct mrt_dictionary baked[3]; // by enum mrt_maze

static const struct mrt_dictionary *dictionary_of(enum mrt_maze maze)
{
    struct mrt_dictionary *out = &baked[maze];
    if (out->element_count) return out;
    struct mrt_dictionary_options options = mrt_fixture_options();
    options.maze = (int32_t)maze;
    options.texels = maze == MRT_TUNNEL ? 4 : 8;
    options.rays = 4096;
    struct bake *bake = mrt_fixture_bake(&options, 0, false);
    CHECK(mrt_dictionary_init(test_host(), bake_tensors(bake), &options, out));
    bake_destroy(bake);
    return out;
}

static bool finish_at_end(void)
{
    for (int m = 0; m < 3; m++) mrt_dictionary_finish(test_host(), &baked[m]);
    return true;
}

__attribute__((constructor)) static void register_end(void)
{
    test_register_end(finish_at_end);
}

static void load(const char *spec, struct lit_scene *s)
{
    *s = (struct lit_scene){ .scene = scene_load(test_host(), spec) };
    CHECK(s->scene && pose_init(&s->pose, s->scene, -1, 0.0f));
    CHECK((s->trace = trace_scene_create(test_host(), &s->pose)) != NULL);
    CHECK(s->scene->light_count == 1);
    s->light = pose_light(&s->pose, 0);
}

// Irradiance of the point light or the sun, with its shadow.
static vec3s direct_at(const struct lit_scene *s, vec3s position, vec3s normal)
{
    vec3s from = glms_vec3_muladds(normal, 1e-3f, position);
    bool sun = s->light.type == LIGHT_SUN;
    vec3s to =
        sun ? glms_vec3_scale(s->light.direction, -1e3f) : glms_vec3_sub(s->light.position, from);
    float distance = glms_vec3_norm(to), cosine = glms_vec3_dot(to, normal) / distance;
    if (!(cosine > 0.0f) || trace_occluded(s->trace, from, to, 0.999f)) return vec3_of(0, 0, 0);
    return glms_vec3_scale(s->light.intensity, sun ? cosine : cosine / (distance * distance));
}

// One bounce, by cosine-distributed rays.
static void reference_texel(void *user, size_t i)
{
    struct lit_scene *s = user;
    const struct mrt_geometry_texel *at = &s->geometry[i];
    if (i % STRIDE) return;
    vec3s sum = vec3_of(0, 0, 0), tangent, bitangent;
    vec3s from = glms_vec3_muladds(at->normal, 1e-3f, at->position);
    basis_of(at->normal, &tangent, &bitangent);
    for (uint32_t k = 0; k < RAYS; k++) {
        struct trace_hit hit;
        vec3s local = sample_hemisphere_cosine(sobol_2d(k, (uint32_t)i + 1));
        vec3s ray = glms_vec3_scale(tangent, local.x);
        ray = glms_vec3_muladds(bitangent, local.y, ray);
        ray = glms_vec3_muladds(at->normal, local.z, ray);
        if (!trace_closest(s->trace, from, ray, 1e6f, &hit)) continue;
        const vec3s direct = direct_at(s, hit.position, hit.normal);
        const vec3s reflectance = trace_reflectance(s->trace, ray, &hit);
        sum = glms_vec3_add(sum, glms_vec3_mul(reflectance, direct));
    }
    for (int c = 0; c < 3; c++) s->reference[3 * i + (size_t)c] = sum.raw[c] / RAYS;
}

static float *floats(size_t count)
{
    float *out = host_alloc(test_host(), count, sizeof *out);
    CHECK(out);
    return out;
}

static void solve(struct lit_scene *s, const struct mrt_dictionary *dictionary, int depth)
{
    struct mrt_level level;
    struct mrt_solver solver;
    struct mrt_level_options options = { .max_depth = depth };
    if (!mrt_level_init(test_host(), &s->map, dictionary, &options, &level))
        fail_msg("%s", test_last_message());
    CHECK(mrt_solver_init(test_host(), &level, &solver));
    mrt_solve(&solver, s->radiosity, s->irradiance);
    mrt_solver_finish(&solver);
    mrt_level_finish(&level);
}

static void light_texels(struct lit_scene *s)
{
    for (size_t i = 0; i < (size_t)s->atlas.texels; i++) {
        vec3s direct = direct_at(s, s->geometry[i].position, s->geometry[i].normal);
        for (size_t c = 0; c < 3; c++)
            s->radiosity[3 * i + c] = s->geometry[i].reflectance.raw[c] * direct.raw[c];
    }
}

static void prepare(struct lit_scene *s, int resolution)
{
    CHECK(mrt_atlas_init(test_host(), &s->map, resolution, &s->atlas));
    CHECK((s->geometry = mrt_geometry_create(test_host(), &s->map, &s->atlas, s->trace)) != NULL);
    size_t texels = (size_t)s->atlas.texels;
    s->radiosity = floats(3 * texels);
    s->irradiance = floats(3 * texels);
    s->reference = floats(3 * texels);
    light_texels(s);
    parallel_for(texels, 8, reference_texel, s);
}

static void finish(struct lit_scene *s)
{
    host_free(test_host(), s->radiosity);
    host_free(test_host(), s->irradiance);
    host_free(test_host(), s->reference);
    host_free(test_host(), s->geometry);
    mrt_atlas_finish(&s->atlas);
    mrt_block_map_finish(&s->map);
    trace_scene_destroy(s->trace);
    pose_finish(&s->pose);
    scene_destroy(s->scene);
}

// Relative L2 error and mean ratio over the texels of a range of tiles.
struct comparison {
    double error, ratio, mean;
};
static struct comparison compare(const struct lit_scene *s, int first_tile, int end_tile)
{
    int n = s->atlas.resolution * s->atlas.resolution;
    double difference = 0.0, all = 0.0, sum[2] = { 0.0 };
    size_t count = 0;
    for (size_t i = (size_t)(first_tile * n); i < (size_t)(end_tile * n); i++) {
        if (i % STRIDE || !s->geometry[i].found) continue;
        count++;
        for (size_t c = 0; c < 3; c++) {
            double a = (double)s->irradiance[3 * i + c], b = (double)s->reference[3 * i + c];
            difference += (a - b) * (a - b);
            all += b * b;
            sum[0] += a;
            sum[1] += b;
        }
    }
    return (struct comparison){ sqrt(difference / all), sum[0] / sum[1],
                                sum[1] / (3.0 * (double)count) };
}

static void print_blocks(const struct lit_scene *s)
{
    for (int b = 0, tile = 0; b < s->map.count; b++) {
        int end = tile;
        while (end < s->atlas.tile_count && s->atlas.tiles[end].block == b) end++;
        struct comparison c = compare(s, tile, end);
        print_message("  block %d: %8.2f lx, error %.3f, mean ratio %.3f\n", b, c.mean, c.error,
                      c.ratio);
        tile = end;
    }
}

// ---- maps

enum map { MAP_SCENE, MAP_CUBES, MAP_SINGLE, MAP_AUTO };

static void make_map(struct lit_scene *s, enum map map)
{
    const vec3s seeds[2] = { pose_camera(&s->pose, 0).eye, s->light.position };
    size_t count = s->light.type == LIGHT_SUN ? 1 : 2;
    if (map == MAP_SCENE || map == MAP_CUBES)
        CHECK(mrt_block_map_of_scene(test_host(), s->scene, &s->map));
    else if (map == MAP_SINGLE)
        CHECK(mrt_map_single(test_host(), &s->pose, &s->map));
    else
        CHECK(mrt_map_auto(test_host(), &s->pose, seeds, count, &s->map));
    if (map == MAP_CUBES) CHECK(mrt_block_map_as_cubes(s->scene->name, &s->map));
}

static struct comparison light_map(const char *spec, enum map map,
                                   const struct mrt_dictionary *dictionary, int depth)
{
    static const char *const names[] = { "its own map", "cubes", "single", "auto" };
    struct lit_scene s;
    load(spec, &s);
    make_map(&s, map);
    prepare(&s,
            mrt_face_texels((enum mrt_maze)dictionary->options.maze, dictionary->options.texels));
    solve(&s, dictionary, depth);
    struct comparison all = compare(&s, 0, s.atlas.tile_count);
    print_message("%s, %s: %d blocks, error %.3f, mean ratio %.3f\n", spec, names[map], s.map.count,
                  all.error, all.ratio);
    if (map != MAP_SINGLE) print_blocks(&s);
    finish(&s);
    return all;
}

enum { DEPTH = 4 };

// Bounds: what is reached here, plus a tenth. The blocks of a maze are wider than its rooms by the
// thickness of a wall.
TEST(indirect_light_of_a_maze_is_near_that_of_rays_through_the_scene)
{
    static const double bounds[] = { 0.087, 0.103, 0.094 };
    const struct mrt_dictionary *dictionary = dictionary_of(MRT_MAZE_2D);
    for (int seed = 1; seed < 4; seed++) {
        char spec[64];
        snprintf(spec, sizeof spec, "@maze:blocks=7,light=point,seed=%d", seed);
        struct comparison c = light_map(spec, MAP_SCENE, dictionary, DEPTH);
        CHECK(c.error < bounds[seed - 1]);
        CHECK(fabs(c.ratio - 1.0) < 0.05);
    }
}

// The error stops falling at a few openings: DEPTH is enough.
TEST(light_beyond_a_few_openings_does_not_matter)
{
    const struct mrt_dictionary *dictionary = dictionary_of(MRT_MAZE_2D);
    const char *spec = "@maze:blocks=12,light=point,seed=4";
    double none = light_map(spec, MAP_SCENE, dictionary, 0).error;
    double some = light_map(spec, MAP_SCENE, dictionary, DEPTH).error;
    double more = light_map(spec, MAP_SCENE, dictionary, 3 * DEPTH).error;
    CHECK(some < 0.4 * none);
    CHECK_NEAR(some, more, 0.002);
}

TEST(an_automatic_map_is_far_better_than_a_single_block)
{
    const struct mrt_dictionary *dictionary = dictionary_of(MRT_MAZE_2D);
    double single = light_map("@corridor:light=point", MAP_SINGLE, dictionary, DEPTH).error;
    struct comparison made = light_map("@corridor:light=point", MAP_AUTO, dictionary, DEPTH);
    CHECK(made.error < 0.27 && made.error < 0.4 * single);
    CHECK(fabs(made.ratio - 1.0) < 0.06);
    made = light_map("@maze:blocks=9,light=point,seed=5", MAP_AUTO, dictionary, DEPTH);
    CHECK(made.error < 0.085);
}

// Pipes as warped cubes: bends are sharp, and walls have corners.
TEST(a_tunnel_of_tubes_is_better_than_of_cubes_and_these_than_a_single_block)
{
    const struct mrt_dictionary *dictionary = dictionary_of(MRT_MAZE_2D);
    double single = light_map("@tunnel:light=point", MAP_SINGLE, dictionary, DEPTH).error;
    double cubes = light_map("@tunnel:light=point", MAP_CUBES, dictionary, DEPTH).error;
    struct comparison tubes =
        light_map("@tunnel:light=point", MAP_SCENE, dictionary_of(MRT_TUNNEL), DEPTH);
    CHECK(cubes < 0.31 && cubes < 0.4 * single);
    CHECK(tubes.error < 0.049 && tubes.error < 0.2 * cubes);
    CHECK(fabs(tubes.ratio - 1.0) < 0.03);
}

// A court with galleries, lit by the sun: blocks are open to the sky.
TEST(an_automatic_map_of_a_court_is_better_than_a_single_block)
{
    const struct mrt_dictionary *dictionary = dictionary_of(MRT_MAZE_3D);
    double single = light_map("@atrium", MAP_SINGLE, dictionary, DEPTH).error;
    struct comparison made = light_map("@atrium", MAP_AUTO, dictionary, DEPTH);
    CHECK(made.error < 0.52 && made.error < 0.6 * single);
    CHECK(fabs(made.ratio - 1.0) < 0.07);
}

// Direct light is the caller's; nothing else may divide by a distance to it.
TEST(a_light_outside_all_blocks_or_on_a_wall_gives_finite_light)
{
    struct lit_scene s;
    load("@maze:blocks=3,light=point", &s);
    make_map(&s, MAP_SCENE);
    prepare(&s, 8);
    const vec3s places[] = { vec3_of(100, 50, 3), s.geometry[5].position, s.map.blocks[0].corner[0],
                             vec3_of(0, 2.76f, 0) };
    for (int i = 0; i < 4; i++) {
        s.light.position = places[i];
        light_texels(&s);
        solve(&s, dictionary_of(MRT_MAZE_2D), DEPTH);
        for (int t = 0; t < 3 * s.atlas.texels; t++) CHECK(isfinite(s.irradiance[t]));
    }
    finish(&s);
}
