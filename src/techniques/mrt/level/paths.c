// Light of one block along all paths through openings, breadth first (Loos 2015, section 3.5.3).
//
// A wave is the light that enters a block by one opening, as lightfield coefficients per b of the
// source. Waves of one depth with the same entry are summed before they go on, so the work grows
// with the openings and not with the paths. Differs from the paper: light goes straight, so light
// that left a block in one direction never leaves one in the opposite direction. Such paths are
// skipped; the low rank of the operators would give them a little light. Waves therefore carry the
// directions that they have taken.
#include "level.h"

#include <string.h>

struct wave {
    int entry;
    unsigned taken;          // directions of exits, in the cell of the block that is entered
    struct matrix_f32 light; // k_rlf × k_b
};

struct waves {
    struct wave *wave;
    int count, capacity;
};

struct traversal {
    struct host *host;
    const struct mrt_level *level;
    struct waves now, next;
    float *response; // [entry_count] × k_r × k_b
    bool *reached;   // [entry_count]
};

static void clear(struct host *host, struct waves *waves)
{
    for (int i = 0; i < waves->count; i++) matrix_f32_finish(host, &waves->wave[i].light);
    waves->count = 0;
}

static bool multiply(struct host *host, const struct matrix_f32 *a, const struct matrix_f32 *b,
                     struct matrix_f32 *out)
{
    return matrix_f32_init(host, out, a->rows, b->columns) &&
           matrix_f32_multiply(host, 1.0f, a, NOT_TRANSPOSED, b, NOT_TRANSPOSED, 0.0f, out);
}

// Replaces `light` by operator · light.
static bool apply(const struct traversal *t, const struct matrix_f32 *operator,
                  struct matrix_f32 * light)
{
    struct matrix_f32 applied = { 0 };
    const bool ok = multiply(t->host, operator, light, &applied);
    matrix_f32_finish(t->host, light);
    *light = applied;
    return ok;
}

// Turns the frame of an interface: replaces `light`.
static bool roll(const struct traversal *t, int rolls, struct matrix_f32 *light)
{
    bool ok = true;
    for (int i = 0; ok && i < rolls; i++)
        ok = apply(t, &t->level->dictionary->r_turn[MRT_ROLL], light);
    return ok;
}

static bool append(struct host *host, struct waves *waves, const struct wave *wave)
{
    if (waves->count == waves->capacity) {
        int capacity = waves->capacity ? 2 * waves->capacity : 16;
        struct wave *grown = host_realloc(host, waves->wave, (size_t)capacity, sizeof *waves->wave);
        if (!grown) return false;
        waves->wave = grown;
        waves->capacity = capacity;
    }
    waves->wave[waves->count++] = *wave;
    return true;
}

// Takes the wave's light: added to the waves of the next depth, or freed.
static bool add_wave(struct traversal *t, struct wave *wave)
{
    for (int i = 0; i < t->next.count; i++) {
        struct wave *same = &t->next.wave[i];
        if (same->entry != wave->entry || same->taken != wave->taken) continue;
        for (size_t k = 0; k < wave->light.rows * wave->light.columns; k++)
            same->light.at[k] += wave->light.at[k];
        matrix_f32_finish(t->host, &wave->light);
        return true;
    }
    if (append(t->host, &t->next, wave)) return true;
    matrix_f32_finish(t->host, &wave->light);
    return false;
}

// Light that has left a block by a face, in that face's frame, enters the neighbour.
static bool enter(struct traversal *t, int block, int face, unsigned taken,
                  struct matrix_f32 *light)
{
    const struct mrt_block *from = &t->level->map->blocks[block];
    const struct mrt_neighbor *to = &from->neighbor[face];
    struct wave wave = { .entry = t->level->entry_of_face[CUBE_FACES * to->block + to->face] };
    for (int f = 0; f < CUBE_FACES; f++)
        if (taken >> f & 1u) wave.taken |= 1u << mrt_neighbor_direction(from, face, f);
    bool ok = !mrt_block_has_holes(from, face) ||
              apply(t, &t->level->holes[CUBE_FACES * block + face], light);
    ok = ok && roll(t, to->rolls, light);
    wave.light = *light;
    *light = (struct matrix_f32){ 0 };
    if (ok) return add_wave(t, &wave);
    matrix_f32_finish(t->host, &wave.light);
    return false;
}

static bool leave_source(struct traversal *t, int block)
{
    const struct mrt_cube_place *place = &t->level->place[block];
    mat3s cube_from_block = glms_mat3_transpose(place->block_from_cube);
    for (int f = 0; f < CUBE_FACES; f++) {
        if (t->level->map->blocks[block].neighbor[f].block < 0) continue;
        int face = mrt_rotated_face(cube_from_block, f);
        const struct matrix_f32 *r_b = &t->level->dictionary->element[place->cube].r_b[face];
        mat3s frame = glms_mat3_mul(place->block_from_cube, cube_from_face(face));
        struct matrix_f32 light = { 0 };
        bool ok = matrix_f32_init(t->host, &light, r_b->rows, r_b->columns);
        for (size_t r = 0; ok && r < r_b->rows; r++)
            memcpy(light.at + r * light.stride, r_b->at + r * r_b->stride,
                   r_b->columns * sizeof *r_b->at);
        ok = ok && roll(t, mrt_rolls_between(frame, cube_from_face(f)), &light) &&
             enter(t, block, f, 1u << f, &light);
        matrix_f32_finish(t->host, &light);
        if (!ok) return false;
    }
    return true;
}

static bool respond(struct traversal *t, const struct wave *wave)
{
    size_t rows = (size_t)t->level->k_r, columns = (size_t)t->level->k_b;
    float *response = t->response + (size_t)wave->entry * rows * columns;
    struct matrix_f32 sum = { response, rows, columns, columns };
    const struct mrt_entry *at = &t->level->entries[wave->entry];
    const struct mrt_shape shape = mrt_level_cell(t->level, at->block);
    const int entered = mrt_entered_by(&shape, at->face);
    t->reached[wave->entry] = true;
    return matrix_f32_multiply(t->host, 1.0f, &t->level->dictionary->entered[entered].t_r,
                               NOT_TRANSPOSED, &wave->light, NOT_TRANSPOSED, 1.0f, &sum);
}

static bool pass_block(struct traversal *t, const struct wave *wave)
{
    const struct mrt_entry *at = &t->level->entries[wave->entry];
    const struct mrt_block *block = &t->level->map->blocks[at->block];
    for (int f = 0; f < CUBE_FACES; f++) {
        if (f == at->face || block->neighbor[f].block < 0) continue;
        if (wave->taken >> cube_opposite(f) & 1u) continue;
        struct mrt_passage passage = mrt_passage_between(at->face, f);
        struct matrix_f32 light = { 0 };
        bool ok =
            multiply(t->host, &t->level->dictionary->r_turn[passage.turn], &wave->light, &light) &&
            roll(t, passage.rolls, &light) && enter(t, at->block, f, wave->taken | 1u << f, &light);
        matrix_f32_finish(t->host, &light);
        if (!ok) return false;
    }
    return true;
}

static bool traverse(struct traversal *t, int block, int max_depth)
{
    if (max_depth > 0 && !leave_source(t, block)) return false;
    for (int depth = 1; t->next.count > 0; depth++) {
        struct waves done = t->now;
        t->now = t->next;
        t->next = done;
        for (int i = 0; i < t->now.count; i++) {
            if (!respond(t, &t->now.wave[i])) return false;
            if (depth < max_depth && !pass_block(t, &t->now.wave[i])) return false;
        }
        clear(t->host, &t->now);
    }
    return true;
}

// Keeps the matrices of the entries that were reached.
static bool collect(const struct traversal *t, struct mrt_sent *out)
{
    size_t size = (size_t)t->level->k_r * (size_t)t->level->k_b;
    int count = 0;
    for (int e = 0; e < t->level->entry_count; e++) count += t->reached[e];
    out->entry = host_alloc(t->host, (size_t)count, sizeof *out->entry);
    out->matrices = host_alloc(t->host, (size_t)count * size, sizeof *out->matrices);
    if (!out->entry || !out->matrices) return false;
    for (int e = 0; e < t->level->entry_count; e++) {
        if (!t->reached[e]) continue;
        memcpy(out->matrices + (size_t)out->count * size, t->response + (size_t)e * size,
               size * sizeof *out->matrices);
        out->entry[out->count++] = e;
    }
    return true;
}

bool mrt_send_from(struct host *host, const struct mrt_level *level, int block, int max_depth,
                   struct mrt_sent *out)
{
    struct traversal t = { .host = host, .level = level };
    size_t entries = (size_t)level->entry_count;
    size_t size = (size_t)level->k_r * (size_t)level->k_b;
    *out = (struct mrt_sent){ .host = host };
    t.response = host_alloc(host, entries * size, sizeof *t.response);
    t.reached = host_alloc(host, entries, sizeof *t.reached);
    bool ok = t.response && t.reached && traverse(&t, block, max_depth) && collect(&t, out);
    clear(host, &t.now);
    clear(host, &t.next);
    host_free(host, t.now.wave);
    host_free(host, t.next.wave);
    host_free(host, t.response);
    host_free(host, t.reached);
    if (!ok) mrt_sent_finish(out);
    return ok;
}

void mrt_sent_finish(struct mrt_sent *sent)
{
    if (sent->host) {
        host_free(sent->host, sent->entry);
        host_free(sent->host, sent->matrices);
    }
    *sent = (struct mrt_sent){ 0 };
}
