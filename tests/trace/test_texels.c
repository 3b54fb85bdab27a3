// Light and the inside test at texels, against closed forms.
#include "trace/trace_fixture.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "trace/texels/inside.h"
#include "trace/texels/light.h"

#include <math.h>

static struct trace_scene *open_trace(struct trace_fixture *s)
{
    assert_true(pose_init(&s->pose, s->scene, -1, 0));
    struct trace_scene *scene = trace_scene_create(test_host(), &s->pose);
    assert_non_null(scene);
    return scene;
}

static struct texel_lights light_at(const struct trace_scene *scene, vec3s position, vec3s normal)
{
    const struct texel_receiver receiver = { .position = position,
                                             .normal = normal,
                                             .rays = 1024,
                                             .light_samples = texel_light_samples(scene, 1024),
                                             .seed = 5 };
    struct texel_lights out;
    texel_gather_light(scene, &receiver, NULL, NULL, &out);
    return out;
}

static void check_along(const struct texel_light *light, vec3s normal, double irradiance, double by)
{
    CHECK_RELATIVE(light->irradiance, irradiance, by);
    const vec3s v = vec3_of(light->vector[0], light->vector[1], light->vector[2]);
    CHECK_RELATIVE(glms_vec3_dot(v, normal), light->irradiance, 0.01);
}

// Each patch has the integral of the clamped cosine over its directions, and a share of 255.
static void check_patches(const struct texel_lights *light, vec3s normal)
{
    enum { POINTS = 200000 };
    double exact[ENVIRONMENT_PATCHES] = { 0 };
    uint8_t shares[ENVIRONMENT_PATCHES];
    int sum = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        const vec3s d = sample_sphere(sobol_2d(i, 9));
        exact[environment_patch_of(d)] +=
            4.0 * 3.14159265 / POINTS * fmax((double)glms_vec3_dot(d, normal), 0.0);
    }
    texel_sky_shares(light, shares);
    for (int p = 0; p < ENVIRONMENT_PATCHES; p++) {
        CHECK_NEAR(light->sky_patches[p], exact[p], 0.02);
        CHECK_NEAR(shares[p] / 255.0 * 3.14159265, exact[p], 0.03);
        sum += shares[p];
    }
    CHECK(sum == 255);
}

TEST(emissive_room_and_open_sky_give_pi)
{
    struct trace_fixture s;
    fixture_init(&s);
    fixture_room(&s, 2.0f, fixture_diffuse(&s, vec3_of(0, 0, 0), vec3_of(1, 2, 0)));
    struct trace_scene *scene = open_trace(&s);
    const vec3s up = vec3_of(0, 1, 0);
    const struct texel_lights room = light_at(scene, vec3_of(0.3f, -1.5f, 0.7f), up);
    check_along(&room.emitted[0], up, 3.14159, 0.02);
    check_along(&room.emitted[1], up, 2 * 3.14159, 0.02);
    CHECK(room.emitted[2].irradiance == 0.0f && room.sky.irradiance == 0.0f);
    const struct texel_lights sky = light_at(scene, vec3_of(0, 3, 0), up); // over the room
    check_along(&sky.sky, up, 3.14159, 1e-4);
    check_patches(&sky, up);
    trace_scene_destroy(scene);
    fixture_finish(&s);
}

// E = L A / d², which few rays meet.
TEST(small_emitter_is_sampled)
{
    struct trace_fixture s;
    fixture_init(&s);
    const int emitter = fixture_diffuse(&s, vec3_of(0, 0, 0), vec3_of(100, 100, 100));
    fixture_disk(&s, vec3_of(0, 4, 0), vec3_of(0, -1, 0), 0.01f, 8, emitter);
    struct trace_scene *scene = open_trace(&s);
    const vec3s up = vec3_of(0, 1, 0);
    const struct texel_lights light = light_at(scene, vec3_of(0, 0, 0), up);
    check_along(&light.emitted[0], up, 100.0 * 0.01 / 16.0, 0.01);
    const struct texel_lights below = light_at(scene, vec3_of(0, 0, 0), vec3_of(0, -1, 0));
    CHECK(below.emitted[0].irradiance == 0.0f);
    trace_scene_destroy(scene);
    fixture_finish(&s);
}

// Rays are denser in some cells: half a sky and the other half an emissive wall keep their light,
// and shares of all rays sum to 1.
static void add_share(void *user, const struct ray *ray, const struct ray_hit *hit, vec3s local,
                      const struct texel_hit *at_hit)
{
    (void)ray, (void)hit, (void)local;
    *(double *)user += (double)at_hit->share;
}

TEST(rays_that_are_denser_in_cells_keep_the_mean)
{
    struct trace_fixture s;
    uint8_t further[64];
    double shares = 0;
    fixture_init(&s);
    const int emitter = fixture_diffuse(&s, vec3_of(0, 0, 0), vec3_of(2, 2, 2));
    fixture_disk(&s, vec3_of(0, 0, -1), vec3_of(0, 0, 1), 1e7f, 64, emitter);
    struct trace_scene *scene = open_trace(&s);
    for (int i = 0; i < 64; i++) further[i] = i % 3 == 0 ? 16 : i % 3 == 1 ? 2 : 0;
    const struct texel_receiver receiver = { .position = vec3_of(0, 0, 0),
                                             .normal = vec3_of(0, 1, 0),
                                             .rays = 256,
                                             .light_samples = 64,
                                             .seed = 5,
                                             .cells = { 8, further } };
    struct texel_lights light;
    texel_gather_light(scene, &receiver, add_share, &shares, &light);
    check_along(&light.sky, receiver.normal, 1.5708, 0.01);
    check_along(&light.emitted[1], receiver.normal, 2 * 1.5708, 0.02);
    CHECK_NEAR(shares + (double)light.sky.irradiance / 3.14159265, 1.0, 1e-5);
    trace_scene_destroy(scene);
    fixture_finish(&s);
}

static bool is_behind_wall(bool double_sided)
{
    struct trace_fixture s;
    struct material material = material_default();
    fixture_init(&s);
    material.double_sided = double_sided;
    fixture_room(&s, 2.0f, fixture_material(&s, &material));
    struct trace_scene *scene = open_trace(&s);
    const vec3s inwards = vec3_of(0, 0, -1);
    const int room = inside_backs(scene, vec3_of(0, 0, 1.9f), inwards, 0, INSIDE_RAYS);
    const int wall = inside_backs(scene, vec3_of(0, 0, 2.01f), inwards, 0, INSIDE_RAYS);
    CHECK(room == 0);
    CHECK(wall == inside_backs(scene, vec3_of(0, 0, 2.01f), inwards, 0, 4) +
                      inside_backs(scene, vec3_of(0, 0, 2.01f), inwards, 4, INSIDE_RAYS));
    trace_scene_destroy(scene);
    fixture_finish(&s);
    return is_inside(wall, INSIDE_RAYS);
}

TEST(backs_of_single_sided_surfaces_are_inside)
{
    CHECK(is_behind_wall(false));
    CHECK(!is_behind_wall(true));
    CHECK(is_inside(9, 16) && !is_inside(8, 16));
}

static void add_box(struct trace_fixture *s, vec3s low, vec3s high, int material)
{
    for (int face = 0; face < 6; face++) {
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        vec3s corner[4];
        for (int i = 0; i < 4; i++) {
            corner[i].raw[axis] = face % 2 ? high.raw[axis] : low.raw[axis];
            corner[i].raw[u] = i == 1 || i == 2 ? high.raw[u] : low.raw[u];
            corner[i].raw[v] = i >= 2 ? high.raw[v] : low.raw[v];
        }
        if (face % 2)
            fixture_quad(s, corner[0], corner[1], corner[2], corner[3], material);
        else
            fixture_quad(s, corner[0], corner[3], corner[2], corner[1], material);
    }
}

// A wall stands on a floor, which lies on the ground, and carries a ceiling: planes are shared.
TEST(crossings_count_both_faces_where_solids_touch)
{
    struct trace_fixture s;
    fixture_init(&s);
    const int material = fixture_diffuse(&s, vec3_of(0.5f, 0.5f, 0.5f), vec3_of(0, 0, 0));
    add_box(&s, vec3_of(-20, -0.4f, -20), vec3_of(20, -0.2f, 20), material);
    add_box(&s, vec3_of(-3, -0.2f, -3), vec3_of(3, 0, 3), material);
    add_box(&s, vec3_of(-3, 0, -3), vec3_of(-2.8f, 2.8f, 3), material);
    add_box(&s, vec3_of(-2.8f, 0, -3), vec3_of(3, 2.8f, -2.8f), material);
    add_box(&s, vec3_of(-3, 2.8f, -3), vec3_of(3, 3, 3), material);
    struct trace_scene *scene = open_trace(&s);
    const vec3s down = vec3_of(0, -1, 0), height = vec3_of(0, 2.799f, 0);
    for (int i = 0; i < 100; i++) {
        const float along = -2.75f + 0.055f * (float)i;
        const vec3s room = glms_vec3_add(height, vec3_of(-2.79f, 0, along));
        const vec3s wall = glms_vec3_add(height, vec3_of(-2.81f, 0, along));
        const vec3s corner = glms_vec3_add(height, vec3_of(along, 0, -2.81f));
        CHECK(inside_crossings(scene, room, down) == 0 && !inside_solid(scene, room, down));
        CHECK(inside_crossings(scene, wall, down) == INSIDE_CROSSINGS);
        CHECK(inside_crossings(scene, corner, down) == INSIDE_CROSSINGS);
        CHECK(inside_solid(scene, wall, down) && inside_solid(scene, corner, down));
    }
    trace_scene_destroy(scene);
    fixture_finish(&s);
}
