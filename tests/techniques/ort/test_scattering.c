// Error of transfer maps of scattered light against the sum over all texels, by the dipole of each
// pair without a reach. None of the sum is of the bake.
#include "techniques/ort/bake_fixture.h"
#include "techniques/ort/bake/profile.h"

#include "trace/texels/texels.h"

#include <math.h>
#include <stdlib.h>

#define SUBJECT  "texels=1024,rays=16,transfer=scattering,material=skin1,mm_per_unit=15"
#define CENTIRAD 0.01f

// ---- bodies of about 3 cm

enum { ACROSS = 48, DOWN = 24 };

static vec3s on_ball(int i, int k)
{
    const float east = 2.0f * GLM_PIf * (float)i / ACROSS;
    const float south = CENTIRAD + (GLM_PIf - 2.0f * CENTIRAD) * (float)k / DOWN;
    return vec3_of(sinf(south) * cosf(east), cosf(south), -sinf(south) * sinf(east));
}

static void add_quad_of_ball(uint32_t *out, int i, int k)
{
    const uint32_t a = (uint32_t)(k * (ACROSS + 1) + i), below = a + ACROSS + 1;
    const uint32_t corners[6] = { a, below, below + 1, a, below + 1, a + 1 };
    for (int c = 0; c < 6; c++) out[c] = corners[c];
}

// A ball that meridians and parallels unwrap.
static void ball(struct ort_fixture *f)
{
    enum { VERTICES = (ACROSS + 1) * (DOWN + 1) };
    static vec3s positions[VERTICES];
    static vec2s uv[VERTICES];
    static uint32_t indices[6 * ACROSS * DOWN];
    for (int k = 0; k <= DOWN; k++)
        for (int i = 0; i <= ACROSS; i++) {
            const int v = k * (ACROSS + 1) + i;
            positions[v] = on_ball(i, k);
            uv[v] = (vec2s){ { (float)i / ACROSS, 0.5f * (float)k / DOWN } };
            if (i < ACROSS && k < DOWN)
                add_quad_of_ball(indices + (size_t)6 * (size_t)(k * ACROSS + i), i, k);
        }
    *f = (struct ort_fixture){ 0 };
    fixture_init(&f->s, NULL);
    const struct mesh mesh = { .name = "ball",
                               .vertex_count = VERTICES,
                               .index_count = sizeof indices / sizeof *indices,
                               .positions = positions,
                               .normals = positions,
                               .uv = { uv },
                               .indices = indices,
                               .material = fixture_matte(&f->s, vec3_of(0.8f, 0.6f, 0.5f)) };
    const int index = scene_add_mesh(f->s.scene, &mesh);
    CHECK(index >= 0);
    fixture_instance(&f->s, index, NULL);
}

// A box: a chart for each face, and a plate that is thin to red light.
static void box(struct ort_fixture *f)
{
    *f = (struct ort_fixture){ 0 };
    fixture_init(&f->s, NULL);
    const int material = fixture_matte(&f->s, vec3_of(0.8f, 0.6f, 0.5f));
    fixture_box(&f->s, vec3_of(-0.9f, -0.2f, -0.7f), vec3_of(0.9f, 0.2f, 0.7f), false, material);
}

// ---- first-order light, 1 lux where it is full

enum kind { UNIFORM, SUN, HALF, SPOT, LIGHTS };
static const char *const LIGHT_NAMES[LIGHTS] = { "uniform", "sun", "half", "spot" };

// The body's centre is the origin, and it is convex: lights need no shadow rays.
static float light_at(enum kind kind, vec3s to_light, vec3s at, vec3s normal)
{
    if (kind == UNIFORM) return 1.0f;
    if (kind == HALF) return glms_vec3_dot(at, to_light) > 0.0f ? 1.0f : 0.0f;
    const float cosine = fmaxf(glms_vec3_dot(normal, to_light), 0.0f);
    if (kind == SUN) return cosine;
    static const float RADIUS = 0.3f; // of the beam
    const float aside =
        glms_vec3_norm(glms_vec3_muladds(to_light, -glms_vec3_dot(at, to_light), at));
    return aside < RADIUS ? cosine : 0.0f;
}

static void light_texels(const struct ort_fixture *f, enum kind kind, float *out)
{
    const vec3s to_light = glms_vec3_normalize(vec3_of(0.6f, 0.7f, 0.4f));
    for (uint32_t i = 0; i < f->map.texel_count; i++) {
        const float lux = light_at(kind, to_light, chart_texel_of(&f->map.charts, i)->position,
                                   chart_texel_normal(&f->map.charts, i));
        for (size_t c = 0; c < 3; c++) out[3 * (size_t)i + c] = lux;
    }
}

// ---- the sum over all texels

struct subject {
    struct ort_fixture f;
    struct ort_profile profile[3];
    double mm; // in a unit
    float *light[LIGHTS], *expected[LIGHTS];
};

// A point of the plane of a texel's triangle, by its place in the atlas.
static vec3s point_at(const struct charts *charts, uint32_t texel, float x, float y)
{
    const struct chart_triangle *t = chart_triangle_of(charts, texel);
    float u, v;
    texel_weigh(t, x, y, &u, &v);
    const vec3s at = glms_vec3_muladds(glms_vec3_sub(t->corner[1], t->corner[0]), u, t->corner[0]);
    return glms_vec3_muladds(glms_vec3_sub(t->corner[2], t->corner[0]), v, at);
}

// The profile over a texel about its centroid, of its shape in the world, at a grid of points; the
// point in the middle of its own stands for a disk.
static double mean_over_texel(const struct subject *u, const struct ort_profile *profile,
                              uint32_t texel, vec3s between, double area_mm2)
{
    enum { GRID = 15 };
    const struct charts *charts = &u->f.map.charts;
    const vec3s x = glms_vec3_sub(point_at(charts, texel, 1, 0), point_at(charts, texel, 0, 0));
    const vec3s y = glms_vec3_sub(point_at(charts, texel, 0, 1), point_at(charts, texel, 0, 0));
    const double part_mm2 = area_mm2 / (GRID * GRID);
    double sum = 0.0;
    for (int i = 0; i < GRID * GRID; i++) {
        const float along_x = ((float)(i % GRID) + 0.5f) / GRID - 0.5f;
        const float along_y = ((float)(i / GRID) + 0.5f) / GRID - 0.5f;
        const vec3s at = glms_vec3_muladds(y, along_y, glms_vec3_muladds(x, along_x, between));
        const double r = (double)glms_vec3_norm(at) * u->mm;
        sum += r < 1e-6 ? 1.0 - ort_profile_beyond(profile, sqrt(part_mm2 / GLM_PI))
                        : ort_profile_at(profile, r) * part_mm2;
    }
    return sum;
}

// Share of the light of a texel that leaves at another, per colour.
static void find_shares(const struct subject *u, uint32_t to, uint32_t from, double out[3])
{
    static const double NEAR = 8; // sides of a texel
    const struct chart_texel *b = chart_texel_of(&u->f.map.charts, from);
    const vec3s between =
        glms_vec3_sub(b->centroid, chart_texel_of(&u->f.map.charts, to)->centroid);
    const double area = (double)b->area_m2 * u->mm * u->mm;
    const double r = (double)glms_vec3_norm(between) * u->mm;
    for (int c = 0; c < 3; c++)
        out[c] = r > NEAR * sqrt(area) ? ort_profile_at(&u->profile[c], r) * area
                                       : mean_over_texel(u, &u->profile[c], from, between, area);
}

static void find_expected(struct subject *u, uint32_t to)
{
    double sum[LIGHTS][3] = { 0 };
    for (uint32_t from = 0; from < u->f.map.texel_count; from++) {
        double share[3];
        find_shares(u, to, from, share);
        for (int k = 0; k < LIGHTS; k++)
            for (size_t c = 0; c < 3; c++)
                sum[k][c] += share[c] * (double)u->light[k][3 * (size_t)from + c];
    }
    for (int k = 0; k < LIGHTS; k++)
        for (size_t c = 0; c < 3; c++) u->expected[k][3 * (size_t)to + c] = (float)sum[k][c];
}

// options: SUBJECT, and more.
static void open_subject(struct subject *u, void (*scene)(struct ort_fixture *),
                         const char *options)
{
    struct gi_spec spec;
    scene(&u->f);
    ort_fixture_open(&u->f, options);
    CHECK(gi_spec_parse(&spec, test_host(), "ort:" SUBJECT));
    const struct ort_options *o = spec.options[0];
    u->mm = (double)o->mm_per_unit;
    for (int c = 0; c < 3; c++) u->profile[c] = ort_profile_of(o, c);
    gi_spec_finish(&spec);
    for (int k = 0; k < LIGHTS; k++) {
        u->light[k] = ort_texel_floats(&u->f);
        u->expected[k] = ort_texel_floats(&u->f);
        light_texels(&u->f, (enum kind)k, u->light[k]);
    }
    for (uint32_t i = 0; i < u->f.map.texel_count; i++) find_expected(u, i);
}

static void close_subject(struct subject *u)
{
    for (int k = 0; k < LIGHTS; k++) {
        free(u->light[k]);
        free(u->expected[k]);
    }
    ort_fixture_close(&u->f);
}

// ---- errors

enum { SEEDS = 3 };

// RMS over the area, divided by that of the sum; ratio of the fluxes.
struct error {
    double rms, energy;
};

static struct error error_of(const struct subject *u, const float *got, const float *expected)
{
    double error = 0.0, square = 0.0, flux = 0.0, whole = 0.0;
    for (uint32_t i = 0; i < u->f.map.texel_count; i++)
        for (size_t c = 0; c < 3; c++) {
            const double area = (double)chart_texel_of(&u->f.map.charts, i)->area_m2;
            const double e = (double)expected[3 * i + c], g = (double)got[3 * i + c];
            error += area * (g - e) * (g - e);
            square += area * e * e;
            flux += area * g;
            whole += area * e;
        }
    return (struct error){ sqrt(error / square), flux / whole };
}

// more: options of the bake.
static void measure(const struct subject *u, const char *more, uint64_t seed,
                    struct error out[LIGHTS])
{
    float *got = ort_texel_floats(&u->f);
    struct ort_baked baked = ort_fixture_bake(&u->f, more, seed);
    for (int k = 0; k < LIGHTS; k++) {
        ort_indirect(&u->f, &baked, u->light[k], got);
        out[k] = error_of(u, got, u->expected[k]);
    }
    ort_baked_finish(&baked);
    free(got);
}

static double median(double a, double b, double c)
{
    return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

static void measure_medians(const struct subject *u, const char *more, struct error out[LIGHTS])
{
    struct error e[SEEDS][LIGHTS];
    for (uint64_t i = 0; i < SEEDS; i++) measure(u, more, i, e[i]);
    for (int k = 0; k < LIGHTS; k++) {
        out[k] = (struct error){ median(e[0][k].rms, e[1][k].rms, e[2][k].rms),
                                 median(e[0][k].energy, e[1][k].energy, e[2][k].energy) };
        print_message("%s, %s: error %.4f, energy %.4f\n", more, LIGHT_NAMES[k], out[k].rms,
                      out[k].energy);
    }
}

// Rows have exact sums, so that uniform light has the error of the profile's mean over a texel
// alone: of a few squares in place of its shape, and around edges of the box in the wrong plane.
static const double OF_TEXELS = 0.015;

static void check_uniform(struct error e)
{
    CHECK(e.rms <= 2 * OF_TEXELS);
    CHECK_NEAR(e.energy, 1.0, OF_TEXELS);
}

// 50 to 400 offsets. Random offsets alone would give √(50/400) = 0.35. of_texels: RMS error under
// uniform light, to which that of others falls.
static void check_fall(struct error few, struct error many, double of_texels, enum kind kind)
{
    print_message("%s: error of 400 over that of 50: %.3f\n", LIGHT_NAMES[kind],
                  many.rms / few.rms);
    CHECK(many.rms <= hypot(0.45 * few.rms, 1.5 * of_texels));
    CHECK_NEAR(many.energy, 1.0, 2 * OF_TEXELS);
}

TEST(scattered_light_of_a_ball_approaches_the_sum_over_all_texels)
{
    static const char *const OPTIONS[] = { "offsets=50", "offsets=100", "offsets=200",
                                           "offsets=400" };
    enum { COUNT = sizeof OPTIONS / sizeof *OPTIONS };
    struct subject u;
    struct error e[COUNT][LIGHTS];
    open_subject(&u, ball, SUBJECT);
    for (int i = 0; i < COUNT; i++) {
        measure_medians(&u, OPTIONS[i], e[i]);
        check_uniform(e[i][UNIFORM]);
    }
    for (int k = SUN; k < LIGHTS; k++)
        check_fall(e[0][k], e[COUNT - 1][k], e[0][UNIFORM].rms, (enum kind)k);
    close_subject(&u);
}

// With local=1 a set of offsets has to serve six charts.
static void measure_shared(struct error out[LIGHTS])
{
    struct subject u;
    open_subject(&u, box, SUBJECT ",local=1");
    CHECK(u.f.map.group_count == 1);
    measure_medians(&u, "offsets=50", out);
    check_uniform(out[UNIFORM]);
    close_subject(&u);
}

TEST(scattered_light_of_a_box_approaches_the_sum_over_all_texels)
{
    struct subject u;
    struct error few[LIGHTS], many[LIGHTS], shared[LIGHTS];
    open_subject(&u, box, SUBJECT);
    CHECK(u.f.map.group_count == 6);
    measure_medians(&u, "offsets=50", few);
    measure_medians(&u, "offsets=400", many);
    measure_shared(shared);
    check_uniform(few[UNIFORM]);
    check_uniform(many[UNIFORM]);
    for (int k = SUN; k < LIGHTS; k++) {
        check_fall(few[k], many[k], many[UNIFORM].rms, (enum kind)k);
        print_message("%s: offsets of charts have %.3f of the error of shared ones\n",
                      LIGHT_NAMES[k], few[k].rms / shared[k].rms);
        CHECK(few[k].rms < shared[k].rms);
    }
    close_subject(&u);
}
