// Memory aliasing of images: the barrier with which one image takes over the memory of another.
//
// The new image begins in the layout UNDEFINED, since the other's texels mean nothing to it. Its
// first access is a layout transition, which waits for all accesses of the other and makes its
// writes available, so that none of them lands later.
#include "gpu/vk.h"

#include <stdio.h>
#include <string.h>

// Images of a smaller size keep the memory of a larger one: no more than 5/2 of what they need.
static bool suits(const struct allocation *memory, const VkMemoryRequirements *needs)
{
    return memory->bytes >= needs->size && 2 * memory->bytes <= 5 * needs->size &&
           memory->offset % needs->alignment == 0 && needs->memoryTypeBits >> memory->type & 1u;
}

static bool fits(const struct gpu *gpu, const struct alias *alias, const char *name,
                 const VkMemoryRequirements *needs)
{
    return alias->alive > 0 && alias->client == gpu->client && strcmp(alias->name, name) == 0 &&
           suits(&alias->memory, needs);
}

static struct alias *find(const struct gpu *gpu, const char *name,
                          const VkMemoryRequirements *needs)
{
    for (uint32_t i = 0; i < gpu->alias_count; i++)
        if (fits(gpu, gpu->aliases[i], name, needs)) return gpu->aliases[i];
    return NULL;
}

static struct alias *add(struct gpu *gpu, const char *name, const char *owner,
                         const VkMemoryRequirements *needs)
{
    struct alias **list = host_realloc(gpu->host, gpu->aliases, gpu->alias_count + 1, sizeof *list);
    if (!list) return NULL;
    gpu->aliases = list;
    struct alias *alias = host_alloc(gpu->host, 1, sizeof *alias);
    if (!alias) return NULL;
    if (!memory_allocate(gpu, needs, MEMORY_DEVICE, false, owner, &alias->memory)) {
        host_free(gpu->host, alias);
        return NULL;
    }
    snprintf(alias->name, sizeof alias->name, "%s", name);
    alias->client = gpu->client;
    gpu->aliases[gpu->alias_count++] = alias;
    return alias;
}

bool alias_allocate(struct gpu *gpu, struct image *image, const char *name,
                    const VkMemoryRequirements *needs)
{
    struct alias *alias = find(gpu, name, needs);
    if (!alias) alias = add(gpu, name, image->name, needs);
    if (!alias) return false;
    alias->users++;
    alias->alive++;
    image->alias = alias;
    return true;
}

// A state that waits for what both wait for.
static void add_accesses(struct hazard *to, const struct image *image)
{
    const uint32_t count = image->whole ? 1 : image->desc.mips * image->layers;
    for (uint32_t i = 0; i < count; i++) {
        const struct hazard *h = &image->hazards[i];
        to->write_stages |= h->write_stages | h->read_stages;
        to->write_access |= h->write_access;
    }
}

static void remove_alias(struct gpu *gpu, struct alias *alias)
{
    uint32_t i = 0;
    while (gpu->aliases[i] != alias) i++;
    gpu->aliases[i] = gpu->aliases[--gpu->alias_count];
    memory_free(gpu, &alias->memory);
    host_free(gpu->host, alias);
}

void alias_retire(struct image *image)
{
    if (!image->alias || image->retired) return;
    image->retired = true;
    image->alias->alive--;
}

void alias_release(struct gpu *gpu, struct image *image)
{
    struct alias *alias = image->alias;
    if (!alias) return;
    alias_retire(image);
    if (alias->current == image) {
        add_accesses(&alias->last, image);
        alias->current = NULL;
    }
    if (--alias->users == 0) remove_alias(gpu, alias);
}

static bool used_by(const struct gpu_cmd *cmd, const struct image *image)
{
    const uint32_t count = image->whole ? 1 : image->desc.mips * image->layers;
    for (uint32_t i = 0; i < count; i++)
        if (image->hazards[i].op == cmd->op) return true;
    return false;
}

void alias_use(struct gpu_cmd *cmd, struct image *image)
{
    struct alias *alias = image->alias;
    const struct image *other = alias->current;
    if (other == image) return;
    if (other && used_by(cmd, other))
        gpu_misuse(cmd->gpu, "one operation uses the images %s and %s, which share memory",
                   other->name, image->name);
    struct hazard taken = alias->last;
    if (other) add_accesses(&taken, other);
    add_accesses(&taken, image); // a caller's, between frames
    taken.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    image->whole = true;
    image->hazards[0] = taken;
    alias->last = (struct hazard){ 0 };
    alias->current = image;
}
