// Emissive surfaces as virtual lights: the list holds their light, all of it, where it is.
#include "frame/emitters.h"
#include "frame/frame_fixture.h"

#include "image/png_file.h"
#include "scene/builtin/builtin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static struct material emissive_material(vec3s radiance)
{
    struct material m = material_default();
    m.emissive = radiance;
    m.metallic = 0;
    return m;
}

static int grey_emissive(struct frame_fixture *s, float radiance)
{
    struct material m = emissive_material(vec3_of(radiance, radiance, radiance));
    return fixture_material(s, &m);
}

// A square in the plane y, facing up.
static int square(struct frame_fixture *s, float x, float y, float size, int material)
{
    return fixture_quad(s, vec3_of(x, y, size), vec3_of(x + size, y, size), vec3_of(x + size, y, 0),
                        vec3_of(x, y, 0), material);
}

struct list {
    struct frame_fixture fixture;
    struct emitters emitters;
};

static void list_begin(struct list *l)
{
    fixture_init(&l->fixture, NULL);
    l->emitters = (struct emitters){ 0 };
}

static void list_make(struct list *l)
{
    assert_true(pose_init(&l->fixture.pose, l->fixture.scene, -1, 0));
    assert_true(emitters_init(&l->emitters, test_host(), l->fixture.scene));
    emitters_update(&l->emitters, &l->fixture.pose);
}

static void list_finish(struct list *l)
{
    emitters_finish(&l->emitters);
    fixture_finish(&l->fixture);
}

static vec3s sum_of(const struct emitters *e, bool (*counts)(const struct frame_emitter *))
{
    double sum[3] = { 0 };
    for (int i = 0; i < e->count; i++) {
        if (counts && !counts(&e->points[i])) continue;
        for (int c = 0; c < 3; c++) sum[c] += (double)e->points[i].flux.raw[c];
    }
    return vec3_of((float)sum[0], (float)sum[1], (float)sum[2]);
}

static bool faces_up(const struct frame_emitter *p)
{
    return p->normal.y > 0.999f;
}

static bool is_left(const struct frame_emitter *p)
{
    return p->position.x < 0.5f;
}

TEST(total_flux_is_pi_times_radiance_times_area)
{
    struct list l;
    list_begin(&l);
    struct material m = emissive_material(vec3_of(10, 20, 30));
    square(&l.fixture, 0, 1, 2, fixture_material(&l.fixture, &m));
    list_make(&l);
    vec3s sum = sum_of(&l.emitters, NULL);
    for (int c = 0; c < 3; c++) {
        CHECK_RELATIVE(sum.raw[c], PI * 4 * 10 * (c + 1), 1e-6);
        CHECK_RELATIVE(l.emitters.flux.raw[c], sum.raw[c], 1e-6);
    }
    CHECK(l.emitters.count == EMITTERS_MAX);
    for (int i = 0; i < l.emitters.count; i++) {
        vec3s p = l.emitters.points[i].position;
        CHECK(p.x >= 0 && p.x <= 2 && p.y == 1 && p.z >= 0 && p.z <= 2);
        CHECK(faces_up(&l.emitters.points[i]));
    }
    list_finish(&l);
}

TEST(flux_of_the_cornell_lamp_is_that_of_its_quad)
{
    struct scene *scene = scene_load(test_host(), "@cornell");
    assert_non_null(scene);
    struct scene_pose pose;
    struct emitters e;
    assert_true(pose_init(&pose, scene, -1, 0) && emitters_init(&e, test_host(), scene));
    emitters_update(&e, &pose);
    vec3s radiance = vec3_of(0, 0, 0);
    for (int i = 0; i < scene->material_count; i++)
        radiance = glms_vec3_add(radiance, scene->materials[i].emissive);
    struct box3 lamp = box3_empty();
    for (int i = 0; i < e.count; i++) lamp = box3_add_point(lamp, e.points[i].position);
    for (int i = 0; i < scene->instance_count; i++) {
        const struct mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        if (scene->materials[mesh->material].emissive.x <= 0.0f) continue;
        vec3s size = box3_size(mesh->bounds), seen = box3_size(lamp);
        for (int c = 0; c < 3; c++)
            CHECK_RELATIVE(e.flux.raw[c], PI * (double)radiance.raw[c] * (double)(size.x * size.z),
                           1e-5);
        CHECK_RELATIVE(seen.x, size.x, 0.05); // its points reach its edges
        CHECK_RELATIVE(seen.z, size.z, 0.05);
    }
    for (int i = 0; i < e.count; i++) CHECK(e.points[i].normal.y < -0.999f);
    emitters_finish(&e);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(both_sides_of_a_double_sided_surface_emit_the_same)
{
    struct list l;
    list_begin(&l);
    struct material m = emissive_material(vec3_of(7, 7, 7));
    m.double_sided = true;
    square(&l.fixture, 0, 0, 1, fixture_material(&l.fixture, &m));
    list_make(&l);
    CHECK_RELATIVE(l.emitters.flux.x, 2 * PI * 7, 1e-6);
    CHECK_RELATIVE(sum_of(&l.emitters, faces_up).x, PI * 7, 1e-5);
    list_finish(&l);
}

// A texture that is bright on the left quarter and dim elsewhere, with noise of a texel's size.
static int texture(struct frame_fixture *s, int size, double *mean, double *mean_left)
{
    uint8_t *rgba = calloc((size_t)size * (size_t)size, 4);
    assert_non_null(rgba);
    double sum = 0, left = 0;
    for (int i = 0; i < size * size; i++) {
        uint8_t value = (uint8_t)(i % size < size / 4 ? 255 - i * 7 % 60 : i * 13 % 50);
        memset(&rgba[4 * i], value, 3);
        rgba[4 * i + 3] = value > 100 ? 255 : 0;
        double linear = (double)srgb_decode((float)value / 255.0f);
        sum += linear;
        if (i % size < size / 2) left += linear;
    }
    *mean = sum / ((double)size * size);
    *mean_left = left / ((double)size * size);
    int image = scene_add_image(
        s->scene,
        &(struct scene_image){ .name = "emission", .width = size, .height = size, .rgba = rgba });
    free(rgba);
    assert_true(image >= 0);
    return image;
}

TEST(a_textured_emitter_has_the_mean_of_its_texture_where_the_texture_is)
{
    static const int sizes[] = { 1, 4, 64, 300, 1000 };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct list l;
        list_begin(&l);
        struct material m = emissive_material(vec3_of(100, 50, 25));
        double mean, left;
        m.emissive_map.image = texture(&l.fixture, sizes[i], &mean, &left);
        square(&l.fixture, 0, 0, 1, fixture_material(&l.fixture, &m));
        list_make(&l);
        // Both triangles are looked up at 1024 places each, bilinearly between texels.
        CHECK_RELATIVE(l.emitters.flux.x, PI * 100 * mean, 0.01);
        CHECK_RELATIVE(l.emitters.flux.z, PI * 25 * mean, 0.01);
        if (sizes[i] >= 64) CHECK_RELATIVE(sum_of(&l.emitters, is_left).x, PI * 100 * left, 0.02);
        list_finish(&l);
    }
}

TEST(what_a_mask_cuts_away_does_not_emit)
{
    struct list l;
    list_begin(&l);
    double mean, left;
    struct material m = emissive_material(vec3_of(1, 1, 1));
    m.base_color_map.image = texture(&l.fixture, 64, &mean, &left);
    m.alpha_mode = ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    square(&l.fixture, 0, 0, 1, fixture_material(&l.fixture, &m));
    m.base_color_map.image = -1;
    m.base_color.w = 0.25f;
    square(&l.fixture, 0, 1, 1, fixture_material(&l.fixture, &m)); // all of it
    list_make(&l);
    CHECK_RELATIVE(l.emitters.flux.x, PI / 4, 0.01);
    // The texture repeats: a little of its left edge is seen at the right one.
    CHECK_RELATIVE(sum_of(&l.emitters, is_left).x, PI / 4, 0.03);
    list_finish(&l);
}

TEST(a_dim_wall_does_not_starve_a_lamp_nor_a_lamp_the_wall)
{
    struct list l;
    list_begin(&l);
    square(&l.fixture, 0, 0, 100, grey_emissive(&l.fixture, 0.01f));   // 314 lm
    square(&l.fixture, 50, 2, 0.01f, grey_emissive(&l.fixture, 1e6f)); // 314 lm as well
    list_make(&l);
    int lamp = 0, cells[8][8] = { { 0 } };
    for (int i = 0; i < l.emitters.count; i++) {
        vec3s p = l.emitters.points[i].position;
        if (p.y > 1.0f)
            lamp++;
        else
            cells[(int)(p.z / 12.51f)][(int)(p.x / 12.51f)]++;
    }
    CHECK(lamp > EMITTERS_MAX / 5 && lamp < EMITTERS_MAX / 2);
    for (int i = 0; i < 64; i++) CHECK(cells[i / 8][i % 8] > EMITTERS_MAX / 64 / 3);
    CHECK_RELATIVE(l.emitters.flux.x, 200 * PI, 1e-3); // floats at 50 m know 4e-6
    list_finish(&l);
}

TEST(more_triangles_than_points_lose_no_light)
{
    enum { ACROSS = 100 };
    struct list l;
    list_begin(&l);
    struct material m = emissive_material(vec3_of(3, 2, 1));
    m.double_sided = true;
    int material = fixture_material(&l.fixture, &m);
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        float x = (float)(i % ACROSS) / ACROSS, z = (float)(i / ACROSS) / ACROSS, d = 1.0f / ACROSS;
        fixture_quad(&l.fixture, vec3_of(x, 0, z + d), vec3_of(x + d, 0, z + d),
                     vec3_of(x + d, 0, z), vec3_of(x, 0, z), material);
    }
    list_make(&l);
    CHECK(l.emitters.count == EMITTERS_MAX);
    CHECK_RELATIVE(sum_of(&l.emitters, NULL).x, 2 * PI * 3, 1e-5);
    CHECK_RELATIVE(sum_of(&l.emitters, faces_up).x, PI * 3, 2.0 / EMITTERS_MAX);
    CHECK_RELATIVE(sum_of(&l.emitters, is_left).x, PI * 3, 0.02);
    list_finish(&l);
}

TEST(points_move_with_their_surface_and_leave_nothing_behind)
{
    struct list l;
    list_begin(&l);
    int instance = square(&l.fixture, 0, 0, 1, grey_emissive(&l.fixture, 5));
    square(&l.fixture, 3, 0, 1, fixture_matte(&l.fixture, vec3_of(1, 1, 1)));
    list_make(&l);
    size_t bytes = EMITTERS_MAX * sizeof *l.emitters.points;
    struct frame_emitter *before = malloc(bytes);
    assert_non_null(before);
    memcpy(before, l.emitters.points, bytes);
    mat4s *node = &l.fixture.pose.world_from_node[l.fixture.scene->instances[instance].node];
    node->raw[3][1] = 2;
    emitters_update(&l.emitters, &l.fixture.pose);
    for (int i = 0; i < EMITTERS_MAX; i++) {
        CHECK(l.emitters.points[i].position.y == 2);
        CHECK_NEAR(l.emitters.points[i].position.x, before[i].position.x, 1e-6);
    }
    CHECK_RELATIVE(l.emitters.flux.x, PI * 5, 1e-6);
    node->raw[3][1] = 0;
    emitters_update(&l.emitters, &l.fixture.pose);
    CHECK(memcmp(before, l.emitters.points, bytes) == 0);
    free(before);
    list_finish(&l);
}

TEST(a_mirrored_instance_emits_from_its_front)
{
    struct list l;
    list_begin(&l);
    int instance = square(&l.fixture, 0, 0, 1, grey_emissive(&l.fixture, 5));
    list_make(&l);
    mat4s *node = &l.fixture.pose.world_from_node[l.fixture.scene->instances[instance].node];
    node->raw[0][0] = -2; // twice as wide, and turned over
    emitters_update(&l.emitters, &l.fixture.pose);
    CHECK(faces_up(&l.emitters.points[0]) && l.emitters.points[0].position.x < 0);
    CHECK_RELATIVE(l.emitters.flux.x, 2 * PI * 5, 1e-6);
    list_finish(&l);
}

TEST(half_the_strength_is_half_the_flux_at_the_same_places)
{
    struct list full, half;
    list_begin(&full), list_begin(&half);
    square(&full.fixture, 0, 0, 1, grey_emissive(&full.fixture, 8));
    square(&half.fixture, 0, 0, 1, grey_emissive(&half.fixture, 4));
    list_make(&full), list_make(&half);
    for (int i = 0; i < EMITTERS_MAX; i++) {
        const struct frame_emitter *a = &full.emitters.points[i], *b = &half.emitters.points[i];
        CHECK(memcmp(&a->position, &b->position, sizeof a->position) == 0);
        CHECK(a->flux.x == 2 * b->flux.x);
    }
    list_finish(&full), list_finish(&half);
}

TEST(a_scene_without_emitters_has_an_empty_list)
{
    struct list l;
    list_begin(&l);
    square(&l.fixture, 0, 0, 1, fixture_matte(&l.fixture, vec3_of(1, 1, 1)));
    list_make(&l);
    vec3s e = emitters_irradiance(&l.emitters, l.fixture.pose.bounds);
    CHECK(l.emitters.count == 0 && l.emitters.flux.x == 0 && e.x == 0);
    list_finish(&l);
    emitters_finish(&(struct emitters){ 0 });
}

// A closed cube with emissive walls: Φ/S = π L.
TEST(mean_irradiance_of_an_emissive_cube_is_flux_over_surface)
{
    struct list l;
    list_begin(&l);
    fixture_box(&l.fixture, vec3_of(-1, 2, 3), vec3_of(4, 7, 8), true,
                grey_emissive(&l.fixture, 10));
    list_make(&l);
    CHECK_RELATIVE(emitters_irradiance(&l.emitters, l.fixture.pose.bounds).x, PI * 10, 1e-4);
    list_finish(&l);
}

TEST(a_flat_scene_keeps_no_light)
{
    struct list l;
    list_begin(&l);
    square(&l.fixture, 0, 0, 1, grey_emissive(&l.fixture, 10));
    list_make(&l);
    CHECK(l.emitters.count > 0);
    CHECK(emitters_irradiance(&l.emitters, l.fixture.pose.bounds).x == 0);
    CHECK(emitters_irradiance(&l.emitters, box3_empty()).x == 0);
    list_finish(&l);
}

// ---- In a frame ---------------------------------------------------------------------------------

struct seen {
    int count;
    double flux, irradiance;
    bool bound;
};

static void look(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    (void)cmd;
    struct seen *seen = user;
    double scale = (double)view->constants->radiance_scale;
    *seen = (struct seen){ .count = view->emitter_count,
                           .irradiance = (double)view->emitted_irradiance.x / scale,
                           .bound = view->emitters_binding.buffer.id != 0 };
    for (int i = 0; i < view->emitter_count; i++)
        seen->flux += (double)view->emitters[i].flux.x / scale;
}

// A room 4 m wide with a lamp below its ceiling, seen from inside.
static void room(struct frame_fixture *s, struct gpu *gpu, float lamp_m, float radiance)
{
    fixture_init(s, gpu);
    fixture_box(s, vec3_of(-2, 0, -2), vec3_of(2, 4, 2), true,
                fixture_matte(s, vec3_of(0.5f, 0.6f, 0.7f)));
    float h = lamp_m / 2;
    fixture_quad(s, vec3_of(-h, 3.9f, -h), vec3_of(h, 3.9f, -h), vec3_of(h, 3.9f, h),
                 vec3_of(-h, 3.9f, h), grey_emissive(s, radiance));
    fixture_look(s, vec3_of(0, 2, 1.9f), vec3_of(0, 2.5f, -2));
}

TEST_GPU(techniques_get_the_list_when_they_ask_for_it)
{
    struct frame_fixture s;
    room(&s, gpu, 1, 1000);
    struct seen seen;
    s.indirect = (struct frame_indirect){ .record = look, .user = &seen, .needs = 0 };
    fixture_open(&s);
    fixture_render(&s);
    CHECK(seen.count == 0 && !seen.bound);
    s.indirect.needs = FRAME_NEEDS_EMITTERS;
    fixture_render(&s);
    CHECK(seen.count == EMITTERS_MAX && seen.bound);
    CHECK_RELATIVE(seen.flux, PI * 1000, 1e-5);
    CHECK_RELATIVE(seen.irradiance, PI * 1000 * (2.0 / 3.0 * 3.9) / (4 * 64), 1e-4);
    fixture_finish(&s);
}

// From 10⁻³ to an LED die's 10⁶ cd/m², small or large: the emitter's own radiance is exact, and the
// irradiance of the walls is well inside of the range of half floats.
TEST_GPU(no_strength_of_emission_leaves_the_range_of_the_images)
{
    static const float sizes[] = { 0.02f, 3 }, radiances[] = { 1e-3f, 1, 1e6f };
    for (int i = 0; i < 6; i++) {
        struct frame_fixture s;
        room(&s, gpu, sizes[i / 3], radiances[i % 3]);
        fixture_look(&s, vec3_of(0, 3.85f, 0), vec3_of(0, 4, 0));
        struct seen seen;
        s.indirect =
            (struct frame_indirect){ .record = look, .user = &seen, .needs = FRAME_NEEDS_EMITTERS };
        fixture_open(&s);
        fixture_render(&s);
        CHECK_RELATIVE(fixture_pixel(&s, READ_EMISSIVE, 16, 16).x, radiances[i % 3], 1e-3);
        CHECK_RELATIVE(fixture_pixel(&s, READ_COLOR, 16, 16).x, radiances[i % 3], 1e-3);
        double scaled = seen.irradiance * (double)frame_radiance_scale(s.frame);
        CHECK(scaled > 0.03 && scaled < 1000); // 2⁻¹⁴ is the least normal half
        fixture_finish(&s);
    }
}
