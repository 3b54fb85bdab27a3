// Transfer vectors against closed forms: the clamped cosine, form factors of a disk and of spheres,
// the Neumann series of an integrating sphere.
#include "techniques/prt/prt_fixture.h"

#include "core/rng.h"
#include "techniques/prt/bake/scene.h"
#include "techniques/technique_rules.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- without shadows

// The clamped cosine has the bands π, 2π/3, π/4, 0, −π/24 of a function's irradiance (Ramamoorthi &
// Hanrahan 2001).
TEST(unshadowed_vectors_are_the_clamped_cosine_around_the_normal)
{
    static const float BAND[5] = { GLM_PIf, 2 * GLM_PIf / 3, GLM_PIf / 4, 0, -GLM_PIf / 24 };
    static const char *const COUNTS[] = { "4", "9", "16", "25" };
    for (int n = 0; n < 4; n++) {
        struct prt_fixture f;
        char more[64];
        double worst = 0;
        prt_fixture_init(&f);
        prt_fixture_sphere(&f, vec3_of(0, 1, 0), 1, 16, 0, false, prt_fixture_diffuse(&f, 0.5f));
        prt_fixture_open(&f, "texels=1024,rays=16");
        snprintf(more, sizeof more, "transfer=unshadowed,coefficients=%s", COUNTS[n]);
        struct prt_baked baked = prt_fixture_bake(&f, more, 0);
        for (uint32_t i = 0; i < f.charts.side_texel_count; i++) {
            float y[SH_MAX_COUNT];
            if (!prt_is_open(&baked, i)) continue;
            sh_eval(2 + n, chart_texel_normal(&f.charts, i), y);
            for (int k = 0, l = 0; k < SH_COUNT(2 + n); k++) {
                if (k == SH_COUNT(l + 1)) l++;
                const double expected = (double)(BAND[l] * y[k]);
                worst =
                    fmax(worst, fabs((double)prt_coefficient(&baked, i, (size_t)k).x - expected));
            }
        }
        print_message("%s coefficients: at most %.2g off\n", COUNTS[n], worst);
        CHECK(worst < 1e-3);
        prt_baked_finish(&baked);
        prt_fixture_close(&f);
    }
}

// ---- shadows

// The form factor of a disk of radius r, parallel to the surface at a height h, from a place at a
// distance a from its axis.
static double disk_form_factor(double r, double h, double a)
{
    const double z = h * h + a * a + r * r;
    return 0.5 * (1 - (z - 2 * r * r) / sqrt(z * z - 4 * r * r * a * a));
}

// That of a sphere above the horizon.
static double sphere_form_factor(double r, double h, double a)
{
    const double d2 = h * h + a * a;
    return r * r / d2 * (h / sqrt(d2));
}

enum { RAYS = 1024 };

struct errors {
    double worst, rms; // of irradiance under a uniform sky, in standard errors of as many rays
    double mean;       // of all texels, relative
};

// On a floor below an occluder of a known form factor.
static struct errors check_floor(const struct prt_fixture *f, const struct prt_baked *baked,
                                 double (*form_factor)(double, double, double), double r, double h)
{
    struct errors e = { 0 };
    struct prt_light sky;
    double sum = 0, exact = 0;
    int count = 0;
    prt_uniform_light(&sky);
    for (uint32_t i = 0; i < f->charts.side_texel_count; i++) {
        const float *point = tensors_find(baked->tensors, LIGHT_MAP_POINT)->data;
        const vec3s at = vec3_of(point[4 * i], point[4 * i + 1], point[4 * i + 2]);
        float got[3];
        if (fabsf(at.y) > 1e-3f || chart_texel_normal(&f->charts, i).y < 0.9f) continue;
        prt_irradiance(baked, i, &sky, got);
        const double share = form_factor(r, h, (double)hypotf(at.x, at.z));
        const double sigma = GLM_PI * sqrt(share * (1 - share) / RAYS);
        const double error = fabs((double)got[0] - GLM_PI * (1 - share)) / sigma;
        e.worst = fmax(e.worst, error);
        e.rms += error * error;
        sum += (double)got[0];
        exact += GLM_PI * (1 - share);
        count++;
    }
    CHECK(count > 100);
    e.rms = sqrt(e.rms / count);
    e.mean = sum / exact - 1;
    return e;
}

static void check_errors(const char *what, struct errors e)
{
    print_message("%s: %.2f standard errors at worst, %.2f in the mean; sum of texels %+.2g\n",
                  what, e.worst, e.rms, e.mean);
    CHECK(e.worst < 3 && e.rms < 1 && fabs(e.mean) < 2e-3);
}

TEST(irradiance_below_a_black_disk_is_that_of_its_form_factor)
{
    static const float HEIGHT[] = { 0.5f, 3, 20 };
    for (int i = 0; i < 3; i++) {
        struct prt_fixture f;
        char text[64];
        const float h = HEIGHT[i], r = h > 10 ? 8 : 1;
        prt_fixture_init(&f);
        fixture_floor(&f.s, 1, prt_fixture_diffuse(&f, 0.8f));
        prt_fixture_disk(&f, vec3_of(0, h, 0), r, prt_fixture_diffuse(&f, 0));
        prt_fixture_open(&f, i == 2 ? "density=16,rays=1024" : "density=20,rays=1024");
        struct prt_baked baked = prt_fixture_bake(&f, "transfer=shadowed", 0);
        snprintf(text, sizeof text, "disk of %g at %g", (double)r, (double)h);
        check_errors(text, check_floor(&f, &baked, disk_form_factor, (double)r, (double)h));
        prt_baked_finish(&baked);
        prt_fixture_close(&f);
    }
}

// A floor cut to what sees the whole sphere.
TEST(irradiance_below_a_black_sphere_is_that_of_its_form_factor)
{
    struct prt_fixture f;
    prt_fixture_init(&f);
    fixture_floor(&f.s, 2, prt_fixture_diffuse(&f, 0.8f));
    prt_fixture_sphere(&f, vec3_of(0, 1.5f, 0), 1, 48, 0, false, prt_fixture_diffuse(&f, 0));
    prt_fixture_open(&f, "density=12,rays=1024");
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    check_errors("sphere", check_floor(&f, &baked, sphere_form_factor, 1, 1.5));
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

TEST(a_plane_under_a_black_half_sphere_has_no_light)
{
    struct prt_fixture f;
    struct prt_light sky;
    prt_fixture_init(&f);
    fixture_floor(&f.s, 3, prt_fixture_diffuse(&f, 1));
    prt_fixture_sphere(&f, vec3_of(0, 0, 0), 2, 24, 0, true, prt_fixture_diffuse(&f, 0));
    prt_fixture_open(&f, "density=8,rays=256");
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    prt_uniform_light(&sky);
    int inside = 0;
    for (uint32_t i = 0; i < f.charts.texel_count; i++) {
        const vec3s at = f.charts.texels[i].position;
        float e[3];
        if (fabsf(at.y) > 1e-3f || hypotf(at.x, at.z) > 1.8f) continue;
        prt_irradiance(&baked, i, &sky, e);
        CHECK(e[0] == 0);
        inside++;
    }
    CHECK(inside > 100);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// ---- bounces

enum { RINGS = 32, OPEN = 6 };

// The integrating sphere: from any point inside of it, a part of it has the form factor of its
// share f of the area, here that of the hole. Direct irradiance by a sky of 1 is πf everywhere, and
// bounce b is ρ(1 − f) times the one before.
static void open_sphere(struct prt_fixture *f, float albedo)
{
    prt_fixture_init(f);
    prt_fixture_sphere(f, vec3_of(0, 0, 0), 1, RINGS, OPEN, true, prt_fixture_diffuse(f, albedo));
    prt_fixture_open(f, "texels=1024,rays=512,bounces=64,threshold=0");
}

static double hole(void)
{
    return 0.5 * (1 - cos(GLM_PI * OPEN / RINGS));
}

struct sphere_means {
    double direct, bounced;
};

static struct sphere_means sphere_light(const struct prt_fixture *f, const struct prt_baked *baked)
{
    struct sphere_means mean = { 0 };
    double area = 0;
    for (uint32_t i = 0; i < f->charts.side_texel_count; i++) {
        const vec4s t = prt_coefficient(baked, i, 0);
        const double a = (double)chart_texel_of(&f->charts, i)->area_m2;
        CHECK(t.y == t.z && t.y == t.w);
        mean.direct += a * (double)t.x * sqrt(4 * GLM_PI);
        mean.bounced += a * (double)t.y * sqrt(4 * GLM_PI);
        area += a;
    }
    mean.direct /= area;
    mean.bounced /= area;
    return mean;
}

TEST(bounces_in_a_sphere_with_a_hole_are_their_geometric_series)
{
    static const float ALBEDO[] = { 0.3f, 0.6f, 0.9f };
    for (int i = 0; i < 3; i++) {
        struct prt_fixture f;
        open_sphere(&f, ALBEDO[i]);
        struct prt_baked baked = prt_fixture_bake(&f, "", 0);
        const struct sphere_means got = sphere_light(&f, &baked);
        const double ratio = (double)ALBEDO[i] * (1 - hole()), direct = GLM_PI * hole();
        print_message("albedo %.1f: direct %.4f of %.4f, bounced %.4f of %.4f\n", (double)ALBEDO[i],
                      got.direct, direct, got.bounced, direct * ratio / (1 - ratio));
        CHECK_RELATIVE(got.direct, direct, 0.01);
        CHECK_RELATIVE(got.bounced / got.direct, ratio / (1 - ratio), 0.01);
        prt_baked_finish(&baked);
        prt_fixture_close(&f);
    }
}

TEST(bounces_end_where_they_are_told)
{
    struct prt_fixture f;
    open_sphere(&f, 0.6f);
    const double ratio = 0.6 * (1 - hole());
    double sum = 0;
    for (int bounces = 1; bounces <= 3; bounces++) {
        char more[32];
        snprintf(more, sizeof more, "bounces=%d", bounces);
        struct prt_baked baked = prt_fixture_bake(&f, more, 0);
        const struct sphere_means got = sphere_light(&f, &baked);
        sum += pow(ratio, bounces);
        CHECK_RELATIVE(got.bounced / got.direct, sum, 0.01);
        prt_baked_finish(&baked);
    }
    struct prt_baked all = prt_fixture_bake(&f, "", 0),
                     few = prt_fixture_bake(&f, "threshold=0.01", 0);
    const double left = sphere_light(&f, &all).bounced - sphere_light(&f, &few).bounced;
    print_message("a threshold of 0.01 loses %.4f lx\n", left);
    CHECK(left > 0 && left < 0.01 * sqrt(4 * GLM_PI) * ratio / (1 - ratio));
    prt_baked_finish(&all);
    prt_baked_finish(&few);
    prt_fixture_close(&f);
}

// Nothing absorbs: light from all directions arrives from all directions.
TEST(a_white_scene_in_a_white_sky_is_a_furnace)
{
    struct prt_fixture f;
    struct prt_light sky;
    double least = HUGE_VAL, most = 0;
    prt_fixture_init(&f);
    fixture_floor(&f.s, 2, prt_fixture_diffuse(&f, 1));
    fixture_box(&f.s, vec3_of(-1, 0, -0.5f), vec3_of(0, 1, 0.5f), false,
                prt_fixture_diffuse(&f, 1));
    fixture_box(&f.s, vec3_of(-1.5f, 1.4f, -1.5f), vec3_of(1.5f, 1.6f, 1.5f), false,
                prt_fixture_diffuse(&f, 1));
    prt_fixture_open(&f, "density=8,rays=256,bounces=64,threshold=0");
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    prt_uniform_light(&sky);
    for (uint32_t i = 0; i < f.charts.side_texel_count; i++) {
        float e[3];
        if (!prt_is_open(&baked, i)) continue;
        prt_irradiance(&baked, i, &sky, e);
        least = fmin(least, (double)e[0] / GLM_PI);
        most = fmax(most, (double)e[0] / GLM_PI);
    }
    print_message("%.4f to %.4f of π\n", least, most);
    CHECK(least > 0.98 && most < 1.002);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// A closed sphere of emission L and albedo ρ has the irradiance πL / (1 − ρ) everywhere.
TEST(a_closed_emissive_sphere_is_a_furnace)
{
    struct prt_fixture f;
    struct material m = material_default();
    double direct = 0, bounced = 0, worst = 0;
    m.metallic = m.specular = 0;
    m.base_color = vec4_of(vec3_of(0.5f, 0.5f, 0.5f), 1);
    m.emissive = vec3_of(1, 1, 1);
    prt_fixture_init(&f);
    prt_fixture_sphere(&f, vec3_of(0, 0, 0), 1, 16, 0, true, fixture_material(&f.s, &m));
    prt_fixture_open(&f, "texels=512,rays=256,bounces=64,threshold=0.0001");
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    const float *emitted = tensors_find(baked.tensors, LIGHT_MAP_EMITTED)->data;
    const float *bounces = tensors_find(baked.tensors, PRT_EMITTED)->data;
    int count = 0;
    for (uint32_t i = 0; i < f.charts.side_texel_count; i++) {
        if (!prt_is_open(&baked, i)) continue;
        CHECK(prt_coefficient(&baked, i, 0).x == 0 && prt_coefficient(&baked, i, 0).y == 0);
        direct += (double)emitted[12 * i];
        bounced += (double)bounces[3 * i];
        worst = fmax(worst, fabs((double)(emitted[12 * i] + bounces[3 * i]) / (2 * GLM_PI) - 1));
        count++;
    }
    print_message("direct %.4f of π, bounced %.4f of π; %.2g off at worst\n",
                  direct / count / GLM_PI, bounced / count / GLM_PI, worst);
    CHECK_RELATIVE(direct / count, GLM_PI, 0.005);
    CHECK_RELATIVE(bounced / count, GLM_PI, 0.005);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// Noise of the bounces of a spot below an emissive disk, on the belt of a sphere. The least
// contrast that an observer sees is 1 % or so (Weber fraction).
TEST(light_of_a_small_bright_spot_is_even)
{
    struct prt_fixture f;
    struct material m = material_default();
    double sum = 0, squares = 0;
    int count = 0;
    m.metallic = m.specular = 0;
    m.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    m.emissive = vec3_of(100, 100, 100);
    prt_fixture_init(&f);
    prt_fixture_sphere(&f, vec3_of(0, 0, 0), 2, 16, 0, true, prt_fixture_diffuse(&f, 0.7f));
    prt_fixture_disk(&f, vec3_of(0, -1.85f, 0), 0.1f, fixture_material(&f.s, &m));
    prt_fixture_open(&f, "texels=2048");
    struct prt_baked baked = prt_fixture_bake(&f, "rays=512", 0),
                     precise = prt_fixture_bake(&f, "rays=4096", 1);
    const float *bounces = tensors_find(baked.tensors, PRT_EMITTED)->data,
                *expected = tensors_find(precise.tensors, PRT_EMITTED)->data;
    for (uint32_t i = 0; i < f.charts.side_texel_count; i++) {
        if (fabsf(chart_texel_of(&f.charts, i)->position.y) > 0.4f || !prt_is_open(&baked, i))
            continue;
        const double difference = (double)(bounces[3 * i] - expected[3 * i]);
        sum += (double)expected[3 * i];
        squares += difference * difference;
        count++;
    }
    const double mean = sum / count, deviation = sqrt(squares / count);
    print_message("%d texels: mean %.4f lux, deviation %.4f\n", count, mean, deviation / mean);
    CHECK(count > 300);
    CHECK(deviation < 0.01 * mean);
    prt_baked_finish(&precise);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// ---- rays

TEST(the_direct_transfer_of_a_uniform_sky_is_its_irradiance)
{
    struct prt_fixture f;
    open_sphere(&f, 0.5f);
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    const float *sky = tensors_find(baked.tensors, LIGHT_MAP_SKY)->data;
    for (uint32_t i = 0; i < f.charts.side_texel_count; i++) {
        if (!prt_is_open(&baked, i)) continue;
        CHECK_RELATIVE(prt_coefficient(&baked, i, 0).x * sqrtf(4 * GLM_PIf), sky[4 * (size_t)i],
                       1e-3f);
    }
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// ---- compression

// Floor, boxes, a sphere with a hole: clusters with subspaces are closer than points and than one
// subspace, which have at least as many bytes.
TEST(clustered_components_of_a_scene_are_better_than_both_at_equal_bytes)
{
    static const char *const MORE[] = { "compression=cpca,clusters=16,vectors=6",
                                        "compression=pca,vectors=9",
                                        "compression=vq,clusters=1024" };
    struct prt_fixture f;
    double error[3], bytes[3];
    prt_fixture_init(&f);
    fixture_floor(&f.s, 2, prt_fixture_diffuse(&f, 0.7f));
    fixture_box(&f.s, vec3_of(-1, 0, -0.5f), vec3_of(0, 1, 0.5f), false,
                fixture_matte(&f.s, vec3_of(0.8f, 0.5f, 0.2f)));
    fixture_box(&f.s, vec3_of(-1, 1.3f, -1.5f), vec3_of(1.5f, 1.4f, 1), false,
                fixture_matte(&f.s, vec3_of(0.3f, 0.5f, 0.8f)));
    prt_fixture_sphere(&f, vec3_of(1, 0.8f, 0), 0.7f, 16, 4, true, prt_fixture_diffuse(&f, 0.6f));
    prt_fixture_open(&f, "texels=4096,rays=128");
    for (int i = 0; i < 3; i++) {
        struct prt_baked baked = prt_fixture_bake(&f, MORE[i], 0);
        const struct tensor *rows = tensors_find(baked.tensors, PRT_CODEBOOK),
                            *weight = tensors_find(baked.tensors, PRT_WEIGHT),
                            *cluster = tensors_find(baked.tensors, PRT_CLUSTER);
        const float *squares = tensors_find(baked.tensors, PRT_ERROR)->data;
        error[i] = (double)(squares[0] / squares[1]);
        bytes[i] =
            (double)(rows->bytes + (weight ? weight->bytes : 0) + (i == 1 ? 0 : cluster->bytes));
        print_message("%s: error %.2g of the variance, %.0f bytes\n", MORE[i], error[i], bytes[i]);
        prt_baked_finish(&baked);
    }
    CHECK(bytes[1] >= bytes[0] && bytes[2] >= 0.9 * bytes[0]);
    CHECK(error[0] < error[1] && error[0] < error[2]);
    prt_fixture_close(&f);
}

// ---- rotation

// A box, a slab over it and a floor, turned around their middle.
static void open_turned(struct prt_fixture *f, mat3s turn, const char *options)
{
    prt_fixture_init(f);
    struct frame_fixture *s = &f->s;
    const int first = s->scene->mesh_count;
    fixture_floor(s, 2, prt_fixture_diffuse(f, 0.7f));
    fixture_box(s, vec3_of(-0.5f, 0, -0.5f), vec3_of(0.5f, 1, 0.5f), false,
                prt_fixture_diffuse(f, 0.5f));
    fixture_box(s, vec3_of(-1, 1.5f, -0.2f), vec3_of(0.3f, 1.6f, 0.7f), false,
                prt_fixture_diffuse(f, 0.3f));
    for (int m = first; m < s->scene->mesh_count; m++) {
        struct mesh *mesh = &s->scene->meshes[m];
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            mesh->positions[v] = glms_mat3_mulv(turn, mesh->positions[v]);
            mesh->normals[v] = glms_mat3_mulv(turn, mesh->normals[v]);
        }
    }
    prt_fixture_open(f, options);
}

// Mean over all texels by area.
static void mean_light(const struct prt_fixture *f, const struct prt_baked *baked,
                       const struct prt_light *light, double out[3])
{
    double area = 0;
    memset(out, 0, 3 * sizeof *out);
    for (uint32_t i = 0; i < f->charts.side_texel_count; i++) {
        const double a = (double)chart_texel_of(&f->charts, i)->area_m2;
        float e[3];
        if (!prt_is_open(baked, i)) continue;
        prt_irradiance(baked, i, light, e);
        for (int c = 0; c < 3; c++) out[c] += a * (double)e[c];
        area += a;
    }
    for (int c = 0; c < 3; c++) out[c] /= area;
}

static void turn_light(const struct prt_light *from, mat3s turn, int bands, struct prt_light *out)
{
    *out = (struct prt_light){ 0 };
    for (int c = 0; c < 3; c++) {
        float in[SH_MAX_COUNT], turned[SH_MAX_COUNT];
        for (int k = 0; k < SH_COUNT(bands); k++) in[k] = from->direct[k].raw[c];
        sh_rotate(bands, turn, in, turned);
        for (int k = 0; k < SH_COUNT(bands); k++)
            out->direct[k].raw[c] = out->bounced[k].raw[c] = turned[k];
    }
}

// The texels of both scenes are those of the same places: islands of TEXCOORD do not turn.
TEST(a_scene_turned_with_its_light_has_the_same_irradiance)
{
    static const char *const MORE[] = { "transfer=unshadowed", "transfer=shadowed", "" };
    const mat3s one = glms_mat3_identity();
    const mat3s turn = glms_mat4_pick3(glms_rotate_make(1.1f, vec3_of(0.3f, 0.8f, -0.5f)));
    struct prt_light light, turned;
    prt_random_light(3, &light);
    light.direct[0] = light.bounced[0] = (vec4s){ { 4, 5, 6, 0 } };
    turn_light(&light, turn, 4, &turned);
    for (int i = 0; i < 3; i++) {
        struct prt_fixture a, b;
        double mean_a[3], mean_b[3];
        open_turned(&a, one, "density=8,rays=1024,coefficients=16");
        open_turned(&b, turn, "density=8,rays=1024,coefficients=16");
        struct prt_baked baked_a = prt_fixture_bake(&a, MORE[i], 0),
                         baked_b = prt_fixture_bake(&b, MORE[i], 0);
        mean_light(&a, &baked_a, &light, mean_a);
        mean_light(&b, &baked_b, &turned, mean_b);
        print_message("%s: %.5f %.5f %.5f, turned %.5f %.5f %.5f\n", MORE[i], mean_a[0], mean_a[1],
                      mean_a[2], mean_b[0], mean_b[1], mean_b[2]);
        for (int c = 0; c < 3; c++) CHECK_RELATIVE(mean_a[c], mean_b[c], 1e-3);
        prt_baked_finish(&baked_a);
        prt_baked_finish(&baked_b);
        prt_fixture_close(&a);
        prt_fixture_close(&b);
    }
}
