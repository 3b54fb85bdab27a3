// Error of transfer maps against the exact transfer of all bounces, which a dense system of all
// texels gives: form factors by 4096 rays of each texel, none of it of the bake.
#include "techniques/ort/bake_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- the exact transfer: E = F ρ (E₀ + E)

enum { RAYS_SIDE = 64 }; // of a grid of rays

struct exact {
    const struct ort_fixture *f;
    float *factor; // [texels][texels]
    float *albedo; // [texels][3]
};

static uint32_t texel_hit(const struct ort_fixture *f, uint32_t texel, vec2s u)
{
    const vec3s normal = chart_texel_normal(&f->map.charts, texel);
    const vec3s helper = fabsf(normal.y) < 0.9f ? vec3_of(0, 1, 0) : vec3_of(1, 0, 0);
    const vec3s tangent = glms_vec3_normalize(glms_vec3_cross(helper, normal));
    const vec3s bitangent = glms_vec3_cross(normal, tangent);
    const float radius = sqrtf(u.x), angle = 2.0f * GLM_PIf * u.y;
    vec3s direction = glms_vec3_scale(normal, sqrtf(1.0f - u.x));
    direction = glms_vec3_muladds(tangent, radius * cosf(angle), direction);
    direction = glms_vec3_muladds(bitangent, radius * sinf(angle), direction);
    const vec3s from =
        glms_vec3_muladds(normal, 1e-4f, chart_texel_of(&f->map.charts, texel)->position);
    struct trace_hit hit;
    if (!trace_closest(f->trace, from, direction, HUGE_VALF, &hit) || !hit.front) return CHART_NONE;
    return chart_texel_at(&f->map.charts, hit.instance, hit.triangle, hit.u, hit.v, false);
}

static void find_factors(struct exact *exact, uint32_t texel)
{
    const float share = 1.0f / (RAYS_SIDE * RAYS_SIDE);
    float *row = exact->factor + (size_t)texel * exact->f->map.texel_count;
    for (int i = 0; i < RAYS_SIDE * RAYS_SIDE; i++) {
        const vec2s u = { { ((float)(i % RAYS_SIDE) + 0.5f) / RAYS_SIDE,
                            ((float)(i / RAYS_SIDE) + 0.5f) / RAYS_SIDE } };
        const uint32_t seen = texel_hit(exact->f, texel, u);
        if (seen != CHART_NONE) row[seen] += share;
    }
}

static void find_albedo(struct exact *exact, uint32_t texel)
{
    const struct scene *scene = exact->f->s.scene;
    const int instance = chart_triangle_of(&exact->f->map.charts, texel)->instance;
    const int material = scene->meshes[scene->instances[instance].mesh].material;
    for (int c = 0; c < 3; c++)
        exact->albedo[3 * (size_t)texel + (size_t)c] = scene->materials[material].base_color.raw[c];
}

static void exact_init(struct exact *exact, const struct ort_fixture *f)
{
    const size_t n = f->map.texel_count;
    *exact = (struct exact){ f, calloc(n * n, sizeof(float)), calloc(3 * n, sizeof(float)) };
    assert_true(exact->factor && exact->albedo);
    for (uint32_t i = 0; i < n; i++) {
        find_factors(exact, i);
        find_albedo(exact, i);
    }
}

static void exact_finish(struct exact *exact)
{
    free(exact->factor);
    free(exact->albedo);
}

// One more bounce: out = F ρ (light + before). Returns the largest change.
static float bounce(const struct exact *exact, const float *light, const float *before, float *out)
{
    const size_t n = exact->f->map.texel_count;
    float most = 0.0f;
    for (size_t i = 0; i < n; i++) {
        float sum[3] = { 0 };
        for (size_t j = 0; j < n; j++) {
            const float factor = exact->factor[i * n + j];
            if (factor == 0.0f) continue;
            for (size_t c = 0; c < 3; c++)
                sum[c] +=
                    factor * exact->albedo[3 * j + c] * (light[3 * j + c] + before[3 * j + c]);
        }
        for (size_t c = 0; c < 3; c++) {
            most = fmaxf(most, fabsf(sum[c] - before[3 * i + c]));
            out[3 * i + c] = sum[c];
        }
    }
    return most;
}

static void exact_indirect(const struct exact *exact, const float *light, float *out)
{
    const size_t bytes = 3 * (size_t)exact->f->map.texel_count * sizeof *out;
    float *before = calloc(1, bytes);
    assert_non_null(before);
    memset(out, 0, bytes);
    while (bounce(exact, light, before, out) > 1e-4f) memcpy(before, out, bytes);
    free(before);
}

// ---- errors

enum { LIGHTS = 7, SEEDS = 3, COUNTS = 4 };
enum { SMOOTH, SPOTS, UNIFORM, KINDS }; // of lights
static const int OFFSETS[COUNTS] = { 50, 100, 200, 400 };

struct subject {
    struct ort_fixture f;
    struct exact exact;
    float *light[LIGHTS], *expected[LIGHTS];
};

// Smooth and spots in turn, then a uniform one.
static int kind_of(int light)
{
    return light == LIGHTS - 1 ? UNIFORM : light % 2;
}

static void make_light(const struct ort_fixture *f, int i, float *light)
{
    if (kind_of(i) != UNIFORM)
        ort_random_light(f, kind_of(i) == SPOTS ? ORT_SPOTS : ORT_SMOOTH, (uint32_t)i, light);
    for (uint32_t k = 0; kind_of(i) == UNIFORM && k < 3 * f->map.texel_count; k++) light[k] = 1.0f;
}

static void open_subject(struct subject *u, void (*scene)(struct ort_fixture *),
                         const char *options)
{
    scene(&u->f);
    ort_fixture_open(&u->f, options);
    exact_init(&u->exact, &u->f);
    for (int i = 0; i < LIGHTS; i++) {
        u->light[i] = ort_texel_floats(&u->f);
        u->expected[i] = ort_texel_floats(&u->f);
        make_light(&u->f, i, u->light[i]);
        exact_indirect(&u->exact, u->light[i], u->expected[i]);
    }
}

static void close_subject(struct subject *u)
{
    for (int i = 0; i < LIGHTS; i++) {
        free(u->light[i]);
        free(u->expected[i]);
    }
    exact_finish(&u->exact);
    ort_fixture_close(&u->f);
}

// RMS over the area and its ratio to the RMS of the exact irradiance; ratio of the sums.
struct error {
    double rms[KINDS], energy; // energy of smooth lights and spots
    double filtered[KINDS];    // rms with prefiltered light
};

struct sums {
    double error, square, got, expected;
};

static void add_light(const struct subject *u, const float *got, const float *expected,
                      struct sums *sums)
{
    for (uint32_t i = 0; i < u->f.map.texel_count; i++)
        for (uint32_t c = 0; c < 3; c++) {
            const double area = (double)chart_texel_of(&u->f.map.charts, i)->area_m2;
            const double e = (double)expected[3 * i + c], g = (double)got[3 * i + c];
            sums->error += area * (g - e) * (g - e);
            sums->square += area * e * e;
            sums->got += area * g;
            sums->expected += area * e;
        }
}

static struct sums sums_of(const struct subject *u, const struct ort_baked *baked, int kind,
                           bool prefilter)
{
    struct sums sums = { 0 };
    float *got = ort_texel_floats(&u->f);
    for (int i = 0; i < LIGHTS; i++) {
        if (kind_of(i) != kind) continue;
        (prefilter ? ort_indirect_prefiltered : ort_indirect)(&u->f, baked, u->light[i], got);
        add_light(u, got, u->expected[i], &sums);
    }
    free(got);
    return sums;
}

static struct error error_of(const struct subject *u, int offsets, const char *rows, uint64_t seed)
{
    char more[64];
    struct error out = { 0 };
    struct sums sums[KINDS];
    snprintf(more, sizeof more, "offsets=%d,rows=%s", offsets, rows);
    struct ort_baked baked = ort_fixture_bake(&u->f, more, seed);
    for (int k = 0; k < KINDS; k++) {
        const struct sums filtered = sums_of(u, &baked, k, true);
        sums[k] = sums_of(u, &baked, k, false);
        out.rms[k] = sqrt(sums[k].error / sums[k].square);
        out.filtered[k] = sqrt(filtered.error / filtered.square);
    }
    out.energy = (sums[0].got + sums[1].got) / (sums[0].expected + sums[1].expected);
    ort_baked_finish(&baked);
    return out;
}

static double median(double a, double b, double c)
{
    return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

static struct error median_error(const struct subject *u, int offsets, const char *rows)
{
    struct error e[SEEDS];
    for (uint64_t i = 0; i < SEEDS; i++) e[i] = error_of(u, offsets, rows, i);
    struct error out = { .energy = median(e[0].energy, e[1].energy, e[2].energy) };
    for (int k = 0; k < KINDS; k++) {
        out.rms[k] = median(e[0].rms[k], e[1].rms[k], e[2].rms[k]);
        out.filtered[k] = median(e[0].filtered[k], e[1].filtered[k], e[2].filtered[k]);
    }
    return out;
}

struct figures {
    struct error paper[COUNTS], exact[COUNTS];
};

static void find_figures(void (*scene)(struct ort_fixture *), const char *name, struct figures *out)
{
    struct subject u;
    open_subject(&u, scene, "texels=1024");
    print_message("%s: %u texels in %u x %u\n", name, u.f.map.texel_count, u.f.map.width,
                  u.f.map.height);
    for (int i = 0; i < COUNTS; i++) {
        const struct error p = out->paper[i] = median_error(&u, OFFSETS[i], "paper");
        const struct error e = out->exact[i] = median_error(&u, OFFSETS[i], "exact");
        print_message("%s, %d offsets: smooth light %.4f (paper %.4f, prefiltered %.4f), "
                      "spots %.4f (paper %.4f, prefiltered %.4f), uniform %.4f, energy %.4f (paper "
                      "%.4f)\n",
                      name, OFFSETS[i], e.rms[0], p.rms[0], e.filtered[0], e.rms[1], p.rms[1],
                      e.filtered[1], e.rms[UNIFORM], e.energy, p.energy);
    }
    close_subject(&u);
}

// 50 to 400 offsets. Random offsets alone would give √(50/400) = 0.35.
static void check_fall(const struct figures *f)
{
    static const double MOST = 0.45;
    for (int k = 0; k < 2; k++) {
        const double paper = f->paper[COUNTS - 1].rms[k] / f->paper[0].rms[k];
        const double exact = f->exact[COUNTS - 1].rms[k] / f->exact[0].rms[k];
        print_message("%s: error of 400 over that of 50: paper %.3f, exact %.3f\n",
                      k ? "spots" : "smooth light", paper, exact);
        CHECK(paper <= MOST && exact <= MOST);
    }
}

static void check_energy(const struct figures *f)
{
    CHECK(f->paper[COUNTS - 1].energy >= 0.8 && f->paper[COUNTS - 1].energy <= 1.25);
    CHECK_NEAR(f->exact[COUNTS - 1].energy, 1.0, 0.01);
}

// Twice the error under uniform light, which is that of sums of rows by 256 rays: rows that see
// little have most of it.
static double noise_of(const struct figures *f, int i)
{
    return 2.0 * f->exact[i].rms[UNIFORM];
}

// Sums of rows are the share of smooth light: its error is halved, at `halved` counts of offsets,
// and at others no larger but for the noise. That of spots depends on the offsets that meet one.
// Rows that lose light lose its noise, too: errors are compared at equal energy.
static void check_rows(const struct figures *f, int halved)
{
    for (int i = 0; i < COUNTS; i++) {
        const struct error *exact = &f->exact[i], *paper = &f->paper[i];
        const double spots = paper->rms[SPOTS] * exact->energy / paper->energy;
        if (i < halved) CHECK(exact->rms[SMOOTH] <= 0.5 * paper->rms[SMOOTH]);
        CHECK(exact->rms[SMOOTH] <= hypot(paper->rms[SMOOTH], noise_of(f, i)));
        CHECK(exact->rms[SPOTS] <= hypot(spots, noise_of(f, i)));
    }
}

// Averages lower the error of spots, to `least` where few offsets have large regions, and leave
// that of smooth light, within the noise of rows.
static void check_prefilter(const struct figures *f, double least)
{
    CHECK(f->exact[0].filtered[SPOTS] <= least * f->exact[0].rms[SPOTS]);
    for (int i = 0; i < COUNTS; i++) {
        CHECK(f->exact[i].filtered[SMOOTH] <= hypot(f->exact[i].rms[SMOOTH], noise_of(f, i)));
        CHECK(f->exact[i].filtered[SPOTS] <= f->exact[i].rms[SPOTS]);
    }
}

// Two squares have 0.016 of noise: half the paper's error of 100 offsets is 0.032.
TEST(error_of_two_facing_squares_falls_with_offsets_and_exact_rows)
{
    struct figures f;
    find_figures(ort_fixture_facing, "facing squares", &f);
    check_fall(&f);
    check_energy(&f);
    check_rows(&f, 1);
    check_prefilter(&f, 1.0);
}

TEST(error_of_a_box_in_a_box_falls_with_offsets_and_exact_rows)
{
    struct figures f;
    find_figures(ort_fixture_boxes, "boxes", &f);
    check_fall(&f);
    check_energy(&f);
    check_rows(&f, COUNTS);
    check_prefilter(&f, 0.67);
}
