#include "techniques/mrt/mrt_operators_fixture.h"

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

static struct mrt_dictionary empty(enum mrt_maze maze, int resolution, int k_b, int k_rlf, int k_r)
{
    struct mrt_dictionary d = { .element_count = mrt_dictionary_shapes(maze),
                                .entered_count = mrt_entered_shapes(maze) };
    d.options.maze = (int32_t)maze;
    d.options.texels = resolution;
    d.options.modes = k_b;
    d.options.lightfield_modes = k_rlf;
    d.options.response_modes = k_r;
    return d;
}

struct mrt_dictionary mrt_random_operators(enum mrt_maze maze, int resolution, int k_b, int k_rlf,
                                           int k_r, uint32_t seed)
{
    struct rng rng = rng_for(seed, 3, 1);
    struct mrt_dictionary o = empty(maze, resolution, k_b, k_rlf, k_r);
    for (int i = 0; i < mrt_dictionary_shapes(maze); i++) {
        const struct mrt_shape shape = mrt_dictionary_shape(maze, resolution, i);
        const int texels = mrt_shape_texels(&shape);
        o.element[i].t_db = random_matrix(&rng, k_b, texels);
        o.element[i].u_b = random_matrix(&rng, texels, k_b);
        for (int f = 0; f < CUBE_FACES; f++) o.element[i].r_b[f] = random_matrix(&rng, k_rlf, k_b);
    }
    for (int t = 0; t < (maze == MRT_MAZE_3D ? MRT_TURNS_3D : MRT_TURNS_2D); t++)
        o.r_turn[t] = random_matrix(&rng, k_rlf, k_rlf);
    for (int i = 0; i < o.entered_count; i++) {
        const struct mrt_shape entered = mrt_entered_shape(maze, resolution, i);
        o.entered[i].t_r = random_matrix(&rng, k_r, k_rlf);
        o.entered[i].u_r = random_matrix(&rng, mrt_shape_texels(&entered), k_r);
    }
    return o;
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
static void fill_cube(const struct mrt_dictionary *o, int i, struct mrt_element *out)
{
    struct mrt_shape cube =
        mrt_cube(RESOLUTION, mrt_cube_missing((enum mrt_maze)o->options.maze, i));
    int texels = mrt_shape_texels(&cube);
    out->t_db = identity(o->options.modes, texels);
    out->u_b = zero_matrix(texels, o->options.modes);
    for (int f = 0; f < CUBE_FACES; f++) {
        out->r_b[f] = zero_matrix(o->options.lightfield_modes, o->options.modes);
        if (!(cube.missing >> f & 1u)) continue;
        struct matrix_f32 one = identity(texels, o->options.modes);
        CHECK(mrt_lightfield_of_surfaces(test_host(), LIGHTFIELD, &cube, f, &one, 0, &out->r_b[f]));
        matrix_f32_finish(test_host(), &one);
    }
}

static struct matrix_f32 response(int samples)
{
    struct mrt_shape entered = mrt_entered_shape(MRT_MAZE_3D, RESOLUTION, 0);
    struct matrix_f32 m = zero_matrix(mrt_shape_texels(&entered), samples);
    struct mrt_rays rays;
    CHECK(mrt_rays_init(test_host(), MRT_IRRADIANCE, RAYS, &rays));
    for (size_t t = 0; t < m.rows; t++)
        mrt_gather_interface(LIGHTFIELD, &entered, mrt_shape_texel(&entered, (int)t), &rays,
                             m.at + t * m.stride);
    mrt_rays_finish(test_host(), &rays);
    return m;
}

struct mrt_dictionary mrt_unreduced_operators(void)
{
    struct mrt_dictionary o =
        empty(MRT_MAZE_3D, RESOLUTION, texels_of(RESOLUTION, 0),
              (int)mrt_lightfield_samples(LIGHTFIELD), texels_of(RESOLUTION, 1u << CUBE_BACK));
    int k_rlf = o.options.lightfield_modes, k_r = o.options.response_modes;
    for (int i = 0; i < mrt_dictionary_shapes(MRT_MAZE_3D); i++) fill_cube(&o, i, &o.element[i]);
    struct matrix_f32 one = identity(k_rlf, k_rlf);
    for (int t = 0; t < MRT_TURNS_3D; t++) {
        o.r_turn[t] = zero_matrix(k_rlf, k_rlf);
        CHECK(mrt_propagate(test_host(), LIGHTFIELD, (enum mrt_turn)t, &one, 0, &o.r_turn[t]));
    }
    matrix_f32_finish(test_host(), &one);
    o.entered[0].t_r = response(k_rlf);
    o.entered[0].u_r = identity(k_r, k_r);
    return o;
}
