// A thin board before a wall: bitmasks let light pass behind it, horizons do not.
#include "techniques/gtao/gtao_fixture.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT };

static const float GAP_M = 0.3f, HALF_M = 0.3f, RADIUS_M = 1.0f, WALL_M = -4.0f;

// The direction has z away from the wall.
static bool passes_board(vec3s direction, const void *user)
{
    const vec3s *from = user;
    const float t = GAP_M / direction.z;
    return t > RADIUS_M || fabsf(from->x + t * direction.x) > HALF_M ||
           fabsf(from->y + t * direction.y) > HALF_M;
}

struct difference {
    double mean, expected; // of visibility
};

// On the wall, up to 0.6 m from the board's middle.
static struct difference around_board(struct frame_fixture *s, const char *options)
{
    float *v = gtao_visibility(s, options), *at = fixture_read(s, READ_POSITION);
    struct difference out = { 0.0, 0.0 };
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
        const vec3s from = vec3_of(at[3 * i], at[3 * i + 1], at[3 * i + 2]);
        if (from.z > WALL_M + 0.1f || fabsf(from.x) > 0.6f || fabsf(from.y) > 0.6f) continue;
        const double expected = gtao_share(passes_board, &from);
        out.expected += expected;
        out.mean += (double)v[i] - expected;
        count++;
    }
    CHECK(count > 100);
    out.mean /= count;
    out.expected /= count;
    print_message("%s: %.3f expected, mean difference %+.4f\n", options, out.expected, out.mean);
    free(v);
    free(at);
    return out;
}

TEST_GPU(light_passes_behind_a_thin_board_with_bitmasks_alone)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    s.width = WIDTH;
    s.height = HEIGHT;
    const int matte = fixture_matte(&s, vec3_of(0.5f, 0.5f, 0.5f));
    const float board_m = WALL_M + GAP_M;
    fixture_quad(&s, vec3_of(-30, -30, WALL_M), vec3_of(30, -30, WALL_M), vec3_of(30, 30, WALL_M),
                 vec3_of(-30, 30, WALL_M), matte);
    fixture_quad(&s, vec3_of(-HALF_M, -HALF_M, board_m), vec3_of(HALF_M, -HALF_M, board_m),
                 vec3_of(HALF_M, HALF_M, board_m), vec3_of(-HALF_M, HALF_M, board_m), matte);
    fixture_look(&s, vec3_of(0, 0, 0), vec3_of(0, 0, -1));
    s.input.camera.vertical_fov_rad = 0.5f;
    fixture_open(&s);
#define MANY "radius=1,reach=1,falloff=0,slices=16,steps=64"
    const struct difference horizons = around_board(&s, MANY);
    const struct difference thin = around_board(&s, MANY ",bitmask=true,thickness=0.05");
    const struct difference thick = around_board(&s, MANY ",bitmask=true,thickness=100");
    // Horizons close the wall behind the board, half of what the board does; samples 0.03 m apart
    // leave no gaps in sheets of 0.05 m.
    CHECK(horizons.expected < 0.9 && horizons.mean < -0.3 * (1.0 - horizons.expected));
    CHECK(fabs(thin.mean) < 0.1 * (1.0 - thin.expected));
    CHECK(fabs(thick.mean - horizons.mean) < 0.1 * (1.0 - thin.expected));
    fixture_finish(&s);
}
