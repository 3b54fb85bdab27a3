// Creation of a level.
#include "level.h"

#include "core/parallel.h"

#include <string.h>

static bool unsupported(const struct mrt_level *level, int block, const char *why)
{
    static const char *const mazes[] = { "plane", "space", "tunnel" };
    return host_fail(level->host, FAIL_UNSUPPORTED, "block %s: maze=%s has no %s; set maze=auto",
                     level->map->blocks[block].name, mazes[level->maze], why);
}

static bool is_tilted(const struct mrt_block *block)
{
    for (int f = 0; f < CUBE_FACES; f++)
        if (block->neighbor[f].block >= 0 && block->neighbor[f].rolls != 0) return true;
    return false;
}

static bool choose_shape(struct mrt_level *level, int b)
{
    const struct mrt_block *block = &level->map->blocks[b];
    const bool tube = mrt_block_is_tube(block);
    if (tube != (level->maze == MRT_TUNNEL))
        return unsupported(level, b, tube ? "cylinders" : "cubes");
    if (tube)
        level->place[b] = (struct mrt_cube_place){ (int)mrt_block_bend(block), GLMS_MAT3_IDENTITY };
    else if (!mrt_cube_find(level->maze, block->open, &level->place[b]))
        return unsupported(level, b, "cube with its openings");
    for (int f = 0; f < CUBE_FACES; f++)
        if (mrt_block_has_holes(block, f) && !mrt_wall_may_have_holes(level->maze, f))
            return unsupported(level, b, "holes in floors and ceilings");
    return (level->maze == MRT_MAZE_3D || !is_tilted(block)) ||
           unsupported(level, b, "turn for its tilted neighbor");
}

static bool choose_shapes(struct mrt_level *level)
{
    for (int b = 0; b < level->map->count; b++) {
        if (!choose_shape(level, b)) return false;
        struct mrt_shape cell = mrt_level_cell(level, b);
        level->first_texel[b + 1] = level->first_texel[b] + mrt_shape_texels(&cell);
    }
    return true;
}

static void list_entries(struct mrt_level *level)
{
    for (int i = 0; i < CUBE_FACES * level->map->count; i++) {
        int block = i / CUBE_FACES, face = i % CUBE_FACES;
        level->entry_of_face[i] = -1;
        if (level->map->blocks[block].neighbor[face].block < 0) continue;
        level->entries[level->entry_count] = (struct mrt_entry){ block, face };
        level->entry_of_face[i] = level->entry_count++;
    }
}

// ---- T_b→r

struct send_job {
    const struct mrt_level *level;
    struct host *hosts; // [blocks]: failures of tasks do not race
    struct mrt_sent *sent;
    int max_depth;
    bool *ok;
};

static void send_task(void *user, size_t i)
{
    struct send_job *job = user;
    job->hosts[i] = *job->level->host;
    job->ok[i] = mrt_send_from(&job->hosts[i], job->level, (int)i, job->max_depth, &job->sent[i]);
}

// From lists by source to lists by entry: entries ascend within a source, sources within an entry.
static bool gather_links(struct mrt_level *level, const struct mrt_sent *sent)
{
    size_t k_b = (size_t)level->k_b, k_r = (size_t)level->k_r, total = 0;
    size_t stride = (size_t)level->link_stride;
    for (int b = 0; b < level->map->count; b++) {
        total += (size_t)sent[b].count;
        for (int i = 0; i < sent[b].count; i++) level->first_link[sent[b].entry[i] + 1]++;
    }
    for (int e = 0; e < level->entry_count; e++) level->first_link[e + 1] += level->first_link[e];
    level->links = host_alloc(level->host, total, sizeof *level->links);
    level->matrices = host_alloc(level->host, total * k_b * stride, sizeof *level->matrices);
    int *next = host_alloc(level->host, (size_t)level->entry_count, sizeof *next);
    bool ok = level->links && level->matrices && next;
    if (ok) memcpy(next, level->first_link, (size_t)level->entry_count * sizeof *next);
    for (int b = 0; ok && b < level->map->count; b++) {
        for (int i = 0; i < sent[b].count; i++) {
            size_t link = (size_t)next[sent[b].entry[i]]++, at = link * k_b * stride;
            const float *from = sent[b].matrices + (size_t)i * k_b * k_r;
            level->links[link] = (struct mrt_link){ b, at };
            for (size_t r = 0; r < k_r; r++)
                for (size_t c = 0; c < k_b; c++)
                    level->matrices[at + c * stride + r] = from[r * k_b + c];
        }
    }
    host_free(level->host, next);
    return ok;
}

// Σ share · R_hole of each wall with holes.
static bool add_holes(struct mrt_level *level)
{
    const struct matrix_f32 *parts = level->dictionary->r_hole;
    const size_t faces = CUBE_FACES * (size_t)level->map->count;
    level->holes = host_alloc(level->host, faces, sizeof *level->holes);
    for (size_t f = 0; level->holes && f < faces; f++) {
        const struct mrt_block *block = &level->map->blocks[f / CUBE_FACES];
        struct matrix_f32 *sum = &level->holes[f];
        if (!mrt_block_has_holes(block, (int)(f % CUBE_FACES))) continue;
        if (!matrix_f32_init(level->host, sum, parts[0].rows, parts[0].columns)) return false;
        for (int p = 0; p < MRT_HOLE_PARTS; p++)
            for (size_t i = 0; i < sum->rows * sum->columns; i++)
                sum->at[i] += block->holes[f % CUBE_FACES].share[p] * parts[p].at[i];
    }
    return level->holes;
}

static void finish_holes(struct mrt_level *level)
{
    for (int f = 0; level->holes && f < CUBE_FACES * level->map->count; f++)
        matrix_f32_finish(level->host, &level->holes[f]);
    host_free(level->host, level->holes);
    level->holes = NULL;
}

static bool propagate(struct mrt_level *level, int max_depth)
{
    size_t blocks = (size_t)level->map->count;
    struct send_job job = { .level = level, .max_depth = max_depth };
    job.hosts = host_alloc(level->host, blocks, sizeof *job.hosts);
    job.sent = host_alloc(level->host, blocks, sizeof *job.sent);
    job.ok = host_alloc(level->host, blocks, sizeof *job.ok);
    bool ok = job.hosts && job.sent && job.ok;
    if (ok) parallel_for(blocks, 1, send_task, &job);
    for (size_t b = 0; ok && b < blocks; b++) {
        ok = job.ok[b];
        if (!ok) level->host->failure = job.hosts[b].failure;
    }
    ok = ok && gather_links(level, job.sent);
    for (size_t b = 0; job.sent && b < blocks; b++) mrt_sent_finish(&job.sent[b]);
    host_free(level->host, job.hosts);
    host_free(level->host, job.sent);
    host_free(level->host, job.ok);
    return ok;
}

static void set_sizes(struct mrt_level *level)
{
    const struct mrt_dictionary_options *o = &level->dictionary->options;
    level->maze = (enum mrt_maze)o->maze;
    level->resolution = mrt_face_texels(level->maze, o->texels);
    level->k_b = o->modes;
    level->k_rlf = o->lightfield_modes;
    level->k_r = o->response_modes;
    level->link_stride = (level->k_r + MRT_LANES - 1) / MRT_LANES * MRT_LANES;
}

bool mrt_level_init(struct host *host, const struct mrt_block_map *map,
                    const struct mrt_dictionary *dictionary,
                    const struct mrt_level_options *options, struct mrt_level *level)
{
    size_t blocks = (size_t)map->count, faces = CUBE_FACES * blocks;
    *level = (struct mrt_level){ .host = host, .map = map, .dictionary = dictionary };
    set_sizes(level);
    level->place = host_alloc(host, blocks, sizeof *level->place);
    level->first_texel = host_alloc(host, blocks + 1, sizeof *level->first_texel);
    level->entries = host_alloc(host, faces, sizeof *level->entries);
    level->entry_of_face = host_alloc(host, faces, sizeof *level->entry_of_face);
    level->first_link = host_alloc(host, faces + 1, sizeof *level->first_link);
    bool ok = level->place && level->first_texel && level->entries && level->entry_of_face &&
              level->first_link && choose_shapes(level);
    if (ok) list_entries(level);
    if (ok && options->retrace.most > 0 && level->maze != MRT_TUNNEL)
        ok = mrt_retraces_init(host, map, level->place, dictionary, options->retrace,
                               &level->retraces);
    ok = ok && add_holes(level) && propagate(level, options->max_depth);
    finish_holes(level);
    if (!ok) mrt_level_finish(level);
    return ok;
}

void mrt_level_finish(struct mrt_level *level)
{
    if (level->host) {
        mrt_retraces_finish(&level->retraces);
        host_free(level->host, level->place);
        host_free(level->host, level->first_texel);
        host_free(level->host, level->entries);
        host_free(level->host, level->entry_of_face);
        host_free(level->host, level->first_link);
        host_free(level->host, level->links);
        host_free(level->host, level->matrices);
    }
    *level = (struct mrt_level){ 0 };
}
