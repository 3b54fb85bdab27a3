// Operators and transfer of dictionary cubes.
#include "techniques/mrt/mrt_fixture.h"

#include "framework/test.h"

#include "core/parallel.h"

#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/dictionary/prior.h"

enum { RAYS = 16384, PROBES = 4, K_D = 64, MAX_RESOLUTION = 16 };

struct closed_cube {
    struct mrt_shape cube;
    struct mrt_rays rays[3];
    struct mrt_cube_operators operators;
    bool ready;
};

static struct closed_cube kept[MAX_RESOLUTION + 1];

static void gather_point(struct closed_cube *c, enum mrt_measure measure, size_t i)
{
    struct matrix_f32 *to = &c->operators.by_measure[measure];
    const struct mrt_rays *rays = &c->rays[measure];
    size_t values = (size_t)rays->values;
    if (i >= to->rows / values) return;
    mrt_gather(&c->cube, mrt_gather_point(&c->cube, PROBES, measure, (int)i), rays,
               to->at + i * values * to->stride, to->stride);
}

static void gather_all(void *user, size_t i)
{
    for (int m = 0; m < 3; m++) gather_point(user, (enum mrt_measure)m, i);
}

static void finish_kept(void)
{
    for (int i = 0; i <= MAX_RESOLUTION; i++)
        for (int m = 0; m < 3; m++) {
            mrt_rays_finish(test_host(), &kept[i].rays[m]);
            matrix_f32_finish(test_host(), &kept[i].operators.by_measure[m]);
        }
}

const struct mrt_rays *mrt_fixture_rays(int resolution, enum mrt_measure measure)
{
    mrt_fixture_cube(resolution);
    return &kept[resolution].rays[measure];
}

const struct mrt_cube_operators *mrt_fixture_cube(int resolution)
{
    struct closed_cube *c = &kept[resolution];
    if (c->ready) return &c->operators;
    c->cube = mrt_cube(resolution, 0);
    size_t texels = (size_t)mrt_shape_texels(&c->cube);
    for (int m = 0; m < 3; m++) {
        size_t points = m == MRT_PROBE ? PROBES * PROBES * PROBES : texels;
        CHECK(mrt_rays_init(test_host(), (enum mrt_measure)m, RAYS, &c->rays[m]));
        CHECK(matrix_f32_init(test_host(), &c->operators.by_measure[m],
                              points * (size_t)c->rays[m].values, texels));
    }
    parallel_for(texels, 8, gather_all, c);
    c->ready = true;
    return &c->operators;
}

static bool finish_at_end(void)
{
    finish_kept();
    return true;
}

__attribute__((constructor)) static void register_end(void)
{
    test_register_end(finish_at_end);
}

struct direct_job {
    const struct mrt_shape *shape;
    struct mrt_prior_light *lights;
    struct matrix_f32 column; // lights × texels
};

static void light_column(void *user, size_t i)
{
    struct direct_job *job = user;
    mrt_prior_column(job->shape, job->lights[i], job->column.at + i * job->column.stride, 1);
}

struct matrix_f64 mrt_fixture_direct(const struct mrt_shape *shape)
{
    struct matrix_f64 out = { 0 };
    size_t lights = (size_t)mrt_prior_light_count(shape), texels = (size_t)mrt_shape_texels(shape);
    struct direct_job job = { .shape = shape };
    job.lights = host_alloc(test_host(), lights, sizeof *job.lights);
    CHECK(job.lights && matrix_f32_init(test_host(), &job.column, lights, texels));
    mrt_prior_lights(shape, job.lights);
    parallel_for(lights, 8, light_column, &job);
    CHECK(matrix_f64_init(test_host(), &out, texels, lights));
    for (size_t r = 0; r < texels; r++)
        for (size_t c = 0; c < lights; c++)
            out.at[r * out.stride + c] = (double)job.column.at[c * job.column.stride + r];
    matrix_f32_finish(test_host(), &job.column);
    host_free(test_host(), job.lights);
    return out;
}

void mrt_fixture_transfer(const struct mrt_shape *shape, int k_b, bool enrich, struct matrix_f64 *f,
                          struct mrt_transfer *out)
{
    struct mrt_transfer_options options = { .k_d = K_D, .k_b = k_b, .enrich = enrich };
    struct matrix_f64 direct = mrt_fixture_direct(shape);
    CHECK(mrt_cube_operator_of(test_host(), mrt_fixture_cube(shape->resolution), MRT_IRRADIANCE,
                               shape, f));
    CHECK(mrt_transfer_init(test_host(), shape, f, &direct, &options, out));
    matrix_f64_finish(test_host(), &direct);
}
