// intrusion=shadow: occluders between an object and a receiver, against the part of the object's
// disk that the receiver sees.
#include "techniques/baked_fixture.h"
#include "techniques/dnrt/sphere_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SOURCE "lpv:geometry=off,dim=16,cascades=1,bounces=0,probes=true"
#define DNRT   "+dnrt:size=16,rays=64"
enum { PIXELS = 96, MAP_SIZE = 64 };
static const float RADIUS = 0.4f;
static const vec3s CENTRE = { { 0, 0.8f, 0 } };

struct wall_scene {
    struct frame_fixture fixture;
    struct baked_fixture run;
    int ball; // node
};

static void add_ball(struct wall_scene *w)
{
    struct frame_fixture *s = &w->fixture;
    struct node node = node_default();
    node.translation = CENTRE;
    node.scale = vec3_of(RADIUS, RADIUS, RADIUS);
    const int mesh = sphere_fixture_add(s->scene, fixture_matte(s, vec3_of(0.02f, 0.02f, 0.02f)));
    const int instance = fixture_instance(s, mesh, &node);
    s->scene->instances[instance].movable = true;
    w->ball = s->scene->instances[instance].node;
}

static void start(struct wall_scene *w, struct gpu *gpu)
{
    struct frame_fixture *s = &w->fixture;
    fixture_init(s, gpu);
    s->width = s->height = PIXELS;
    fixture_add_sun(s, vec3_of(0.3f, -1, -0.2f), vec3_of(1000, 1000, 1000));
    add_ball(w);
}

static void finish(struct wall_scene *w, const char *gi)
{
    struct frame_fixture *s = &w->fixture;
    baked_fixture_open(&w->run, s, gi);
    s->indirect.needs |= FRAME_LEAVES_DYNAMIC; // also of a source alone
    fixture_render(s);
}

static void close_scene(struct wall_scene *w)
{
    baked_fixture_close(&w->run, &w->fixture);
}

static vec3s at(const float *image, int pixel)
{
    return vec3_of(image[3 * pixel], image[3 * pixel + 1], image[3 * pixel + 2]);
}

// Runs of the same scene: without dnrt, with it, and with intrusion=shadow.
enum { BEFORE, OFF, SHADOW, RUNS };
struct runs {
    float *irradiance[RUNS], *position;
};

static struct runs render_runs(struct gpu *gpu, void (*open)(struct wall_scene *, float),
                               float parameter)
{
    static const char *const gi[RUNS] = { SOURCE, SOURCE DNRT ",intrusion=off",
                                          SOURCE DNRT ",intrusion=shadow" };
    struct runs runs;
    for (int r = 0; r < RUNS; r++) {
        struct wall_scene w;
        start(&w, gpu);
        open(&w, parameter);
        finish(&w, gi[r]);
        runs.irradiance[r] = fixture_read(&w.fixture, READ_IRRADIANCE);
        if (r == 0) runs.position = fixture_read(&w.fixture, READ_POSITION);
        close_scene(&w);
    }
    return runs;
}

static void free_runs(struct runs *runs)
{
    for (int r = 0; r < RUNS; r++) free(runs->irradiance[r]);
    free(runs->position);
}

static double change(const struct runs *runs, int run, int pixel)
{
    return (double)glms_vec3_distance(at(runs->irradiance[run], pixel),
                                      at(runs->irradiance[BEFORE], pixel));
}

// ---- a wall between the object and half of a floor

static const float WALL = 0.5f, THICKNESS = 0.04f;

static void open_wall(struct wall_scene *w, float unused)
{
    struct frame_fixture *s = &w->fixture;
    const int white = fixture_matte(s, vec3_of(0.7f, 0.7f, 0.7f));
    (void)unused;
    fixture_floor(s, 3, white);
    fixture_box(s, vec3_of(WALL, -1, -3), vec3_of(WALL + THICKNESS, 3, 3), false, white);
    fixture_look(s, vec3_of(2.6f, 1.6f, 0.8f), vec3_of(0.9f, 0, 0));
}

// Samples of the filter look from the object. Of points whose penumbra contains the wall's foot a
// few pass below the rays that they stand for, and meet the floor before the wall.
enum { FILTER_TAPS = 16, LEAKING_TAPS = 3 };
static const float FOOT = 0.25f;         // m from the wall
static const double HALF_STEP = 0x1p-10; // rounding of two irradiances, over the larger one

TEST_GPU(a_wall_keeps_an_object_from_changing_its_other_side)
{
    struct runs runs = render_runs(gpu, open_wall, 0);
    double most = 0, share = 0;
    int changed = 0, beyond = 0;
    for (int i = 0; i < PIXELS * PIXELS; i++) {
        const vec3s p = at(runs.position, i);
        if (p.x < WALL + THICKNESS + 1e-3f || fabsf(p.z) > 2 || fabsf(p.y) > 1e-3f) continue;
        const double off = change(&runs, OFF, i), shadow = change(&runs, SHADOW, i);
        const double rounding = HALF_STEP * (double)glms_vec3_norm(at(runs.irradiance[BEFORE], i));
        beyond++;
        most = fmax(most, off);
        changed += off > 0.0;
        if (p.x > WALL + THICKNESS + FOOT) CHECK(shadow == 0);
        share = fmax(share, (shadow - rounding) / (off + rounding));
    }
    print_message(
        "floor beyond the wall, %d pixels: off changes %d by up to %.3g lux, shadow by at "
        "most %.3f of it, 0 beyond %.2f m\n",
        beyond, changed, most, share, (double)FOOT);
    CHECK(changed > 200 && most > 1);
    CHECK(share < (double)LEAKING_TAPS / FILTER_TAPS);
    free_runs(&runs);
}

// ---- the edge of a panel between the object and a wall

static const float PANEL = 0.8f;

// Seen through the panel, whose back faces the camera.
static void open_panel(struct wall_scene *w, float distance)
{
    struct frame_fixture *s = &w->fixture;
    const int white = fixture_matte(s, vec3_of(0.7f, 0.7f, 0.7f));
    fixture_quad(s, vec3_of(distance, -1.2f, -2), vec3_of(distance, -1.2f, 2),
                 vec3_of(distance, 2.8f, 2), vec3_of(distance, 2.8f, -2), white);
    fixture_quad(s, vec3_of(PANEL, -1.2f, 0), vec3_of(PANEL, -1.2f, -4), vec3_of(PANEL, 2.8f, -4),
                 vec3_of(PANEL, 2.8f, 0), white);
    fixture_look(s, vec3_of(-2, 2.4f, 0), vec3_of(distance, 0.8f, 0));
}

// The part of the disk of the bounding sphere that a point of the wall sees past the panel.
static double seen_part(vec3s p)
{
    enum { STEPS = 64 };
    vec3s a, b;
    int seen = 0, count = 0;
    basis_of(glms_vec3_normalize(glms_vec3_sub(p, CENTRE)), &a, &b);
    for (int y = 0; y < STEPS; y++)
        for (int x = 0; x < STEPS; x++) {
            const float u = (2.0f * ((float)x + 0.5f) / STEPS - 1.0f) * RADIUS;
            const float v = (2.0f * ((float)y + 0.5f) / STEPS - 1.0f) * RADIUS;
            if (u * u + v * v > RADIUS * RADIUS) continue;
            const vec3s q = glms_vec3_muladds(a, u, glms_vec3_muladds(b, v, CENTRE));
            const float share = (p.x - PANEL) / (p.x - q.x);
            seen += p.z + (q.z - p.z) * share > 0.0f;
            count++;
        }
    return (double)seen / count;
}

struct edge {
    double mean_error, worst;
    double width; // m
    int count;
};

static struct edge edge_at(struct gpu *gpu, float distance)
{
    struct runs runs = render_runs(gpu, open_panel, distance);
    struct edge edge = { 0 };
    int soft = 0;
    for (int i = 0; i < PIXELS * PIXELS; i++) {
        const vec3s p = at(runs.position, i);
        const double off = change(&runs, OFF, i);
        if (fabsf(p.x - distance) > 1e-3f || fabsf(p.y - CENTRE.y) > 0.3f || fabsf(p.z) > 0.6f)
            continue;
        CHECK(off > 0.05);
        const double seen = change(&runs, SHADOW, i) / off, error = fabs(seen - seen_part(p));
        edge.mean_error += error;
        edge.worst = fmax(edge.worst, error);
        soft += seen > 0.02 && seen < 0.98;
        edge.count++;
    }
    edge.mean_error /= edge.count;
    edge.width = 1.2 * soft / edge.count;
    free_runs(&runs);
    return edge;
}

// At the panel's distance z and the wall's d the penumbra is 2 R (d − z)/z wide, R (1/z − 1/d) of
// which is its radius as a tangent at the object. Two samples of the filter, and half a texel of
// the map, may be on the wrong side of the edge.
TEST_GPU(edges_are_as_soft_as_the_object_is_large)
{
    static const float distances[] = { 1.0f, 1.25f, 1.5f };
    for (int i = 0; i < 3; i++) {
        const double d = (double)distances[i], z = (double)PANEL, r = (double)RADIUS;
        const double expected = 2 * r * (d - z) / z, tangent = r * (1 / z - 1 / d);
        const struct edge e = edge_at(gpu, distances[i]);
        print_message("wall at %.2f m: penumbra %.3f m of %.3f, error %.4f, worst %.3f\n", d,
                      e.width, expected, e.mean_error, e.worst);
        CHECK(e.count > 100);
        CHECK(e.mean_error < 1.0 / FILTER_TAPS);
        CHECK(e.worst < 2.0 / FILTER_TAPS + 1.0 / MAP_SIZE / tangent);
        CHECK(e.width > 0.6 * expected && e.width < 1.2 * expected);
    }
}

// ---- maps that are kept

static bool drew_maps(struct gpu *gpu)
{
    struct gpu_timing timings[64];
    const int count = gpu_frame_timings(gpu, timings, 64);
    bool found = false;
    for (int i = 0; i < count; i++) found = found || strcmp(timings[i].name, "dnrt.maps") == 0;
    return found;
}

static void open_kept(struct wall_scene *w, struct gpu *gpu, bool keep)
{
    start(w, gpu);
    open_wall(w, 0);
    w->fixture.options.keep_maps = keep;
    finish(w, SOURCE DNRT ",intrusion=shadow");
}

static mat4s *node_of(struct wall_scene *w, int node)
{
    return &w->fixture.pose.world_from_node[node];
}

static void turn_ball(struct wall_scene *w)
{
    mat4s *ball = node_of(w, w->ball);
    *ball = glms_mat4_mul(*ball, glms_rotate_make(0.3f, vec3_of(0, 1, 0)));
}

static void move_ball(struct wall_scene *w)
{
    node_of(w, w->ball)->raw[3][0] += 0.1f;
}

static void move_wall(struct wall_scene *w)
{
    for (int side = 2; side < 8; side++)
        node_of(w, w->fixture.scene->instances[side].node)->raw[3][2] += 3.0f;
}

static void stay(struct wall_scene *w)
{
    (void)w;
}

static const struct {
    void (*change)(struct wall_scene *w);
    bool draws;
} frames[] = {
    { stay, false }, { turn_ball, false }, { move_ball, true }, { stay, false }, { move_wall, true }
};

TEST_GPU(maps_are_drawn_again_only_when_something_else_moves)
{
    struct wall_scene kept, drawn;
    open_kept(&kept, gpu, true);
    CHECK(drew_maps(gpu));
    open_kept(&drawn, gpu, false);
    for (size_t f = 0; f < sizeof frames / sizeof *frames; f++) {
        frames[f].change(&kept);
        frames[f].change(&drawn);
        fixture_render(&kept.fixture);
        CHECK(drew_maps(gpu) == frames[f].draws);
        fixture_render(&drawn.fixture);
        CHECK(drew_maps(gpu));
        float *a = fixture_read(&kept.fixture, READ_IRRADIANCE);
        float *b = fixture_read(&drawn.fixture, READ_IRRADIANCE);
        CHECK(memcmp(a, b, sizeof *a * 3 * PIXELS * PIXELS) == 0);
        free(a);
        free(b);
    }
    close_scene(&kept);
    close_scene(&drawn);
}
