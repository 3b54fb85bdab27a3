// Modular radiance transfer: the block, or none, that a surface takes its light from.
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"

#include <stdio.h>

enum { SIZE = 32 };

#define MAP "mrt-places.json"
#define DICTIONARY                                                                                 \
    "mrt:blocks=" MAP ",texels=8,rays=1024,modes=24,lightfield_positions=4,"                       \
    "lightfield_directions=6,lightfield_supersampling=1,lightfield_modes=16,"                      \
    "lightfield_rounds=0,response_modes=8,block_probes=2"

static void write_map(const char *blocks)
{
    FILE *file = fopen(MAP, "w");
    assert_non_null(file);
    fprintf(file, "{ \"afterglow_block_map\": 1, \"blocks\": [ %s ] }", blocks);
    fclose(file);
}

// Irradiance of the pixel in the middle after one frame; ends the fixture.
static vec3s middle_of(struct frame_fixture *s)
{
    fixture_open(s);
    struct gi *gi = gi_fixture_light(s, DICTIONARY);
    fixture_render(s);
    const vec3s out = fixture_pixel(s, READ_IRRADIANCE, SIZE / 2, SIZE / 2);
    gi_destroy(gi);
    fixture_finish(s);
    remove(MAP);
    return out;
}

// A closed house on a wide floor under a sky of this radiance.
static vec3s house(struct gpu *gpu, vec3s eye, vec3s target)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    const int grey = fixture_matte(&s, vec3_of(0.5f, 0.5f, 0.5f));
    fixture_floor(&s, 20, grey);
    fixture_box(&s, vec3_of(-2, 0.01f, -2), vec3_of(2, 3, 2), true, grey);
    fixture_box(&s, vec3_of(-2.2f, 0.01f, -2.2f), vec3_of(2.2f, 3.2f, 2.2f), false, grey);
    s.input.environment.sky = vec3_of(3, 2, 1);
    fixture_look(&s, eye, target);
    write_map("{ \"name\": \"room\", \"box\": [[-2, 0.01, -2], [2, 3, 2]] }");
    return middle_of(&s);
}

TEST_GPU(mrt_surfaces_outdoors_have_the_irradiance_of_the_sky)
{
    // Far from the house, and within an edge of the room.
    static const float at[] = { 12.0f, 4.5f };
    for (int i = 0; i < 2; i++) {
        const vec3s e = house(gpu, vec3_of(at[i], 2, 8), vec3_of(at[i], 0, 0.5f));
        print_message("%.1f m: %.3f %.3f %.3f\n", (double)at[i], (double)e.x, (double)e.y,
                      (double)e.z);
        for (int c = 0; c < 3; c++) {
            const double sky = 3.14159265 * (3 - c);
            CHECK((double)e.raw[c] > (i == 0 ? 0.97 : 0.8) * sky && (double)e.raw[c] < 1.05 * sky);
        }
    }
}

TEST_GPU(mrt_light_of_the_sky_does_not_leak_into_a_closed_room)
{
    const vec3s e = house(gpu, vec3_of(-1, 1.5f, 0), vec3_of(2, 1, 0.3f));
    for (int c = 0; c < 3; c++) CHECK_NEAR(e.raw[c], 0.0f, 1e-5f);
}

// Two rooms with a lamp in the first one. What separates them faces the first room and stands at
// x: 0 is where their blocks meet.
static float fold(struct gpu *gpu, float x)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    const int grey = fixture_matte(&s, vec3_of(0.5f, 0.5f, 0.5f));
    fixture_box(&s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, grey);
    fixture_quad(&s, vec3_of(x, 0, -2), vec3_of(x, 0, 2), vec3_of(x, 3, 2), vec3_of(x, 3, -2),
                 grey);
    fixture_quad(&s, vec3_of(x + 0.02f, 0, 2), vec3_of(x + 0.02f, 0, -2), vec3_of(x + 0.02f, 3, -2),
                 vec3_of(x + 0.02f, 3, 2), grey);
    fixture_add_point(&s, vec3_of(-1, 1.5f, 0.2f), vec3_of(100, 100, 100));
    fixture_look(&s, vec3_of(-1.8f, 1.5f, 0), vec3_of(0, 1.2f, 0.1f));
    write_map("{ \"name\": \"lit\", \"box\": [[-2, 0, -2], [0, 3, 2]] },"
              "{ \"name\": \"dark\", \"box\": [[0, 0, -2], [2, 3, 2]] }");
    return middle_of(&s).x;
}

TEST_GPU(mrt_surfaces_that_face_a_wall_nearby_have_the_light_beyond_it)
{
    const double plane = (double)fold(gpu, 0.0f), behind = (double)fold(gpu, 0.1f);
    print_message("at the plane %.3f, behind it %.3f\n", plane, behind);
    CHECK(plane > 1.0);
    CHECK_NEAR(behind / plane, 1.0, 0.2);
}
