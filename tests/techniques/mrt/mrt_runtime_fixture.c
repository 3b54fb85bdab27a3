#include "techniques/mrt/mrt_runtime_fixture.h"

#include "techniques/mrt/mrt_fixture.h"

#include "core/rng.h"

#include <stdlib.h>
#include <string.h>

static void make_geometry(struct mrt_runtime_fixture *f, vec3s reflectance)
{
    int n = f->atlas.resolution;
    f->images.geometry = calloc((size_t)f->atlas.texels, sizeof *f->images.geometry);
    f->images.emitted = calloc((size_t)f->atlas.texels, sizeof *f->images.emitted);
    f->images.sky = calloc((size_t)f->atlas.texels, sizeof *f->images.sky);
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
static void make_bases(struct mrt_runtime_fixture *f, int k_b)
{
    f->bases = calloc((size_t)f->map.count, sizeof *f->bases);
    f->basis_of_block = calloc((size_t)f->map.count, sizeof *f->basis_of_block);
    for (int b = 0; b < f->map.count; b++) {
        struct mrt_shape shape = mrt_cube(f->atlas.resolution, f->map.blocks[b].open);
        int texels = mrt_shape_texels(&shape);
        f->bases[b] =
            (struct mrt_basis_input){ .open = shape.missing,
                                      .t_db = zeros(k_b, texels),
                                      .u = { zeros(texels, k_b), zeros(4 * texels, k_b) } };
        f->basis_of_block[b] = b;
    }
}

static void make_openings(struct mrt_runtime_fixture *f)
{
    f->openings = calloc(CUBE_FACES * (size_t)f->map.count, sizeof *f->openings);
    for (int i = 0; i < CUBE_FACES * f->map.count; i++) {
        const struct mrt_block *block = &f->map.blocks[i / CUBE_FACES];
        if (block->neighbor[i % CUBE_FACES].block < 0) continue;
        f->openings[f->input.opening_count++] =
            (struct mrt_opening_input){ i / CUBE_FACES, i % CUBE_FACES, i % CUBE_FACES };
    }
}

void mrt_runtime_fixture_init(struct mrt_runtime_fixture *f, struct mrt_block_map map,
                              int resolution, int k_b, int k_r, vec3s reflectance)
{
    *f = (struct mrt_runtime_fixture){ .map = map };
    CHECK(mrt_atlas_init(test_host(), &f->map, resolution, &f->atlas));
    make_geometry(f, reflectance);
    make_bases(f, k_b);
    make_openings(f);
    f->input.map = &f->map;
    f->input.atlas = &f->atlas;
    f->input.images = &f->images;
    f->input.k_b = k_b;
    f->input.k_r = k_r;
    f->input.bases = f->bases;
    f->input.basis_count = map.count;
    f->input.basis_of_block = f->basis_of_block;
    f->input.openings = f->openings;
    f->input.responses = f->responses;
    f->input.response_count = CUBE_FACES;
    for (int face = 0; face < CUBE_FACES; face++)
        f->responses[face] =
            (struct mrt_response_input){ { zeros(6 * resolution * resolution, k_r),
                                           zeros(24 * resolution * resolution, k_r) } };
}

void mrt_runtime_fixture_finish(struct mrt_runtime_fixture *f)
{
    for (int b = 0; b < f->map.count; b++) {
        matrix_f32_finish(test_host(), &f->bases[b].t_db);
        matrix_f32_finish(test_host(), &f->bases[b].u[MRT_IRRADIANCE]);
        matrix_f32_finish(test_host(), &f->bases[b].u[MRT_VECTOR]);
    }
    for (int face = 0; face < CUBE_FACES; face++) {
        matrix_f32_finish(test_host(), &f->responses[face].u[MRT_IRRADIANCE]);
        matrix_f32_finish(test_host(), &f->responses[face].u[MRT_VECTOR]);
    }
    mrt_atlas_finish(&f->atlas);
    mrt_block_map_finish(&f->map);
    free(f->images.geometry);
    free(f->images.emitted);
    free(f->images.sky);
    free(f->bases);
    free(f->basis_of_block);
    free(f->openings);
    free(f->pairs);
    free(f->t_br);
}

static void randomize(struct matrix_f32 *m, struct rng *rng, float scale)
{
    for (size_t i = 0; i < m->rows * m->columns; i++) m->at[i] = scale * (rng_float(rng) - 0.3f);
}

static void make_pairs(struct mrt_runtime_fixture *f, struct rng *rng)
{
    int count = 2 * f->input.opening_count, size = f->input.k_r * f->input.k_b;
    f->pairs = calloc((size_t)count + 1, sizeof *f->pairs);
    f->t_br = calloc((size_t)(count * size) + 1, sizeof *f->t_br);
    for (int i = 0; i < count * size; i++) f->t_br[i] = rng_float(rng) - 0.5f;
    for (int i = 0; i < count; i++)
        f->pairs[i] = (struct mrt_pair_input){ i / 2, (int)(rng_u32(rng) % (uint32_t)f->map.count),
                                               f->t_br + i * size };
    f->input.pairs = f->pairs;
    f->input.pair_count = count;
    f->input.t_br_stride = f->input.k_r;
}

void mrt_runtime_fixture_randomize(struct mrt_runtime_fixture *f, uint32_t seed)
{
    struct rng rng = rng_for(seed, 0, 0);
    for (int b = 0; b < f->map.count; b++) {
        // As in a dictionary: small in T_d→b, large in U_b.
        randomize(&f->bases[b].t_db, &rng, 1e-6f);
        randomize(&f->bases[b].u[MRT_IRRADIANCE], &rng, 1e3f);
        randomize(&f->bases[b].u[MRT_VECTOR], &rng, 1e3f);
    }
    for (int face = 0; face < CUBE_FACES; face++) {
        randomize(&f->responses[face].u[MRT_IRRADIANCE], &rng, 1.0f);
        randomize(&f->responses[face].u[MRT_VECTOR], &rng, 1.0f);
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
    mrt_fixture_transfer(&cube, f->input.k_b, true, &gather, &transfer);
    copy_matrix(&transfer.t_db, &f->bases[0].t_db);
    copy_matrix(&transfer.u_b, &f->bases[0].u[MRT_IRRADIANCE]);
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
    int k_b = f->input.k_b, per_tile = f->atlas.resolution * f->atlas.resolution;
    double *b = calloc((size_t)(f->map.count * k_b * 3), sizeof *b);
    int first[MRT_MAX_BLOCKS] = { 0 };
    for (int t = f->atlas.tile_count - 1; t >= 0; t--)
        first[f->atlas.tiles[t].block] = f->atlas.tiles[t].first_texel;
    for (int i = 0; i < f->atlas.texels; i++) {
        int block = f->atlas.tiles[i / per_tile].block;
        const struct matrix_f32 *t_db = &f->bases[block].t_db;
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
    int k_b = f->input.k_b, k_r = f->input.k_r;
    double *r = calloc((size_t)(f->input.opening_count * k_r * 3) + 1, sizeof *r);
    for (int p = 0; p < f->input.pair_count; p++)
        for (int k = 0; k < k_r; k++)
            for (int m = 0; m < k_b; m++)
                for (int c = 0; c < 3; c++)
                    r[(f->pairs[p].opening * k_r + k) * 3 + c] +=
                        (double)f->pairs[p].t_br[m * k_r + k] *
                        b[(f->pairs[p].source * k_b + m) * 3 + c];
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
    int per_tile = f->atlas.resolution * f->atlas.resolution, k_b = f->input.k_b, rows = 0;
    double *b = project(f, radiosity), *r = couple(f, b);
    float *out = calloc((size_t)(f->atlas.texels * values * 3), sizeof *out);
    for (int i = 0, block = -1; i < f->atlas.texels * values; i++, rows++) {
        const struct mrt_tile *tile = &f->atlas.tiles[i / values / per_tile];
        if (tile->block != block) rows = 0;
        block = tile->block;
        const struct mrt_basis_input *basis = &f->bases[block];
        for (int c = 0; c < 3; c++) {
            double sum = row_dot(&basis->u[values == 1 ? MRT_IRRADIANCE : MRT_VECTOR], rows,
                                 b + 3 * block * k_b, c);
            for (int o = 0; o < f->input.opening_count; o++) {
                if (f->openings[o].block != block) continue;
                const struct mrt_response_input *response = &f->responses[f->openings[o].face];
                int row = (tile->face * per_tile + i / values % per_tile) * values + i % values;
                sum += row_dot(&response->u[values == 1 ? MRT_IRRADIANCE : MRT_VECTOR], row,
                               r + 3 * o * f->input.k_r, c);
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
