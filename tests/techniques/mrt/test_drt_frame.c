// Delta radiance transfer in whole frames.
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"

#include "core/sh.h"
#include "techniques/gi_state.h"
#include "techniques/mrt/mrt_state.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 32, FLOATS = SIZE * SIZE * 3, TEXT = 512 };

#define DICTIONARY                                                                                 \
    ":texels=8,rays=1024,modes=24,lightfield_positions=4,lightfield_directions=6,"                 \
    "lightfield_supersampling=1,lightfield_modes=16,lightfield_rounds=0,response_modes=8,"         \
    "block_probes=2"

// Each side of the boxes is a face.
#define HOLLOW                                                                                     \
    ":map=single,texels=8,rays=1024,modes=24,lightfield_positions=4,lightfield_directions=6,"      \
    "lightfield_supersampling=1,lightfield_modes=16,lightfield_rounds=0,response_modes=20,"        \
    "block_probes=2"

struct room {
    const char *technique, *options;
    bool box;
    float power;
    int frames;
};

// A closed room, with a box in it or without, after some frames. The caller destroys the stack and
// finishes the fixture.
static struct gi *render_room(struct frame_fixture *s, struct gpu *gpu, struct room room)
{
    char text[TEXT];
    fixture_init(s, gpu);
    const int material = fixture_matte(s, vec3_of(0.6f, 0.5f, 0.4f));
    fixture_box(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, material);
    if (room.box)
        fixture_box(s, vec3_of(-0.5f, 0, -0.5f), vec3_of(0.6f, 1.3f, 0.4f), false, material);
    fixture_look(s, vec3_of(-1.5f, 2.5f, 1.5f), vec3_of(0.5f, 0, -0.5f));
    fixture_add_point(s, vec3_of(-1.2f, 2.2f, -1),
                      glms_vec3_scale(vec3_of(100, 60, 20), room.power));
    snprintf(text, sizeof text, "%s" DICTIONARY "%s", room.technique, room.options);
    fixture_open(s);
    struct gi *gi = gi_fixture_light(s, text);
    for (int i = 0; i < room.frames; i++) fixture_render(s);
    return gi;
}

// The caller frees the irradiance.
static float *irradiance_of(struct gpu *gpu, struct room room)
{
    struct frame_fixture s;
    struct gi *gi = render_room(&s, gpu, room);
    float *out = fixture_read(&s, READ_IRRADIANCE);
    gi_destroy(gi);
    fixture_finish(&s);
    return out;
}

static double sum_of(const float *e)
{
    double sum = 0.0;
    for (int i = 0; i < FLOATS; i++) {
        CHECK(isfinite(e[i]) && e[i] >= 0.0f);
        sum += (double)e[i];
    }
    return sum;
}

// With the same share of further bounces, whose default differs.
TEST_GPU(drt_without_objects_is_mrt)
{
    float *mrt = irradiance_of(gpu, (struct room){ "mrt", ",remainder=false", false, 1, 1 });
    float *drt = irradiance_of(gpu, (struct room){ "drt", "", false, 1, 1 });
    CHECK(sum_of(mrt) > 0.0);
    CHECK(memcmp(mrt, drt, FLOATS * sizeof *mrt) == 0);
    free(mrt);
    free(drt);
}

// Occlusion takes light, reflection gives some of it back.
TEST_GPU(drt_operators_change_light_as_they_say)
{
    float *off =
        irradiance_of(gpu, (struct room){ "drt", ",occlusion=false,reflection=false", true, 1, 1 });
    float *dark = irradiance_of(gpu, (struct room){ "drt", ",reflection=false", true, 1, 1 });
    float *both = irradiance_of(gpu, (struct room){ "drt", "", true, 1, 1 });
    const double none = sum_of(off), shadowed = sum_of(dark), all = sum_of(both);
    print_message("occlusion leaves %.3f of the light, reflection brings it to %.3f\n",
                  shadowed / none, all / none);
    CHECK(shadowed < 0.95 * none);
    CHECK(all > 1.05 * shadowed && all < none);
    free(off);
    free(dark);
    free(both);
}

TEST_GPU(drt_is_linear_in_light_and_still)
{
    float *one = irradiance_of(gpu, (struct room){ "drt", "", true, 1, 1 });
    float *twice = irradiance_of(gpu, (struct room){ "drt", "", true, 2, 1 });
    float *later = irradiance_of(gpu, (struct room){ "drt", "", true, 1, 3 });
    CHECK(sum_of(one) > 0.0);
    for (int i = 0; i < FLOATS; i++) CHECK_NEAR(twice[i], 2.0f * one[i], 2e-3f * one[i] + 1e-2f);
    CHECK(memcmp(one, later, FLOATS * sizeof *one) == 0);
    free(one);
    free(twice);
    free(later);
}

// Feedback from frame to frame converges to the bounces of one frame.
TEST_GPU(drt_feedback_converges)
{
    float *bounces = irradiance_of(gpu, (struct room){ "drt", ",bounces=16", true, 1, 1 });
    float *feedback =
        irradiance_of(gpu, (struct room){ "drt", ",bounces=1,feedback=true", true, 1, 16 });
    CHECK_RELATIVE(sum_of(bounces), sum_of(feedback), 5e-3);
    free(bounces);
    free(feedback);
}

// After a frame with a point light. Finishes the fixture; the caller frees the irradiance.
static float *lit_irradiance(struct frame_fixture *s, const char *text)
{
    fixture_add_point(s, vec3_of(-1.5f, 2.7f, -1.2f), vec3_of(100, 60, 20));
    fixture_open(s);
    struct gi *gi = gi_fixture_light(s, text);
    fixture_render(s);
    float *out = fixture_read(s, READ_IRRADIANCE);
    gi_destroy(gi);
    fixture_finish(s);
    return out;
}

// Sides of a closed hollow box. SHEETS: double-sided, around some of the probes.
enum sides { THICK, THIN, SHEETS, SIDES };

static void add_hollow(struct frame_fixture *s, enum sides sides, int matte)
{
    struct material sheet = s->scene->materials[matte];
    sheet.double_sided = true;
    if (sides == SHEETS) {
        fixture_box(s, vec3_of(-1.2f, 0.5f, -1.2f), vec3_of(0.7f, 2.5f, 0.7f), false,
                    fixture_material(s, &sheet));
        return;
    }
    const float outer = sides == THIN ? 0.71f : 0.8f;
    fixture_box(s, vec3_of(-outer, 1.4f - outer, -outer), vec3_of(outer, 1.4f + outer, outer),
                false, matte);
    fixture_box(s, vec3_of(-0.7f, 0.7f, -0.7f), vec3_of(0.7f, 2.1f, 0.7f), true, matte);
}

// The camera in a closed hollow box with a small box in it, which are clutter; a lit room is around
// it. Returns the irradiance; the caller frees it.
static float *irradiance_in_hollow(struct gpu *gpu, const char *text, enum sides sides)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    const int material = fixture_matte(&s, vec3_of(0.6f, 0.5f, 0.4f));
    fixture_box(&s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, material);
    add_hollow(&s, sides, material);
    fixture_box(&s, vec3_of(0.2f, 0.7f, -0.6f), vec3_of(0.6f, 1.1f, -0.2f), false, material);
    fixture_look(&s, vec3_of(-0.5f, 1.9f, 0.5f), vec3_of(0.5f, 0.8f, -0.5f));
    return lit_irradiance(&s, text);
}

// mrt's light passes through.
TEST_GPU(drt_has_no_light_in_closed_clutter)
{
    static const char *const options[] = { "", ",gather=false" };
    static const char *const names[SIDES] = { "thick", "thin", "double-sided" };
    for (int sides = 0; sides < SIDES; sides++) {
        float *through = irradiance_in_hollow(gpu, "mrt" HOLLOW, (enum sides)sides);
        CHECK(sum_of(through) > 0.0);
        for (int i = 0; i < 2; i++) {
            char text[TEXT];
            snprintf(text, sizeof text, "drt" HOLLOW "%s", options[i]);
            float *inside = irradiance_in_hollow(gpu, text, (enum sides)sides);
            print_message("drt%s: %.4f of the light in a %s box\n", options[i],
                          sum_of(inside) / sum_of(through), names[sides]);
            CHECK(sum_of(inside) == 0.0);
            free(inside);
        }
        free(through);
    }
}

// The camera in a closed hollow box looks at a side less than a voxel of 25 cm before the plane
// x = 1 m of probes. One of them is in the box and lights all of that side, which all others are
// behind: a brighter one, at x = -1 m, too.
TEST_GPU(drt_lights_a_surface_by_no_probe_behind_it)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    const int material = fixture_matte(&s, vec3_of(0.6f, 0.5f, 0.4f));
    fixture_box(&s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, material);
    fixture_box(&s, vec3_of(0.7f, 1.8f, -1.5f), vec3_of(1.8f, 2.8f, -0.5f), false, material);
    fixture_box(&s, vec3_of(0.8f, 1.9f, -1.4f), vec3_of(1.7f, 2.7f, -0.6f), true, material);
    fixture_look(&s, vec3_of(1, 2.15f, -1), vec3_of(0.8f, 2.1f, -1));
    float *e = lit_irradiance(&s, "drt" HOLLOW ",gather=false");
    for (int i = 0; i < FLOATS; i++) CHECK_RELATIVE(e[i], e[i % 3], 1e-3);
    free(e);
}

// ---- Before the pixel

// Least green irradiance of values, and the mean.
struct least {
    double least, mean;
    int count;
};

static void add_value(struct least *to, double e)
{
    to->least = to->count == 0 ? e : fmin(to->least, e);
    to->mean += (e - to->mean) / (double)++to->count;
}

static float *read_floats(struct gpu *gpu, gpu_buffer buffer, size_t floats)
{
    float *out = calloc(floats, sizeof *out);
    assert_non_null(out);
    CHECK(gpu_buffer_download(gpu, buffer, 0, out, floats * sizeof *out));
    return out;
}

static struct least least_of_walls(struct mrt_runtime *runtime)
{
    const size_t texels = runtime->level.texels;
    struct least out = { 0 };
    float *e = read_floats(runtime->gpu, mrt_buffer(runtime, "mrt_irradiance"), 3 * texels);
    for (size_t i = 0; i < texels; i++) add_value(&out, (double)e[3 * i + 1]);
    free(e);
    return out;
}

// By the normals to the sides, edges and corners of a cube.
static struct least least_of_probes(struct mrt_runtime *runtime)
{
    const size_t p = runtime->level.probes, probes = p * p * p;
    struct least out = { 0 };
    float *e = read_floats(runtime->gpu, mrt_buffer(runtime, "mrt_probe_light"), 27 * probes);
    for (size_t i = 0; i < probes; i++)
        for (int d = 0; d < 27; d++) {
            const vec3s way =
                vec3_of((float)(d % 3 - 1), (float)(d / 3 % 3 - 1), (float)(d / 9 - 1));
            float basis[9];
            double sum = 0.0;
            if (d == 13) continue;
            sh_eval(3, vec3_unit(way), basis);
            for (size_t k = 0; k < 9; k++) sum += (double)basis[k] * (double)e[(9 * i + k) * 3 + 1];
            add_value(&out, sum);
        }
    free(e);
    return out;
}

// At the normals of the texels, which are found once more: the run time does not keep them.
static struct least least_of_clutter(const struct frame_fixture *s, struct mrt *mrt)
{
    const struct mrt_clutter_options options = { 10, mrt->options.response_modes };
    struct mrt_clutter clutter;
    struct least out = { 0 };
    CHECK(mrt_clutter_init(&clutter, test_host(), &s->pose, &mrt->map, &options));
    const size_t texels = clutter.charts.texel_count;
    float *e = read_floats(mrt->gpu, mrt_buffer(&mrt->runtime, "mrt_clutter_light"), 12 * texels);
    for (size_t i = 0; i < texels; i++) {
        float basis[4];
        double sum = 0.0;
        sh_eval(2, chart_texel_normal(&clutter.charts, clutter.texels[i]), basis);
        for (size_t k = 0; k < 4; k++) sum += (double)basis[k] * (double)e[(4 * i + k) * 3 + 1];
        add_value(&out, sum);
    }
    free(e);
    mrt_clutter_finish(&clutter);
    return out;
}

// Up to the pixel light is linear, so that what is negative is not cut off. What clutter leaves of
// U_b is the difference of two sets of rays.
TEST_GPU(drt_has_no_negative_light_before_the_pixel)
{
    for (int bounces = 1; bounces <= 8; bounces += 7) {
        struct frame_fixture s;
        char options[TEXT];
        snprintf(options, sizeof options, ",bounces=%d", bounces);
        struct gi *gi = render_room(&s, gpu, (struct room){ "drt", options, true, 1, 1 });
        struct mrt *mrt = gi->state[0];
        const struct least of[] = { least_of_walls(&mrt->runtime), least_of_probes(&mrt->runtime),
                                    least_of_clutter(&s, mrt) };
        static const char *const names[] = { "walls", "probes", "clutter" };
        for (int i = 0; i < 3; i++) {
            print_message("%d bounces, %s: at least %.4f of the mean irradiance\n", bounces,
                          names[i], of[i].least / of[i].mean);
            CHECK(of[i].count > 0 && of[i].least >= 0.0);
        }
        gi_destroy(gi);
        fixture_finish(&s);
    }
}

// Irradiance of a sheet in the room, whose front faces +x or −x, seen from −x. Others are 0.
static void sheet_irradiance(struct gpu *gpu, bool from_back, float out[FLOATS])
{
    const float x = 0.4f;
    const vec3s low = vec3_of(x, 0.5f, -0.8f), high = vec3_of(x, 1.7f, 0.8f);
    const vec3s across = vec3_of(x, low.y, high.z), up = vec3_of(x, high.y, low.z);
    struct frame_fixture s;
    struct material m = material_default();
    fixture_init(&s, gpu);
    fixture_box(&s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true,
                fixture_matte(&s, vec3_of(0.6f, 0.5f, 0.4f)));
    m.double_sided = true;
    m.base_color = vec4_of(vec3_of(0, 0, 0), 1); // both sides of a face have one radiosity
    m.specular = 0;
    const int sheet = fixture_quad(&s, low, from_back ? up : across, high, from_back ? across : up,
                                   fixture_material(&s, &m));
    fixture_look(&s, vec3_of(-1.5f, 1.5f, 0.5f), vec3_of(x, 1.1f, 0));
    fixture_add_point(&s, vec3_of(-1.2f, 2.2f, -1), vec3_of(100, 60, 20));
    fixture_open(&s);
    struct gi *gi = gi_fixture_light(&s, "drt" HOLLOW);
    s.input.want_id_layer = true;
    fixture_render(&s);
    float *e = fixture_read(&s, READ_IRRADIANCE), *id = fixture_read(&s, READ_ID);
    for (int i = 0; i < FLOATS; i++) out[i] = (int)id[2 * (i / 3)] == sheet ? e[i] : 0.0f;
    free(e);
    free(id);
    gi_destroy(gi);
    fixture_finish(&s);
}

TEST_GPU(drt_lights_both_sides_of_a_double_sided_surface_alike)
{
    static float front[FLOATS], back[FLOATS];
    double sum = 0.0, difference = 0.0;
    sheet_irradiance(gpu, false, front);
    sheet_irradiance(gpu, true, back);
    for (int i = 0; i < FLOATS; i++) {
        sum += (double)front[i];
        difference += fabs((double)back[i] - (double)front[i]);
    }
    print_message("the back differs by %.4f from the same side as a front\n", difference / sum);
    CHECK(sum > 0.0 && difference < 0.005 * sum);
}
