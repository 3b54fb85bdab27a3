#include "techniques/mrt/light/reflectors.h"

#include "core/parallel.h"

#include "frame/octahedral.h"
#include "trace/reflectance.h"

#include <math.h>
#include <string.h>

enum {
    GRID_CELLS = 32,
    SLOTS_PER_REFLECTOR = 2,
    FIRST_ROOM = 256,
    FINE = 1 << 18,
    FINE_SHARES = 1 << 23
};

// Surfaces behind a wall that its texels may stand for: as far as their rays (geometry.c).
static const float BEHIND_WALL = 0.75f;
static const float FACING = 0.5f;        // cosine
static const float TEXELS = 1.0f / 16;   // smallest places, of the shortest edge of a block
static const float PER_DISTANCE = 0.125; // edge of a place over its distance, at most

// ---- which surfaces

enum owner { OF_BLOCK, INSIDE_BLOCK, OUTSIDE_BLOCKS };

static enum owner owner_in(const struct mrt_reflectors *r, int index, vec3s point, vec3s normal)
{
    const struct mrt_block *block = &r->grid.map->blocks[index];
    vec3s cell;
    if (!mrt_warp_inverse(block->corner, point, &cell)) return OUTSIDE_BLOCKS;
    const vec3s out = glms_vec3_abs(cell);
    const float most = glms_vec3_max(out);
    if (!(most <= BEHIND_WALL)) return OUTSIDE_BLOCKS;
    if (most <= MRT_IN_CELL)
        return !r->inside.texels || mrt_geometry_has(&r->inside, index, cell, point, normal)
                   ? OF_BLOCK
                   : INSIDE_BLOCK;
    const int axis = most == out.x ? 0 : most == out.y ? 1 : 2;
    const mat3s jacobian = mrt_warp_jacobian(block->corner, cell);
    const vec3s across = vec3_unit(jacobian.col[axis]);
    return copysignf(1.0f, -cell.raw[axis]) * glms_vec3_dot(across, normal) > FACING
               ? OF_BLOCK
               : OUTSIDE_BLOCKS;
}

static enum owner owner_of(const struct mrt_reflectors *r, vec3s point, vec3s normal)
{
    const struct mrt_block_list list = mrt_blocks_near(&r->grid, point);
    enum owner owner = OUTSIDE_BLOCKS;
    for (uint32_t k = 0; k < list.count; k++) {
        const enum owner here = owner_in(r, (int)r->grid.candidates[list.first + k], point, normal);
        if (here == OF_BLOCK) return here;
        if (here == INSIDE_BLOCK) owner = here;
    }
    return owner;
}

static int level_of(float edges)
{
    return edges >= 2.0f ? ilogbf(fminf(edges, 0x1p20f)) : 0;
}

// A place: a cube of a grid whose size is about an eighth of the distance, and a direction of six.
static uint64_t key_of(const struct mrt_reflectors *r, vec3s point, vec3s normal, float distance,
                       float *edge_m)
{
    enum { BITS = 18 };
    const float wanted = distance * PER_DISTANCE / r->least_m;
    const int least = level_of(wanted), most = level_of(distance / r->least_m);
    const int level = r->least_level < least  ? least
                      : r->least_level > most ? most
                                              : r->least_level;
    const vec3s way = glms_vec3_abs(normal);
    const int axis = way.x >= way.y && way.x >= way.z ? 0 : way.y >= way.z ? 1 : 2;
    uint64_t key = (uint64_t)level * 6 + 2 * (uint64_t)axis + (normal.raw[axis] > 0.0f);
    *edge_m = ldexpf(r->least_m, level);
    for (int a = 0; a < 3; a++) {
        const float cell = floorf(point.raw[a] / *edge_m);
        key = key << BITS | ((uint64_t)(int64_t)cell & ((UINT64_C(1) << BITS) - 1));
    }
    return key;
}

static enum owner owner_at(const struct mrt_reflectors *r, const struct trace_scene *scene,
                           const struct ray *ray, const struct ray_hit *hit,
                           const struct texel_hit *at_hit)
{
    const int instance = scene->meshes[hit->geometry].instance;
    if (at_hit->inside || (r->own.has && r->own.has(r->own.user, instance, hit->triangle)))
        return OF_BLOCK;
    const vec3s position = glms_vec3_muladds(ray->direction, hit->distance, ray->origin);
    const vec3s facet = scene->meshes[hit->geometry].facets[hit->triangle].normal;
    return owner_of(r, position, at_hit->back ? glms_vec3_negate(facet) : facet);
}

bool mrt_reflectors_have(const struct mrt_reflectors *r, const struct trace_scene *scene,
                         const struct ray *ray, const struct ray_hit *hit,
                         const struct texel_hit *at_hit)
{
    return owner_at(r, scene, ray, hit, at_hit) != OF_BLOCK;
}

void mrt_reflectors_add_hit(struct mrt_reflector_hits *hits, const struct trace_scene *scene,
                            const struct ray *ray, const struct ray_hit *hit,
                            const struct texel_hit *at_hit)
{
    float edge_m;
    if (!hits->of) return;
    const enum owner owner = owner_at(hits->of, scene, ray, hit, at_hit);
    if (owner == OF_BLOCK) return;
    struct surface surface;
    surface_at(scene, ray, hit, NULL, &surface);
    const uint64_t key =
        key_of(hits->of, surface.position, surface.geometric, hit->distance, &edge_m);
    hits->at[hits->count++] = (struct mrt_reflector_hit){
        .key = key,
        .position = surface.position,
        .normal = surface.normal,
        .reflectance = surface_reflectance(&surface),
        .direction = ray->direction,
        .area_m2 = edge_m * edge_m,
        .share = at_hit->share,
        .in_block = owner == INSIDE_BLOCK,
    };
}

void mrt_reflectors_drop_inside(struct mrt_reflector_hits *hits)
{
    uint32_t kept = 0;
    for (uint32_t k = 0; k < hits->count; k++)
        if (!hits->at[k].in_block) hits->at[kept++] = hits->at[k];
    hits->count = kept;
}

// ---- reflectors of hits

bool mrt_reflectors_init(struct host *host, const struct mrt_block_map *map,
                         struct mrt_reflectors *out)
{
    *out = (struct mrt_reflectors){ .host = host,
                                    .least_m = TEXELS * mrt_shortest_edge(map),
                                    .fine = FINE,
                                    .fine_shares = FINE_SHARES };
    return mrt_block_grid_init(host, map, BEHIND_WALL - 0.5f, GRID_CELLS, &out->grid);
}

void mrt_reflectors_finish(struct mrt_reflectors *r)
{
    if (!r->host) return;
    mrt_block_grid_finish(&r->grid);
    host_free(r->host, r->at);
    host_free(r->host, r->keys);
    host_free(r->host, r->newest);
    host_free(r->host, r->shares);
    host_free(r->host, r->slots);
    *r = (struct mrt_reflectors){ 0 };
}

static uint32_t slot_of(const struct mrt_reflectors *r, uint64_t key)
{
    uint64_t mixed = key * UINT64_C(0x9E3779B97F4A7C15);
    uint32_t slot = (uint32_t)(mixed >> 32) & (r->slot_count - 1);
    while (r->slots[slot] && r->keys[r->slots[slot] - 1] != key)
        slot = (slot + 1) & (r->slot_count - 1);
    return slot;
}

static bool make_room(struct mrt_reflectors *r)
{
    const uint32_t room = r->room ? 2 * r->room : FIRST_ROOM;
    if (r->count < r->room) return true;
    struct mrt_geometry_texel *at = host_realloc(r->host, r->at, room, sizeof *at);
    if (at) r->at = at;
    uint64_t *keys = at ? host_realloc(r->host, r->keys, room, sizeof *keys) : NULL;
    if (keys) r->keys = keys;
    uint32_t *newest = keys ? host_realloc(r->host, r->newest, room, sizeof *newest) : NULL;
    if (!newest) return false;
    r->newest = newest;
    host_free(r->host, r->slots);
    r->room = room;
    r->slot_count = SLOTS_PER_REFLECTOR * room;
    r->slots = host_alloc(r->host, r->slot_count, sizeof *r->slots);
    for (uint32_t i = 0; r->slots && i < r->count; i++) r->slots[slot_of(r, r->keys[i])] = i + 1;
    return r->slots;
}

// The first hit of a place is the reflector.
static bool find(struct mrt_reflectors *r, const struct mrt_reflector_hit *hit, uint32_t *out)
{
    if (!make_room(r)) return false;
    const uint32_t slot = slot_of(r, hit->key);
    if (!r->slots[slot]) {
        r->keys[r->count] = hit->key;
        r->newest[r->count] = 0;
        r->at[r->count] = (struct mrt_geometry_texel){ .position = hit->position,
                                                       .normal = hit->normal,
                                                       .reflectance = hit->reflectance,
                                                       .found = true,
                                                       .area_m2 = hit->area_m2 };
        r->slots[slot] = ++r->count;
    }
    *out = r->slots[slot] - 1;
    return true;
}

static bool add_share(struct mrt_reflectors *r, uint32_t reflector)
{
    if (r->share_count == r->share_room) {
        const uint32_t room = r->share_room ? 2 * r->share_room : FIRST_ROOM;
        struct mrt_reflector_share *shares = host_realloc(r->host, r->shares, room, sizeof *shares);
        if (!shares) return false;
        r->shares = shares;
        r->share_room = room;
    }
    r->shares[r->share_count++] = (struct mrt_reflector_share){ .reflector = reflector };
    r->newest[reflector] = r->share_count;
    return true;
}

// ---- gathering, in parts, so that few hits are kept at a time

enum { MOST_HITS = 1 << 17 };

struct part {
    const struct mrt_reflector_gather *gather;
    struct mrt_reflector_hits *hits; // of each receiver
    vec3s *ways;                     // [rays]
    size_t first;
};

static void gather_one(void *user, size_t i)
{
    const struct part *part = user;
    struct mrt_reflector_hits none = { 0 };
    part->gather->gather(part->gather->user, part->first + i, part->hits ? &part->hits[i] : &none);
}

// One share for each reflector. ways: of the shares of a row, sums of directions.
static bool add_row(struct mrt_reflectors *r, const struct part *part, size_t i)
{
    const struct mrt_reflector_gather *g = part->gather;
    const struct mrt_reflector_hits *hits = &part->hits[i];
    const uint32_t first = r->share_count;
    for (uint32_t k = 0; k < hits->count; k++) {
        const struct mrt_reflector_hit *hit = &hits->at[k];
        uint32_t reflector;
        if (!find(r, hit, &reflector)) return false;
        if (r->newest[reflector] <= first) {
            if (!add_share(r, reflector)) return false;
            part->ways[r->share_count - 1 - first] = vec3_of(0, 0, 0);
        }
        const uint32_t share = r->newest[reflector] - 1;
        r->shares[share].weight += g->weight * hit->share;
        part->ways[share - first] =
            glms_vec3_muladds(hit->direction, hit->share, part->ways[share - first]);
    }
    for (uint32_t k = first; k < r->share_count; k++)
        r->shares[k].direction = octahedral_pack(part->ways[k - first]);
    *g->row_of(g->user, part->first + i) =
        (struct mrt_reflector_row){ first, r->share_count - first };
    return true;
}

static int levels_beyond(uint32_t count, uint32_t fine)
{
    return count <= fine ? 0 : 1 + (int)((count - fine) / (fine / 32));
}

static bool gather_part(struct mrt_reflectors *r, struct part *part, size_t count,
                        struct mrt_reflector_hit *hits)
{
    for (size_t i = 0; i < count; i++)
        part->hits[i] =
            (struct mrt_reflector_hits){ .of = r, .at = hits + i * (size_t)part->gather->rays };
    parallel_for(count, 8, gather_one, part);
    for (size_t i = 0; i < count; i++)
        if (!add_row(r, part, i)) return false;
    const int level = levels_beyond(r->count, r->fine),
              of_shares = levels_beyond(r->share_count, r->fine_shares);
    r->least_level = level > of_shares ? level : of_shares;
    return true;
}

bool mrt_reflectors_gather(struct mrt_reflectors *r, const struct mrt_reflector_gather *gather)
{
    struct part part = { .gather = gather };
    if (!r) {
        parallel_for(gather->count, 8, gather_one, &part);
        return true;
    }
    const size_t most = MOST_HITS / (size_t)gather->rays;
    struct mrt_reflector_hit *hits = host_alloc(r->host, most * (size_t)gather->rays, sizeof *hits);
    part.hits = host_alloc(r->host, most, sizeof *part.hits);
    part.ways = host_alloc(r->host, (size_t)gather->rays, sizeof *part.ways);
    bool ok = hits && part.hits && part.ways;
    for (; ok && part.first < gather->count; part.first += most) {
        const size_t rest = gather->count - part.first;
        ok = gather_part(r, &part, rest < most ? rest : most, hits);
    }
    host_free(r->host, hits);
    host_free(r->host, part.hits);
    host_free(r->host, part.ways);
    return ok;
}
