// The map of the environment in specular lobes of metal.
#include "scene/environment_fixture.h"
#include "techniques/gi_fixture.h"
#include "techniques/trials/light_trial_scenes.h"

#include <stdlib.h>

#define RADIOSITY "radiosity:texels=4096,rays=1024"
#define ORT       "ort:texels=1024,offsets=100,coordinates=charts,rays=1024"
#define ORT_ROOM  "ort:texels=4096,offsets=400,coordinates=charts"
#define PRT       "prt:texels=1024,rays=1024"
#define GLOSSY    PRT ",glossy=true"
#define COUNT(of) (sizeof(of) / sizeof *(of))

struct trial {
    const char *gi;
    double tolerance;
};

static int metal(struct frame_fixture *s, float roughness)
{
    struct material m = material_default();
    m.metallic = 1;
    m.roughness = roughness;
    return fixture_material(s, &m);
}

// A layer of one frame of a fixture that is not open.
static float *layer_of(struct frame_fixture *s, const char *text, enum frame_readback layer)
{
    fixture_open(s);
    struct gi *gi = gi_fixture_light(s, text);
    fixture_render(s);
    float *values = fixture_read(s, layer);
    gi_destroy(gi);
    return values;
}

static float *color_of(struct frame_fixture *s, const char *text)
{
    return layer_of(s, text, READ_COLOR);
}

static double mean_of(const float *color, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += (double)color[i];
    return sum / (double)count;
}

static vec3s uniform(vec3s d)
{
    (void)d;
    return vec3_of(3, 2, 1);
}

// Bands 0 and 1, of which 4 coefficients have all: red from +x, green from +y, blue from +z.
static vec3s gradient(vec3s d)
{
    return vec3_of(2 + 1.6f * d.x, 2 + 1.6f * d.y, 2 + 1.6f * d.z);
}

// Bright from above −x alone, dark elsewhere.
static vec3s window(vec3s d)
{
    const float bright = d.x < -0.3f && d.y > 0.2f ? 10.0f : 0.01f;
    return vec3_of(bright, bright, bright);
}

// ---- a plate that sees all of the sky

// Metal that fills the image.
static void plate(struct frame_fixture *s, struct gpu *gpu, const struct environment *environment)
{
    fixture_init(s, gpu);
    fixture_floor(s, 3, metal(s, 0.1f));
    fixture_look(s, vec3_of(1, 2, 1.5f), vec3_of(0, 0, 0));
    s->input.camera.vertical_fov_rad = 0.7f;
    s->input.environment = *environment;
}

// Lobes of this roughness have a deviation of 0.01, over which the map hardly changes. Light maps
// have the noise of their vectors besides, in which oblique rays weigh 1 / cos θ: less than 0.1 of
// the mean with 1024 rays.
TEST_GPU(a_polished_plate_shows_the_map)
{
    static const struct trial cases[] = { { "vct:quality=high", 0.01 },
                                          { "ambient", 0.01 },
                                          { RADIOSITY, 0.1 },
                                          { ORT, 0.1 },
                                          { PRT, 0.1 },
                                          { GLOSSY, 0.1 } };
    const struct environment e = { .map = fixture_map(128, gradient),
                                   .strength = 2,
                                   .rotation_rad = 1.2f };
    for (size_t k = 0; k < COUNT(cases); k++) {
        struct frame_fixture s;
        double squares = 0, sum = 0, expected_sum = 0;
        plate(&s, gpu, &e);
        float *color = color_of(&s, cases[k].gi);
        for (uint32_t i = 0; i < s.width * s.height; i++) {
            const vec3s d = glms_vec3_normalize(
                fixture_ray(&s, (float)(i % s.width) + 0.5f, (float)(i / s.width) + 0.5f));
            const vec3s expected = environment_radiance(&e, vec3_of(d.x, -d.y, d.z));
            for (uint32_t c = 0; c < 3; c++) {
                const double got = (double)color[3 * i + c];
                squares += (got - (double)expected.raw[c]) * (got - (double)expected.raw[c]);
                sum += got;
                expected_sum += (double)expected.raw[c];
            }
        }
        const double deviation = sqrt(squares / (3.0 * s.width * s.height)) / 4;
        print_message("%s: plate %.4f of the map, deviation %.4f of its mean\n", cases[k].gi,
                      sum / expected_sum, deviation);
        CHECK_RELATIVE(sum, expected_sum, 0.04);
        CHECK(deviation < cases[k].tolerance);
        free(color);
        fixture_finish(&s);
    }
    environment_map_release(e.map);
}

// ---- metal beside others

// A metal box on a floor, of which some lobes see the other.
static float *box_on_floor(struct gpu *gpu, const char *gi, const struct environment *environment,
                           size_t *count)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    fixture_floor(&s, 3, metal(&s, 0.4f));
    fixture_box(&s, vec3_of(-1, 0, -1), vec3_of(1, 2, 1), false, metal(&s, 0.2f));
    fixture_look(&s, vec3_of(3, 4, 4), vec3_of(0, 0.8f, 0));
    s.input.camera.vertical_fov_rad = 0.6f;
    s.input.environment = *environment;
    float *color = color_of(&s, gi);
    *count = (size_t)3 * s.width * s.height;
    fixture_finish(&s);
    return color;
}

// Values are half floats, of which several are rounded.
TEST_GPU(a_uniform_map_is_mirrored_as_a_uniform_sky)
{
    static const char *const cases[] = { RADIOSITY, ORT, PRT, GLOSSY };
    const struct environment map = { .map = fixture_map(32, uniform), .strength = 1 };
    const struct environment sky = { .sky = uniform(vec3_of(0, 1, 0)) };
    for (size_t k = 0; k < COUNT(cases); k++) {
        size_t count;
        double most = 0;
        float *a = box_on_floor(gpu, cases[k], &map, &count);
        float *b = box_on_floor(gpu, cases[k], &sky, &count);
        const double mean = mean_of(b, count);
        for (size_t i = 0; i < count; i++)
            most = fmax(most, fabs((double)a[i] - (double)b[i]) / mean);
        print_message("%s: uniform map against sky: %.6f, pixels at most %.5f\n", cases[k],
                      mean_of(a, count) / mean, most);
        CHECK(mean > 0.5);
        CHECK_RELATIVE(mean_of(a, count), mean, 1e-3);
        CHECK(most < 4e-3);
        free(a);
        free(b);
    }
    environment_map_release(map.map);
}

// A metal floor that mirrors the window of a dark sky, or a black wall before it.
static double floor_beside(struct gpu *gpu, const char *gi, bool wall,
                           const struct environment *environment)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    fixture_floor(&s, 1, metal(&s, 0.2f));
    if (wall)
        fixture_box(&s, vec3_of(-1.2f, 0, -8), vec3_of(-1, 8, 8), false,
                    fixture_matte(&s, vec3_of(0, 0, 0)));
    fixture_look(&s, vec3_of(1.5f, 1, 0), vec3_of(0, 0, 0));
    s.input.camera.vertical_fov_rad = 0.4f;
    s.input.environment = *environment;
    float *color = color_of(&s, gi);
    const double mean = mean_of(color, (size_t)3 * s.width * s.height);
    free(color);
    fixture_finish(&s);
    return mean;
}

// The mirror direction of each pixel is up to 45° above −x: the window, or the wall, which is at
// least 80° high there.
TEST_GPU(a_wall_hides_the_map_from_a_metal_floor)
{
    static const struct trial cases[] = {
        { "vct:quality=high", 0.1 }, { RADIOSITY, 0.1 }, { ORT, 0.1 }, { PRT, 0.1 }, { GLOSSY, 0.1 }
    };
    const struct environment e = { .map = fixture_map(128, window), .strength = 1 };
    for (size_t k = 0; k < COUNT(cases); k++) {
        const double open = floor_beside(gpu, cases[k].gi, false, &e);
        const double hidden = floor_beside(gpu, cases[k].gi, true, &e);
        print_message("%s: floor %.3f cd/m2, %.4f of it beside a wall\n", cases[k].gi, open,
                      hidden / open);
        CHECK_RELATIVE(open, 10, 0.15);
        CHECK(hidden < cases[k].tolerance * open);
    }
    environment_map_release(e.map);
}

// ---- darkness

// A room without a roof and one with, each with a metal box on the floor.
static double room_radiance(struct gpu *gpu, const char *gi, bool dark,
                            const struct environment *environment)
{
    struct frame_fixture s;
    trial_two_rooms(&s, gpu, dark);
    const int material = metal(&s, 0.2f);
    fixture_box(&s, vec3_of(0.8f, 0.2f, -1.5f), vec3_of(1.8f, 1.2f, -0.5f), false, material);
    fixture_box(&s, vec3_of(-1.8f, 0.2f, -1.5f), vec3_of(-0.8f, 1.2f, -0.5f), false, material);
    s.input.light_count = 0;
    s.input.environment = *environment;
    float *specular = layer_of(&s, gi, READ_SPECULAR);
    const double mean = mean_of(specular, (size_t)3 * s.width * s.height);
    free(specular);
    fixture_finish(&s);
    return mean;
}

// Light maps and cones leak some light at edges: a map's no more than a uniform sky's.
TEST_GPU(metal_in_a_closed_room_stays_dark)
{
    static const char *const cases[] = { "vct:quality=high", RADIOSITY, ORT_ROOM, PRT, GLOSSY };
    const struct environment sky = { .sky = vec3_of(2000, 2000, 2000) };
    const struct environment map = { .map = fixture_map(64, gradient), .strength = 1000 };
    for (size_t k = 0; k < COUNT(cases); k++) {
        const double open = room_radiance(gpu, cases[k], false, &map);
        const double dark = room_radiance(gpu, cases[k], true, &map) / open;
        const double leaks =
            room_radiance(gpu, cases[k], true, &sky) / room_radiance(gpu, cases[k], false, &sky);
        print_message("%s: closed room %.5f of the open one (%.0f cd/m2), under a sky %.5f\n",
                      cases[k], dark, open, leaks);
        CHECK(open > 10 && dark <= 1.1 * leaks + 1e-3);
    }
    environment_map_release(map.map);
}
