// A dictionary from the tensors of a bake.
#include "dictionary.h"

#include <stdio.h>
#include <string.h>

#define OPTION(...) OPTION_ROW(struct mrt_dictionary_options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "techniques/mrt/dictionary/dictionary_options.def"
};
#undef OPTION

static const struct option_table table = OPTION_TABLE(struct mrt_dictionary_options, rows, NULL);

const struct option_table *mrt_dictionary_option_table(void)
{
    return &table;
}

// What a read needs at each tensor.
struct reader {
    struct host *host;
    const struct tensors *bake;
};

// Copies part `part` of axis 0 of a tensor of `parts` × rows × columns; parts 0: a tensor of two
// axes, or of three where `middle` is not 1.
static bool take(const struct reader *reader, const char *name, size_t rows_, size_t middle,
                 size_t columns, struct matrix_f32 *out)
{
    const uint64_t wide[3] = { rows_, middle, columns }, flat[2] = { rows_, columns };
    const float *data = tensors_expect(reader->host, reader->bake, name, TENSOR_F32,
                                       middle > 1 ? 3 : 2, middle > 1 ? wide : flat);
    if (!data || !matrix_f32_init(reader->host, out, rows_ * middle, columns)) return false;
    memcpy(out->at, data, rows_ * middle * columns * sizeof *data);
    return true;
}

// Copies each matrix of a stack.
static bool take_stack(const struct reader *reader, const char *name, size_t count, size_t rows_,
                       size_t columns, struct matrix_f32 *const *out)
{
    const uint64_t shape[3] = { count, rows_, columns };
    const float *data = tensors_expect(reader->host, reader->bake, name, TENSOR_F32, 3, shape);
    if (!data) return false;
    for (size_t i = 0; i < count; i++) {
        if (!matrix_f32_init(reader->host, out[i], rows_, columns)) return false;
        memcpy(out[i]->at, data + i * rows_ * columns, rows_ * columns * sizeof *data);
    }
    return true;
}

static const char *cube_tensor(char out[32], int cube, const char *what)
{
    snprintf(out, 32, "cube/%d/%s", cube, what);
    return out;
}

static bool take_element(const struct reader *reader, const struct mrt_dictionary_options *o,
                         int cube, struct mrt_element *e)
{
    char name[32];
    e->shape = mrt_cube(o->texels, mrt_cube_missing((enum mrt_maze)o->maze, cube));
    size_t n = (size_t)mrt_shape_texels(&e->shape), k = (size_t)o->modes;
    size_t probes = (size_t)(o->probes * o->probes * o->probes);
    struct matrix_f32 *openings[MRT_MAX_OPENINGS];
    size_t count = 0;
    for (int f = 0; f < CUBE_FACES; f++)
        if (e->shape.missing >> f & 1u) openings[count++] = &e->r_b[f];
    return take(reader, cube_tensor(name, cube, "U_b"), n, 1, k, &e->u_b) &&
           take(reader, cube_tensor(name, cube, "T_db"), k, 1, n, &e->t_db) &&
           take(reader, cube_tensor(name, cube, "U_vec"), n, 4, k, &e->u_vec) &&
           take(reader, cube_tensor(name, cube, "U_bvol"), probes, 9, k, &e->u_bvol) &&
           (count == 0 || take_stack(reader, cube_tensor(name, cube, "R_b"), count,
                                     (size_t)o->lightfield_modes, k, openings));
}

static bool take_interfaces(const struct reader *reader, const struct mrt_dictionary_options *o,
                            struct mrt_dictionary *d)
{
    struct mrt_shape entered = mrt_cube_entered(o->texels);
    size_t m = (size_t)mrt_shape_texels(&entered), k_r = (size_t)o->response_modes;
    size_t k_l = (size_t)o->lightfield_modes, probes = (size_t)(o->probes * o->probes * o->probes);
    struct matrix_f32 *turns[MRT_TURNS_3D];
    for (int t = 0; t < MRT_TURNS_3D; t++) turns[t] = &d->r_turn[t];
    return take_stack(reader, "interface/R_turn", (size_t)d->turn_count, k_l, k_l, turns) &&
           take(reader, "interface/T_r", k_r, 1, k_l, &d->t_r) &&
           take(reader, "interface/U_r", m, 1, k_r, &d->u_r) &&
           take(reader, "interface/U_rvec", m, 4, k_r, &d->u_rvec) &&
           take(reader, "interface/U_rvol", probes, 9, k_r, &d->u_rvol);
}

bool mrt_dictionary_init(struct host *host, const struct tensors *bake,
                         const struct mrt_dictionary_options *options, struct mrt_dictionary *out)
{
    const struct reader reader = { host, bake };
    *out = (struct mrt_dictionary){
        .options = *options,
        .element_count = mrt_cube_count((enum mrt_maze)options->maze),
        .turn_count = options->maze == MRT_MAZE_2D ? MRT_TURNS_2D : MRT_TURNS_3D,
    };
    bool ok = take_interfaces(&reader, options, out);
    for (int i = 0; ok && i < out->element_count; i++)
        ok = take_element(&reader, options, i, &out->element[i]);
    if (!ok) mrt_dictionary_finish(host, out);
    return ok;
}

static void element_finish(struct host *host, struct mrt_element *e)
{
    matrix_f32_finish(host, &e->u_b);
    matrix_f32_finish(host, &e->t_db);
    matrix_f32_finish(host, &e->u_vec);
    matrix_f32_finish(host, &e->u_bvol);
    for (int f = 0; f < MRT_MAX_OPENINGS; f++) matrix_f32_finish(host, &e->r_b[f]);
}

void mrt_dictionary_finish(struct host *host, struct mrt_dictionary *d)
{
    for (int i = 0; i < MRT_MAX_CUBES; i++) element_finish(host, &d->element[i]);
    for (int t = 0; t < MRT_TURNS_3D; t++) matrix_f32_finish(host, &d->r_turn[t]);
    matrix_f32_finish(host, &d->t_r);
    matrix_f32_finish(host, &d->u_r);
    matrix_f32_finish(host, &d->u_rvec);
    matrix_f32_finish(host, &d->u_rvol);
    *d = (struct mrt_dictionary){ 0 };
}

static size_t bytes_of(const struct matrix_f32 *m)
{
    return m->rows * m->columns * sizeof *m->at;
}

struct mrt_dictionary_bytes mrt_dictionary_bytes(const struct mrt_dictionary *d)
{
    struct mrt_dictionary_bytes out = { 0 };
    for (int i = 0; i < d->element_count; i++) {
        const struct mrt_element *e = &d->element[i];
        out.shapes += bytes_of(&e->u_b) + bytes_of(&e->t_db) + bytes_of(&e->u_vec);
        out.probes += bytes_of(&e->u_bvol);
        for (int f = 0; f < MRT_MAX_OPENINGS; f++) out.interfaces += bytes_of(&e->r_b[f]);
    }
    for (int t = 0; t < d->turn_count; t++) out.interfaces += bytes_of(&d->r_turn[t]);
    out.interfaces += bytes_of(&d->t_r) + bytes_of(&d->u_r) + bytes_of(&d->u_rvec);
    out.probes += bytes_of(&d->u_rvol);
    return out;
}
