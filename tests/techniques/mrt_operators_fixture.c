#include "techniques/mrt_operators_fixture.h"

#include "framework/test.h"

#include "core/rng.h"

static struct matrix_f32 random_matrix(struct rng *rng, int rows, int columns)
{
    struct matrix_f32 m;
    CHECK(matrix_f32_init(test_host(), &m, (size_t)rows, (size_t)columns));
    // About the norm of a rotation, so that long paths neither vanish nor grow.
    for (int i = 0; i < rows * columns; i++)
        m.at[i] = (2.0f * rng_float(rng) - 1.0f) / glm_max(1.0f, (float)columns / 3.0f);
    return m;
}

static int texels_of(int resolution, unsigned missing)
{
    struct mrt_shape cube = mrt_cube(resolution, missing);
    return mrt_shape_texels(&cube);
}

struct mrt_operators mrt_random_operators(enum mrt_maze maze, int resolution, int k_b, int k_rlf,
                                          int k_r, uint32_t seed)
{
    struct rng rng = rng_for(seed, 3, 1);
    struct mrt_operators o = { .maze = maze, .resolution = resolution };
    o.k_b = k_b;
    o.k_rlf = k_rlf;
    o.k_r = k_r;
    for (int i = 0; i < mrt_cube_count(maze); i++) {
        int texels = texels_of(resolution, mrt_cube_missing(maze, i));
        o.cube[i].t_db = random_matrix(&rng, k_b, texels);
        o.cube[i].u_b = random_matrix(&rng, texels, k_b);
        for (int f = 0; f < CUBE_FACES; f++) o.cube[i].r_b[f] = random_matrix(&rng, k_rlf, k_b);
    }
    for (int t = 0; t < (maze == MRT_MAZE_2D ? MRT_TURNS_2D : MRT_TURNS_3D); t++)
        o.turn[t] = random_matrix(&rng, k_rlf, k_rlf);
    o.t_r = random_matrix(&rng, k_r, k_rlf);
    o.u_r = random_matrix(&rng, texels_of(resolution, 1u << CUBE_BACK), k_r);
    return o;
}

void mrt_operators_finish(struct mrt_operators *o)
{
    for (int i = 0; i < MRT_MAX_CUBES; i++) {
        matrix_f32_finish(test_host(), &o->cube[i].t_db);
        matrix_f32_finish(test_host(), &o->cube[i].u_b);
        for (int f = 0; f < CUBE_FACES; f++) matrix_f32_finish(test_host(), &o->cube[i].r_b[f]);
    }
    for (int t = 0; t < MRT_TURNS_3D; t++) matrix_f32_finish(test_host(), &o->turn[t]);
    matrix_f32_finish(test_host(), &o->t_r);
    matrix_f32_finish(test_host(), &o->u_r);
}

// ---- without reduction

enum { RESOLUTION = 4, RAYS = 4096 };
static const struct mrt_lightfield LIGHTFIELD = { .positions = 4,
                                                  .directions = 8,
                                                  .supersampling = 3 };

static struct matrix_f32 zero_matrix(int rows, int columns)
{
    struct matrix_f32 m;
    CHECK(matrix_f32_init(test_host(), &m, (size_t)rows, (size_t)columns));
    return m;
}

static struct matrix_f32 identity(int rows, int columns)
{
    struct matrix_f32 m = zero_matrix(rows, columns);
    for (int i = 0; i < rows && i < columns; i++) m.at[(size_t)i * m.stride + (size_t)i] = 1.0f;
    return m;
}

// Lightfields at the openings of one cube.
static void fill_cube(const struct mrt_operators *o, int i, struct mrt_cube_matrices *out)
{
    struct mrt_shape cube = mrt_cube(RESOLUTION, mrt_cube_missing(o->maze, i));
    int texels = mrt_shape_texels(&cube);
    out->t_db = identity(o->k_b, texels);
    out->u_b = zero_matrix(texels, o->k_b);
    for (int f = 0; f < CUBE_FACES; f++) {
        out->r_b[f] = zero_matrix(o->k_rlf, o->k_b);
        if (!(cube.missing >> f & 1u)) continue;
        struct matrix_f32 one = identity(texels, o->k_b);
        struct matrix_f32 seen = zero_matrix(texels_of(RESOLUTION, 1u << CUBE_FRONT), o->k_b);
        mrt_seen_from_opening(&cube, f, &one, &seen);
        CHECK(mrt_lightfield_of_surfaces(test_host(), LIGHTFIELD, &seen, RESOLUTION, 0,
                                         &out->r_b[f]));
        matrix_f32_finish(test_host(), &one);
        matrix_f32_finish(test_host(), &seen);
    }
}

static struct matrix_f32 response(int samples)
{
    struct mrt_shape entered = mrt_cube_entered(RESOLUTION);
    struct matrix_f32 m = zero_matrix(mrt_shape_texels(&entered), samples);
    struct mrt_rays rays;
    CHECK(mrt_rays_init(test_host(), MRT_IRRADIANCE, RAYS, &rays));
    for (size_t t = 0; t < m.rows; t++)
        mrt_gather_interface(LIGHTFIELD, mrt_shape_texel(&entered, (int)t), &rays,
                             m.at + t * m.stride);
    mrt_rays_finish(test_host(), &rays);
    return m;
}

struct mrt_operators mrt_unreduced_operators(void)
{
    struct mrt_operators o = { .maze = MRT_MAZE_3D, .resolution = RESOLUTION };
    o.k_rlf = (int)mrt_lightfield_samples(LIGHTFIELD);
    o.k_b = texels_of(RESOLUTION, 0);
    o.k_r = texels_of(RESOLUTION, 1u << CUBE_BACK);
    for (int i = 0; i < mrt_cube_count(o.maze); i++) fill_cube(&o, i, &o.cube[i]);
    struct matrix_f32 one = identity(o.k_rlf, o.k_rlf);
    for (int t = 0; t < MRT_TURNS_3D; t++) {
        o.turn[t] = zero_matrix(o.k_rlf, o.k_rlf);
        CHECK(mrt_propagate(test_host(), LIGHTFIELD, (enum mrt_turn)t, &one, 0, &o.turn[t]));
    }
    matrix_f32_finish(test_host(), &one);
    o.t_r = response(o.k_rlf);
    o.u_r = identity(o.k_r, o.k_r);
    return o;
}
