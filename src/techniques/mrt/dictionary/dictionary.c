// A dictionary from the tensors of a bake.
#include "dictionary.h"

#include <stdio.h>
#include <string.h>

// Arguments of all reads of tensors.
struct reader {
    struct host *host;
    const struct tensors *bake;
};

// A part of a tensor: rows × middle × columns, where middle 1 is not an axis of its own.
struct tensor_part {
    size_t rows, middle, columns;
};

static const char *shape_tensor(char out[32], int maze, int i, const char *what)
{
    snprintf(out, 32, "%s/%d/%s", maze == MRT_TUNNEL ? "tube" : "cube", i, what);
    return out;
}

// Parts of a tensor whose axis 0 is `parts` times that of a part.
static bool copy_parts(const struct reader *reader, const char *name, struct tensor_part part,
                       size_t parts, struct matrix_f32 *const *out)
{
    const uint64_t flat[2] = { parts * part.rows, part.columns };
    const uint64_t wide[3] = { parts * part.rows, part.middle, part.columns };
    const size_t elements = part.rows * part.middle * part.columns;
    const float *data = tensors_expect(reader->host, reader->bake, name, TENSOR_F32,
                                       part.middle > 1 ? 3 : 2, part.middle > 1 ? wide : flat);
    if (!data) return false;
    for (size_t i = 0; i < parts; i++) {
        if (!matrix_f32_init(reader->host, out[i], part.rows * part.middle, part.columns))
            return false;
        memcpy(out[i]->at, data + i * elements, elements * sizeof *data);
    }
    return true;
}

static bool copy_matrix(const struct reader *reader, const char *name, size_t rows_, size_t middle,
                        size_t columns, struct matrix_f32 *out)
{
    return copy_parts(reader, name, (struct tensor_part){ rows_, middle, columns }, 1, &out);
}

static bool copy_element(const struct reader *reader, const struct mrt_dictionary_options *o, int i,
                         struct mrt_element *e)
{
    char name[32];
    e->shape = mrt_dictionary_shape((enum mrt_maze)o->maze, o->texels, i);
    size_t n = (size_t)mrt_shape_texels(&e->shape), k = (size_t)o->modes;
    size_t probes = (size_t)(o->block_probes * o->block_probes * o->block_probes);
    struct matrix_f32 *openings[MRT_MAX_OPENINGS], *walls[CUBE_FACES];
    size_t count = 0, wall_count = 0;
    for (int f = 0; f < CUBE_FACES; f++) {
        if (mrt_shape_is_open(&e->shape, f))
            openings[count++] = &e->r_b[f];
        else if (mrt_wall_may_have_holes((enum mrt_maze)o->maze, f))
            walls[wall_count++] = &e->r_b[f];
    }
    const struct tensor_part light = { 1, (size_t)o->lightfield_modes, k };
    return copy_matrix(reader, shape_tensor(name, o->maze, i, "U_b"), n, 1, k, &e->u_b) &&
           copy_matrix(reader, shape_tensor(name, o->maze, i, "T_db"), k, 1, n, &e->t_db) &&
           copy_matrix(reader, shape_tensor(name, o->maze, i, "L_imp"), n, 1, k, &e->l_imp) &&
           copy_matrix(reader, shape_tensor(name, o->maze, i, "U_vec"), n, 4, k, &e->u_vec) &&
           copy_matrix(reader, shape_tensor(name, o->maze, i, "U_bvol"), probes, 9, k,
                       &e->u_bvol) &&
           (count == 0 ||
            copy_parts(reader, shape_tensor(name, o->maze, i, "R_b"), light, count, openings)) &&
           (wall_count == 0 ||
            copy_parts(reader, shape_tensor(name, o->maze, i, "R_wall"), light, wall_count, walls));
}

static bool copy_interfaces(const struct reader *reader, const struct mrt_dictionary_options *o,
                            struct mrt_dictionary *d)
{
    const struct mrt_shape entered = mrt_entered_shape((enum mrt_maze)o->maze, o->texels, 0);
    const size_t m = (size_t)mrt_shape_texels(&entered), k_r = (size_t)o->response_modes;
    const size_t k_l = (size_t)o->lightfield_modes, parts = (size_t)d->entered_count;
    const size_t probes = (size_t)(o->block_probes * o->block_probes * o->block_probes);
    struct matrix_f32 *turns[MRT_TURNS_3D], *holes[MRT_HOLE_PARTS], *part[4][MRT_MAX_ENTERED];
    for (int h = 0; h < MRT_HOLE_PARTS; h++) holes[h] = &d->r_hole[h];
    for (int t = 0; t < MRT_TURNS_3D; t++) turns[t] = &d->r_turn[t];
    for (int i = 0; i < MRT_MAX_ENTERED; i++) {
        part[0][i] = &d->entered[i].t_r;
        part[1][i] = &d->entered[i].u_r;
        part[2][i] = &d->entered[i].u_rvec;
        part[3][i] = &d->entered[i].u_rvol;
    }
    return copy_parts(reader, "interface/R_turn", (struct tensor_part){ 1, k_l, k_l },
                      (size_t)d->turn_count, turns) &&
           (o->maze == MRT_TUNNEL ||
            copy_parts(reader, "interface/R_hole", (struct tensor_part){ 1, k_l, k_l },
                       MRT_HOLE_PARTS, holes)) &&
           copy_parts(reader, "interface/T_r", (struct tensor_part){ k_r, 1, k_l }, parts,
                      part[0]) &&
           copy_parts(reader, "interface/U_r", (struct tensor_part){ m, 1, k_r }, parts, part[1]) &&
           copy_parts(reader, "interface/U_rvec", (struct tensor_part){ m, 4, k_r }, parts,
                      part[2]) &&
           copy_parts(reader, "interface/U_rvol", (struct tensor_part){ probes, 9, k_r }, parts,
                      part[3]);
}

bool mrt_dictionary_init(struct host *host, const struct tensors *bake,
                         const struct mrt_dictionary_options *options, struct mrt_dictionary *out)
{
    const struct reader reader = { host, bake };
    const enum mrt_maze maze = mrt_dictionary_maze(options);
    *out = (struct mrt_dictionary){
        .options = *options,
        .element_count = mrt_dictionary_shapes(maze),
        .turn_count = maze == MRT_MAZE_3D ? MRT_TURNS_3D : MRT_TURNS_2D,
        .entered_count = mrt_entered_shapes(maze),
    };
    out->options.maze = (int32_t)maze;
    bool ok = copy_interfaces(&reader, &out->options, out);
    for (int i = 0; ok && i < out->element_count; i++)
        ok = copy_element(&reader, &out->options, i, &out->element[i]);
    if (!ok) mrt_dictionary_finish(host, out);
    return ok;
}

static void element_finish(struct host *host, struct mrt_element *e)
{
    matrix_f32_finish(host, &e->u_b);
    matrix_f32_finish(host, &e->t_db);
    matrix_f32_finish(host, &e->l_imp);
    matrix_f32_finish(host, &e->u_vec);
    matrix_f32_finish(host, &e->u_bvol);
    for (int f = 0; f < MRT_MAX_OPENINGS; f++) matrix_f32_finish(host, &e->r_b[f]);
}

void mrt_dictionary_finish(struct host *host, struct mrt_dictionary *d)
{
    for (int i = 0; i < MRT_MAX_CUBES; i++) element_finish(host, &d->element[i]);
    for (int t = 0; t < MRT_TURNS_3D; t++) matrix_f32_finish(host, &d->r_turn[t]);
    for (int h = 0; h < MRT_HOLE_PARTS; h++) matrix_f32_finish(host, &d->r_hole[h]);
    for (int i = 0; i < MRT_MAX_ENTERED; i++) {
        matrix_f32_finish(host, &d->entered[i].t_r);
        matrix_f32_finish(host, &d->entered[i].u_r);
        matrix_f32_finish(host, &d->entered[i].u_rvec);
        matrix_f32_finish(host, &d->entered[i].u_rvol);
    }
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
        for (int f = 0; f < MRT_MAX_OPENINGS; f++)
            *(mrt_shape_is_open(&e->shape, f) ? &out.interfaces : &out.holes) +=
                bytes_of(&e->r_b[f]);
    }
    for (int h = 0; h < MRT_HOLE_PARTS; h++) out.holes += bytes_of(&d->r_hole[h]);
    for (int t = 0; t < d->turn_count; t++) out.interfaces += bytes_of(&d->r_turn[t]);
    for (int i = 0; i < d->entered_count; i++) {
        const struct mrt_entered *e = &d->entered[i];
        out.interfaces += bytes_of(&e->t_r) + bytes_of(&e->u_r) + bytes_of(&e->u_rvec);
        out.probes += bytes_of(&e->u_rvol);
    }
    return out;
}
