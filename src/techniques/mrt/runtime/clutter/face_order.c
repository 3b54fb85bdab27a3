#include "techniques/mrt/runtime/clutter/face_order.h"

#include <string.h>

enum use { NOTHING, WALLS, CLUTTER, USES };

// The opening that is the clutter of a block.
struct order {
    struct mrt_delta_operators *of;
    int opening, block, place; // place: among the openings of the block
    int faces, kept;
    enum use *use;
    int *slot; // of each face, −1: none
    float *row;
};

static bool has_column(const struct matrix_f32 *m, int column)
{
    for (size_t r = 0; r < m->rows; r++)
        if (m->at[r * m->stride + (size_t)column] != 0.0f) return true;
    return false;
}

static bool has_row(const struct matrix_f32 *m, int row)
{
    for (size_t c = 0; c < m->columns; c++)
        if (m->at[(size_t)row * m->stride + c] != 0.0f) return true;
    return false;
}

static struct mrt_clutter_rows_input *map_of(const struct order *s)
{
    for (int i = 0; i < s->of->atlas.input.count; i++)
        if (s->of->atlas.rows[i].block == s->block) return &s->of->atlas.rows[i];
    return NULL;
}

static enum use use_of(const struct order *s, int face)
{
    const struct mrt_clutter_rows_input *map = map_of(s);
    const struct mrt_response_input *response =
        &s->of->responses[s->of->openings[s->opening].response];
    if (map && has_column(&map->u_r[s->place], face)) return CLUTTER;
    for (int m = 0; m < MRT_MEASURES; m++)
        if (has_column(&response->u[m], face)) return WALLS;
    for (int i = 0; i < s->of->face_pair_count; i++)
        if (s->of->face_pairs[i].source == s->block && has_row(&s->of->face_pairs[i].of_c, face))
            return WALLS;
    return NOTHING;
}

static void find_slots(struct order *s)
{
    s->kept = 0;
    for (int f = 0; f < s->faces; f++) s->use[f] = use_of(s, f);
    for (int use = CLUTTER; use >= NOTHING; use--)
        for (int f = 0; f < s->faces; f++)
            if ((int)s->use[f] == use) s->slot[f] = use > NOTHING ? s->kept++ : -1;
}

// ---- moving coefficients

// Entries `step` apart.
static void move_row(const struct order *s, float *at, size_t step)
{
    for (int f = 0; f < s->faces; f++) s->row[f] = at[(size_t)f * step];
    for (int f = 0; f < s->faces; f++) at[(size_t)f * step] = 0.0f;
    for (int f = 0; f < s->faces; f++)
        if (s->slot[f] >= 0) at[(size_t)s->slot[f] * step] = s->row[f];
}

static void move_columns(const struct order *s, struct matrix_f32 *m)
{
    for (size_t r = 0; r < m->rows; r++) move_row(s, m->at + r * m->stride, 1);
}

static void move_rows(const struct order *s, struct matrix_f32 *m)
{
    for (size_t c = 0; c < m->columns; c++) move_row(s, m->at + c, m->stride);
}

// T_b→r of faces: k_b rows of `stride`.
static void move_gathered(const struct order *s, const float *of, size_t stride)
{
    for (int i = 0; i < s->of->gathered_count; i++) {
        struct matrix_f32 *m = &s->of->gathered[i];
        if (m->at != of) continue;
        for (size_t at = 0; at < m->columns; at += stride) move_row(s, m->at + at, 1);
    }
}

static void move_operators(const struct order *s)
{
    struct mrt_delta_operators *of = s->of;
    struct mrt_response_input *response = &of->responses[of->openings[s->opening].response];
    struct mrt_clutter_rows_input *map = map_of(s);
    for (int m = 0; m < MRT_MEASURES; m++) move_columns(s, &response->u[m]);
    if (map) move_columns(s, &map->u_r[s->place]);
    for (int i = 0; i < of->input.pair_count; i++)
        if (of->pairs[i].opening == s->opening)
            move_gathered(s, of->pairs[i].t_br, (size_t)of->input.t_br_stride);
    for (int i = 0; i < of->face_pair_count; i++) {
        if (of->face_pairs[i].opening == s->opening) move_columns(s, &of->face_pairs[i].of_c);
        if (of->face_pairs[i].source == s->block) move_rows(s, &of->face_pairs[i].of_c);
    }
}

static void move_faces(const struct order *s)
{
    struct mrt_clutter_input *clutter = &s->of->clutter;
    int kept = 0;
    for (int i = 0; i < clutter->face_count; i++) {
        struct mrt_clutter_face_input face = s->of->faces[i];
        if (face.opening == s->opening) face.slot = s->slot[face.slot];
        if (face.slot >= 0) s->of->faces[kept++] = face;
    }
    clutter->face_count = kept;
}

static int faces_of(const struct mrt_delta_operators *of, int opening)
{
    int count = 0;
    for (int i = 0; i < of->clutter.face_count; i++) count += of->faces[i].opening == opening;
    return count;
}

static int first_opening_of(const struct mrt_delta_operators *of, int block)
{
    int i = 0;
    while (of->openings[i].block != block) i++;
    return i;
}

bool mrt_order_faces(struct mrt_delta_operators *of)
{
    const size_t most = (size_t)of->input.k_r;
    struct order s = { .of = of };
    s.use = host_alloc(of->host, most, sizeof *s.use);
    s.slot = host_alloc(of->host, most, sizeof *s.slot);
    s.row = host_alloc(of->host, most, sizeof *s.row);
    const bool ok = s.use && s.slot && s.row;
    for (int i = 0; ok && i < of->clutter.opening_count; i++) {
        s.opening = of->clutter_openings[i];
        s.block = of->openings[s.opening].block;
        s.place = s.opening - first_opening_of(of, s.block);
        s.faces = faces_of(of, s.opening);
        find_slots(&s);
        move_operators(&s);
        move_faces(&s);
    }
    host_free(of->host, s.use);
    host_free(of->host, s.slot);
    host_free(of->host, s.row);
    return ok;
}
