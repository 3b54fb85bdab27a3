// Reflectors: places of surfaces that no texel stands for. They are in no block, such as ground
// outdoors or the reveals of a window, or inside a block whose objects have no light of their own:
// the sides of furniture, the inside of a shade. Each stands for the surface around it and reflects
// light of the sky, the sun, other lights and emissive surfaces, and what other reflectors send of
// that, towards the texels and points whose rays end there.
#pragma once

#include "techniques/mrt/level/block_grid.h"
#include "techniques/mrt/level/geometry.h"
#include "trace/texels/light.h"

// Objects, whose triangles have light of their own.
struct mrt_own_light {
    bool (*has)(const void *user, int instance, uint32_t triangle);
    const void *user;
};

// A reflector's share of the light of a texel or a point. weight: at a texel, irradiance over the
// reflector's radiosity; at a point, its solid angle over π.
struct mrt_reflector_share {
    uint32_t reflector;
    uint32_t direction; // towards it, of all rays the mean: octahedral_pack
    float weight;
};

struct mrt_reflectors {
    struct host *host;
    struct mrt_block_grid grid;
    struct mrt_geometry inside; // texels NULL: blocks stand for all surfaces inside
    struct mrt_own_light own;   // has NULL: blocks of a level stand for all surfaces inside
    float least_m;              // edge of the smallest place
    // Numbers from which later hits have larger places: each 32nd part more doubles the edge, up to
    // the distance of the hit.
    uint32_t fine, fine_shares;
    int least_level;
    // Texels without a wall; area_m2 is that of the place.
    struct mrt_geometry_texel *at;
    uint64_t *keys;
    uint32_t *newest; // number of the newest share of each, from 1; 0: none
    uint32_t count, room;
    struct mrt_reflector_share *shares;
    uint32_t share_count, share_room;
    uint32_t *slots; // a hash table with open addressing: reflector + 1, 0: none
    uint32_t slot_count;
};

// The map must outlive it. false: out of memory.
bool mrt_reflectors_init(struct host *host, const struct mrt_block_map *map,
                         struct mrt_reflectors *out);
void mrt_reflectors_finish(struct mrt_reflectors *reflectors); // accepts zero

// ---- gathering

struct mrt_reflector_hit {
    uint64_t key;
    vec3s position, normal, reflectance, direction;
    float area_m2;
    float share; // of the ray
    bool in_block;
};

// The hits of one receiver.
struct mrt_reflector_hits {
    const struct mrt_reflectors *of; // NULL: none are wanted
    struct mrt_reflector_hit *at;
    uint32_t count;
};

// Whether the hit is one of a reflector: no block has the surface, and it is not seen from inside a
// solid.
bool mrt_reflectors_have(const struct mrt_reflectors *reflectors, const struct trace_scene *scene,
                         const struct ray *ray, const struct ray_hit *hit,
                         const struct texel_hit *at_hit);

// Adds the hit if it is one of a reflector, with the share of the ray (texel_hit).
void mrt_reflectors_add_hit(struct mrt_reflector_hits *hits, const struct trace_scene *scene,
                            const struct ray *ray, const struct ray_hit *hit,
                            const struct texel_hit *at_hit);

// Drops hits inside blocks: lookups between probes would show this light beyond the objects.
void mrt_reflectors_drop_inside(struct mrt_reflector_hits *hits);

// Calls `gather` for each receiver, on all cores, and keeps what it adds: at most `rays` hits, of
// this weight times the share of the ray. Afterwards *row_of(user, i) has the receiver's shares.
// reflectors NULL: it gathers alone. false: out of memory.
struct mrt_reflector_gather {
    void (*gather)(void *user, size_t i, struct mrt_reflector_hits *hits);
    struct mrt_reflector_row *(*row_of)(void *user, size_t i);
    void *user;
    size_t count;
    int rays;
    float weight;
};
bool mrt_reflectors_gather(struct mrt_reflectors *reflectors,
                           const struct mrt_reflector_gather *gather);
