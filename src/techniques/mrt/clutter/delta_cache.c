#include "techniques/mrt/clutter/delta_cache.h"

#include "core/hash.h"

#include <math.h>

bool mrt_delta_cache_init(struct mrt_delta_cache *out, struct host *host, int blocks)
{
    *out = (struct mrt_delta_cache){ .host = host, .count = blocks };
    out->blocks = host_alloc(host, (size_t)blocks, sizeof *out->blocks);
    out->entries = host_alloc(host, (size_t)blocks * CUBE_FACES, sizeof *out->entries);
    return out->blocks && out->entries;
}

static void forget_delta(struct mrt_kept_block *kept)
{
    mrt_delta_block_finish(&kept->delta);
    kept->has_delta = false;
}

static void forget_gathered(struct mrt_kept_block *kept)
{
    mrt_gather_faces_finish(&kept->gathered);
    kept->has_gathered = false;
}

static void forget_transfer(struct mrt_kept_block *kept)
{
    mrt_clutter_transfer_finish(&kept->transfer);
    kept->has_transfer = false;
}

void mrt_delta_cache_finish(struct mrt_delta_cache *cache)
{
    if (!cache->host) return;
    for (int b = 0; cache->blocks && b < cache->count; b++) {
        forget_delta(&cache->blocks[b]);
        forget_gathered(&cache->blocks[b]);
        forget_transfer(&cache->blocks[b]);
    }
    for (int i = 0; cache->entries && i < cache->count * CUBE_FACES; i++)
        mrt_delta_entry_finish(&cache->entries[i].entry);
    host_free(cache->host, cache->blocks);
    host_free(cache->host, cache->entries);
    *cache = (struct mrt_delta_cache){ 0 };
}

// ---- clutter of a block

// By more than the rounding of rays that run along its sides.
static struct box3 widened(struct box3 box)
{
    const float margin = 1e-3f * glms_vec3_max(box3_size(box));
    const vec3s by = vec3_of(margin, margin, margin);
    return (struct box3){ glms_vec3_sub(box.min, by), glms_vec3_add(box.max, by) };
}

static struct box3 bounds_of_block(const struct mrt_block *block)
{
    return widened(mrt_warp_bounds(block->corner));
}

static struct box3 bounds_of_triangle(const struct chart_triangle *triangle)
{
    struct box3 box = box3_empty();
    for (int k = 0; k < 3; k++) box = box3_add_point(box, triangle->corner[k]);
    return box;
}

struct box3 mrt_clutter_bounds_in(const struct mrt_clutter *clutter, const struct mrt_block *block)
{
    const struct box3 at = bounds_of_block(block);
    struct box3 all = box3_empty();
    for (uint32_t t = 0; t < clutter->charts.triangle_count; t++) {
        const struct box3 box = bounds_of_triangle(&clutter->charts.triangles[t]);
        if (box3_intersects(box, at)) all = box3_union(all, box);
    }
    return box3_is_empty(all) ? all : widened(all);
}

// ---- keys

// Hashes the properties of a material that rays read.
static struct hash128 add_material(struct hash128 key, const struct mrt_clutter *clutter,
                                   int instance)
{
    const struct scene *scene = &clutter->objects.scene;
    const struct mesh *mesh = scene_mesh_of(scene, instance);
    const struct material *m = &scene->materials[mesh->material];
    const float cutoff[2] = { m->base_color.w, m->alpha_cutoff };
    const int kind[3] = { (int)m->alpha_mode, mesh->material, scene->instances[instance].skin };
    key = hash128_add(key, &m->double_sided, sizeof m->double_sided);
    if (m->alpha_mode == ALPHA_OPAQUE) return key;
    return hash128_add(hash128_add(key, cutoff, sizeof cutoff), kind, sizeof kind);
}

static struct hash128 add_triangle(struct hash128 key, const struct mrt_clutter *clutter,
                                   const struct chart_triangle *triangle, int face)
{
    key = hash128_add(key, triangle->corner, sizeof triangle->corner);
    key = hash128_add(key, &face, sizeof face);
    return add_material(key, clutter, triangle->instance);
}

// Triangles that reach into a box.
static struct hash128 add_triangles(struct hash128 key, const struct mrt_clutter *clutter,
                                    int block, int first_face, struct box3 box)
{
    for (uint32_t t = 0; t < clutter->charts.triangle_count; t++) {
        const struct chart_triangle *triangle = &clutter->charts.triangles[t];
        if (!box3_intersects(bounds_of_triangle(triangle), box)) continue;
        const int face = mrt_face_of_chart(clutter, block, triangle->chart);
        key = add_triangle(key, clutter, triangle, face < 0 ? -1 : face - first_face);
    }
    return key;
}

static struct hash128 add_texel(struct hash128 key, const struct charts *charts, uint32_t texel)
{
    const struct chart_texel *at = &charts->texels[texel];
    const vec3s normal = chart_texel_normal(charts, texel);
    const float values[7] = { at->position.x, at->position.y, at->position.z, at->area_m2,
                              normal.x,       normal.y,       normal.z };
    return hash128_add(key, values, sizeof values);
}

// Texels of the faces of a block. Widens the box by them.
static struct hash128 add_faces(struct hash128 key, const struct mrt_clutter *clutter, int first,
                                int faces, struct box3 *box)
{
    for (int f = first; f < first + faces; f++) {
        const struct mrt_clutter_face *face = &clutter->faces[f];
        key = hash128_add(key, &face->texel_count, sizeof face->texel_count);
        for (uint32_t t = 0; t < face->texel_count; t++) {
            const uint32_t texel = clutter->texels[face->first_texel + t];
            key = add_texel(key, &clutter->charts, texel);
            *box = box3_add_point(*box, clutter->charts.texels[texel].position);
        }
    }
    return key;
}

// Rays of faces go through openings: all clutter may block them.
static struct hash128 gather_key(const struct mrt_clutter *clutter, int block)
{
    const vec3s far = vec3_of(INFINITY, INFINITY, INFINITY);
    struct box3 everything = { glms_vec3_negate(far), far }, unused = box3_empty();
    int first;
    const int faces = mrt_faces_of_block(clutter, block, &first);
    struct hash128 key = add_faces((struct hash128){ 0 }, clutter, first, faces, &unused);
    // Columns of all faces.
    key = hash128_add(key, clutter->chart_faces,
                      clutter->first_chart_face[clutter->charts.count] *
                          sizeof *clutter->chart_faces);
    return add_triangles(key, clutter, block, first, everything);
}

// Blocks that rays reach through an opening. Writes the number of openings behind it, −1: none.
static void find_reached(const struct mrt_block_map *map, int first, int depth, int *openings)
{
    for (int b = 0; b < map->count; b++) openings[b] = b == first ? 0 : -1;
    for (int d = 0; d < depth; d++)
        for (int b = 0; b < map->count; b++)
            for (int f = 0; f < CUBE_FACES && openings[b] == d; f++) {
                const int next = map->blocks[b].neighbor[f].block;
                if (mrt_block_is_open(&map->blocks[b], f) && next >= 0 && openings[next] < 0)
                    openings[next] = d + 1;
            }
}

static struct hash128 entry_key(const struct mrt_delta_entry_input *input, const int *openings)
{
    struct hash128 key = { 0 };
    for (int b = 0; b < input->map->count; b++) {
        int first;
        const int faces = mrt_faces_of_block(input->clutter, b, &first);
        if (openings[b] < 0) continue;
        key = hash128_add(key, &faces, sizeof faces);
        key = add_triangles(key, input->clutter, b, first, bounds_of_block(&input->map->blocks[b]));
    }
    return key;
}

// Rays of texels end in their block, but may begin beyond it.
static struct hash128 transfer_key(const struct mrt_clutter_transfer_input *input, int block)
{
    struct box3 box = bounds_of_block(&input->map->blocks[block]);
    int first;
    const int faces = mrt_faces_of_block(input->clutter, block, &first);
    const struct hash128 key = add_faces((struct hash128){ 0 }, input->clutter, first, faces, &box);
    return add_triangles(key, input->clutter, block, first, box);
}

// ---- operators

const struct mrt_delta_block *mrt_kept_delta(struct mrt_delta_cache *cache,
                                             const struct mrt_delta_input *input)
{
    struct mrt_kept_block *kept = &cache->blocks[input->index];
    int first;
    const int faces = mrt_faces_of_block(input->clutter, input->index, &first);
    const struct hash128 key = add_triangles((struct hash128){ 0 }, input->clutter, input->index,
                                             first, bounds_of_block(input->block));
    if (kept->has_delta && hash128_same(kept->delta_key, key) && kept->delta.face_count == faces) {
        kept->delta.first_face = first;
        return &kept->delta;
    }
    forget_delta(kept);
    if (!mrt_delta_block_init(&kept->delta, cache->host, input)) return NULL;
    cache->traced += kept->delta.touched;
    kept->delta_key = key;
    kept->has_delta = true;
    return &kept->delta;
}

const struct mrt_gather_faces *mrt_kept_gather(struct mrt_delta_cache *cache,
                                               const struct mrt_gather_input *input, int block)
{
    struct mrt_kept_block *kept = &cache->blocks[block];
    const struct hash128 key = gather_key(input->clutter, block);
    if (kept->has_gathered && hash128_same(kept->gathered_key, key)) return &kept->gathered;
    forget_gathered(kept);
    if (!mrt_gather_faces_init(&kept->gathered, cache->host, input, block)) return NULL;
    kept->gathered_key = key;
    kept->has_gathered = true;
    return &kept->gathered;
}

const struct mrt_clutter_transfer *mrt_kept_transfer(struct mrt_delta_cache *cache,
                                                     const struct mrt_clutter_transfer_input *input,
                                                     int block)
{
    struct mrt_kept_block *kept = &cache->blocks[block];
    const struct hash128 key = transfer_key(input, block);
    int first;
    const int faces = mrt_faces_of_block(input->clutter, block, &first);
    if (kept->has_transfer && hash128_same(kept->transfer_key, key)) {
        kept->transfer.first_texel = faces > 0 ? input->clutter->faces[first].first_texel : 0;
        return &kept->transfer;
    }
    forget_transfer(kept);
    if (!mrt_clutter_transfer_init(&kept->transfer, cache->host, input, block)) return NULL;
    kept->transfer_key = key;
    kept->has_transfer = true;
    return &kept->transfer;
}

const struct mrt_delta_entry *mrt_kept_entry(struct mrt_delta_cache *cache,
                                             const struct mrt_delta_entry_input *input)
{
    struct mrt_kept_entry *kept = &cache->entries[input->block * CUBE_FACES + input->face];
    int *openings = host_alloc(cache->host, (size_t)cache->count, sizeof *openings);
    if (!openings) return NULL;
    find_reached(input->map, input->map->blocks[input->block].neighbor[input->face].block,
                 input->depth, openings);
    const struct hash128 key = entry_key(input, openings);
    host_free(cache->host, openings);
    if (kept->valid && hash128_same(kept->key, key)) return &kept->entry;
    kept->valid = false;
    mrt_delta_entry_finish(&kept->entry);
    if (!mrt_delta_entry_init(&kept->entry, cache->host, input)) return NULL;
    kept->key = key;
    kept->valid = true;
    return &kept->entry;
}
