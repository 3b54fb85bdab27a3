// Profiles of subsurface scattering: their integrals, the published reflectances, and the light of
// all texels nearby.
#include "framework/test.h"

#include "core/rng.h"
#include "techniques/ort/bake/near.h"

#include <math.h>
#include <stdio.h>

static const char *const NAMES[] = { "exponential", "apple",   "chicken1", "chicken2",
                                     "cream",       "ketchup", "marble",   "potato",
                                     "skimmilk",    "skin1",   "skin2",    "wholemilk" };
enum { MATERIALS = sizeof NAMES / sizeof NAMES[0] };

static struct ort_profile profile_of(int material, int colour)
{
    const struct ort_options options = { .material = material, .falloff = 2.0f };
    return ort_profile_of(&options, colour);
}

// Jensen et al. 2001, figure 5: diffuse reflectance, measured, from which the coefficients are.
TEST(dipoles_reflect_what_was_published)
{
    static const double PUBLISHED[MATERIALS][3] = {
        { 1, 1, 1 },          { 0.85, 0.84, 0.53 }, { 0.31, 0.15, 0.10 }, { 0.32, 0.16, 0.10 },
        { 0.98, 0.90, 0.73 }, { 0.16, 0.01, 0.00 }, { 0.83, 0.79, 0.75 }, { 0.77, 0.62, 0.21 },
        { 0.81, 0.81, 0.69 }, { 0.44, 0.22, 0.13 }, { 0.63, 0.44, 0.34 }, { 0.91, 0.88, 0.76 }
    };
    for (int m = 0; m < MATERIALS; m++)
        for (int c = 0; c < 3; c++) {
            const struct ort_profile p = profile_of(m, c);
            printf("%s colour %d: %.3f (%.2f)\n", NAMES[m], c, p.total, PUBLISHED[m][c]);
            CHECK_NEAR(p.total, PUBLISHED[m][c], 0.03);
        }
}

// ∫ P 2πr dr by the trapezoid rule in log r.
static double integral_between(const struct ort_profile *p, double low, double high)
{
    enum { STEPS = 4000 };
    const double step = log(high / low) / STEPS;
    double sum = 0.0;
    for (int i = 0; i <= STEPS; i++) {
        const double r = low * exp(step * i);
        sum += (i == 0 || i == STEPS ? 0.5 : 1.0) * ort_profile_at(p, r) * 2.0 * GLM_PI * r * r;
    }
    return sum * step;
}

TEST(profiles_integrate_to_one_and_to_what_lies_beyond)
{
    for (int m = 0; m < MATERIALS; m++)
        for (int c = 0; c < 3; c++) {
            const struct ort_profile p = profile_of(m, c);
            const double reach = ort_profile_reach(&p, 1e-6), r = ort_profile_reach(&p, 0.3);
            CHECK_NEAR(integral_between(&p, 1e-6 * r, reach), 1.0, 2e-5);
            CHECK_NEAR(integral_between(&p, r, reach), 0.3, 2e-5);
            CHECK_NEAR(ort_profile_beyond(&p, 0.0), 1.0, 1e-12);
        }
}

// A plane of square texels.
static double sum_over_plane(const struct ort_kernel *kernel, int colour, float texel_m)
{
    const int last = (int)ceilf(kernel->reach_m / texel_m);
    double sum = 0.0;
    for (int y = -last; y <= last; y++)
        for (int x = -last; x <= last; x++) {
            float share[3];
            ort_kernel_at(kernel, texel_m * hypotf((float)x, (float)y), texel_m * texel_m, share);
            sum += (double)(share[colour] * texel_m * texel_m);
        }
    return sum;
}

// Texels from so fine that their sum is the integral to so coarse that all light stays in one.
static void check_sums_over_planes(const struct ort_kernel *kernel)
{
    static const float TEXELS_MM[] = { 0.2f, 0.5f, 0.7f, 1, 1.4f, 2, 3, 5, 10, 20, 1000 };
    double least = 1.0, most = 1.0;
    for (size_t i = 0; i < sizeof TEXELS_MM / sizeof *TEXELS_MM; i++)
        for (int c = 0; c < 3; c++) {
            const double sum = sum_over_plane(kernel, c, 1e-3f * TEXELS_MM[i]);
            least = fmin(least, sum);
            most = fmax(most, sum);
        }
    printf("sums of a plane: %.4f to %.4f\n", least, most);
    CHECK(least > 0.99 && most < 1.01);
}

TEST(light_of_a_plane_sums_to_one_whatever_its_texels)
{
    static struct ort_kernel kernel;
    static const int SUBJECTS[] = { 6, 9 }; // marble, skin1
    for (size_t i = 0; i < sizeof SUBJECTS / sizeof *SUBJECTS; i++) {
        ort_kernel_init(&kernel,
                        &(struct ort_options){ .material = SUBJECTS[i], .mm_per_unit = 1000.0f });
        check_sums_over_planes(&kernel);
    }
}

TEST(reach_of_a_scene_of_half_the_size_is_twice_as_far)
{
    static struct ort_kernel kernel;
    ort_kernel_init(&kernel, &(struct ort_options){ .material = 9, .mm_per_unit = 1000.0f });
    const float reach_m = kernel.reach_m;
    ort_kernel_init(&kernel, &(struct ort_options){ .material = 9, .mm_per_unit = 500.0f });
    CHECK_NEAR(kernel.reach_m, 2.0f * reach_m, 1e-5f);
}

// ---- neighbours

enum { TEXELS = 3000 };

struct found {
    const struct charts *charts;
    vec3s from;
    float reach_m;
    int count, within;
};

static void count(void *user, uint32_t texel)
{
    struct found *f = user;
    f->count++;
    f->within += glms_vec3_distance(f->charts->texels[texel].centroid, f->from) <= f->reach_m;
}

TEST(near_texels_are_all_those_within_the_reach)
{
    struct chart_texel *texels = host_alloc(test_host(), TEXELS, sizeof *texels);
    struct ort_map map = { .host = test_host(),
                           .texel_count = TEXELS,
                           .charts = { .texels = texels, .texel_count = TEXELS } };
    struct rng rng = rng_for(1, 2, 3);
    for (int i = 0; i < TEXELS; i++)
        texels[i].centroid =
            vec3_of(rng_float(&rng) - 0.5f, 0.2f * rng_float(&rng), 7.0f * rng_float(&rng));
    static const float REACH[] = { 1e-4f, 0.05f, 0.3f, 2.0f, 100.0f };
    for (size_t k = 0; k < sizeof REACH / sizeof REACH[0]; k++) {
        struct ort_near near;
        CHECK(ort_near_init(&near, &map, REACH[k]));
        for (int i = 0; i < TEXELS; i += 61) {
            struct found found = { &map.charts, texels[i].centroid, REACH[k], 0, 0 };
            int within = 0;
            for (int j = 0; j < TEXELS; j++)
                within += glms_vec3_distance(texels[j].centroid, found.from) <= REACH[k];
            ort_near_visit(&near, found.from, count, &found);
            CHECK(found.within == within && found.count <= TEXELS);
        }
        ort_near_finish(&near);
    }
    host_free(test_host(), texels);
}
