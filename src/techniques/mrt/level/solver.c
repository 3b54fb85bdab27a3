// The solver: operators in the order that the products read, and the steps of a frame.
#include "solver.h"

#include "core/parallel.h"

#include "techniques/mrt/level/opening_view.h"

#include <string.h>

// ---- products of a matrix with three colours at once, eight elements at a time: vectors of the
// compiler, which splits them into those of the processor. Lengths and strides are multiples of
// MRT_LANES.

typedef float lanes __attribute__((vector_size(4 * MRT_LANES), aligned(4), may_alias));

static inline float sum_of(const lanes *v)
{
    // A fixed order, whatever the width of the processor's vectors.
    return (((*v)[0] + (*v)[4]) + ((*v)[1] + (*v)[5])) +
           (((*v)[2] + (*v)[6]) + ((*v)[3] + (*v)[7]));
}

// Two rows share the loads of the values.
static void project_two(const float *m, const float *n, int length, const float *const values[3],
                        float *out_m, float *out_n)
{
    lanes a[3] = { { 0 } }, b[3] = { { 0 } };
    for (int i = 0; i < length; i += MRT_LANES) {
        lanes x = *(const lanes *)(m + i), y = *(const lanes *)(n + i);
        for (int c = 0; c < 3; c++) {
            lanes v = *(const lanes *)(values[c] + i);
            a[c] += x * v;
            b[c] += y * v;
        }
    }
    for (int c = 0; c < 3; c++) {
        out_m[c] = sum_of(&a[c]);
        out_n[c] = sum_of(&b[c]);
    }
}

// out[r · 3 + c] = Σ_i m[r · stride + i] · values[c][i] for `rows` rows of `length` elements.
static void project(const float *m, int stride, int rows, int length, const float *const values[3],
                    float *out)
{
    for (int r = 0; r < rows; r += 2) {
        int s = r + 1 < rows ? r + 1 : r;
        project_two(m + (long)r * stride, m + (long)s * stride, length, values, out + 3 * r,
                    out + 3 * s);
    }
}

// out[c][i] += Σ_r m[r · stride + i] · values[r · 3 + c].
static void expand(const float *m, int stride, int rows, int length, const float *values,
                   float *const out[3])
{
    for (int i = 0; i < length; i += MRT_LANES) {
        lanes sum[3];
        for (int c = 0; c < 3; c++) sum[c] = *(const lanes *)(out[c] + i);
        for (int r = 0; r < rows; r++) {
            lanes x = *(const lanes *)(m + (long)r * stride + i);
            for (int c = 0; c < 3; c++) sum[c] += x * values[3 * r + c];
        }
        for (int c = 0; c < 3; c++) *(lanes *)(out[c] + i) = sum[c];
    }
}

// ---- sizes

// Walls of a shape of the dictionary.
static int walls_of(enum mrt_maze maze, int shape)
{
    if (maze == MRT_TUNNEL) return 1;
    struct mrt_shape cube = mrt_cube(1, mrt_cube_missing(maze, shape));
    return mrt_shape_texels(&cube);
}

// The padded index of a texel: each wall starts at a multiple of the lanes.
static int padded(const struct mrt_solver *s, int texel)
{
    int n = s->level->resolution * s->level->resolution;
    return texel / n * s->face_texels + texel % n;
}

static int block_stride(const struct mrt_solver *s)
{
    return 3 * (s->level->maze == MRT_TUNNEL ? 1 : CUBE_FACES) * s->face_texels;
}

static int entry_stride(const struct mrt_level *level)
{
    return 3 * (level->link_stride + level->k_r);
}

// ---- operators

// Padded texels of a cube.
static size_t cube_stride(const struct mrt_solver *s, int cube)
{
    return (size_t)walls_of(s->level->maze, cube) * (size_t)s->face_texels;
}

// Modes × padded texels; the two strides of `from`.
static float *copy_modes(const struct mrt_solver *s, int cube, const struct matrix_f32 *from,
                         size_t by_mode, size_t by_texel)
{
    const size_t stride = cube_stride(s, cube), modes = (size_t)s->level->k_b;
    const size_t texels = by_mode == 1 ? from->rows : from->columns;
    float *out = host_alloc(s->host, stride * modes, sizeof *out);
    for (size_t t = 0; out && t < texels; t++)
        for (size_t m = 0; m < modes; m++)
            out[m * stride + (size_t)padded(s, (int)t)] = from->at[m * by_mode + t * by_texel];
    return out;
}

static bool copy_cube(struct mrt_solver *s, int cube)
{
    const struct mrt_element *from = &s->level->dictionary->element[cube];
    s->t_db[cube] = copy_modes(s, cube, &from->t_db, from->t_db.stride, 1);
    s->u_b[cube] = copy_modes(s, cube, &from->u_b, 1, from->u_b.stride);
    return s->t_db[cube] && s->u_b[cube];
}

static bool copy_retraced(struct mrt_solver *s)
{
    const struct mrt_retraces *from = &s->level->retraces;
    s->t_retraced = host_alloc(s->host, (size_t)from->count, sizeof *s->t_retraced);
    s->u_retraced = host_alloc(s->host, (size_t)from->count, sizeof *s->u_retraced);
    bool ok = s->t_retraced && s->u_retraced;
    for (int i = 0; ok && i < from->count; i++) {
        const struct mrt_retraced *of = &from->at[i];
        s->t_retraced[i] = copy_modes(s, of->cube, &of->t_db, of->t_db.stride, 1);
        s->u_retraced[i] = copy_modes(s, of->cube, &of->u_b, 1, of->u_b.stride);
        ok = s->t_retraced[i] && s->u_retraced[i];
    }
    return ok;
}

// Light that enters blocks that are no cubes.
static bool copy_ratios(struct mrt_solver *s)
{
    const struct mrt_level *level = s->level;
    const struct mrt_shape closed = mrt_cube(level->resolution, 0);
    const size_t texels = (size_t)mrt_shape_texels(&closed);
    if (level->retraces.count == 0) return true;
    s->ratios = host_alloc(s->host, (size_t)level->entry_count * texels, sizeof *s->ratios);
    for (int e = 0; s->ratios && e < level->entry_count; e++) {
        const struct mrt_entry *entry = &level->entries[e];
        float *to = s->ratios + (size_t)e * texels;
        for (size_t t = 0; t < texels; t++) to[t] = 1.0f;
        if (mrt_level_retraced(level, entry->block))
            mrt_opening_ratios(
                &closed, mrt_warp_jacobian(level->map->blocks[entry->block].corner, GLMS_VEC3_ZERO),
                entry->face, to);
    }
    return s->ratios;
}

// Walls of a shape that light enters.
static size_t entered_walls(const struct mrt_solver *s)
{
    return s->level->maze == MRT_TUNNEL ? 1 : CUBE_FACES - 1;
}

static bool copy_response(struct mrt_solver *s)
{
    size_t n = (size_t)(s->level->resolution * s->level->resolution), walls = entered_walls(s);
    size_t face = (size_t)s->face_texels, k_r = (size_t)s->level->k_r;
    size_t count = (size_t)s->level->dictionary->entered_count;
    s->u_r = host_alloc(s->host, count * walls * k_r * face, sizeof *s->u_r);
    if (!s->u_r) return false;
    for (size_t i = 0; i < count * walls * n; i++) {
        const struct matrix_f32 *u_r = &s->level->dictionary->entered[i / (walls * n)].u_r;
        size_t t = i % (walls * n), wall = i / n, in_wall = i % n;
        for (size_t r = 0; r < k_r; r++)
            s->u_r[(wall * k_r + r) * face + in_wall] = u_r->at[t * u_r->stride + r];
    }
    return true;
}

// ---- texels

static void map_block(struct mrt_solver *s, int block)
{
    const struct mrt_level *level = s->level;
    const struct mrt_cube_place *place = &level->place[block];
    struct mrt_shape cell = mrt_level_cell(level, block);
    struct mrt_shape cube =
        mrt_dictionary_shape(level->maze, level->dictionary->options.texels, place->cube);
    for (int t = 0; t < mrt_shape_texels(&cell); t++)
        s->cube_texel[level->first_texel[block] + t] =
            padded(s, mrt_rotated_texel(&cube, place->block_from_cube, &cell, t));
}

// Texels of a wall, the only one of `only`, as seen by light that enters at a face.
static void map_entry(struct mrt_solver *s, const struct mrt_shape *only, int wall, int face,
                      int response)
{
    const struct mrt_level *level = s->level;
    const int n = level->resolution * level->resolution, index = mrt_entered_by(only, face);
    const struct mrt_shape entered =
        mrt_entered_shape(level->maze, level->dictionary->options.texels, index);
    int *out = s->entered_texel + (response * CUBE_FACES + wall) * n;
    for (int t = 0; t < n; t++) {
        int texel = mrt_rotated_texel(&entered, mrt_block_from_entry(face), only, t);
        s->entered_face[response][wall] = index * (int)entered_walls(s) + texel / n;
        out[t] = texel % n;
    }
}

// Walls of tubes, or each wall of a cube, for each face that light enters by.
static void map_entries(struct mrt_solver *s)
{
    const bool tubes = s->level->maze == MRT_TUNNEL;
    const int first = tubes ? MRT_BLOCK_STRAIGHT : MRT_BLOCK_CUBE;
    for (int kind = first; kind < (tubes ? MRT_BLOCK_KINDS : MRT_BLOCK_STRAIGHT); kind++) {
        struct mrt_block block;
        mrt_block_init(&block, "", (enum mrt_block_kind)kind);
        for (int wall = 0; wall < (tubes ? 1 : CUBE_FACES); wall++) {
            const struct mrt_shape only =
                tubes ? mrt_block_shape(&block, s->level->resolution)
                      : mrt_cube(s->level->resolution, CUBE_ALL_FACES & ~(1u << wall));
            for (int f = 0; f < CUBE_FACES; f++)
                if (mrt_shape_is_open(&only, f))
                    map_entry(s, &only, wall, f, mrt_response_of(&block, f));
        }
    }
}

static void map_texels(struct mrt_solver *s)
{
    for (int b = 0; b < s->level->map->count; b++) map_block(s, b);
    map_entries(s);
}

static bool allocate(struct mrt_solver *s)
{
    const struct mrt_level *level = s->level;
    size_t blocks = (size_t)level->map->count;
    size_t n = (size_t)(level->resolution * level->resolution);
    s->cube_texel =
        host_alloc(s->host, (size_t)level->first_texel[level->map->count], sizeof *s->cube_texel);
    s->entered_texel =
        host_alloc(s->host, MRT_RESPONSES * CUBE_FACES * n, sizeof *s->entered_texel);
    s->light = host_alloc(s->host, blocks * (size_t)block_stride(s), sizeof *s->light);
    s->b = host_alloc(s->host, blocks * 3 * (size_t)level->k_b, sizeof *s->b);
    s->r =
        host_alloc(s->host, (size_t)level->entry_count * (size_t)entry_stride(level), sizeof *s->r);
    return s->cube_texel && s->entered_texel && s->light && s->b && s->r;
}

bool mrt_solver_init(struct host *host, const struct mrt_level *level, struct mrt_solver *solver)
{
    int n = level->resolution * level->resolution;
    *solver = (struct mrt_solver){ .host = host, .level = level };
    solver->face_texels = (n + MRT_LANES - 1) / MRT_LANES * MRT_LANES;
    bool ok =
        allocate(solver) && copy_response(solver) && copy_retraced(solver) && copy_ratios(solver);
    for (int i = 0; ok && i < mrt_dictionary_shapes(level->maze); i++) ok = copy_cube(solver, i);
    if (ok)
        map_texels(solver);
    else
        mrt_solver_finish(solver);
    return ok;
}

void mrt_solver_finish(struct mrt_solver *solver)
{
    if (solver->host) {
        host_free(solver->host, solver->ratios);
        for (int i = 0; i < MRT_MAX_CUBES; i++) {
            host_free(solver->host, solver->t_db[i]);
            host_free(solver->host, solver->u_b[i]);
        }
        for (int i = 0; i < solver->level->retraces.count; i++) {
            if (solver->t_retraced) host_free(solver->host, solver->t_retraced[i]);
            if (solver->u_retraced) host_free(solver->host, solver->u_retraced[i]);
        }
        host_free(solver->host, solver->t_retraced);
        host_free(solver->host, solver->u_retraced);
        host_free(solver->host, solver->u_r);
        host_free(solver->host, solver->cube_texel);
        host_free(solver->host, solver->entered_texel);
        host_free(solver->host, solver->light);
        host_free(solver->host, solver->b);
        host_free(solver->host, solver->r);
    }
    *solver = (struct mrt_solver){ 0 };
}

// ---- a frame

struct frame {
    struct mrt_solver *solver;
    const float *radiosity;
    float *irradiance;
};

// Three planes of a block's padded texels; their length.
static int planes_of(const struct mrt_solver *s, int block, float *planes[3])
{
    const struct mrt_level *level = s->level;
    int cube = level->place[block].cube;
    int length = walls_of(level->maze, cube) * s->face_texels;
    for (int c = 0; c < 3; c++)
        planes[c] = s->light + (size_t)block * (size_t)block_stride(s) + (size_t)(c * length);
    return length;
}

// −1: a block has the bases of its cube.
static int retraced_of(const struct mrt_level *level, int block)
{
    return level->retraces.of_block ? level->retraces.of_block[block] : -1;
}

// b = T_d→b l_d. The padding is 0 and stays so.
static void project_block(void *user, size_t i)
{
    const struct frame *frame = user;
    struct mrt_solver *s = frame->solver;
    const struct mrt_level *level = s->level;
    int block = (int)i, cube = level->place[block].cube, k_b = level->k_b;
    float *planes[3];
    int length = planes_of(s, block, planes);
    memset(planes[0], 0, 3 * (size_t)length * sizeof *planes[0]);
    for (int t = level->first_texel[block]; t < level->first_texel[block + 1]; t++)
        for (int c = 0; c < 3; c++) planes[c][s->cube_texel[t]] = frame->radiosity[3 * t + c];
    const float *const light[3] = { planes[0], planes[1], planes[2] };
    const int retraced = retraced_of(level, block);
    project(retraced < 0 ? s->t_db[cube] : s->t_retraced[retraced], length, k_b, length, light,
            s->b + i * 3 * (size_t)k_b);
}

// r = T_b→r b for one entry, interleaved.
static const float *receive(struct mrt_solver *s, int entry)
{
    const struct mrt_level *level = s->level;
    int k_b = level->k_b, k_r = level->k_r, stride = level->link_stride;
    float *planes = s->r + (size_t)entry * (size_t)entry_stride(level), *out = planes + 3 * stride;
    float *const r[3] = { planes, planes + stride, planes + 2 * stride };
    memset(planes, 0, 3 * (size_t)stride * sizeof *planes);
    for (int l = level->first_link[entry]; l < level->first_link[entry + 1]; l++) {
        const struct mrt_link *link = &level->links[l];
        expand(level->matrices + link->matrix, stride, k_b, stride,
               s->b + (size_t)link->source * 3 * (size_t)k_b, r);
    }
    for (int k = 0; k < k_r; k++)
        for (int c = 0; c < 3; c++) out[3 * k + c] = r[c][k];
    return out;
}

// U_r r on the walls of one block.
static void add_response(const struct mrt_solver *s, int entry, const float *r, float *irradiance)
{
    const int block = s->level->entries[entry].block, entry_face = s->level->entries[entry].face;
    const struct mrt_block *of = &s->level->map->blocks[block];
    const int response = mrt_response_of(of, entry_face);
    int n = s->level->resolution * s->level->resolution, face = s->face_texels;
    int k_r = s->level->k_r;
    float *planes[3];
    planes_of(s, block, planes);
    for (int c = 0; c < 3; c++) planes[c] = planes[0] + c * face; // light is no longer needed
    for (int wall = 0; wall < CUBE_FACES; wall++) {
        if (!mrt_block_has_wall(of, wall)) continue;
        memset(planes[0], 0, 3 * (size_t)face * sizeof *planes[0]);
        int from = s->entered_face[response][wall];
        expand(s->u_r + (size_t)(from * k_r) * (size_t)face, face, k_r, face, r, planes);
        const int *texel = s->entered_texel + (response * CUBE_FACES + wall) * n;
        const float *ratios = s->ratios ? s->ratios + (entry * CUBE_FACES + wall) * n : NULL;
        for (int t = 0; t < n; t++)
            for (int c = 0; c < 3; c++)
                irradiance[3 * t + c] += (ratios ? ratios[t] : 1.0f) * planes[c][texel[t]];
        irradiance += 3 * n;
    }
}

static void light_block(void *user, size_t i)
{
    const struct frame *frame = user;
    struct mrt_solver *s = frame->solver;
    const struct mrt_level *level = s->level;
    int block = (int)i, first = level->first_texel[block];
    float *planes[3];
    int length = planes_of(s, block, planes), k_b = level->k_b;
    memset(planes[0], 0, 3 * (size_t)length * sizeof *planes[0]);
    const int retraced = retraced_of(level, block);
    const float *u_b = retraced < 0 ? s->u_b[level->place[block].cube] : s->u_retraced[retraced];
    expand(u_b, length, k_b, length, s->b + i * 3 * (size_t)k_b, planes);
    float *out = frame->irradiance + 3 * (size_t)first;
    for (int t = first; t < level->first_texel[block + 1]; t++)
        for (int c = 0; c < 3; c++) out[3 * (t - first) + c] = planes[c][s->cube_texel[t]];
    for (int f = 0; f < CUBE_FACES; f++) {
        int entry = level->entry_of_face[CUBE_FACES * block + f];
        if (entry < 0) continue;
        add_response(s, entry, receive(s, entry), out);
    }
}

void mrt_solve(struct mrt_solver *solver, const float *radiosity, float *irradiance)
{
    struct frame frame = { solver, radiosity, irradiance };
    size_t blocks = (size_t)solver->level->map->count;
    parallel_for(blocks, 1, project_block, &frame);
    parallel_for(blocks, 1, light_block, &frame);
}
