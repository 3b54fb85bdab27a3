// Light of surfaces in no block, at points and texels of a block beside them.
#include "framework/test.h"
#include "techniques/mrt/mrt_map_fixture.h"

#include "core/sh.h"
#include "frame/octahedral.h"

#include "techniques/mrt/light/area_light.h"

#include <math.h>

static const float ALBEDO = 0.5f;

// A block of edge 2 around the origin, and a square of 800 with its normal up.
struct place {
    struct scene *scene;
    struct scene_pose pose;
    struct mrt_block_map map;
    struct trace_scene *trace;
    struct mrt_reflectors reflectors;
};

static void open_place(struct place *p, float height, vec3s across, vec3s along)
{
    static uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    const vec3s middle = vec3_of(0, height, 0);
    vec3s positions[4];
    for (int i = 0; i < 4; i++) {
        positions[i] = glms_vec3_muladds(across, i == 1 || i == 2 ? 1.0f : -1.0f, middle);
        positions[i] = glms_vec3_muladds(along, i >= 2 ? 1.0f : -1.0f, positions[i]);
    }
    struct material matte = material_default();
    matte.base_color = vec4_of(vec3_of(ALBEDO, ALBEDO, ALBEDO), 1);
    matte.metallic = 0;
    matte.specular = 0;
    *p = (struct place){ .scene = scene_create(test_host(), "place") };
    const int mesh = scene_add_mesh(
        p->scene, &(struct mesh){ .name = "square",
                                  .vertex_count = 4,
                                  .index_count = 6,
                                  .positions = positions,
                                  .indices = indices,
                                  .material = scene_add_material(p->scene, &matte) });
    assert_true(mesh >= 0);
    const struct node identity = node_default();
    const int node = scene_add_node(p->scene, &identity);
    const struct instance instance = { .node = node, .mesh = mesh, .skin = -1 };
    assert_true(scene_add_instance(p->scene, &instance) >= 0);
    assert_true(pose_init(&p->pose, p->scene, -1, 0));
    assert_true(mrt_block_map_init(test_host(), "place", 1, &p->map));
    mrt_block_init(&p->map.blocks[0], "block", MRT_BLOCK_CUBE);
    mrt_block_set_box(&p->map.blocks[0], (struct box3){ vec3_of(-1, -1, -1), vec3_of(1, 1, 1) });
    assert_non_null(p->trace = trace_scene_create(test_host(), &p->pose));
    assert_true(mrt_reflectors_init(test_host(), &p->map, &p->reflectors));
}

static void close_place(struct place *p)
{
    mrt_reflectors_finish(&p->reflectors);
    trace_scene_destroy(p->trace);
    mrt_block_map_finish(&p->map);
    pose_finish(&p->pose);
    scene_destroy(p->scene);
}

static void open_ground(struct place *p, float height)
{
    open_place(p, height, vec3_of(0, 0, 400), vec3_of(400, 0, 0));
}

static vec3s direction_of(const struct mrt_reflector_share *share)
{
    const int x = (int16_t)(share->direction & 0xffffu), y = (int16_t)(share->direction >> 16);
    return octahedral_decode((vec2s){ { (float)x / 32767, (float)y / 32767 } });
}

// Irradiance by normal of reflectors of radiosity 1.
static float irradiance(const struct place *p, const struct mrt_reflector_row *row, vec3s normal)
{
    float sum = 0.0f;
    for (uint32_t k = row->first; k < row->first + row->count; k++) {
        const struct mrt_reflector_share *share = &p->reflectors.shares[k];
        float basis[9], weight[9];
        sh_eval(3, direction_of(share), basis);
        sh_irradiance(3, basis, weight);
        sum += share->weight * sh_dot(3, weight, normal);
    }
    return sum;
}

// Radiosity 1 is radiance 1/π, whose irradiance of a hemisphere is 1. Beyond the square's edge, 0.4
// degrees of the sky are seen.
TEST(a_point_above_ground_receives_its_radiosity)
{
    struct place p;
    struct mrt_lit_point point = { .position = vec3_of(0.1f, 0.2f, 0.3f) };
    open_ground(&p, -3);
    assert_true(mrt_area_light_points(p.trace, &p.reflectors, 256, &point, 1));
    const struct mrt_reflector_row *row = &point.light.reflected;
    CHECK(row->count > 100);
    CHECK_NEAR(irradiance(&p, row, vec3_of(0, -1, 0)), 1, 0.02);
    CHECK_NEAR(irradiance(&p, row, vec3_of(1, 0, 0)), 0.5, 0.02);
    CHECK_NEAR(irradiance(&p, row, vec3_of(0, 1, 0)), 0, 0.02);
    for (uint32_t i = 0; i < p.reflectors.count; i++) {
        CHECK_NEAR(p.reflectors.at[i].position.y, -3, 1e-4);
        CHECK_NEAR(p.reflectors.at[i].reflectance.x, ALBEDO, 1e-5);
        CHECK(p.reflectors.at[i].normal.y > 0.999f);
    }
    close_place(&p);
}

// Points close to the ground see more places than that; later points have larger ones.
TEST(many_reflectors_become_larger_and_keep_their_light)
{
    enum { POINTS = 4096, ROW = 64, RAYS = 256 };
    uint32_t counts[2];
    for (int few = 0; few < 2; few++) {
        struct place p;
        struct mrt_lit_point *points = host_alloc(test_host(), POINTS, sizeof *points);
        assert_non_null(points);
        for (int i = 0; i < POINTS; i++)
            points[i].position =
                vec3_of((float)(i % ROW) - ROW / 2, -2, (float)(i / ROW) - ROW / 2);
        open_ground(&p, -3);
        if (few) p.reflectors.fine = 256;
        assert_true(mrt_area_light_points(p.trace, &p.reflectors, RAYS, points, POINTS));
        for (int i = POINTS - ROW; i < POINTS; i++)
            CHECK_NEAR(irradiance(&p, &points[i].light.reflected, vec3_of(0, -1, 0)), 1, 0.05);
        counts[few] = p.reflectors.count;
        host_free(test_host(), points);
        close_place(&p);
    }
    print_message("%u places, %u with larger ones\n", counts[0], counts[1]);
    CHECK(2 * counts[1] < counts[0]);
}

// Light of a quarter of the sphere, of radiance 1/π, above or below, has a vector irradiance of 1/2
// along the surface, as its irradiance.
static void check_vectors(const struct place *p, const struct mrt_geometry_texel *upright)
{
    const struct mrt_reflector_row row = upright->reflected;
    double down = 0.0;
    for (uint32_t k = row.first; k < row.first + row.count; k++) {
        const vec3s way = direction_of(&p->reflectors.shares[k]);
        const float cosine = fmaxf(glms_vec3_dot(way, upright->normal), 1e-3f);
        down -= (double)(p->reflectors.shares[k].weight * way.y / cosine);
    }
    CHECK_NEAR(upright->sky_vector.y, 0.5, 0.02);
    CHECK_NEAR(upright->sky_vector.z, 0, 0.02);
    CHECK_NEAR(down, 0.5, 0.05);
}

// A texel that faces the ground sees no sky, one that is upright as much as ground.
TEST(a_texel_receives_the_share_of_its_rays)
{
    struct place p;
    struct mrt_geometry_texel texels[2] = {
        { .position = vec3_of(0, 1, 0), .normal = vec3_of(0, -1, 0), .found = true },
        { .position = vec3_of(1, 0, 0), .normal = vec3_of(-1, 0, 0), .found = true },
    };
    bool lit;
    open_ground(&p, -3);
    assert_true(mrt_area_light_texels(p.trace, &p.reflectors,
                                      &(struct mrt_texel_list){ texels, 2, 1 }, &lit));
    CHECK(lit);
    for (int i = 0; i < 2; i++) {
        float sum = 0.0f;
        const struct mrt_reflector_row row = texels[i].reflected;
        for (uint32_t k = row.first; k < row.first + row.count; k++)
            sum += p.reflectors.shares[k].weight;
        CHECK_NEAR(sum + texels[i].sky, 1, 1e-5);
        CHECK_NEAR(sum, i == 0 ? 1 : 0.5, 0.04);
    }
    check_vectors(&p, &texels[1]);
    close_place(&p);
}

static uint32_t reflectors_seen(float height, vec3s across, vec3s along)
{
    struct place p;
    struct mrt_lit_point point = { .position = vec3_of(0.1f, 0.2f, 0.3f) };
    open_place(&p, height, across, along);
    assert_true(mrt_area_light_points(p.trace, &p.reflectors, 8192, &point, 1));
    const uint32_t count = p.reflectors.count;
    close_place(&p);
    return count;
}

// A wall's texels stand for surfaces behind it, but not for those that stand on its plane, as the
// reveals of a window do.
TEST(surfaces_of_a_block_are_no_reflectors)
{
    const vec3s across = vec3_of(0, 0, 0.9f), along = vec3_of(0.9f, 0, 0);
    CHECK(reflectors_seen(-0.7f, across, along) == 0);
    CHECK(reflectors_seen(-1, across, along) == 0);
    CHECK(reflectors_seen(-1.2f, across, along) == 0);
    CHECK(reflectors_seen(-1.6f, across, along) > 0);
    CHECK(reflectors_seen(-1.2f, across, vec3_of(0, -0.15f, 0)) > 0);
}

// Below the ground there is no outdoors, though rays downward meet nothing.
TEST(points_below_the_ground_are_not_outdoors)
{
    struct place p;
    struct mrt_outdoors outdoors;
    const struct box3 bounds = { vec3_of(-8, -6, -8), vec3_of(8, 4, 8) };
    open_ground(&p, -3);
    assert_true(mrt_outdoors_init(p.trace, &p.reflectors, bounds, &outdoors));
    assert_non_null(outdoors.probes);
    for (uint32_t i = 0; i < probe_grid_count(outdoors.grid); i++) {
        const vec3s at = probe_grid_point(outdoors.grid, i);
        const bool in_block = glms_vec3_max(glms_vec3_abs(at)) <= 1.001f;
        if (at.y < -3.0f || in_block)
            CHECK(outdoors.probes[i].open <= 0.1f);
        else
            CHECK(outdoors.probes[i].open == 1.0f);
    }
    mrt_outdoors_finish(&outdoors);
    close_place(&p);
}

// Room for 12 points along the longest side at least, and not for many more than 4096 in all.
TEST(outdoor_points_are_as_dense_as_their_number_allows)
{
    const vec3s sizes[] = { vec3_of(40, 6, 40), vec3_of(10, 10, 10), vec3_of(100, 0, 100),
                            vec3_of(100, 1, 1) };
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct place p;
        struct mrt_outdoors outdoors;
        const struct box3 bounds = { glms_vec3_scale(sizes[i], -0.5f),
                                     glms_vec3_scale(sizes[i], 0.5f) };
        open_ground(&p, -60);
        assert_true(mrt_outdoors_init(p.trace, &p.reflectors, bounds, &outdoors));
        const float longest = glms_vec3_max(sizes[i]);
        CHECK(outdoors.grid.spacing_m <= 1.0001f * longest / 11);
        CHECK(probe_grid_count(outdoors.grid) >= 12);
        CHECK(probe_grid_count(outdoors.grid) <= 3 * 4096);
        mrt_outdoors_finish(&outdoors);
        close_place(&p);
    }
}

static vec3s hidden_by(struct place *p, const struct mrt_atlas *atlas,
                       struct mrt_geometry_texel *geometry, int texel)
{
    bool lit;
    p->reflectors.inside = (struct mrt_geometry){ &p->map, atlas, geometry };
    assert_true(mrt_area_light_texels(p->trace, &p->reflectors,
                                      &(struct mrt_texel_list){ &geometry[texel], 1, 0 }, &lit));
    CHECK(lit);
    return geometry[texel].hidden;
}

// The underside of a table is a reflector for the floor, of which it hides the share of its form
// factor. From a texel above, which sees a surface that texels of the floor's wall stand for,
// nothing is hidden.
TEST(the_side_of_an_object_that_no_texel_stands_for_is_a_reflector)
{
    enum { RESOLUTION = 8 };
    struct place p;
    struct mrt_atlas atlas;
    open_place(&p, -0.5f, vec3_of(0.4f, 0, 0), vec3_of(0, 0, 0.4f));
    assert_true(mrt_atlas_init(test_host(), &p.map, RESOLUTION, &atlas));
    struct mrt_geometry_texel *geometry = mrt_geometry_create(test_host(), &p.map, &atlas, p.trace);
    assert_non_null(geometry);
    const int top = atlas.tiles[atlas.tile_of_face[CUBE_TOP]].first_texel;
    geometry[top] = (struct mrt_geometry_texel){ .position = vec3_of(0, -1, 0),
                                                 .normal = vec3_of(0, 1, 0),
                                                 .found = true };
    // The form factor of a square of edge 2a at the height h, centred, with x = a/h.
    const double x = 0.8, root = sqrt(1 + x * x);
    const double share = 4 / 3.14159265 * x / root * atan(x / root);
    const vec3s hidden = hidden_by(&p, &atlas, geometry, top);
    CHECK_NEAR(hidden.x, (1 - (double)ALBEDO) * share, 0.02);
    geometry[top].position = vec3_of(0, 0.9f, 0);
    geometry[top].normal = vec3_of(0, -1, 0);
    CHECK(glms_vec3_max(hidden_by(&p, &atlas, geometry, top)) == 0.0f);
    host_free(test_host(), geometry);
    mrt_atlas_finish(&atlas);
    close_place(&p);
}
