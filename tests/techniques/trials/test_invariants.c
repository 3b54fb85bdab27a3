// Invariants of every source in the full frame: linearity, black without light, determinism.
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"
#include "techniques/technique_rules.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 32, FLOATS = SIZE * SIZE * 3 };

// A closed room; `lights` has a bit for each of two lights.
static float *layer(struct gpu *gpu, const char *text, int lights, float strength, int frames,
                    enum frame_readback what)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    fixture_box(&s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true,
                fixture_matte(&s, vec3_of(0.7f, 0.5f, 0.3f)));
    fixture_box(&s, vec3_of(0.2f, 0, -0.5f), vec3_of(1, 1, 0.3f), false,
                fixture_matte(&s, vec3_of(0.2f, 0.5f, 0.8f)));
    const vec3s one = { { 100 * strength, 60 * strength, 20 * strength } };
    const vec3s two = { { 10 * strength, 40 * strength, 90 * strength } };
    if (lights & 1) fixture_add_point(&s, vec3_of(-1, 2, 0), one);
    if (lights & 2) fixture_add_spot(&s, vec3_of(1, 2.5f, 1), vec3_of(-1, -2, -1), 0.3f, 0.7f, two);
    fixture_look(&s, vec3_of(-1.7f, 2, 1.8f), vec3_of(1, 0.5f, -1));
    fixture_open(&s);
    struct gi *gi = gi_fixture_light_small(&s, text);
    for (int i = 0; i < frames; i++) fixture_render(&s);
    float *out = fixture_read(&s, what);
    gi_destroy(gi);
    fixture_finish(&s);
    return out;
}

static float *irradiance(struct gpu *gpu, const char *text, int lights, float strength, int frames)
{
    return layer(gpu, text, lights, strength, frames, READ_IRRADIANCE);
}

static float largest(const float *values)
{
    float most = 0.0f;
    for (int i = 0; i < FLOATS; i++) most = fmaxf(most, values[i]);
    return most;
}

TEST_GPU(techniques_give_half_for_half_the_light)
{
    for (size_t t = 0; techniques[t]; t++) {
        if (techniques[t]->role != ROLE_SOURCE) continue;
        float *full = irradiance(gpu, techniques[t]->name, 3, 1.0f, 1);
        float *half = irradiance(gpu, techniques[t]->name, 3, 0.5f, 1);
        for (int i = 0; i < FLOATS; i++) CHECK(half[i] == 0.5f * full[i]);
        free(full);
        free(half);
    }
}

TEST_GPU(techniques_add_two_lights_up)
{
    for (size_t t = 0; techniques[t]; t++) {
        if (techniques[t]->role != ROLE_SOURCE) continue;
        float *both = irradiance(gpu, technique_additive(techniques[t]), 3, 1.0f, 1);
        float *one = irradiance(gpu, technique_additive(techniques[t]), 1, 1.0f, 1);
        float *two = irradiance(gpu, technique_additive(techniques[t]), 2, 1.0f, 1);
        const double most = (double)largest(both);
        int compared = 0;
        for (int i = 0; i < FLOATS; i++) {
            // Linearity does not hold where one of them is clamped at zero.
            if (most > 0.0 && (one[i] == 0.0f || two[i] == 0.0f || both[i] == 0.0f)) continue;
            compared++;
            CHECK_NEAR((double)both[i], (double)one[i] + (double)two[i], 2e-3 * most);
        }
        CHECK(compared > FLOATS / 2);
        free(both);
        free(one);
        free(two);
    }
}

TEST_GPU(techniques_give_exactly_zero_without_light)
{
    for (size_t t = 0; techniques[t]; t++) {
        if (techniques[t]->role != ROLE_SOURCE) continue;
        float *dark = irradiance(gpu, techniques[t]->name, 0, 1.0f, 1);
        CHECK(largest(dark) == 0.0f);
        free(dark);
        if (techniques[t] == technique_find("none") || techniques[t] == technique_find("prt"))
            continue; // prt transfers distant light alone: tests/techniques/prt
        float *lit = irradiance(gpu, techniques[t]->name, 3, 1.0f, 1);
        CHECK(largest(lit) > 1.0f); // lux
        free(lit);
    }
}

TEST_GPU(techniques_give_the_same_bytes_in_every_run_and_frame)
{
    for (size_t t = 0; techniques[t]; t++) {
        static const enum frame_readback results[ROLE_COUNT] = { [ROLE_SOURCE] = READ_IRRADIANCE,
                                                                 [ROLE_DELTA] = READ_IRRADIANCE,
                                                                 [ROLE_VISIBILITY] =
                                                                     READ_VISIBILITY,
                                                                 [ROLE_REFLECTION] =
                                                                     READ_SPECULAR };
        const enum frame_readback what = results[techniques[t]->role];
        const size_t floats = what == READ_VISIBILITY ? FLOATS / 3 : FLOATS;
        float *first = layer(gpu, techniques[t]->name, 3, 1.0f, 1, what);
        float *again = layer(gpu, techniques[t]->name, 3, 1.0f, 1, what);
        assert_memory_equal(first, again, floats * sizeof *first);
        float *one = layer(gpu, technique_of_one_frame(techniques[t]), 3, 1.0f, 1, what);
        float *later = layer(gpu, technique_of_one_frame(techniques[t]), 3, 1.0f, 3, what);
        assert_memory_equal(one, later, floats * sizeof *one);
        free(first);
        free(again);
        free(one);
        free(later);
    }
}

struct span {
    float least, most;
};

// For techniques of the role visibility, which do not depend on light.
static struct span visibility(struct gpu *gpu, const char *text)
{
    float *lit = layer(gpu, text, 3, 1.0f, 1, READ_VISIBILITY);
    float *dark = layer(gpu, text, 0, 1.0f, 1, READ_VISIBILITY);
    assert_memory_equal(lit, dark, SIZE * SIZE * sizeof *lit);
    struct span span = { 1.0f, 0.0f };
    for (int i = 0; i < SIZE * SIZE; i++) {
        span.least = fminf(span.least, lit[i]);
        span.most = fmaxf(span.most, lit[i]);
    }
    free(lit);
    free(dark);
    return span;
}

// The room has corners and a box: visibility varies, and does not depend on light.
TEST_GPU(visibility_depends_on_geometry_and_not_on_light)
{
    for (size_t t = 0; techniques[t]; t++) {
        if (techniques[t]->role != ROLE_VISIBILITY) continue;
        // Cones reach all walls of the closed room: without decay it is dark, with a steep decay
        // open.
        const bool far = strcmp(techniques[t]->name, "vctao") == 0;
        const struct span near = visibility(gpu, far ? "vctao:decay=16" : techniques[t]->name);
        const struct span whole = far ? visibility(gpu, "vctao:decay=0") : near;
        CHECK(whole.least < 0.7f && near.most > 0.95f);
    }
}
