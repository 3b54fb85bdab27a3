// Direct light in closed form: inverse squares, rectangles, disks, form factors.
#include "trace/trace_fixture.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static vec3s grey(float v)
{
    return vec3_of(v, v, v);
}

static void add_floor(struct trace_fixture *s, float half)
{
    fixture_quad(s, vec3_of(-half, 0, half), vec3_of(half, 0, half), vec3_of(half, 0, -half),
                 vec3_of(-half, 0, -half), fixture_diffuse(s, grey(1), grey(0)));
}

// Illuminance at the floor's origin, from the radiance E/π of a white floor over a few millimetres.
static struct layer_mean illuminance(struct trace_fixture *s)
{
    fixture_aim_camera(s, vec3_of(0.3f, 0.2f, 0.1f), vec3_of(0, 0, 0), 0.01f);
    struct layer_mean m = fixture_mean(s, REFERENCE_DIRECT);
    for (int c = 0; c < 3; c++) m.mean[c] *= PI;
    m.error *= PI;
    return m;
}

TEST(point_light_follows_the_inverse_square_law)
{
    for (int i = 1; i <= 4; i++) {
        struct trace_fixture s;
        fixture_init(&s);
        s.samples = 1;
        add_floor(&s, 5);
        fixture_light(&s, LIGHT_POINT, vec3_of(0, (float)i, 0), vec3_of(0, -1, 0),
                      vec3_of(100, 50, 10));
        struct layer_mean m = illuminance(&s);
        CHECK_RELATIVE(m.mean[0], 100.0 / (i * i), 1e-4);
        CHECK_RELATIVE(m.mean[2], 10.0 / (i * i), 1e-4);
        fixture_finish(&s);
    }
}

TEST(directional_light_gives_its_illuminance_times_the_cosine)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.samples = 1;
    add_floor(&s, 5);
    fixture_light(&s, LIGHT_SUN, vec3_of(0, 1, 0), vec3_of(1, -1, 0), vec3_of(1000, 500, 200));
    struct layer_mean m = illuminance(&s);
    CHECK_RELATIVE(m.mean[0], 1000 * sqrt(0.5), 1e-5);
    CHECK_RELATIVE(m.mean[1], 500 * sqrt(0.5), 1e-5);
    fixture_finish(&s);
}

TEST(an_occluder_blocks_the_light)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.samples = 1;
    add_floor(&s, 5);
    fixture_light(&s, LIGHT_POINT, vec3_of(0, 4, 0), vec3_of(0, -1, 0), grey(100));
    // Single-sided, back face towards the light: occludes as well.
    fixture_quad(&s, vec3_of(-1, 3, -1), vec3_of(1, 3, -1), vec3_of(1, 3, 1), vec3_of(-1, 3, 1),
                 fixture_diffuse(&s, grey(1), grey(0)));
    struct layer_mean m = illuminance(&s);
    CHECK_NEAR(m.mean[1], 0, 0);
    fixture_finish(&s);
}

// Form factor of a right-angled corner of a parallel rectangle above the point (Howell, "A Catalog
// of Radiation Heat Transfer Configuration Factors", B-3): a, b: its sides over its height.
static double corner_factor(double a, double b)
{
    double p = sqrt(1 + a * a), q = sqrt(1 + b * b);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / (2 * PI);
}

TEST(rectangle_light_gives_its_closed_form_irradiance)
{
    static const float heights[] = { 0.2f, 1.0f, 4.0f };
    for (int i = 0; i < 3; i++) {
        struct trace_fixture s;
        fixture_init(&s);
        s.samples = 512;
        add_floor(&s, 8);
        float h = heights[i];
        fixture_quad(&s, vec3_of(-0.5f, h, -1), vec3_of(0.5f, h, -1), vec3_of(0.5f, h, 1),
                     vec3_of(-0.5f, h, 1), fixture_diffuse(&s, grey(0), vec3_of(5, 2, 1)));
        fixture_aim_camera(&s, vec3_of(0.3f, 0.1f, 0.1f), vec3_of(0, 0, 0), 0.01f);
        struct layer_mean m = illuminance(&s);
        double expected = 4 * corner_factor(0.5 / (double)h, 1.0 / (double)h) * PI;
        CHECK_NEAR(m.mean[1], 2 * expected, 3 * m.error + 2e-3 * expected);
        CHECK_RELATIVE(m.mean[0], 5 * expected, 0.005);
        fixture_finish(&s);
    }
}

// A disk of radius r centred at the height h: E = π L r² / (r² + h²).
TEST(disk_light_gives_its_closed_form_irradiance)
{
    static const float heights[] = { 0.5f, 1.0f, 3.0f };
    for (int i = 0; i < 3; i++) {
        struct trace_fixture s;
        fixture_init(&s);
        s.samples = 512;
        add_floor(&s, 8);
        double h = (double)heights[i];
        fixture_disk(&s, vec3_of(0, heights[i], 0), vec3_of(0, -1, 0), (float)PI, 360,
                     fixture_diffuse(&s, grey(0), grey(3)));
        struct layer_mean m = illuminance(&s);
        double expected = PI * 3 / (1 + h * h);
        CHECK_NEAR(m.mean[1], expected, 3 * m.error + 2e-3 * expected);
        CHECK_RELATIVE(m.mean[1], expected, 0.005);
        fixture_finish(&s);
    }
}

// Mean irradiance over the unit square y = 0 (x, z in 0…1), which fills the image.
static double mean_irradiance(struct trace_fixture *s)
{
    fixture_quad(s, vec3_of(0, 0, 1), vec3_of(1, 0, 1), vec3_of(1, 0, 0), vec3_of(0, 0, 0),
                 fixture_diffuse(s, grey(1), grey(0)));
    s->samples = 1024;
    s->options.antialias = true;
    s->options.bounces = 0;
    // 1/2 above the square with a field of view of 90 degrees, below the other square's edge.
    s->camera = (struct world_camera){ .eye = vec3_of(0.5f, 0.5f, 0.5f),
                                       .forward = vec3_of(0, -1, 0),
                                       .up = vec3_of(0, 0, -1),
                                       .vertical_fov_rad = (float)(PI / 2),
                                       .near_m = 0.01f };
    return fixture_mean(s, REFERENCE_DIRECT).mean[1] * PI;
}

// F between the unit squares: parallel at a distance of 1, 0.1998; at right angles with a common
// edge, 0.2000 (Howell, C-11 and C-14), to more digits from their formulas.
TEST(parallel_squares_have_their_form_factor)
{
    struct trace_fixture s;
    fixture_init(&s);
    fixture_quad(&s, vec3_of(0, 1, 0), vec3_of(1, 1, 0), vec3_of(1, 1, 1), vec3_of(0, 1, 1),
                 fixture_diffuse(&s, grey(0), grey(1)));
    double factor = 2 / PI * (log(2 / sqrt(3)) + 2 * sqrt(2) * atan(1 / sqrt(2)) - 2 * atan(1));
    CHECK_NEAR(factor, 0.1998, 5e-5);
    CHECK_RELATIVE(mean_irradiance(&s), PI * factor, 0.005);
    fixture_finish(&s);
}

TEST(perpendicular_squares_have_their_form_factor)
{
    struct trace_fixture s;
    fixture_init(&s);
    fixture_quad(&s, vec3_of(0, 0, 0), vec3_of(1, 0, 0), vec3_of(1, 1, 0), vec3_of(0, 1, 0),
                 fixture_diffuse(&s, grey(0), grey(1)));
    double factor =
        (2 * atan(1) - sqrt(2) * atan(1 / sqrt(2)) + 0.25 * log(4.0 / 3 * 3 / 4 * 3 / 4)) / PI;
    CHECK_NEAR(factor, 0.2000, 5e-5);
    CHECK_RELATIVE(mean_irradiance(&s), PI * factor, 0.005);
    fixture_finish(&s);
}
