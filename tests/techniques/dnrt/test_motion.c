// Objects that move: their effect has no steps in time, and follows from their shape alone.
#include "techniques/baked_fixture.h"
#include "techniques/dnrt/sphere_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SOURCE "lpv:geometry=off,dim=16,cascades=1,bounces=0,probes=true"
enum { PIXELS = 64, BALLS = 2 };
static const float RADIUS = 0.3f;

struct moving_scene {
    struct frame_fixture fixture;
    struct baked_fixture run;
    int node[BALLS];
};

// A spot that no ball shadows, so that the source's light does not depend on them.
static void add_spot(struct frame_fixture *s)
{
    fixture_add_spot(s, vec3_of(-2.2f, 2.5f, 0.5f), vec3_of(0, -1, 0), 0.3f, 0.45f,
                     vec3_of(9000, 9000, 9000));
}

static void add_sun(struct frame_fixture *s)
{
    fixture_add_sun(s, vec3_of(0.3f, -1, -0.6f), vec3_of(1000, 1000, 1000));
}

// Spots whose light on floor and wall no ball of the path shadows: the reflective shadow map of a
// lamp loses texels to the shadow of an object, and the source's light has steps. One lights the
// top of the wall, the other, from the foot of the wall upwards, the ball alone.
static void add_spots_of_path(struct frame_fixture *s)
{
    fixture_add_spot(s, vec3_of(0, 2.9f, 1), glms_vec3_normalize(vec3_of(0, -0.3f, -1)), 0.2f, 0.3f,
                     vec3_of(9e5f, 9e5f, 9e5f));
    fixture_add_spot(s, vec3_of(0.3f, 0.1f, -1.1f), glms_vec3_normalize(vec3_of(0, 0.5f, 1)), 0.2f,
                     0.45f, vec3_of(900, 900, 900));
}

// A floor and a wall, and the balls that have a bit in `balls`.
static void open_scene(struct moving_scene *m, struct gpu *gpu, const char *gi, unsigned balls,
                       void (*add_light)(struct frame_fixture *))
{
    static const vec3s centre[BALLS] = { { { -0.4f, 0.6f, 0 } }, { { 0.5f, 0.7f, -0.5f } } };
    struct frame_fixture *s = &m->fixture;
    fixture_init(s, gpu);
    s->width = s->height = PIXELS;
    fixture_floor(s, 3, fixture_matte(s, vec3_of(0.7f, 0.7f, 0.7f)));
    fixture_quad(s, vec3_of(-3, 0, -1.2f), vec3_of(3, 0, -1.2f), vec3_of(3, 3, -1.2f),
                 vec3_of(-3, 3, -1.2f), fixture_matte(s, vec3_of(0.8f, 0.1f, 0.1f)));
    const int mesh = sphere_fixture_add(s->scene, fixture_matte(s, vec3_of(0.2f, 0.4f, 0.9f)));
    for (int b = 0; b < BALLS; b++) {
        struct node node = node_default();
        node.translation = centre[b];
        node.scale = vec3_of(RADIUS, RADIUS, RADIUS);
        if (!(balls >> b & 1)) continue;
        const int instance = fixture_instance(s, mesh, &node);
        s->scene->instances[instance].movable = true;
        m->node[b] = s->scene->instances[instance].node;
    }
    add_light(s);
    fixture_look(s, vec3_of(0, 2.0f, 2.6f), vec3_of(0, 0.3f, -0.6f));
    s->input.want_id_layer = true;
    baked_fixture_open(&m->run, s, gi);
    s->indirect.needs |= FRAME_LEAVES_DYNAMIC; // also of a source alone
    fixture_render(s);
}

static void close_scene(struct moving_scene *m)
{
    baked_fixture_close(&m->run, &m->fixture);
}

struct pixels {
    float *irradiance, *id;
};

static struct pixels read_pixels(struct moving_scene *m)
{
    return (struct pixels){ fixture_read(&m->fixture, READ_IRRADIANCE),
                            fixture_read(&m->fixture, READ_ID) };
}

static void free_pixels(struct pixels *p)
{
    free(p->irradiance);
    free(p->id);
}

static vec3s at(const struct pixels *p, int i)
{
    return vec3_of(p->irradiance[3 * i], p->irradiance[3 * i + 1], p->irradiance[3 * i + 2]);
}

// Whether a pixel is of the floor or the wall, the first two instances.
static bool is_ground(const struct pixels *p, int i)
{
    return p->id[2 * i] == 0 || p->id[2 * i] == 1;
}

// Changes of pixels that show the ground in both frames.
struct step {
    double most, mean;
};

static struct step step_between(const struct pixels *a, const struct pixels *b)
{
    struct step step = { 0 };
    int count = 0;
    for (int i = 0; i < PIXELS * PIXELS; i++) {
        if (!is_ground(a, i) || !is_ground(b, i)) continue;
        const double d = (double)glms_vec3_distance(at(a, i), at(b, i));
        step.most = fmax(step.most, d);
        step.mean += d;
        count++;
    }
    step.mean /= count;
    return step;
}

// ---- a path

// From where no pixel changes, past the camera, to where none does.
static struct step largest_step(struct moving_scene *m, int frames)
{
    struct step largest = { 0 };
    struct pixels before = { NULL, NULL };
    mat4s *ball = &m->fixture.pose.world_from_node[m->node[0]];
    for (int f = 0; f <= frames; f++) {
        const float along = (float)f / (float)frames;
        ball->col[3] = vec4_of(
            vec3_of(-4.0f + 8.0f * along, 0.65f + 0.25f * sinf(7.0f * along), 1.0f - 1.7f * along),
            1);
        fixture_render(&m->fixture);
        struct pixels now = read_pixels(m);
        if (f > 0) {
            const struct step step = step_between(&before, &now);
            largest.most = fmax(largest.most, step.most);
            largest.mean += step.mean / frames;
            free_pixels(&before);
        }
        before = now;
    }
    free_pixels(&before);
    return largest;
}

// An effect that began or ended with a step would have the same largest change for any length of a
// frame's way. A smooth one has half the change over half the way, but for its curvature within a
// frame and the rounding of two half floats.
static void check_path(struct gpu *gpu, const char *gi)
{
    struct moving_scene m;
    open_scene(&m, gpu, gi, 1, add_spots_of_path);
    const struct step half = largest_step(&m, 50), full = largest_step(&m, 100);
    print_message("%s: largest step of a pixel %.3g lux in 100 frames, %.3g in 50; mean %.3g\n",
                  strrchr(gi, '+') + 1, full.most, half.most, full.mean);
    CHECK(half.most > 1);
    CHECK(full.most < 0.6 * half.most);
    close_scene(&m);
}

TEST_GPU(an_objects_effect_has_no_steps_along_a_path)
{
    check_path(gpu, SOURCE "+dnrt:size=16,rays=64");
    check_path(gpu, SOURCE "+dnrt:size=16,rays=64,direct=true");
}

// ---- a turn

static double largest_change(const struct pixels *a, const struct pixels *b)
{
    return step_between(a, b).most;
}

// A sphere that turns about an axis is the same object, but its volume is a cube, and turns. With h
// the half edge of the inner volume, V ∝ 1/d² and the fall-off (h²/d² − 1/4)/(3/4), an eighth of a
// turn changes a point at d along an axis by at most V(h)/6: at √2 h it is on the border of the
// inner volume, V/2, or in the outer one, V/3; at 2 h in the outer one, V/6, or on its border. The
// nearest points of this scene are at h, and have the largest change.
TEST_GPU(a_sphere_that_turns_about_its_centre_changes_little)
{
    struct moving_scene without, with;
    open_scene(&without, gpu, SOURCE, 1, add_sun);
    struct pixels source = read_pixels(&without);
    close_scene(&without);
    open_scene(&with, gpu, SOURCE "+dnrt:size=16,rays=1024", 1, add_sun);
    struct pixels first = read_pixels(&with);
    const double most = largest_change(&source, &first);
    mat4s *ball = &with.fixture.pose.world_from_node[with.node[0]];
    const mat4s before = *ball;
    double quarter = 0, any = 0;
    for (int i = 1; i <= 8; i++) {
        *ball = glms_mat4_mul(before, glms_rotate_make(GLM_PI_4f * (float)i, vec3_of(0, 1, 0)));
        fixture_render(&with.fixture);
        struct pixels now = read_pixels(&with);
        double *worst = i % 2 ? &any : &quarter;
        *worst = fmax(*worst, largest_change(&first, &now) / most);
        free_pixels(&now);
    }
    print_message("a sphere that turns: %.4f of its largest change, %.4f by quarter turns\n", any,
                  quarter);
    CHECK(most > 5);
    CHECK(quarter < 0.02);
    CHECK(any < 1.0 / 6.0);
    close_scene(&with);
    free_pixels(&source);
    free_pixels(&first);
}

// ---- sums

static struct pixels pixels_of(struct gpu *gpu, const char *gi, unsigned balls)
{
    struct moving_scene m;
    open_scene(&m, gpu, gi, balls, add_spot);
    const struct pixels p = read_pixels(&m);
    close_scene(&m);
    return p;
}

static bool is_dark(const struct pixels *p, int i)
{
    return glms_vec3_min(at(p, i)) <= 0.0f;
}

static const double DIM = 1; // lux: half floats of less have fewer digits

// The sum is that of the changes, each of which is rounded with its irradiance to half floats. If
// they remove more light than there is, it ends at 0.
TEST_GPU(two_objects_are_the_sum_of_each_alone)
{
    static const char *const gi = SOURCE "+dnrt:size=16,rays=64";
    struct pixels none = pixels_of(gpu, SOURCE, 3), both = pixels_of(gpu, gi, 3);
    struct pixels one = pixels_of(gpu, gi, 1), two = pixels_of(gpu, gi, 2);
    double most = 0, worst = 0;
    for (int i = 0; i < PIXELS * PIXELS; i++) {
        if (!is_ground(&both, i) || is_dark(&one, i) || is_dark(&two, i) || is_dark(&both, i))
            continue;
        const vec3s source = at(&none, i), sum = glms_vec3_add(at(&one, i), at(&two, i));
        const vec3s expected = glms_vec3_sub(sum, source);
        const double size = (double)glms_vec3_norm(sum) + (double)glms_vec3_norm(source) + DIM;
        most = fmax(most, (double)glms_vec3_distance(expected, source));
        worst = fmax(worst, (double)glms_vec3_distance(at(&both, i), expected) / size);
    }
    print_message("two objects: largest change %.3g lux, error %.2g of the irradiances\n", most,
                  worst);
    CHECK(most > 5);
    CHECK(worst < 0x1p-10);
    free_pixels(&none);
    free_pixels(&both);
    free_pixels(&one);
    free_pixels(&two);
}
