// Tables of texels, tiles, blocks, openings and borders.
#include "techniques/mrt/gpu/upload.h"

#include "frame/octahedral.h"

#include <string.h>

static uint32_t texels_of_tile(const struct mrt_runtime_input *input)
{
    return (uint32_t)(input->atlas->resolution * input->atlas->resolution);
}

static uint32_t packed(vec3s across)
{
    return glms_vec3_norm2(across) > 0.0f ? octahedral_pack(across) : 0;
}

static struct mrt_texel texel_of(const struct mrt_geometry_texel *from)
{
    return (struct mrt_texel){
        .position = from->position,
        .area_m2 = from->area_m2,
        .normal = from->normal,
        .found = from->found,
        .reflectance = from->reflectance,
        .sky = from->sky,
        .emitted = from->emitted,
        .reflected = { from->reflected.first, from->reflected.count },
        .emitted_vector = { from->emitted_vector[0], from->emitted_vector[1],
                            from->emitted_vector[2] },
        .sky_vector = from->sky_vector,
        .across = packed(from->across),
        .hidden = from->hidden,
    };
}

void mrt_fill_texels(const struct mrt_geometry_texel *from, size_t count, struct mrt_texel *out)
{
    for (size_t i = 0; i < count; i++) out[i] = texel_of(&from[i]);
}

static void fill_texels(const struct mrt_runtime_input *input, void *items)
{
    mrt_fill_texels(input->images->geometry, (size_t)input->atlas->texels, items);
}

static bool is_near_wall(const struct mrt_runtime_input *input, const struct mrt_tile *tile,
                         vec3s point)
{
    vec3s cell;
    if (!mrt_warp_inverse(input->map->blocks[tile->block].corner, point, &cell)) return true;
    return 0.5f - glms_vec3_dot(cube_from_face(tile->face).col[2], cell) <= MRT_NEAR_WALL;
}

// The nearest texel of the tile that stands for its wall; the texel itself where there is none.
static int nearest_of_wall(const struct mrt_runtime_input *input, const struct mrt_tile *tile,
                           int k)
{
    const int n = input->atlas->resolution;
    const struct mrt_geometry_texel *texels = input->images->geometry + tile->first_texel;
    int nearest = k, least = 2 * n * n;
    if (is_near_wall(input, tile, texels[k].position)) return k;
    for (int i = 0; i < n * n; i++) {
        const int x = i % n - k % n, y = i / n - k / n;
        if (x * x + y * y >= least || !is_near_wall(input, tile, texels[i].position)) continue;
        least = x * x + y * y;
        nearest = i;
    }
    return nearest;
}

// Texels that stand for an object far from the wall have its area light, but pixels that look them
// up are on the wall beside the object or behind it.
static void fill_shown(const struct mrt_runtime_input *input, void *items)
{
    uint32_t *shown = items;
    const bool is_tube = mrt_block_is_tube(&input->map->blocks[0]);
    for (int i = 0; i < input->atlas->texels; i++) shown[i] = (uint32_t)i;
    for (int i = 0; i < input->atlas->tile_count && !is_tube; i++) {
        const struct mrt_tile *tile = &input->atlas->tiles[i];
        for (uint32_t k = 0; k < texels_of_tile(input); k++)
            shown[tile->first_texel + (int)k] =
                (uint32_t)(tile->first_texel + nearest_of_wall(input, tile, (int)k));
    }
}

// First row of a basis in the operators.
static uint32_t basis_row(const struct mrt_operators *operators, int block)
{
    size_t row = 0;
    for (int i = 0; i < operators->basis_of_block[block]; i++) row += operators->bases[i].u[0].rows;
    return (uint32_t)row;
}

int mrt_first_texel(const struct mrt_atlas *atlas, int block)
{
    for (int f = 0; f < CUBE_FACES; f++) {
        int tile = atlas->tile_of_face[CUBE_FACES * block + f];
        if (tile >= 0) return atlas->tiles[tile].first_texel;
    }
    return -1;
}

static void fill_tiles(const struct mrt_runtime_input *input, void *items)
{
    struct mrt_gpu_tile *tiles = items;
    for (int i = 0; i < input->atlas->tile_count; i++) {
        const struct mrt_tile *tile = &input->atlas->tiles[i];
        uint32_t before =
            (uint32_t)(tile->first_texel - mrt_first_texel(input->atlas, tile->block));
        tiles[i] = (struct mrt_gpu_tile){
            .block = (uint32_t)tile->block,
            .first_texel = (uint32_t)tile->first_texel,
            .basis_row = basis_row(input->operators, tile->block) + before,
            .response_row = (uint32_t)tile->face * texels_of_tile(input),
            .x = tile->x,
            .y = tile->y,
        };
    }
}

// The affine part of the warp, inverted.
static void fill_inverse(const struct mrt_block *from, struct mrt_gpu_block *to)
{
    const vec3s middle = vec3_of(0, 0, 0);
    mat3s inverse = glms_mat3_inv(mrt_warp_jacobian(from->corner, middle));
    to->middle = mrt_warp_point(from->corner, middle);
    for (int a = 0; a < 3; a++)
        to->inverse[a] =
            vec3_of(inverse.col[0].raw[a], inverse.col[1].raw[a], inverse.col[2].raw[a]);
}

uint32_t mrt_used_quads(const struct mrt_operators *operators, const struct mrt_opening *opening)
{
    if (opening->face >= 0) return mrt_quads(operators->k_r);
    return opening->face_count > 0 ? mrt_quads(opening->face_count) : 1;
}

static bool sends(const struct matrix_f32 *of_c, size_t face)
{
    for (size_t k = 0; k < of_c->columns; k++)
        if (of_c->at[face * of_c->stride + k] != 0.0f) return true;
    return false;
}

// Writes them to `out` unless that is NULL; returns their number.
static uint32_t senders_of(const struct mrt_opening *opening, struct mrt_sender *out)
{
    uint32_t count = 0;
    for (int i = 0; i < opening->pair_count; i++) {
        const struct matrix_f32 *of_c = &opening->pairs[i].of_c;
        for (size_t f = 0; f < of_c->rows; f++) {
            if (!sends(of_c, f)) continue;
            if (out)
                out[count] = (struct mrt_sender){ opening->pairs[i].source, (int)f,
                                                  of_c->at + f * of_c->stride };
            count++;
        }
    }
    return count;
}

struct mrt_sender *mrt_all_senders(struct host *host, const struct mrt_operators *operators,
                                   uint32_t *count)
{
    *count = 0;
    for (int i = 0; i < operators->opening_count; i++)
        *count += senders_of(&operators->openings[i], NULL);
    struct mrt_sender *out = host_alloc(host, *count, sizeof *out), *next = out;
    for (int i = 0; out && i < operators->opening_count; i++)
        next += senders_of(&operators->openings[i], next);
    return out;
}

static void fill_blocks(const struct mrt_runtime_input *input, void *items)
{
    const struct mrt_operators *o = input->operators;
    struct mrt_gpu_block *blocks = items;
    int opening = 0;
    for (int b = 0; b < input->map->count; b++) {
        const struct mrt_block *from = &input->map->blocks[b];
        struct mrt_gpu_block *to = &blocks[b];
        memcpy(to->corner, from->corner, sizeof to->corner);
        for (int f = 0; f < CUBE_FACES; f++)
            to->tile[f] = input->atlas->tile_of_face[CUBE_FACES * b + f];
        for (int f = 0; f < CUBE_FACES; f++) to->neighbor[f] = mrt_block_beyond(from, f);
        fill_inverse(from, to);
        to->bend = mrt_block_is_tube(from) ? (int32_t)mrt_block_bend(from) : -1;
        to->first_texel = (uint32_t)mrt_first_texel(input->atlas, b);
        to->texels = (uint32_t)mrt_block_walls(from) * texels_of_tile(input);
        to->basis_row = basis_row(input->operators, b);
        to->first_opening = (uint32_t)opening;
        to->columns = 4 * mrt_quads(o->k_b);
        for (; opening < o->opening_count && o->openings[opening].block == b; opening++)
            to->columns += 4 * mrt_used_quads(o, &o->openings[opening]);
        to->openings = (uint32_t)opening - to->first_opening;
    }
}

static void fill_openings(const struct mrt_runtime_input *input, void *items)
{
    const struct mrt_operators *o = input->operators;
    struct mrt_gpu_opening *openings = items;
    uint32_t pair = 0, sender = 0;
    int clutter = 0;
    for (int i = 0; i < o->opening_count; i++) {
        const struct mrt_opening *from = &o->openings[i];
        struct mrt_gpu_opening *to = &openings[i];
        *to = (struct mrt_gpu_opening){ .first_pair = pair,
                                        .quads = mrt_used_quads(o, from),
                                        .clutter = from->face < 0 ? clutter++ : -1,
                                        .first_sender = sender,
                                        .senders = senders_of(from, NULL) };
        for (int k = 0; k < from->response; k++)
            to->response += (uint32_t)o->responses[k].u[0].rows;
        for (int k = 0; k < from->pair_count; k++) to->pairs += from->pairs[k].of_b.rows > 0;
        pair += to->pairs;
        sender += to->senders;
    }
}

static void fill_sources(const struct mrt_runtime_input *input, void *items)
{
    uint32_t *source = items;
    for (int i = 0; i < input->operators->opening_count; i++) {
        const struct mrt_opening *opening = &input->operators->openings[i];
        for (int k = 0; k < opening->pair_count; k++)
            if (opening->pairs[k].of_b.rows > 0) *source++ = (uint32_t)opening->pairs[k].source;
    }
}

static void fill_borders(const struct mrt_runtime_input *input, void *items)
{
    struct mrt_gpu_border *borders = items;
    for (int i = 0; i < input->atlas->border_count; i++) {
        const struct mrt_border *from = &input->atlas->borders[i];
        borders[i] = (struct mrt_gpu_border){ .texel = from->texel, .count = from->count };
        memcpy(borders[i].source, from->source, sizeof borders[i].source);
        memcpy(borders[i].weight, from->weight, sizeof borders[i].weight);
    }
}
_Static_assert(MRT_BORDER_SOURCES == 8, "as in mrt_gpu_border");

static struct mrt_level_params level_of(const struct mrt_runtime_input *input)
{
    return (struct mrt_level_params){
        .resolution = (uint32_t)input->atlas->resolution,
        .texels_of_tile = texels_of_tile(input),
        .texels = (uint32_t)input->atlas->texels,
        .borders = (uint32_t)input->atlas->border_count,
        .map_width = (uint32_t)input->atlas->width,
        .map_height = (uint32_t)input->atlas->height,
        .tiles = (uint32_t)input->atlas->tile_count,
    };
}

bool mrt_tables_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    const struct mrt_atlas *atlas = input->atlas;
    const size_t openings = (size_t)input->operators->opening_count;
    runtime->level = level_of(input);
    runtime->block_count = (uint32_t)input->map->count;
    runtime->opening_count = (uint32_t)openings;
    return mrt_table_upload(runtime, input, "mrt_texels", (size_t)atlas->texels,
                            sizeof(struct mrt_texel), fill_texels) &&
           mrt_table_upload(runtime, input, "mrt_shown", (size_t)atlas->texels, sizeof(uint32_t),
                            fill_shown) &&
           mrt_table_upload(runtime, input, "mrt_tiles", (size_t)atlas->tile_count,
                            sizeof(struct mrt_gpu_tile), fill_tiles) &&
           mrt_table_upload(runtime, input, "mrt_blocks", (size_t)input->map->count,
                            sizeof(struct mrt_gpu_block), fill_blocks) &&
           mrt_table_upload(runtime, input, "mrt_openings", openings,
                            sizeof(struct mrt_gpu_opening), fill_openings) &&
           mrt_table_upload(runtime, input, "mrt_sources", mrt_pair_count(input->operators),
                            sizeof(uint32_t), fill_sources) &&
           mrt_table_upload(runtime, input, "mrt_borders", (size_t)atlas->border_count,
                            sizeof(struct mrt_gpu_border), fill_borders);
}
