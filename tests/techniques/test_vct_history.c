// History of cone tracing after a change of light: error of each frame against the settled image,
// the mean of 200 later frames.
#include "techniques/vct_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A room 11 m wide with a block, a red box and a point light. Returns the box.
static int make_scene(struct vct_fixture *fixture, struct gpu *gpu)
{
    vct_fixture_init(fixture, gpu);
    struct frame_fixture *s = &fixture->frame_fixture;
    s->width = s->height = 64;
    fixture_box(s, vec3_of(0.3f, 0.2f, 0.4f), vec3_of(11.2f, 9.1f, 10.7f), true,
                fixture_matte(s, vec3_of(0.7f, 0.5f, 0.3f)));
    fixture_box(s, vec3_of(8, 0.2f, 3), vec3_of(10, 4, 6), false,
                fixture_matte(s, vec3_of(0.2f, 0.5f, 0.8f)));
    const int first = s->scene->instance_count;
    fixture_box(s, vec3_of(4, 0.2f, 2), vec3_of(5.5f, 3, 3.5f), false,
                fixture_matte(s, vec3_of(0.8f, 0.1f, 0.1f)));
    fixture_add_point(s, vec3_of(3, 7, 5), vec3_of(300, 500, 200));
    fixture_look(s, vec3_of(1, 6, 9), vec3_of(8, 2, 3));
    return first;
}

static void move_box(struct vct_fixture *fixture, int first, vec3s by)
{
    struct frame_fixture *s = &fixture->frame_fixture;
    for (int i = first; i < first + 6; i++)
        for (int k = 0; k < 3; k++)
            s->pose.world_from_node[s->scene->instances[i].node].raw[3][k] += by.raw[k];
}

static float *irradiance_after(struct vct_fixture *fixture, int frames)
{
    for (int i = 0; i < frames; i++) fixture_render(&fixture->frame_fixture);
    return fixture_read(&fixture->frame_fixture, READ_IRRADIANCE);
}

static double error_of(const float *a, const float *b, size_t count)
{
    double d = 0.0, sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        d += fabs((double)a[i] - (double)b[i]);
        sum += (double)b[i];
    }
    return d / sum;
}

enum change { LIGHT_MOVES, BOX_MOVES, LIGHT_JUMPS };

// Ten frames of motion, the last one of which is not rendered; or one jump.
static void change_scene(struct vct_fixture *fixture, int box, enum change change)
{
    struct frame_fixture *s = &fixture->frame_fixture;
    const int steps = change == LIGHT_JUMPS ? 1 : 10;
    for (int i = 0; i < steps; i++) {
        if (i > 0) fixture_render(s);
        if (change == BOX_MOVES)
            move_box(fixture, box, vec3_of(-0.15f, 0.3f, 0.2f));
        else
            s->lights[0].position.x += change == LIGHT_MOVES ? 0.4f : 4.0f;
    }
}

// Prints the error of the frames after the change, and returns that of the fourth.
static double error_after(struct gpu *gpu, const char *options, enum change change)
{
    static const char *const names[] = { "a moving light", "a moving box", "a jump of the light" };
    enum { BEFORE = 40, SHOWN = 8, SETTLED = 200 };
    struct vct_fixture fixture;
    const int box = make_scene(&fixture, gpu);
    vct_fixture_open(&fixture, options);
    const size_t count = (size_t)fixture.frame_fixture.width * fixture.frame_fixture.height * 3;
    float *e[SHOWN], *before = irradiance_after(&fixture, BEFORE);
    change_scene(&fixture, box, change);
    for (int i = 0; i < SHOWN; i++) e[i] = irradiance_after(&fixture, 1);
    float *settled = irradiance_after(&fixture, SETTLED);
    const double changed = error_of(before, settled, count),
                 fourth = error_of(e[3], settled, count);
    print_message("%s: %s by %.1f %%; then", options, names[change], 100.0 * changed);
    for (int i = 0; i < SHOWN; i++) {
        print_message(" %.2f", 100.0 * error_of(e[i], settled, count));
        free(e[i]);
    }
    print_message(" %%\n");
    CHECK(changed > 5.0 * fourth); // without a change the test is void
    free(before), free(settled);
    vct_fixture_finish(&fixture);
    return fourth;
}

TEST_GPU(history_follows_a_change_within_four_frames)
{
    static const char *const options[] = { "resolution=32,temporal=true",
                                           "resolution=128,temporal=true" };
    for (int i = 0; i < 2; i++)
        for (enum change change = LIGHT_MOVES; change <= LIGHT_JUMPS; change++)
            CHECK(error_after(gpu, options[i], change) <= 0.02);
}
