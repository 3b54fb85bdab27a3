// The reference under an environment map, against closed forms and quadratures.
#include "scene/environment_fixture.h"
#include "trace/trace_fixture.h"

#include "scene/scene_edit.h"

#include <stdlib.h>

static const double PI = 3.14159265358979;
static const float DEGREE = GLM_PIf / 180.0f;

static vec3s grey(float value)
{
    return vec3_of(value, value, value);
}

static void set_map(struct trace_fixture *s, int width, fixture_radiance radiance, float strength,
                    float rotation_rad)
{
    struct environment_map *map = fixture_map(width, radiance);
    scene_set_environment_map(s->scene, map, strength, rotation_rad);
    environment_map_release(map);
}

// ---- a convex body: flat faces, so that each point sees exactly the hemisphere of its normal

enum { SECTORS = 24, STACKS = 12 };

static vec3s sphere_corner(float radius, int sector, int stack)
{
    const float polar = GLM_PIf * (float)stack / STACKS;
    const float azimuth = 2 * GLM_PIf * (float)(sector % SECTORS) / SECTORS;
    return vec3_of(radius * sinf(polar) * cosf(azimuth), radius * cosf(polar),
                   radius * sinf(polar) * sinf(azimuth));
}

static void add_sphere(struct trace_fixture *s, float radius, int material)
{
    vec3s positions[SECTORS * STACKS * 4];
    uint32_t indices[SECTORS * STACKS * 6], count = 0;
    for (int k = 0; k < SECTORS * STACKS; k++) {
        static const uint32_t corners[] = { 0, 1, 2, 0, 2, 3 };
        const int sector = k % SECTORS, stack = k / SECTORS;
        positions[4 * k] = sphere_corner(radius, sector, stack);
        positions[4 * k + 1] = sphere_corner(radius, sector + 1, stack);
        positions[4 * k + 2] = sphere_corner(radius, sector + 1, stack + 1);
        positions[4 * k + 3] = sphere_corner(radius, sector, stack + 1);
        for (int i = 0; i < 6; i++) {
            if ((stack == 0 && i < 3) || (stack == STACKS - 1 && i >= 3)) continue; // at a pole
            indices[count++] = 4 * (uint32_t)k + corners[i];
        }
    }
    const struct node node = node_default();
    const int m = scene_add_mesh(s->scene, &(struct mesh){ .name = "sphere",
                                                           .vertex_count = SECTORS * STACKS * 4,
                                                           .index_count = count,
                                                           .positions = positions,
                                                           .indices = indices,
                                                           .material = material });
    const int n = scene_add_node(s->scene, &node);
    assert_true(m >= 0 && n >= 0);
    assert_true(
        scene_add_instance(s->scene, &(struct instance){ .node = n, .mesh = m, .skin = -1 }) >= 0);
}

// A sphere that fills the image.
static void open_sphere(struct trace_fixture *s, float albedo)
{
    fixture_init(s);
    s->options.antialias = false;
    add_sphere(s, 1, fixture_diffuse(s, grey(albedo), grey(0)));
    fixture_aim_camera(s, vec3_of(1.5f, 2, 3), vec3_of(0, 0, 0), 16 * DEGREE);
}

struct layers {
    struct image color, error, normal, irradiance;
};

static struct layers render(struct trace_fixture *s)
{
    struct layers l;
    struct reference *r = fixture_reference(s);
    assert_true(reference_render(r, s->samples, NULL, NULL));
    assert_true(reference_read(r, REFERENCE_COLOR, &l.color));
    assert_true(reference_read(r, REFERENCE_ERROR, &l.error));
    assert_true(reference_read(r, REFERENCE_NORMAL, &l.normal));
    assert_true(reference_read(r, REFERENCE_IRRADIANCE_EMITTERS_SKY, &l.irradiance));
    reference_destroy(r);
    return l;
}

static void layers_finish(struct layers *l)
{
    image_finish(&l->color, test_host());
    image_finish(&l->error, test_host());
    image_finish(&l->normal, test_host());
    image_finish(&l->irradiance, test_host());
}

static vec3s at(const struct image *image, int i)
{
    const float *p = image->pixels + (size_t)i * (size_t)image->channels;
    return vec3_of(p[0], p[1], p[2]);
}

// Differences over their standard errors: of the mean over the image within 3, and their mean
// square over the pixels that of noise, 1.
struct residual {
    double sum, variance, squares;
    int count;
};

static void add_residual(struct residual *r, double difference, double error, double tolerance)
{
    const double beyond = fmax(fabs(difference) - tolerance, 0);
    r->sum += difference;
    r->variance += error * error;
    r->squares += beyond > 0 ? beyond * beyond / (error * error) : 0;
    r->count++;
}

static void check_residual(const struct residual *r, double tolerance)
{
    CHECK(r->count > 0);
    CHECK_NEAR(r->sum / r->count, 0, 3 * sqrt(r->variance) / r->count + tolerance);
    CHECK(r->squares / r->count < 1.5);
}

static const vec3s LOBE = { { 0.6f, 0.48f, 0.64f } };

static vec3s one_lobe(vec3s d)
{
    return vec3_of(fmaxf(glms_vec3_dot(d, LOBE), 0), fmaxf(glms_vec3_dot(d, LOBE), 0),
                   fmaxf(-glms_vec3_dot(d, LOBE), 0));
}

// Irradiance under max(0, ω · a) of a surface whose normal has an angle γ to a.
static double lobe_irradiance(vec3s n, vec3s a)
{
    const double cosine = fmin(fmax((double)glms_vec3_dot(n, a), -1), 1), angle = acos(cosine);
    return 2.0 / 3.0 * ((PI - angle) * cosine + sin(angle));
}

TEST(a_convex_body_under_a_lobe_has_its_irradiance_in_closed_form)
{
    struct trace_fixture s;
    open_sphere(&s, 0.6f);
    s.samples = 128;
    set_map(&s, 128, one_lobe, 1, 0);
    const vec3s normals[] = { LOBE, { { 0, 1, 0 } }, { { -1, 0, 0 } } };
    for (int i = 0; i < 3; i++) {
        const vec3s e = fixture_irradiance(&s.scene->environment, normals[i], 256);
        CHECK_NEAR(e.x, lobe_irradiance(normals[i], LOBE), 2e-3);
        CHECK_NEAR(e.z, lobe_irradiance(normals[i], glms_vec3_negate(LOBE)), 2e-3);
    }
    struct layers l = render(&s);
    struct residual red = { 0 }, blue = { 0 };
    double given = 0, expected = 0;
    for (int i = 0; i < s.width * s.height; i++) {
        const double e = lobe_irradiance(at(&l.normal, i), LOBE);
        const double other = lobe_irradiance(at(&l.normal, i), glms_vec3_negate(LOBE));
        CHECK_NEAR(glms_vec3_norm(at(&l.normal, i)), 1, 1e-4);
        add_residual(&red, (double)at(&l.color, i).x - 0.6 / PI * e, (double)at(&l.error, i).x,
                     5e-4);
        add_residual(&blue, (double)at(&l.color, i).z - 0.6 / PI * other, (double)at(&l.error, i).z,
                     5e-4);
        given += (double)at(&l.irradiance, i).x;
        expected += e;
    }
    check_residual(&red, 5e-4);
    // Blue is seldom sampled: pixels without a sample in its lobe have no estimate of their error.
    CHECK_NEAR(blue.sum / blue.count, 0, 3 * sqrt(blue.variance) / blue.count + 5e-4);
    CHECK_RELATIVE(given, expected, 0.01);
    layers_finish(&l);
    fixture_finish(&s);
}

static vec3s white(vec3s d)
{
    (void)d;
    return grey(1);
}

TEST(a_white_body_disappears_in_a_uniform_map)
{
    struct trace_fixture s;
    open_sphere(&s, 1);
    s.samples = 128;
    set_map(&s, 16, white, 1, 0.3f);
    struct layers l = render(&s);
    struct residual r = { 0 };
    for (int i = 0; i < s.width * s.height; i++)
        add_residual(&r, (double)at(&l.color, i).y - 1, (double)at(&l.error, i).y, 1e-4);
    check_residual(&r, 1e-4);
    layers_finish(&l);
    fixture_finish(&s);
}

// ---- a sphere in the corner of three walls, rotated about y in quarters

static vec3s quarter(vec3s p, int turns)
{
    for (int i = 0; i < turns; i++) p = vec3_of(p.z, p.y, -p.x); // +x to −z, as environments turn
    return p;
}

static void open_corner(struct trace_fixture *s, int turns)
{
    static const float walls[][4][3] = {
        { { -1, -1, 3 }, { 3, -1, 3 }, { 3, -1, -1 }, { -1, -1, -1 } },
        { { -1, -1, -1 }, { 3, -1, -1 }, { 3, 2, -1 }, { -1, 2, -1 } },
        { { -1, -1, 3 }, { -1, -1, -1 }, { -1, 2, -1 }, { -1, 2, 3 } },
    };
    fixture_init(s);
    s->samples = 128;
    s->options.antialias = false;
    const int material = fixture_diffuse(s, vec3_of(0.8f, 0.6f, 0.3f), grey(0));
    for (int w = 0; w < 3; w++) {
        vec3s p[4];
        for (int i = 0; i < 4; i++)
            p[i] = quarter(vec3_of(walls[w][i][0], walls[w][i][1], walls[w][i][2]), turns);
        fixture_quad(s, p[0], p[1], p[2], p[3], material);
    }
    add_sphere(s, 0.6f, material); // symmetric by quarters
    fixture_aim_camera(s, quarter(vec3_of(3, 2, 4), turns), vec3_of(0, 0, 0), 45 * DEGREE);
}

static void check_same(struct trace_fixture *a, struct trace_fixture *b)
{
    struct layers l[2] = { render(a), render(b) };
    for (int c = 0; c < 3; c++) {
        struct residual r = { 0 };
        for (int i = 0; i < a->width * a->height; i++)
            add_residual(
                &r, (double)at(&l[0].color, i).raw[c] - (double)at(&l[1].color, i).raw[c],
                hypot((double)at(&l[0].error, i).raw[c], (double)at(&l[1].error, i).raw[c]), 1e-4);
        check_residual(&r, 1e-4);
    }
    layers_finish(&l[0]);
    layers_finish(&l[1]);
}

TEST(a_uniform_map_is_a_uniform_sky)
{
    struct trace_fixture map, sky;
    open_corner(&map, 0);
    open_corner(&sky, 0);
    set_map(&map, 8, white, 1, 1);
    sky.scene->environment.sky = grey(1);
    sky.options.seed = 1;
    check_same(&map, &sky);
    fixture_finish(&map);
    fixture_finish(&sky);
}

static vec3s gradient(vec3s d)
{
    return vec3_of(1 + d.x, 1 + d.y, 1 + 0.5f * d.z - 0.5f * d.x);
}

TEST(rotating_everything_gives_the_same_image)
{
    for (int turns = 1; turns < 4; turns++) {
        struct trace_fixture still, rotated;
        open_corner(&still, 0);
        open_corner(&rotated, turns);
        set_map(&still, 64, gradient, 1, 0.2f);
        set_map(&rotated, 64, gradient, 1, 0.2f + (float)turns * GLM_PI_2f);
        rotated.options.seed = 1;
        check_same(&still, &rotated);
        fixture_finish(&still);
        fixture_finish(&rotated);
    }
}

// ---- a floor under light from a few directions

static void open_floor(struct trace_fixture *s)
{
    fixture_init(s);
    fixture_quad(s, vec3_of(-9, 0, 9), vec3_of(9, 0, 9), vec3_of(9, 0, -9), vec3_of(-9, 0, -9),
                 fixture_diffuse(s, grey(0.5f), grey(0)));
    fixture_aim_camera(s, vec3_of(0, 1, 0), vec3_of(0.01f, 0, 0), 0.5f);
}

static vec3s window(vec3s d)
{
    const vec3s centre = vec3_of(0.48f, 0.8f, 0.36f);
    return grey(glms_vec3_dot(d, centre) > cosf(10 * DEGREE) ? 100 : 0.1f);
}

TEST(next_event_estimation_finds_a_window_without_bias)
{
    struct trace_fixture s;
    open_floor(&s);
    s.samples = 256;
    set_map(&s, 256, window, 2, -0.8f);
    CHECK(!s.scene->environment.map->sun.found);
    const vec3s up = vec3_of(0, 1, 0);
    double sr, mean = 0, square = 0; // of the radiance over cosine-distributed directions
    for (int i = 0; i < 512 * 256; i++) {
        const vec3s d = sphere_point(512, i, &sr);
        const double share = sr * fmax((double)d.y, 0) / PI;
        const double l = (double)environment_radiance(&s.scene->environment, d).y;
        mean += share * l;
        square += share * l * l;
    }
    const double bsdf_alone = 0.5 * sqrt((square - mean * mean) / s.samples);
    CHECK_RELATIVE(fixture_irradiance(&s.scene->environment, up, 512).y, PI * mean, 1e-4);
    struct layers l = render(&s);
    struct residual r = { 0 };
    double errors = 0;
    for (int i = 0; i < s.width * s.height; i++) {
        const double error = (double)at(&l.error, i).y;
        add_residual(&r, (double)at(&l.color, i).y - 0.5 * mean, error, 1e-3 * mean);
        errors += error * error / (s.width * s.height);
    }
    check_residual(&r, 1e-3 * mean);
    print_message("standard error %.3g, of BSDF sampling alone %.3g\n", sqrt(errors), bsdf_alone);
    CHECK(sqrt(errors) < 0.25 * bsdf_alone);
    layers_finish(&l);
    fixture_finish(&s);
}

static const vec3s TO_SUN = { { 0.48f, 0.6f, 0.64f } };

static vec3s sunny(vec3s d)
{
    const float sun = glms_vec3_dot(d, TO_SUN) > cosf(DEGREE) ? 1e7f : 0;
    return vec3_of(1000 + sun, 1500 + 500 * d.y + 0.8f * sun, 3000 + 0.6f * sun);
}

// Irradiance of the original image, its sun included, on the horizontal plane.
TEST(a_sun_that_became_a_directional_light_has_the_same_illuminance)
{
    enum { WIDTH = 1024 };
    struct trace_fixture s;
    open_floor(&s);
    set_map(&s, WIDTH, sunny, 2, 0.9f);
    CHECK(s.scene->environment.map->sun.found);
    double e[3] = { 0 }, sr;
    for (int i = 0; i < WIDTH * (WIDTH / 2); i++) {
        const vec3s d = sphere_point(WIDTH, i, &sr), l = sunny(d);
        for (int c = 0; c < 3 && d.y > 0; c++) e[c] += sr * (double)d.y * 2 * (double)l.raw[c];
    }
    const struct layer_mean m = fixture_mean(&s, REFERENCE_COLOR);
    for (int c = 0; c < 3; c++) CHECK_RELATIVE(m.mean[c], 0.5 / PI * e[c], 0.01);
    fixture_finish(&s);
}

// A wall on the side of the sun, as the environment turns: its shadow is on the floor.
TEST(the_sun_of_an_environment_turns_with_it)
{
    for (int turns = 0; turns < 4; turns++) {
        struct trace_fixture s;
        open_floor(&s);
        const vec3s towards = quarter(vec3_of(TO_SUN.x, 0, TO_SUN.z), turns);
        const vec3s centre = glms_vec3_scale(glms_vec3_normalize(towards), 2);
        fixture_disk(&s, vec3_of(centre.x, 1.5f, centre.z), glms_vec3_negate(towards), 4, 64,
                     fixture_diffuse(&s, grey(0), grey(0)));
        double mean[2];
        for (int away = 0; away < 2; away++) {
            set_map(&s, 512, sunny, 1, (float)(turns + 2 * away) * GLM_PI_2f);
            mean[away] = fixture_mean(&s, REFERENCE_COLOR).mean[1];
        }
        CHECK(mean[0] < 0.6 * mean[1]);
        fixture_finish(&s);
    }
}

// ---- the background

TEST(pixels_without_a_surface_show_the_radiance_along_their_ray)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.samples = 1;
    s.options.antialias = false;
    s.width = 24;
    // A small quad behind the camera.
    fixture_quad(&s, vec3_of(0, 0, 9), vec3_of(0, 1, 9), vec3_of(1, 1, 9), vec3_of(1, 0, 9),
                 fixture_diffuse(&s, grey(0), grey(0)));
    fixture_aim_camera(&s, vec3_of(0, 0, 0), vec3_of(-1, 0.4f, -2), 1.2f);
    set_map(&s, 32, gradient, 3, 0.6f);
    s.scene->environment.sky = vec3_of(0.1f, 0.2f, 0);
    const struct image image = fixture_layer(&s, REFERENCE_COLOR);
    const vec3s right = glms_vec3_cross(s.camera.forward, s.camera.up);
    const float tan_y = tanf(0.6f), tan_x = tan_y * (float)s.width / (float)s.height;
    for (int i = 0; i < s.width * s.height; i++) {
        const float x = 2 * ((float)(i % s.width) + 0.5f) / (float)s.width - 1;
        const float y = 1 - 2 * ((float)(i / s.width) + 0.5f) / (float)s.height;
        vec3s d = glms_vec3_muladds(right, tan_x * x, s.camera.forward);
        d = glms_vec3_normalize(glms_vec3_muladds(s.camera.up, tan_y * y, d));
        const vec3s expected = environment_radiance(&s.scene->environment, d);
        for (int c = 0; c < 3; c++) CHECK_NEAR(at(&image, i).raw[c], expected.raw[c], 1e-4);
    }
    image_finish((struct image *)&image, test_host());
    fixture_finish(&s);
}
