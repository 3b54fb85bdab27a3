// Emissive surfaces as lights, in the full frame, for every source that gathers emission.
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"
#include "techniques/technique_rules.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 32, FLOATS = SIZE * SIZE * 3 };

static const double PI = 3.14159265358979323846;

struct room {
    struct frame_fixture frame_fixture;
    struct gi *gi;
    int emitter; // instance
};

static int emissive_material(struct frame_fixture *s, vec3s radiance)
{
    struct material m = material_default();
    m.emissive = radiance;
    m.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    m.metallic = 0;
    return fixture_material(s, &m);
}

static void room_open(struct room *r, const char *gi)
{
    fixture_open(&r->frame_fixture);
    r->gi = gi_fixture_light_small(&r->frame_fixture, gi);
}

static void room_finish(struct room *r)
{
    gi_destroy(r->gi);
    fixture_finish(&r->frame_fixture);
}

static float *room_render(struct room *r)
{
    fixture_render(&r->frame_fixture);
    return fixture_read(&r->frame_fixture, READ_IRRADIANCE);
}

// A closed room with an emissive box and a block, viewed from a corner.
static void furnish(struct room *r, struct gpu *gpu, const char *gi, float emission, float point)
{
    *r = (struct room){ 0 };
    struct frame_fixture *s = &r->frame_fixture;
    fixture_init(s, gpu);
    fixture_box(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true,
                fixture_matte(s, vec3_of(0.7f, 0.5f, 0.3f)));
    fixture_box(s, vec3_of(0.2f, 0, -0.5f), vec3_of(1, 1, 0.3f), false,
                fixture_matte(s, vec3_of(0.2f, 0.5f, 0.8f)));
    r->emitter =
        fixture_quad(s, vec3_of(-1, 2.9f, -1), vec3_of(-0.5f, 2.9f, -1),
                     vec3_of(-0.5f, 2.9f, -0.5f), vec3_of(-1, 2.9f, -0.5f),
                     emissive_material(s, vec3_of(300 * emission, 200 * emission, 100 * emission)));
    if (point > 0.0f)
        fixture_add_point(s, vec3_of(-1, 2, 0), vec3_of(40 * point, 60 * point, 20 * point));
    fixture_look(s, vec3_of(-1.7f, 2, 1.8f), vec3_of(1, 0.5f, -1));
    room_open(r, gi);
}

static float *irradiance(struct gpu *gpu, const char *gi, float emission, float point)
{
    struct room r;
    furnish(&r, gpu, gi, emission, point);
    float *out = room_render(&r);
    room_finish(&r);
    return out;
}

static float largest(const float *values)
{
    float most = 0.0f;
    for (int i = 0; i < FLOATS; i++) most = fmaxf(most, values[i]);
    return most;
}

// The next source after `t` that gathers emission; NULL at the end.
static const struct technique *next_gatherer(size_t *t)
{
    for (; techniques[*t]; (*t)++) {
        if (techniques[*t]->role == ROLE_SOURCE && techniques[*t]->capabilities & GATHERS_EMISSION)
            return techniques[(*t)++];
    }
    return NULL;
}

TEST(lpv_and_ambient_gather_emission)
{
    size_t at = 0;
    int count = 0;
    while (next_gatherer(&at)) count++;
    CHECK(count >= 2);
    CHECK(technique_find("lpv")->needs & FRAME_NEEDS_EMITTERS);
    CHECK(technique_find("ambient")->needs & FRAME_NEEDS_EMITTERS);
}

TEST_GPU(half_the_emission_is_half_the_irradiance)
{
    size_t at = 0;
    for (const struct technique *t; (t = next_gatherer(&at));) {
        float *full = irradiance(gpu, t->name, 1, 0), *half = irradiance(gpu, t->name, 0.5f, 0);
        CHECK(largest(full) > 1.0f); // lux
        for (int i = 0; i < FLOATS; i++) CHECK_NEAR(half[i], 0.5f * full[i], 1e-3f * half[i]);
        free(full), free(half);
    }
}

TEST_GPU(emission_and_punctual_light_are_the_sum_of_each_alone)
{
    size_t at = 0;
    for (const struct technique *t; (t = next_gatherer(&at));) {
        float *both = irradiance(gpu, technique_additive(t), 1, 1);
        float *emitter = irradiance(gpu, technique_additive(t), 1, 0),
              *point = irradiance(gpu, technique_additive(t), 0, 1);
        const double most = (double)largest(both);
        const bool distant = t == technique_find("prt"); // it has no light of points
        int compared = 0;
        for (int i = 0; i < FLOATS; i++) {
            // Linearity does not hold where one of them is clamped at zero.
            if (emitter[i] == 0.0f || (point[i] == 0.0f && !distant) || both[i] == 0.0f) continue;
            compared++;
            CHECK_NEAR((double)both[i], (double)emitter[i] + (double)point[i], 2e-3 * most);
        }
        CHECK(compared > FLOATS / 2);
        free(both), free(emitter), free(point);
    }
}

TEST_GPU(no_emission_gives_exactly_zero)
{
    size_t at = 0;
    for (const struct technique *t; (t = next_gatherer(&at));) {
        float *dark = irradiance(gpu, t->name, 0, 0);
        CHECK(largest(dark) == 0.0f);
        free(dark);
    }
    float *off = irradiance(gpu, "lpv:emitters=false", 1, 0);
    CHECK(largest(off) == 0.0f);
    free(off);
}

static void move_lamp(struct room *r, float x)
{
    int node = r->frame_fixture.scene->instances[r->emitter].node;
    r->frame_fixture.pose.world_from_node[node].raw[3][0] = x;
}

// Bounces that take several frames are tested by techniques.vct.bounces; this is the first frame.
static const char *at_once(const struct technique *t)
{
    return strcmp(t->name, "vct") == 0 ? "vct:bounces=1,temporal=false" : t->name;
}

TEST_GPU(a_moving_emitter_leaves_no_trail)
{
    size_t at = 0;
    for (const struct technique *t; (t = next_gatherer(&at));) {
        struct room moved, fresh;
        furnish(&moved, gpu, at_once(t), 1, 0);
        float *before = room_render(&moved);
        move_lamp(&moved, 2);
        float *after = room_render(&moved);
        furnish(&fresh, gpu, at_once(t), 1, 0);
        move_lamp(&fresh, 2);
        float *expected = room_render(&fresh);
        assert_memory_equal(after, expected, FLOATS * sizeof *after);
        if (strcmp(t->name, "lpv") == 0) CHECK(memcmp(before, after, FLOATS * sizeof *after) != 0);
        free(before), free(after), free(expected);
        room_finish(&moved), room_finish(&fresh);
    }
}

TEST_GPU(emission_gives_the_same_bytes_in_every_run)
{
    size_t at = 0;
    for (const struct technique *t; (t = next_gatherer(&at));) {
        float *first = irradiance(gpu, t->name, 1, 1), *again = irradiance(gpu, t->name, 1, 1);
        assert_memory_equal(first, again, FLOATS * sizeof *first);
        free(first), free(again);
    }
}

static double mean_of(const float *rgb)
{
    double sum = 0.0;
    for (int i = 0; i < FLOATS; i += 3) sum += (double)rgb[i];
    return 3.0 * sum / FLOATS;
}

// Form factor of two equal coaxial parallel squares at a distance of their edge (Howell, C-11, X =
// Y = 1).
static double facing_squares(void)
{
    const double root = sqrt(2.0);
    return 2.0 / PI * (log(sqrt(4.0 / 3.0)) + 2.0 * root * atan(1.0 / root) - PI / 2.0);
}

// A black room of 10 m with one emissive wall of π lm/m², viewed from that wall: every pixel shows
// the opposite wall.
static double facing_wall(struct gpu *gpu, const char *gi)
{
    struct room r = { 0 };
    struct frame_fixture *s = &r.frame_fixture;
    fixture_init(s, gpu);
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(10, 10, 10), true, fixture_matte(s, vec3_of(0, 0, 0)));
    fixture_quad(s, vec3_of(0, 0, 0.01f), vec3_of(10, 0, 0.01f), vec3_of(10, 10, 0.01f),
                 vec3_of(0, 10, 0.01f), emissive_material(s, vec3_of(1, 1, 1)));
    s->input.camera =
        camera_look_at(vec3_of(5, 5, 0.1f), vec3_of(5, 5, 10), 2.0f * atanf(5.0f / 9.9f), 0.01f);
    room_open(&r, gi);
    float *wall = room_render(&r);
    const double mean = mean_of(wall);
    free(wall);
    room_finish(&r);
    return mean;
}

#define ONE_GRID "cascades=1,steps=64,bounces=0"

// Propagation keeps a mean cosine of 0.95 per step, a direction for about twenty cells: the more
// cells between two walls, the more light reaches the side walls instead. techniques.lpv.flux
// measures the same for a lit wall (0.50 and 0.41 of the reference for 16 and 24 cells) and
// compares the sum over all walls with their form factors.
TEST_GPU(lpv_of_an_emissive_wall_gives_the_opposite_wall_a_part_of_its_form_factor)
{
    const double truth = PI * facing_squares();
    CHECK_RELATIVE(facing_squares(), 0.199825, 1e-5);
    static const struct {
        const char *gi;
        double least;
    } cases[] = { { "lpv:" ONE_GRID ",dim=16", 0.4 },
                  { "lpv:" ONE_GRID ",dim=24,window=1,offset=0.5", 0.4 },
                  { "lpv:" ONE_GRID ",dim=24", 0.3 },
                  { "lpv:" ONE_GRID, 0.25 },
                  { "lpv:bounces=0", 0.4 } };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double share = facing_wall(gpu, cases[i].gi) / truth;
        print_message("%-48s facing wall: %.2f of the reference\n", cases[i].gi, share);
        CHECK(share > cases[i].least && share < 1.1);
    }
}

// A closed cube of emissive walls (furnace) has E = π L; one emissive wall Φ · ⅔ a / (4 a³).
TEST_GPU(ambient_is_the_mean_fluence_of_a_box)
{
    CHECK_RELATIVE(facing_wall(gpu, "ambient"), PI * 100 * (2.0 / 3.0 * 9.99) / 4000, 2e-3);
    struct room r = { 0 };
    fixture_init(&r.frame_fixture, gpu);
    fixture_box(&r.frame_fixture, vec3_of(-1, -1, -1), vec3_of(1, 1, 1), true,
                emissive_material(&r.frame_fixture, vec3_of(7, 7, 7)));
    room_open(&r, "ambient");
    float *e = room_render(&r);
    CHECK_RELATIVE(mean_of(e), PI * 7, 2e-3);
    free(e);
    room_finish(&r);
}

// Sun on the floor of an open courtyard: ρ E A lumen on paths of ⅔ h through A h give ρ E / 6 at
// any size.
TEST_GPU(ambient_light_leaves_an_open_courtyard)
{
    for (int i = 0; i < 2; i++) {
        struct room r = { 0 };
        struct frame_fixture *s = &r.frame_fixture;
        const float h = i == 0 ? 1 : 9;
        fixture_init(s, gpu);
        int matte = fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f));
        fixture_floor(s, 4, matte);
        fixture_quad(s, vec3_of(-4, 0, -4), vec3_of(4, 0, -4), vec3_of(4, h, -4),
                     vec3_of(-4, h, -4), matte);
        fixture_add_sun(s, vec3_of(0, -1, 0), vec3_of(1000, 1000, 1000));
        fixture_look(s, vec3_of(0, 2, 0), vec3_of(0, 0, -0.5f));
        room_open(&r, "ambient");
        float *e = room_render(&r);
        // Albedo 0.5 in 8 bits of sRGB, and a map of 64² texels over the floor's edges.
        CHECK_RELATIVE(e[3 * (16 * SIZE + 16)], 0.5 * 1000 / 6, 0.05);
        free(e);
        room_finish(&r);
    }
}

TEST_GPU(a_flat_emissive_scene_is_finite)
{
    size_t at = 0;
    for (const struct technique *t; (t = next_gatherer(&at));) {
        struct room r = { 0 };
        fixture_init(&r.frame_fixture, gpu);
        fixture_floor(&r.frame_fixture, 1, emissive_material(&r.frame_fixture, vec3_of(9, 9, 9)));
        fixture_look(&r.frame_fixture, vec3_of(0, 1, 1), vec3_of(0, 0, 0));
        room_open(&r, t->name);
        float *e = room_render(&r);
        for (int i = 0; i < FLOATS; i++) CHECK(isfinite(e[i]) && e[i] >= 0.0f);
        free(e);
        room_finish(&r);
    }
}
