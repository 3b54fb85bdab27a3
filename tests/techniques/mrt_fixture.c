// Operators and transfer of dictionary cubes.
#include "techniques/mrt_fixture.h"

#include "framework/test.h"

#include "core/parallel.h"

#include "techniques/mrt/dictionary/prior.h"

enum { RAYS = 16384, PROBES = 4, K_D = 64, MAX_RESOLUTION = 16 };

static struct mrt_cube_operators kept[MAX_RESOLUTION + 1];

static void run_task(void *user, size_t i)
{
    mrt_cube_operators_run(user, i);
}

static void finish_kept(void)
{
    for (int i = 0; i <= MAX_RESOLUTION; i++) mrt_cube_operators_finish(test_host(), &kept[i]);
}

const struct mrt_cube_operators *mrt_fixture_cube(int resolution)
{
    struct mrt_cube_operators *o = &kept[resolution];
    if (o->probes) return o;
    CHECK(mrt_cube_operators_init(test_host(), resolution, PROBES, RAYS, o));
    parallel_for(mrt_cube_operators_tasks(o), 8, run_task, o);
    return o;
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
