#include "techniques/common/light_hash.h"

#include "core/hash.h"

uint64_t light_hash(const struct frame_view *view)
{
    const struct frame_constants *c = view->constants;
    uint64_t hash =
        hash_bytes(&c->radiance_scale, sizeof c->radiance_scale, (uint64_t)view->shadow_radius);
    hash = hash_bytes(&c->sky, sizeof c->sky, hash);
    return hash_bytes(view->lights, (size_t)view->light_count * sizeof *view->lights, hash);
}
