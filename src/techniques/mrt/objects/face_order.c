// The order of the coefficients of faces.
#include "techniques/mrt/objects/clutter_operators.h"

enum use { NOTHING, WALLS, CLUTTER };

struct order {
    struct mrt_operators *of;
    struct mrt_opening *opening; // that is clutter
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

// The next pair, from this one of this opening on, that carries light of the faces; NULL: none.
static struct mrt_pair *next_sent(const struct order *s, int *opening, int *pair)
{
    for (; *opening < s->of->opening_count; ++*opening, *pair = 0)
        while (*pair < s->of->openings[*opening].pair_count) {
            struct mrt_pair *at = &s->of->openings[*opening].pairs[(*pair)++];
            if (at->source == s->opening->block && at->of_c.rows > 0) return at;
        }
    return NULL;
}

static enum use use_of(const struct order *s, int face)
{
    const struct mrt_block_response *response = &s->of->responses[s->opening->response];
    if (has_column(&s->opening->at_clutter, face)) return CLUTTER;
    for (int m = 0; m < MRT_MEASURES; m++)
        if (has_column(&response->u[m], face)) return WALLS;
    int opening = 0, pair = 0;
    for (const struct mrt_pair *sent; (sent = next_sent(s, &opening, &pair));)
        if (has_row(&sent->of_c, face)) return WALLS;
    return NOTHING;
}

static void find_slots(struct order *s)
{
    const int faces = s->opening->face_count;
    int kept = 0;
    for (int f = 0; f < faces; f++) s->use[f] = use_of(s, f);
    for (int use = CLUTTER; use >= NOTHING; use--)
        for (int f = 0; f < faces; f++)
            if ((int)s->use[f] == use) s->slot[f] = use > NOTHING ? kept++ : -1;
}

// ---- moving coefficients

// Entries `step` apart.
static void move_row(const struct order *s, float *at, size_t step)
{
    const int faces = s->opening->face_count;
    for (int f = 0; f < faces; f++) s->row[f] = at[(size_t)f * step];
    for (int f = 0; f < faces; f++) at[(size_t)f * step] = 0.0f;
    for (int f = 0; f < faces; f++)
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

static void move_operators(const struct order *s)
{
    struct mrt_block_response *response = &s->of->responses[s->opening->response];
    for (int m = 0; m < MRT_MEASURES; m++) move_columns(s, &response->u[m]);
    move_columns(s, &s->opening->at_clutter);
    for (int i = 0; i < s->opening->pair_count; i++) {
        move_columns(s, &s->opening->pairs[i].of_b);
        move_columns(s, &s->opening->pairs[i].of_c);
    }
    int opening = 0, pair = 0;
    for (struct mrt_pair *sent; (sent = next_sent(s, &opening, &pair));) move_rows(s, &sent->of_c);
}

static void move_faces(const struct order *s)
{
    const int faces = s->opening->face_count;
    s->opening->face_count = 0;
    for (int i = 0; i < faces; i++) {
        struct mrt_opening_face face = s->opening->faces[i];
        face.slot = s->slot[face.slot];
        if (face.slot >= 0) s->opening->faces[s->opening->face_count++] = face;
    }
}

bool mrt_order_faces(struct mrt_operators *of)
{
    const size_t most = (size_t)of->k_r;
    struct order s = { .of = of };
    s.use = host_alloc(of->host, most, sizeof *s.use);
    s.slot = host_alloc(of->host, most, sizeof *s.slot);
    s.row = host_alloc(of->host, most, sizeof *s.row);
    const bool ok = s.use && s.slot && s.row;
    for (int i = 0; ok && i < of->opening_count; i++) {
        s.opening = &of->openings[i];
        if (s.opening->face >= 0) continue;
        find_slots(&s);
        move_operators(&s);
        move_faces(&s);
    }
    host_free(of->host, s.use);
    host_free(of->host, s.slot);
    host_free(of->host, s.row);
    return ok;
}
