// Rays between interfaces and the blocks that they connect.
#include "interface.h"

#include "techniques/mrt/dictionary/sparse_row.h"

#include <assert.h>
#include <math.h>

// ---- out of a block

static void see_surfaces(struct mrt_lightfield l, const struct mrt_shape *shape, mat3s frame,
                         size_t sample, struct sparse_row *row)
{
    struct mrt_hit hit;
    vec3s from = mrt_lightfield_position(l, sample);
    from.z = 0.5f;
    from = glms_mat3_mulv(frame, from);
    for (int sub = 0; sub < mrt_lightfield_subsamples(l); sub++) {
        vec3s along = glms_mat3_mulv(frame, mrt_lightfield_direction(l, sample, sub));
        mrt_shape_trace(shape, from, glms_vec3_negate(along), &hit);
        for (int k = 0; k < hit.texels; k++)
            sparse_row_add(row, (size_t)hit.texel[k], hit.weight[k]);
    }
}

bool mrt_lightfield_of_surfaces(struct host *host, struct mrt_lightfield l,
                                const struct mrt_shape *shape, int face,
                                const struct matrix_f32 *radiosity, size_t first_sample,
                                struct matrix_f32 *out)
{
    struct sparse_row row;
    if (!sparse_row_init(host, &row, radiosity->rows)) return false;
    for (size_t r = 0; r < out->rows; r++) {
        see_surfaces(l, shape, cube_from_face(face), first_sample + r, &row);
        sparse_row_apply(&row, 1.0f / (float)mrt_lightfield_subsamples(l), radiosity,
                         out->at + r * out->stride);
    }
    sparse_row_finish(host, &row);
    return true;
}

// ---- between interfaces

mat3s mrt_entry_from_exit(enum mrt_turn turn)
{
    static const struct {
        vec3s v, n;
    } exits[] = {
        [MRT_STRAIGHT] = { { { 0, 1, 0 } }, { { 0, 0, 1 } } },
        [MRT_TURN_LEFT] = { { { 0, 1, 0 } }, { { 1, 0, 0 } } },
        [MRT_TURN_RIGHT] = { { { 0, 1, 0 } }, { { -1, 0, 0 } } },
        [MRT_TURN_UP] = { { { 0, 0, -1 } }, { { 0, 1, 0 } } },
        [MRT_TURN_DOWN] = { { { 0, 0, 1 } }, { { 0, -1, 0 } } },
        [MRT_ROLL] = { { { -1, 0, 0 } }, { { 0, 0, 1 } } },
    };
    vec3s v = exits[turn].v, n = exits[turn].n;
    return (mat3s){ .col = { glms_vec3_cross(v, n), v, n } };
}

mat3s mrt_block_from_entry(int face)
{
    mat3s frame = cube_from_face(face);
    frame.col[0] = glms_vec3_negate(frame.col[0]);
    frame.col[2] = glms_vec3_negate(frame.col[2]);
    return frame;
}

int mrt_rolls_between(mat3s from, mat3s to)
{
    mat3s roll = mrt_entry_from_exit(MRT_ROLL);
    for (int rolls = 0; rolls < 4; rolls++, from = glms_mat3_mul(from, roll)) {
        float same = 0.0f;
        for (int c = 0; c < 3; c++) same += glms_vec3_dot(from.col[c], to.col[c]);
        if (same > 2.5f) return rolls;
    }
    return -1;
}

struct mrt_passage mrt_passage_between(int entry_face, int exit_face)
{
    mat3s exit = glms_mat3_mul(glms_mat3_transpose(mrt_block_from_entry(entry_face)),
                               cube_from_face(exit_face));
    for (int turn = MRT_STRAIGHT; turn <= MRT_TURN_DOWN; turn++) {
        int rolls = mrt_rolls_between(mrt_entry_from_exit((enum mrt_turn)turn), exit);
        if (rolls >= 0) return (struct mrt_passage){ (enum mrt_turn)turn, rolls };
    }
    assert(false);
    return (struct mrt_passage){ 0 };
}

int mrt_entered_by(const struct mrt_shape *shape, int face)
{
    if (shape->kind == MRT_CUBE) return 0;
    for (int f = 0; f < CUBE_FACES; f++)
        if (f != face && mrt_shape_is_open(shape, f)) return (int)mrt_passage_between(face, f).turn;
    return 0;
}
_Static_assert((int)MRT_STRAIGHT == (int)TUBE_STRAIGHT && (int)MRT_TURN_LEFT == (int)TUBE_LEFT &&
                   (int)MRT_TURN_RIGHT == (int)TUBE_RIGHT,
               "light that turns left passes the left bend");

static void add_lookup(const struct mrt_lightfield_lookup *look, struct sparse_row *row)
{
    for (int k = 0; k < LIGHTFIELD_LOOKUP; k++)
        sparse_row_add(row, look->sample[k], look->weight[k]);
}

// The shape that light passes between entry and exit.
static struct mrt_shape shape_of_turn(struct mrt_lightfield l, enum mrt_turn turn)
{
    static const enum tube_bend bends[] = { TUBE_STRAIGHT, TUBE_LEFT, TUBE_RIGHT };
    return l.round ? mrt_tube(4, bends[turn]) : mrt_cube(1, 1u << CUBE_BACK);
}

// Looks up a ray that leaves by the back, whose u is −x.
static void look_up_back(struct mrt_lightfield l, const struct mrt_hit *hit, vec3s along,
                         struct mrt_lightfield_lookup *out)
{
    mrt_lightfield_look_up(l, 0.5f - hit->s, hit->t - 0.5f, along, out);
}

static void see_entry(struct mrt_lightfield l, enum mrt_turn turn, size_t sample,
                      struct sparse_row *row)
{
    const struct mrt_shape shape = shape_of_turn(l, turn);
    mat3s entry_from_exit = mrt_entry_from_exit(turn);
    vec3s from = mrt_lightfield_position(l, sample);
    struct mrt_lightfield_lookup look;
    struct mrt_hit hit;
    from.z = 0.5f;
    from = glms_mat3_mulv(entry_from_exit, from);
    for (int sub = 0; sub < mrt_lightfield_subsamples(l); sub++) {
        vec3s along = glms_mat3_mulv(entry_from_exit, mrt_lightfield_direction(l, sample, sub));
        const vec3s back = glms_vec3_negate(along);
        if (!mrt_shape_points_at(&shape, CUBE_BACK, from, back)) continue;
        mrt_shape_trace(&shape, from, back, &hit);
        if (hit.opening != CUBE_BACK) continue;
        look_up_back(l, &hit, along, &look);
        add_lookup(&look, row);
    }
}

// Both squares of samples have the symmetry of the turn: every sample is one of the entry.
static void see_rolled(struct mrt_lightfield l, size_t sample, struct sparse_row *row)
{
    mat3s entry_from_exit = mrt_entry_from_exit(MRT_ROLL);
    struct mrt_lightfield coarse = { l.positions, l.directions, 1, l.round };
    struct mrt_lightfield_lookup look;
    vec3s from = glms_mat3_mulv(entry_from_exit, mrt_lightfield_position(l, sample));
    vec3s along = glms_mat3_mulv(entry_from_exit, mrt_lightfield_direction(coarse, sample, 0));
    mrt_lightfield_look_up(l, from.x, from.y, along, &look);
    add_lookup(&look, row);
}

bool mrt_propagate(struct host *host, struct mrt_lightfield l, enum mrt_turn turn,
                   const struct matrix_f32 *entry, size_t first_sample, struct matrix_f32 *out)
{
    struct sparse_row row;
    if (!sparse_row_init(host, &row, entry->rows)) return false;
    for (size_t r = 0; r < out->rows; r++) {
        if (turn == MRT_ROLL)
            see_rolled(l, first_sample + r, &row);
        else
            see_entry(l, turn, first_sample + r, &row);
        float scale = turn == MRT_ROLL ? 1.0f : 1.0f / (float)mrt_lightfield_subsamples(l);
        sparse_row_apply(&row, scale, entry, out->at + r * out->stride);
    }
    sparse_row_finish(host, &row);
    return true;
}

// ---- into a block

void mrt_gather_interface(struct mrt_lightfield l, const struct mrt_shape *entered,
                          struct mrt_point point, const struct mrt_rays *rays, float *rows)
{
    struct mrt_lightfield_lookup look;
    struct mrt_hit hit;
    size_t samples = mrt_lightfield_samples(l);
    for (int i = 0; i < rays->count; i++) {
        vec3s ray = glms_mat3_mulv(point.frame, rays->direction[i]);
        if (!mrt_shape_points_at(entered, CUBE_BACK, point.position, ray)) continue;
        mrt_shape_trace(entered, point.position, ray, &hit);
        if (hit.opening != CUBE_BACK) continue;
        look_up_back(l, &hit, glms_vec3_negate(ray), &look);
        const float *weight = rays->weight + (size_t)i * (size_t)rays->values;
        for (size_t q = 0; q < (size_t)rays->values; q++)
            for (int k = 0; k < LIGHTFIELD_LOOKUP; k++)
                rows[q * samples + look.sample[k]] += weight[q] * look.weight[k];
    }
}
