// Owner prefix for the names of new objects and scopes.
#include "gpu/vk.h"

#include <stdio.h>
#include <string.h>

void gpu_owner_push(struct gpu *gpu, const char *owner)
{
    if (gpu->owner_depth < MAX_OWNERS) gpu->owners[gpu->owner_depth] = owner;
    if (++gpu->owner_depth > MAX_OWNERS)
        gpu_misuse(gpu, "owner %s: more than %d are nested", owner, MAX_OWNERS);
}

void gpu_owner_pop(struct gpu *gpu)
{
    if (gpu->owner_depth == 0)
        gpu_misuse(gpu, "owner: none is pushed");
    else
        gpu->owner_depth--;
}

const char *owner_name(const struct gpu *gpu, const char *name, char out[NAME_SIZE])
{
    const uint32_t depth = gpu->owner_depth < MAX_OWNERS ? gpu->owner_depth : MAX_OWNERS;
    if (depth == 0 || !name || !name[0] || strchr(name, '.')) return name;
    snprintf(out, NAME_SIZE, "%s.%s", gpu->owners[depth - 1], name);
    return out;
}
