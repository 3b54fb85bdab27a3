// Transfer matrices against closed forms and against integrals over the GGX lobe.
#include "techniques/prt/prt_fixture.h"

#include "core/rng.h"
#include "core/sh.h"
#include "techniques/prt/bake/lobes.h"
#include "trace/bsdf.h"

#include <math.h>
#include <stdlib.h>

// ---- lobes

enum { RAYS = 2048, DIRECTIONS = 64 };

// An outgoing direction at most 80° from +z.
static vec3s outgoing(uint32_t i)
{
    const float least = cosf(80 * GLM_PIf / 180);
    const vec2s u = sobol_2d(i, 7);
    const float z = least + (1 - least) * u.x, r = sqrtf(1 - z * z), phi = 2 * GLM_PIf * u.y;
    return vec3_of(r * cosf(phi), r * sinf(phi), z);
}

// The mean of a function of 25 coefficients over the lobe: importance-sampled, of normalised
// weights.
static double mean_over_lobe(const float *light, float roughness, vec3s to_viewer)
{
    enum { SAMPLES = 4096 };
    const struct bsdf_material mirror = { .albedo = { { 1, 1, 1 } },
                                          .metallic = 1,
                                          .roughness = roughness };
    const struct bsdf bsdf = bsdf_of(vec3_of(0, 0, 1), to_viewer, &mirror, false);
    double sum = 0, weights = 0;
    for (uint32_t s = 0; s < SAMPLES; s++) {
        const vec3s to_light = bsdf_sample(&bsdf, 0, sobol_2d(s, 11));
        const struct reflection r = bsdf_reflect(&bsdf, to_light);
        if (!(r.pdf > 0) || !(to_light.z > 0)) continue;
        const double weight = (double)(r.f.x * to_light.z / r.pdf);
        sum += weight * (double)sh_dot(PRT_OUTGOING_BANDS, light, to_light);
        weights += weight;
    }
    return sum / weights;
}

// By the rows of the lobe.
static double reflected(const struct prt_lobes *lobes, const float *rows, const float *light,
                        vec3s to_viewer)
{
    float y[PRT_OUTGOING];
    double sum = 0;
    sh_eval(PRT_OUTGOING_BANDS, to_viewer, y);
    for (size_t s = 0; s < lobes->rays; s++) {
        const double radiance = (double)sh_dot(PRT_OUTGOING_BANDS, light, lobes->direction[s]);
        for (size_t k = 0; k < PRT_OUTGOING; k++)
            sum += (double)(y[k] * rows[k * lobes->rays + s]) * radiance;
    }
    return sum;
}

// Root mean square of the difference over that of the exact radiance.
static double error_of_lobe(const struct prt_lobes *lobes, const float *rows, float roughness,
                            uint32_t seed)
{
    struct prt_light random;
    float light[PRT_OUTGOING];
    double off = 0, all = 0;
    prt_random_light(seed, &random);
    for (int k = 0; k < PRT_OUTGOING; k++) light[k] = random.direct[k].x;
    for (uint32_t i = 0; i < DIRECTIONS; i++) {
        const double exact = mean_over_lobe(light, roughness, outgoing(i));
        const double got = reflected(lobes, rows, light, outgoing(i));
        off += (got - exact) * (got - exact);
        all += exact * exact;
    }
    return sqrt(off / all);
}

// Random coefficients have as much of the narrowest detail as of all else: the hardest light.
TEST(rows_are_the_mean_over_the_lobe)
{
    static const float ROUGHNESS[] = { 0.3f, 0.45f, 0.5f, 0.7f, 1.0f };
    struct prt_lobes lobes;
    float *rows = calloc(RAYS, PRT_OUTGOING * sizeof *rows);
    assert_non_null(rows);
    CHECK(prt_lobes_init(&lobes, test_host(), RAYS));
    for (int i = 0; i < 5; i++) {
        float uniform[PRT_OUTGOING] = { sqrtf(4 * GLM_PIf) };
        double worst = 0;
        prt_lobes_at(&lobes, ROUGHNESS[i], rows);
        for (uint32_t d = 0; d < DIRECTIONS; d++)
            worst = fmax(worst, fabs(reflected(&lobes, rows, uniform, outgoing(d)) - 1));
        const double error = error_of_lobe(&lobes, rows, ROUGHNESS[i], 5);
        print_message("roughness %.2f: uniform light %.5f off, random light %.3f\n",
                      (double)ROUGHNESS[i], worst, error);
        CHECK(worst < 0.01);
        CHECK(error < 0.05);
    }
    free(rows);
    prt_lobes_finish(&lobes);
}

// ---- bakes

static int metal(struct prt_fixture *f, float roughness)
{
    struct material m = material_default();
    m.metallic = 1;
    m.roughness = roughness;
    return fixture_material(&f->s, &m);
}

// Least and most of what texels reflect above their surface, of one light.
struct range {
    double least, most;
};

static struct range range_of(const struct prt_fixture *f, const struct prt_baked *baked,
                             const struct prt_light *light)
{
    struct range out = { HUGE_VAL, -HUGE_VAL };
    for (uint32_t i = 0; i < f->charts.side_texel_count; i++) {
        const vec3s normal = chart_texel_normal(&f->charts, i);
        vec3s tangent, bitangent;
        if (!prt_is_open(baked, i)) continue;
        basis_of(normal, &tangent, &bitangent);
        for (uint32_t d = 0; d < 4; d++) {
            const vec3s local = outgoing(i * 4 + d);
            vec3s to_viewer = glms_vec3_scale(normal, local.z);
            float radiance[3];
            to_viewer = glms_vec3_muladds(tangent, local.x, to_viewer);
            to_viewer = glms_vec3_muladds(bitangent, local.y, to_viewer);
            prt_reflected(baked, i, light, to_viewer, radiance);
            out.least = fmin(out.least, (double)radiance[0]);
            out.most = fmax(out.most, (double)radiance[0]);
        }
    }
    return out;
}

TEST(a_metal_in_a_uniform_sky_has_its_radiance)
{
    struct prt_fixture f;
    struct prt_light sky;
    prt_fixture_init(&f);
    prt_fixture_sphere(&f, vec3_of(0, 1, 0), 1, 16, 0, false, metal(&f, 0.4f));
    prt_fixture_open(&f, "texels=512,rays=256,coefficients=25,glossy=true");
    prt_uniform_light(&sky);
    static const char *const MORE[] = { "transfer=unshadowed", "transfer=shadowed", "" };
    for (int i = 0; i < 3; i++) {
        struct prt_baked baked = prt_fixture_bake(&f, MORE[i], 0);
        const struct range r = range_of(&f, &baked, &sky);
        print_message("%s: %.4f to %.4f\n", MORE[i], r.least, r.most);
        CHECK(r.least > 0.99 && r.most < 1.01);
        prt_baked_finish(&baked);
    }
    prt_fixture_close(&f);
}

TEST(a_closed_room_reflects_nothing)
{
    struct prt_fixture f;
    struct prt_light light;
    prt_fixture_init(&f);
    prt_fixture_sphere(&f, vec3_of(0, 1, 0), 1, 8, 0, true, metal(&f, 0.4f));
    prt_fixture_open(&f, "texels=256,rays=128,coefficients=25,glossy=true");
    prt_random_light(2, &light);
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    const struct range r = range_of(&f, &baked, &light);
    CHECK(r.least == 0 && r.most == 0);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// Nothing absorbs: each ray meets the sky or a surface of its radiance.
TEST(a_white_scene_in_a_white_sky_reflects_its_radiance)
{
    struct prt_fixture f;
    struct prt_light sky;
    prt_fixture_init(&f);
    fixture_floor(&f.s, 2, prt_fixture_diffuse(&f, 1));
    fixture_box(&f.s, vec3_of(-1, 0, -0.5f), vec3_of(0, 1, 0.5f), false,
                prt_fixture_diffuse(&f, 1));
    prt_fixture_open(&f, "density=8,rays=256,bounces=64,threshold=0,glossy=true");
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    prt_uniform_light(&sky);
    const struct range r = range_of(&f, &baked, &sky);
    print_message("%.4f to %.4f\n", r.least, r.most);
    CHECK(r.least > 0.96 && r.most < 1.02);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// ---- a wall

// A mirror of roughness 0.3 sees a red wall on one side, the sky on the other.
TEST(a_floor_reflects_the_wall_beside_it)
{
    enum { WALL, SKY };
    struct prt_fixture f;
    struct prt_light sky;
    prt_fixture_init(&f);
    fixture_floor(&f.s, 2, metal(&f, 0.3f));
    fixture_box(&f.s, vec3_of(-2, 0, -2), vec3_of(-1.9f, 8, 2), false,
                fixture_matte(&f.s, vec3_of(0.8f, 0.1f, 0.1f)));
    prt_fixture_open(&f, "density=6,rays=512,coefficients=9,glossy=true");
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    double sum[2][3] = { 0 };
    int count = 0;
    prt_uniform_light(&sky);
    for (uint32_t i = 0; i < f.charts.side_texel_count; i++) {
        const vec3s at = chart_texel_of(&f.charts, i)->position;
        if (!prt_is_open(&baked, i) || chart_texel_normal(&f.charts, i).y < 0.9f) continue;
        if (fabsf(at.x + 1) > 0.5f || fabsf(at.z) > 0.5f || at.y > 0.1f) continue;
        for (int side = 0; side < 2; side++) {
            // Mirrored at 45°, the view ray towards −x goes on towards the wall.
            const vec3s to_viewer = glms_vec3_normalize(vec3_of(side == WALL ? 1.0f : -1.0f, 1, 0));
            float radiance[3];
            prt_reflected(&baked, i, &sky, to_viewer, radiance);
            for (int c = 0; c < 3; c++) sum[side][c] += (double)radiance[c];
        }
        count++;
    }
    CHECK(count > 10);
    for (int side = 0; side < 2; side++)
        print_message("%s: %.3f %.3f %.3f\n", side == WALL ? "wall" : "sky", sum[side][0] / count,
                      sum[side][1] / count, sum[side][2] / count);
    CHECK(sum[SKY][0] / count > 0.9 && sum[SKY][2] / count > 0.9);
    CHECK(sum[WALL][1] < 0.35 * sum[SKY][1] && sum[WALL][1] < 0.5 * sum[WALL][0]);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}
