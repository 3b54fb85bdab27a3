// Irradiance of receivers beside a sphere by one, three and six volumes, against an integral over
// the sphere's solid angle above the receiver's horizon.
#include "framework/test.h"
#include "techniques/dnrt/sphere_fixture.h"

#include "techniques/dnrt/bake/transfer.h"

#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>

// The part of an irradiance of π that the sphere occludes: ∫ (ω·n)₊ dω.
static double hidden_exactly(vec3s point, vec3s n)
{
    enum { DIRECTIONS = 4096 };
    const float d = glms_vec3_norm(point), low = sqrtf(1 - 1 / (d * d));
    const vec3s n_o = glms_vec3_divs(point, -d);
    vec3s a, b;
    double sum = 0;
    basis_of(n_o, &a, &b);
    for (uint32_t i = 0; i < DIRECTIONS; i++) {
        const vec2s u = sobol_2d(i, 1);
        const float z = 1 - u.x * (1 - low), r = sqrtf(1 - z * z), phi = 2 * GLM_PIf * u.y;
        vec3s direction = glms_vec3_scale(n_o, z);
        direction = glms_vec3_muladds(a, r * cosf(phi), direction);
        direction = glms_vec3_muladds(b, r * sinf(phi), direction);
        sum += (double)fmaxf(glms_vec3_dot(direction, n), 0);
    }
    return sum * 2 * M_PI * (double)(1 - low) / DIRECTIONS;
}

// The same from the volumes, with the weights of dnrt_receiver.glsl.
static double hidden_by(const struct traced_shape *ball, int normals, vec3s point, vec3s n,
                        uint32_t seed)
{
    const struct dnrt_sampling how = { ball->trace, vec3_of(0, 0, 0), 1, 1, 256, normals, false };
    struct dnrt_transfer at;
    const float d = glms_vec3_norm(point), cosine = -glms_vec3_dot(point, n) / d;
    const float part = glm_clamp(0.5f + 0.5f * cosine * d, 0, 1);
    const float alone =
        powf(n.x * n.x * n.x * n.x + n.y * n.y * n.y * n.y + n.z * n.z * n.z * n.z, 8);
    double sum = 0;
    dnrt_transfer_at(&how, point, seed, &at);
    for (int i = 0; i < normals; i++) {
        const int axis = normals == 6 ? i / 2 : i;
        const float side = normals == 6 && i % 2 ? -1.0f : 1.0f;
        const float above = part * n.raw[axis] - part * (1 - part) / d * point.raw[axis] / d;
        float weight = fmaxf(cosine, 0);
        if (normals > 1) weight = side * above;
        if (normals == 6) {
            const float square = n.raw[axis] * n.raw[axis];
            weight = (1 - alone) * weight + (side * n.raw[axis] > 0 ? alone * square : 0);
        }
        sum += (double)(weight * at.of[i].hidden[0]);
    }
    return sum * M_PI * M_PI / 0.28209479;
}

struct errors {
    double of[3]; // by 1, 3 and 6 volumes: mean absolute, over the mean irradiance
};

// Errors at receivers at a distance in all directions, with normals at this angle to the nearest
// axis.
static struct errors errors_at(const struct traced_shape *ball, float degrees, float distance)
{
    enum { RECEIVERS = 400 };
    struct errors errors = { { 0 } };
    struct rng rng = rng_for(3, 4, 5);
    double mean = 0;
    for (uint32_t i = 0; i < RECEIVERS; i++) {
        const float u = rng_float(&rng);
        const vec3s point =
            glms_vec3_scale(sample_sphere((vec2s){ { u, rng_float(&rng) } }), distance);
        const float turn = 2 * GLM_PIf * rng_float(&rng), angle = glm_rad(degrees);
        const float plane = degrees > 45 ? GLM_PI_4f : turn; // at 54.7° all axes are alike
        const vec3s n = vec3_of(sinf(angle) * cosf(plane), cosf(angle), sinf(angle) * sinf(plane));
        const double exact = hidden_exactly(point, n);
        mean += exact;
        for (int v = 0; v < 3; v++)
            errors.of[v] +=
                fabs(hidden_by(ball, (const int[]){ 1, 3, 6 }[v], point, n, 2 * i + 1) - exact);
    }
    for (int v = 0; v < 3; v++) errors.of[v] /= mean;
    return errors;
}

TEST(several_normals_have_the_lower_error_of_oblique_receivers_nearby)
{
    struct traced_shape ball;
    const struct material material = material_default();
    traced_shape_open(&ball, &material, sphere_fixture_add);
    for (int d = 0; d < 3; d++)
        for (int a = 0; a < 4; a++) {
            const float distance = (const float[]){ 1.2f, 1.5f, 2.5f }[d];
            const float degrees = (const float[]){ 0, 30, 45, 54.7f }[a];
            const struct errors at = errors_at(&ball, degrees, distance);
            print_message("distance %.1f, %4.1f degrees: 1 %.3f, 3 %.3f, 6 %.3f\n",
                          (double)distance, (double)degrees, at.of[0], at.of[1], at.of[2]);
            CHECK(at.of[1] < 0.5 * at.of[0] && at.of[2] < 0.5 * at.of[0]);
            if (degrees == 0) CHECK(at.of[2] < 0.01);
        }
    traced_shape_close(&ball);
}
