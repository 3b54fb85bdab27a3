#include "techniques/mrt/mrt_runtime_fixture.h"

#include "techniques/mrt/mrt_fixture.h"

#include "core/rng.h"

#include <stdlib.h>
#include <string.h>

static void make_geometry(struct mrt_runtime_fixture *f, vec3s reflectance)
{
    int n = f->atlas.resolution;
    f->images.geometry = calloc((size_t)f->atlas.texels, sizeof *f->images.geometry);
    for (int i = 0; i < f->atlas.texels; i++) {
        const struct mrt_tile *tile = &f->atlas.tiles[i / (n * n)];
        float s = ((float)(i % n) + 0.5f) / (float)n, t = ((float)(i / n % n) + 0.5f) / (float)n;
        const vec3s *corner = f->map.blocks[tile->block].corner;
        vec3s wall = cube_face_point(tile->face, s, t);
        f->images.geometry[i] = (struct mrt_geometry_texel){
            .position = mrt_warp_point(corner, wall),
            .normal = glms_vec3_negate(mrt_warp_face_normal(corner, tile->face, wall)),
            .reflectance = reflectance,
            .found = true,
            .area_m2 =
                mrt_wall_area(&f->map.blocks[tile->block], tile->face, s, t) / (float)(n * n),
        };
    }
}

static struct matrix_f32 zeros(int rows, int columns)
{
    struct matrix_f32 m;
    CHECK(matrix_f32_init(test_host(), &m, (size_t)rows, (size_t)columns));
    return m;
}

// One basis for each block: equal ones need not be shared.
static void make_bases(struct mrt_runtime_fixture *f)
{
    struct mrt_operators *o = &f->operators;
    o->basis_count = f->map.count;
    o->bases = host_alloc(test_host(), (size_t)f->map.count, sizeof *o->bases);
    o->basis_of_block = host_alloc(test_host(), (size_t)f->map.count, sizeof *o->basis_of_block);
    for (int b = 0; b < f->map.count; b++) {
        struct mrt_shape shape = mrt_cube(f->atlas.resolution, f->map.blocks[b].open);
        int texels = mrt_shape_texels(&shape);
        o->bases[b] =
            (struct mrt_block_basis){ .t_db = zeros(o->k_b, texels),
                                      .u = { zeros(texels, o->k_b), zeros(4 * texels, o->k_b) } };
        o->basis_of_block[b] = b;
    }
}

static void make_responses(struct mrt_runtime_fixture *f)
{
    struct mrt_operators *o = &f->operators;
    const int face = f->atlas.resolution * f->atlas.resolution;
    o->response_count = CUBE_FACES;
    o->responses = host_alloc(test_host(), CUBE_FACES, sizeof *o->responses);
    for (int i = 0; i < CUBE_FACES; i++)
        o->responses[i] =
            (struct mrt_block_response){ { zeros(6 * face, o->k_r), zeros(24 * face, o->k_r) } };
}

static void make_openings(struct mrt_runtime_fixture *f)
{
    struct mrt_operators *o = &f->operators;
    o->openings = host_alloc(test_host(), CUBE_FACES * (size_t)f->map.count, sizeof *o->openings);
    for (int i = 0; i < CUBE_FACES * f->map.count; i++) {
        const struct mrt_block *block = &f->map.blocks[i / CUBE_FACES];
        if (block->neighbor[i % CUBE_FACES].block < 0) continue;
        o->openings[o->opening_count++] = (struct mrt_opening){ .block = i / CUBE_FACES,
                                                                .face = i % CUBE_FACES,
                                                                .response = i % CUBE_FACES };
    }
}

void mrt_runtime_fixture_init(struct mrt_runtime_fixture *f, struct mrt_block_map map,
                              int resolution, int k_b, int k_r, vec3s reflectance)
{
    *f = (struct mrt_runtime_fixture){
        .map = map, .operators = { .host = test_host(), .k_b = k_b, .k_r = k_r }
    };
    CHECK(mrt_atlas_init(test_host(), &f->map, resolution, &f->atlas));
    make_geometry(f, reflectance);
    make_bases(f);
    make_responses(f);
    make_openings(f);
    f->input.map = &f->map;
    f->input.atlas = &f->atlas;
    f->input.images = &f->images;
    f->input.operators = &f->operators;
}

void mrt_runtime_fixture_finish(struct mrt_runtime_fixture *f)
{
    mrt_operators_finish(&f->operators);
    mrt_atlas_finish(&f->atlas);
    mrt_block_map_finish(&f->map);
    free(f->images.geometry);
}

static void randomize(struct matrix_f32 *m, struct rng *rng, float scale, float least)
{
    for (size_t i = 0; i < m->rows * m->columns; i++) m->at[i] = scale * (rng_float(rng) - least);
}

static void make_pairs(struct mrt_runtime_fixture *f, struct rng *rng)
{
    struct mrt_operators *o = &f->operators;
    for (int i = 0; i < o->opening_count; i++) {
        struct mrt_opening *opening = &o->openings[i];
        opening->pairs = host_alloc(test_host(), 2, sizeof *opening->pairs);
        opening->pair_count = 2;
        for (int k = 0; k < 2; k++) {
            struct mrt_pair *pair = &opening->pairs[k];
            pair->source = (int)(rng_u32(rng) % (uint32_t)f->map.count);
            pair->of_b = zeros(o->k_b, o->k_r);
            randomize(&pair->of_b, rng, 1.0f, 0.5f);
        }
    }
}

void mrt_runtime_fixture_randomize(struct mrt_runtime_fixture *f, uint32_t seed)
{
    struct mrt_operators *o = &f->operators;
    struct rng rng = rng_for(seed, 0, 0);
    for (int b = 0; b < f->map.count; b++) {
        // As in a dictionary: small in T_d→b, large in U_b.
        randomize(&o->bases[b].t_db, &rng, 1e-6f, 0.3f);
        randomize(&o->bases[b].u[MRT_IRRADIANCE], &rng, 1e3f, 0.3f);
        randomize(&o->bases[b].u[MRT_VECTOR], &rng, 1e3f, 0.3f);
    }
    for (int face = 0; face < CUBE_FACES; face++) {
        randomize(&o->responses[face].u[MRT_IRRADIANCE], &rng, 1.0f, 0.3f);
        randomize(&o->responses[face].u[MRT_VECTOR], &rng, 1.0f, 0.3f);
    }
    make_pairs(f, &rng);
}

static void copy_matrix(const struct matrix_f64 *from, struct matrix_f32 *to)
{
    CHECK(from->rows == to->rows && from->columns == to->columns);
    for (size_t i = 0; i < from->rows; i++)
        for (size_t k = 0; k < from->columns; k++)
            to->at[i * to->stride + k] = (float)from->at[i * from->stride + k];
}

void mrt_runtime_fixture_use_closed_cube(struct mrt_runtime_fixture *f)
{
    struct mrt_shape cube = mrt_cube(f->atlas.resolution, 0);
    struct matrix_f64 gather;
    struct mrt_transfer transfer;
    mrt_fixture_transfer(&cube, f->operators.k_b, true, &gather, &transfer);
    copy_matrix(&transfer.t_db, &f->operators.bases[0].t_db);
    copy_matrix(&transfer.u_b, &f->operators.bases[0].u[MRT_IRRADIANCE]);
    matrix_f64_finish(test_host(), &gather);
    mrt_transfer_finish(test_host(), &transfer);
}

struct mrt_block_map mrt_one_block(vec3s min, vec3s max)
{
    struct mrt_block_map map;
    CHECK(mrt_block_map_init(test_host(), "one block", 1, &map));
    mrt_block_init(&map.blocks[0], "box", MRT_BLOCK_CUBE);
    mrt_block_set_box(&map.blocks[0], (struct box3){ min, max });
    return map;
}

// ---- the same result by the matrices

// [block][k_b][3]
static double *project(const struct mrt_runtime_fixture *f, const float *radiosity)
{
    int k_b = f->operators.k_b, per_tile = f->atlas.resolution * f->atlas.resolution;
    double *b = calloc((size_t)(f->map.count * k_b * 3), sizeof *b);
    int first[MRT_MAX_BLOCKS] = { 0 };
    for (int t = f->atlas.tile_count - 1; t >= 0; t--)
        first[f->atlas.tiles[t].block] = f->atlas.tiles[t].first_texel;
    for (int i = 0; i < f->atlas.texels; i++) {
        int block = f->atlas.tiles[i / per_tile].block;
        const struct matrix_f32 *t_db = &f->operators.bases[block].t_db;
        for (int m = 0; m < k_b; m++)
            for (int c = 0; c < 3; c++)
                b[(block * k_b + m) * 3 + c] +=
                    (double)t_db->at[(size_t)m * t_db->stride + (size_t)(i - first[block])] *
                    (double)radiosity[3 * i + c];
    }
    return b;
}

// [opening][k_r][3]
static double *couple(const struct mrt_runtime_fixture *f, const double *b)
{
    const struct mrt_operators *o = &f->operators;
    double *r = calloc((size_t)(o->opening_count * o->k_r * 3) + 1, sizeof *r);
    for (int i = 0; i < o->opening_count; i++)
        for (int p = 0; p < o->openings[i].pair_count; p++) {
            const struct mrt_pair *pair = &o->openings[i].pairs[p];
            for (int k = 0; k < o->k_r; k++)
                for (int m = 0; m < o->k_b; m++)
                    for (int c = 0; c < 3; c++)
                        r[(i * o->k_r + k) * 3 + c] += (double)pair->of_b.at[m * o->k_r + k] *
                                                       b[(pair->source * o->k_b + m) * 3 + c];
        }
    return r;
}

static double row_dot(const struct matrix_f32 *m, int row, const double *x, int c)
{
    double sum = 0.0;
    for (size_t k = 0; k < m->columns; k++)
        sum += (double)m->at[(size_t)row * m->stride + k] * x[3 * k + (size_t)c];
    return sum;
}

static float *solve(const struct mrt_runtime_fixture *f, const float *radiosity, int values)
{
    int per_tile = f->atlas.resolution * f->atlas.resolution, k_b = f->operators.k_b, rows = 0;
    double *b = project(f, radiosity), *r = couple(f, b);
    float *out = calloc((size_t)(f->atlas.texels * values * 3), sizeof *out);
    for (int i = 0, block = -1; i < f->atlas.texels * values; i++, rows++) {
        const struct mrt_tile *tile = &f->atlas.tiles[i / values / per_tile];
        if (tile->block != block) rows = 0;
        block = tile->block;
        const struct mrt_block_basis *basis = &f->operators.bases[block];
        for (int c = 0; c < 3; c++) {
            double sum = row_dot(&basis->u[values == 1 ? MRT_IRRADIANCE : MRT_VECTOR], rows,
                                 b + 3 * block * k_b, c);
            for (int o = 0; o < f->operators.opening_count; o++) {
                if (f->operators.openings[o].block != block) continue;
                const struct mrt_block_response *response =
                    &f->operators.responses[f->operators.openings[o].face];
                int row = (tile->face * per_tile + i / values % per_tile) * values + i % values;
                sum += row_dot(&response->u[values == 1 ? MRT_IRRADIANCE : MRT_VECTOR], row,
                               r + 3 * o * f->operators.k_r, c);
            }
            out[3 * i + c] = (float)sum;
        }
    }
    free(b);
    free(r);
    return out;
}

float *mrt_runtime_fixture_solve(const struct mrt_runtime_fixture *f, const float *radiosity)
{
    return solve(f, radiosity, 1);
}

float *mrt_runtime_fixture_solve_vector(const struct mrt_runtime_fixture *f, const float *radiosity)
{
    return solve(f, radiosity, 4);
}
