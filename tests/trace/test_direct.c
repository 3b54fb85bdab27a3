// Direct light in closed form: inverse squares, rectangles, disks, form factors.
#include "trace/stage.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static vec3s grey(float v)
{
    return vec3_of(v, v, v);
}

static void add_floor(struct stage *s, float half)
{
    stage_quad(s, vec3_of(-half, 0, half), vec3_of(half, 0, half), vec3_of(half, 0, -half),
               vec3_of(-half, 0, -half), stage_matte(s, grey(1), grey(0)));
}

// The illuminance around the floor's origin: a white floor shows E/π. The camera sees a spot of a
// few millimetres.
static struct stage_mean illuminance(struct stage *s)
{
    stage_look(s, vec3_of(0.3f, 0.2f, 0.1f), vec3_of(0, 0, 0), 0.01f);
    struct stage_mean m = stage_mean(s, REFERENCE_DIRECT);
    for (int c = 0; c < 3; c++) m.mean[c] *= PI;
    m.error *= PI;
    return m;
}

TEST(point_light_falls_off_with_the_square_of_the_distance)
{
    for (int i = 1; i <= 4; i++) {
        struct stage s;
        stage_init(&s);
        s.samples = 1;
        add_floor(&s, 5);
        stage_light(&s, LIGHT_POINT, vec3_of(0, (float)i, 0), vec3_of(0, -1, 0),
                    vec3_of(100, 50, 10));
        struct stage_mean m = illuminance(&s);
        CHECK_RELATIVE(m.mean[0], 100.0 / (i * i), 1e-4);
        CHECK_RELATIVE(m.mean[2], 10.0 / (i * i), 1e-4);
        stage_finish(&s);
    }
}

TEST(sun_gives_its_lux_times_the_cosine)
{
    struct stage s;
    stage_init(&s);
    s.samples = 1;
    add_floor(&s, 5);
    stage_light(&s, LIGHT_SUN, vec3_of(0, 1, 0), vec3_of(1, -1, 0), vec3_of(1000, 500, 200));
    struct stage_mean m = illuminance(&s);
    CHECK_RELATIVE(m.mean[0], 1000 * sqrt(0.5), 1e-5);
    CHECK_RELATIVE(m.mean[1], 500 * sqrt(0.5), 1e-5);
    stage_finish(&s);
}

TEST(what_stands_between_takes_the_light_away)
{
    struct stage s;
    stage_init(&s);
    s.samples = 1;
    add_floor(&s, 5);
    stage_light(&s, LIGHT_POINT, vec3_of(0, 4, 0), vec3_of(0, -1, 0), grey(100));
    // Single-sided, and seen from behind by the light: it shades all the same.
    stage_quad(&s, vec3_of(-1, 3, -1), vec3_of(1, 3, -1), vec3_of(1, 3, 1), vec3_of(-1, 3, 1),
               stage_matte(&s, grey(1), grey(0)));
    struct stage_mean m = illuminance(&s);
    CHECK_NEAR(m.mean[1], 0, 0);
    stage_finish(&s);
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
        struct stage s;
        stage_init(&s);
        s.samples = 512;
        add_floor(&s, 8);
        float h = heights[i];
        stage_quad(&s, vec3_of(-0.5f, h, -1), vec3_of(0.5f, h, -1), vec3_of(0.5f, h, 1),
                   vec3_of(-0.5f, h, 1), stage_matte(&s, grey(0), vec3_of(5, 2, 1)));
        stage_look(&s, vec3_of(0.3f, 0.1f, 0.1f), vec3_of(0, 0, 0), 0.01f);
        struct stage_mean m = illuminance(&s);
        double expected = 4 * corner_factor(0.5 / (double)h, 1.0 / (double)h) * PI;
        CHECK_NEAR(m.mean[1], 2 * expected, 3 * m.error + 2e-3 * expected);
        CHECK_RELATIVE(m.mean[0], 5 * expected, 0.005);
        stage_finish(&s);
    }
}

// A disk of radius r at the height h straight above: E = π L r² / (r² + h²).
TEST(disk_light_gives_its_closed_form_irradiance)
{
    static const float heights[] = { 0.5f, 1.0f, 3.0f };
    for (int i = 0; i < 3; i++) {
        struct stage s;
        stage_init(&s);
        s.samples = 512;
        add_floor(&s, 8);
        double h = (double)heights[i];
        stage_disk(&s, vec3_of(0, heights[i], 0), vec3_of(0, -1, 0), (float)PI, 360,
                   stage_matte(&s, grey(0), grey(3)));
        struct stage_mean m = illuminance(&s);
        double expected = PI * 3 / (1 + h * h);
        CHECK_NEAR(m.mean[1], expected, 3 * m.error + 2e-3 * expected);
        CHECK_RELATIVE(m.mean[1], expected, 0.005);
        stage_finish(&s);
    }
}

// Mean irradiance over the unit square y = 0 (x, z in 0…1), seen whole and straight on by the
// camera.
static double mean_irradiance(struct stage *s)
{
    stage_quad(s, vec3_of(0, 0, 1), vec3_of(1, 0, 1), vec3_of(1, 0, 0), vec3_of(0, 0, 0),
               stage_matte(s, grey(1), grey(0)));
    s->samples = 1024;
    s->options.antialias = true;
    s->options.bounces = 0;
    // From 1/2 above, with a field of view of 90 degrees: the picture is the square. Below the
    // other square's edge.
    s->camera = (struct world_camera){ .eye = vec3_of(0.5f, 0.5f, 0.5f),
                                       .forward = vec3_of(0, -1, 0),
                                       .up = vec3_of(0, 0, -1),
                                       .vertical_fov_rad = (float)(PI / 2),
                                       .near_m = 0.01f };
    return stage_mean(s, REFERENCE_DIRECT).mean[1] * PI;
}

// F between the unit squares: parallel at a distance of 1, 0.1998; at right angles with a common
// edge, 0.2000 (Howell, C-11 and C-14), to more digits from their formulas.
TEST(parallel_squares_exchange_their_form_factor)
{
    struct stage s;
    stage_init(&s);
    stage_quad(&s, vec3_of(0, 1, 0), vec3_of(1, 1, 0), vec3_of(1, 1, 1), vec3_of(0, 1, 1),
               stage_matte(&s, grey(0), grey(1)));
    double factor = 2 / PI * (log(2 / sqrt(3)) + 2 * sqrt(2) * atan(1 / sqrt(2)) - 2 * atan(1));
    CHECK_NEAR(factor, 0.1998, 5e-5);
    CHECK_RELATIVE(mean_irradiance(&s), PI * factor, 0.005);
    stage_finish(&s);
}

TEST(perpendicular_squares_exchange_their_form_factor)
{
    struct stage s;
    stage_init(&s);
    stage_quad(&s, vec3_of(0, 0, 0), vec3_of(1, 0, 0), vec3_of(1, 1, 0), vec3_of(0, 1, 0),
               stage_matte(&s, grey(0), grey(1)));
    double factor =
        (2 * atan(1) - sqrt(2) * atan(1 / sqrt(2)) + 0.25 * log(4.0 / 3 * 3 / 4 * 3 / 4)) / PI;
    CHECK_NEAR(factor, 0.2000, 5e-5);
    CHECK_RELATIVE(mean_irradiance(&s), PI * factor, 0.005);
    stage_finish(&s);
}
