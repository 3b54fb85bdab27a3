#include "techniques/mrt/objects/delta_cache.h"

#include "core/parallel.h"

bool mrt_delta_cache_init(struct mrt_delta_cache *out, struct host *host, int blocks)
{
    *out = (struct mrt_delta_cache){ .host = host, .count = blocks };
    out->blocks = host_alloc(host, (size_t)blocks, sizeof *out->blocks);
    out->entries = host_alloc(host, (size_t)blocks * CUBE_FACES, sizeof *out->entries);
    out->contents = host_alloc(host, (size_t)blocks, sizeof *out->contents);
    return out->blocks && out->entries && out->contents;
}

void mrt_delta_cache_finish(struct mrt_delta_cache *cache)
{
    if (!cache->host) return;
    for (int b = 0; cache->blocks && b < cache->count; b++) {
        mrt_delta_block_finish(&cache->blocks[b].delta);
        mrt_gather_faces_finish(&cache->blocks[b].gathered);
        mrt_clutter_transfer_finish(&cache->blocks[b].transfer);
    }
    for (int i = 0; cache->entries && i < cache->count * CUBE_FACES; i++)
        mrt_delta_entry_finish(&cache->entries[i].entry);
    host_free(cache->host, cache->blocks);
    host_free(cache->host, cache->entries);
    host_free(cache->host, cache->contents);
    *cache = (struct mrt_delta_cache){ 0 };
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
        if (!box3_intersects(mrt_bounds_of_triangle(triangle), box)) continue;
        for (int back = 0; back < 2; back++) {
            const int face = mrt_face_of_chart(clutter, block, triangle->chart, back);
            if (back && face < 0) continue;
            key = add_triangle(key, clutter, triangle, face < 0 ? -1 : face - first_face);
        }
    }
    return key;
}

static struct hash128 add_texel(struct hash128 key, const struct charts *charts, uint32_t texel)
{
    const struct chart_texel *at = chart_texel_of(charts, texel);
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
            *box = box3_add_point(*box, chart_texel_of(&clutter->charts, texel)->position);
        }
    }
    return key;
}

// Rays of faces go through openings: all clutter may block them.
static struct hash128 gather_key(const struct mrt_delta_cache *cache,
                                 const struct mrt_clutter *clutter, int block)
{
    struct box3 unused = box3_empty();
    int first;
    const int faces = mrt_faces_of_block(clutter, block, &first);
    const struct hash128 key = add_faces((struct hash128){ 0 }, clutter, first, faces, &unused);
    return hash128_add(key, &cache->everything, sizeof cache->everything);
}

// Blocks that rays reach through an opening. Writes the number of openings behind it, −1: none.
static void find_reached(const struct mrt_block_map *map, int first, int depth, int *openings)
{
    for (int b = 0; b < map->count; b++) openings[b] = b == first ? 0 : -1;
    for (int d = 0; d < depth; d++)
        for (int b = 0; b < map->count; b++)
            for (int f = 0; f < CUBE_FACES && openings[b] == d; f++) {
                const int next = map->blocks[b].neighbor[f].block;
                if (next >= 0 && openings[next] < 0) openings[next] = d + 1;
            }
}

static struct hash128 entry_key(const struct mrt_delta_cache *cache, const int *openings)
{
    struct hash128 key = { 0 };
    for (int b = 0; b < cache->count; b++)
        if (openings[b] >= 0) key = hash128_add(key, &cache->contents[b], sizeof *cache->contents);
    return key;
}

// Rays of texels end in their block, but may begin beyond it.
static struct hash128 transfer_key(const struct mrt_clutter_rays *rays, int block)
{
    struct box3 box = mrt_bounds_of_block(&rays->map->blocks[block]);
    int first;
    const int faces = mrt_faces_of_block(rays->clutter, block, &first);
    const struct hash128 key = add_faces((struct hash128){ 0 }, rays->clutter, first, faces, &box);
    return add_triangles(key, rays->clutter, block, first, box);
}

// Clutter in the bounds of a block, with its faces there.
static struct hash128 content_of(const struct mrt_clutter_rays *rays, int block)
{
    int first;
    const int faces = mrt_faces_of_block(rays->clutter, block, &first);
    const struct hash128 key = hash128_add((struct hash128){ 0 }, &faces, sizeof faces);
    return add_triangles(key, rays->clutter, block, first,
                         mrt_bounds_of_block(&rays->map->blocks[block]));
}

// All triangles, and the columns of all faces.
static struct hash128 everything_of(const struct mrt_clutter *clutter)
{
    const struct charts *charts = &clutter->charts;
    struct hash128 key = { 0 };
    for (uint32_t t = 0; t < charts->triangle_count; t++)
        key = add_triangle(key, clutter, &charts->triangles[t], (int)charts->triangles[t].chart);
    return hash128_add(key, clutter->chart_faces,
                       clutter->first_chart_face[mrt_chart_sides(clutter)] *
                           sizeof *clutter->chart_faces);
}

struct contents {
    struct mrt_delta_cache *cache;
    const struct mrt_clutter_rays *rays;
};

static void find_content(void *user, size_t block)
{
    const struct contents *job = user;
    job->cache->contents[block] = content_of(job->rays, (int)block);
}

void mrt_delta_cache_begin(struct mrt_delta_cache *cache, const struct mrt_clutter_rays *rays)
{
    struct contents job = { cache, rays };
    cache->everything = everything_of(rays->clutter);
    parallel_for((size_t)cache->count, 1, find_content, &job);
}

// ---- operators

// Else the key is that of what is made next.
static bool is_kept(struct mrt_kept *kept, struct hash128 key)
{
    if (kept->valid && hash128_same(kept->key, key)) return true;
    *kept = (struct mrt_kept){ .key = key };
    return false;
}

const struct mrt_delta_block *mrt_kept_delta(struct mrt_delta_cache *cache,
                                             const struct mrt_clutter_rays *rays, int block)
{
    struct mrt_kept_block *at = &cache->blocks[block];
    if (!is_kept(&at->of_delta, cache->contents[block])) {
        mrt_delta_block_finish(&at->delta);
        if (!mrt_delta_block_init(&at->delta, cache->host, rays, block)) return NULL;
        cache->traced += at->delta.touched;
        at->of_delta.valid = true;
    }
    mrt_faces_of_block(rays->clutter, block, &at->delta.first_face);
    return &at->delta;
}

const struct mrt_gather_faces *mrt_kept_gather(struct mrt_delta_cache *cache,
                                               const struct mrt_clutter_rays *rays, int block)
{
    struct mrt_kept_block *at = &cache->blocks[block];
    if (!is_kept(&at->of_gathered, gather_key(cache, rays->clutter, block))) {
        mrt_gather_faces_finish(&at->gathered);
        if (!mrt_gather_faces_init(&at->gathered, cache->host, rays, block)) return NULL;
        at->of_gathered.valid = true;
    }
    return &at->gathered;
}

const struct mrt_clutter_transfer *mrt_kept_transfer(struct mrt_delta_cache *cache,
                                                     const struct mrt_clutter_rays *rays, int block)
{
    struct mrt_kept_block *at = &cache->blocks[block];
    int first;
    if (!is_kept(&at->of_transfer, transfer_key(rays, block))) {
        mrt_clutter_transfer_finish(&at->transfer);
        if (!mrt_clutter_transfer_init(&at->transfer, cache->host, rays, block)) return NULL;
        at->of_transfer.valid = true;
    }
    if (mrt_faces_of_block(rays->clutter, block, &first) > 0)
        at->transfer.first_texel = rays->clutter->faces[first].first_texel;
    return &at->transfer;
}

const struct mrt_delta_entry *mrt_kept_entry(struct mrt_delta_cache *cache,
                                             const struct mrt_clutter_rays *rays,
                                             const struct mrt_entered_opening *opening)
{
    const int beyond = rays->map->blocks[opening->block].neighbor[opening->face].block;
    struct mrt_kept_entry *at = &cache->entries[opening->block * CUBE_FACES + opening->face];
    int *openings = host_alloc(cache->host, (size_t)cache->count, sizeof *openings);
    if (!openings) return NULL;
    find_reached(rays->map, beyond, rays->depth, openings);
    const struct hash128 key = entry_key(cache, openings);
    host_free(cache->host, openings);
    if (!is_kept(&at->kept, key)) {
        mrt_delta_entry_finish(&at->entry);
        if (!mrt_delta_entry_init(&at->entry, cache->host, rays, opening)) return NULL;
        at->kept.valid = true;
    }
    return &at->entry;
}
