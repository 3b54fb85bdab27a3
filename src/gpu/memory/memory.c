// Device memory: first-fit suballocation of large blocks, and the bytes of each owner.
//
// A block has one memory type and holds either buffers or images, so that bufferImageGranularity
// does not matter. Free ranges are sorted by offset. Large allocations get a dedicated block.
#include "gpu/vk.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const VkDeviceSize BLOCK_BYTES = 64u << 20;
static const VkDeviceSize LARGE_BYTES = 16u << 20;

struct free_range {
    VkDeviceSize offset, bytes;
};

struct memory_block {
    struct memory_block *next;
    struct device_memory device;
    VkDeviceSize bytes;
    uint32_t type;
    bool linear, single; // single: a dedicated block
    bool recycled;       // part of it was in use before
    struct free_range *free;
    uint32_t free_count, free_capacity;
};

static uint32_t owner_index(struct gpu *gpu, const char *name)
{
    struct memory *m = &gpu->memory;
    char owner[sizeof m->owners->name];
    size_t length = strcspn(name, ".");
    snprintf(owner, sizeof owner, "%.*s", (int)length, name);
    // Transient and staging buffers serve all clients.
    const uint32_t client = strcmp(owner, "gpu") == 0 ? 0 : gpu->client;
    uint32_t index = m->owner_count;
    for (uint32_t i = 0; i < m->owner_count; i++) {
        if (m->owners[i].client == client && strcmp(m->owners[i].name, owner) == 0) return i;
        if (!m->owners[i].bytes) index = i;
    }
    if (index == m->owner_count) {
        struct memory_owner *owners =
            host_realloc(gpu->host, m->owners, m->owner_count + 1, sizeof *owners);
        if (!owners) return UINT32_MAX;
        m->owners = owners;
        m->owner_count++;
    }
    m->owners[index] = (struct memory_owner){ .client = client };
    memcpy(m->owners[index].name, owner, sizeof owner);
    return index;
}

// Preference for a memory type; negative: unsuitable.
static int score(VkMemoryPropertyFlags flags, enum memory_kind kind)
{
    const VkMemoryPropertyFlags mapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    bool local = flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    bool cached = flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    if (flags & (VK_MEMORY_PROPERTY_PROTECTED_BIT | VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT))
        return -1;
    if (kind != MEMORY_DEVICE && (flags & mapped) != mapped) return -1;
    switch (kind) {
    case MEMORY_DEVICE: // host-visible device memory may be a small heap: prefer other types
        return (local ? 4 : 0) + (flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT ? 0 : 1);
    case MEMORY_UPLOAD:
        return (local ? 0 : 2) + (cached ? 0 : 1);
    case MEMORY_DOWNLOAD:
        return (cached ? 2 : 0) + (local ? 0 : 1);
    default:
        return (local ? 2 : 0) + (cached ? 0 : 1);
    }
}

static bool add_free_range(struct gpu *gpu, struct memory_block *block, uint32_t at,
                           struct free_range range)
{
    if (block->free_count == block->free_capacity) {
        uint32_t capacity = block->free_capacity ? 2 * block->free_capacity : 16;
        struct free_range *bigger = host_realloc(gpu->host, block->free, capacity, sizeof *bigger);
        if (!bigger) return false;
        block->free = bigger;
        block->free_capacity = capacity;
    }
    memmove(block->free + at + 1, block->free + at, (block->free_count - at) * sizeof *block->free);
    block->free[at] = range;
    block->free_count++;
    return true;
}

static void remove_free_range(struct memory_block *block, uint32_t at)
{
    block->free_count--;
    memmove(block->free + at, block->free + at + 1, (block->free_count - at) * sizeof *block->free);
}

static void block_free(struct gpu *gpu, struct memory_block *block)
{
    device_memory_free(gpu, &block->device);
    host_free(gpu->host, block->free);
    host_free(gpu->host, block);
}

// NULL without a message if this memory type is exhausted: another one may do.
static struct memory_block *block_new(struct gpu *gpu, const struct gpu_memory_request *request,
                                      bool linear)
{
    struct memory_block *block = host_alloc(gpu->host, 1, sizeof *block);
    if (!block) return NULL;
    *block = (struct memory_block){ .bytes = request->bytes,
                                    .type = request->memory_type,
                                    .linear = linear };
    const char *name = linear ? "gpu.buffers" : "gpu.images";
    if (!device_memory_allocate(gpu, request, name, &block->device) ||
        !add_free_range(gpu, block, 0, (struct free_range){ 0, request->bytes })) {
        block_free(gpu, block);
        return NULL;
    }
    block->next = gpu->memory.blocks;
    gpu->memory.blocks = block;
    gpu->memory.block_count++;
    return block;
}

// First fit. Offsets are in the block, which may begin anywhere in its VkDeviceMemory.
static bool block_take(struct gpu *gpu, struct memory_block *block,
                       const VkMemoryRequirements *needs, VkDeviceSize *offset)
{
    for (uint32_t i = 0; i < block->free_count; i++) {
        struct free_range range = block->free[i];
        VkDeviceSize begin = block->device.block.offset + range.offset;
        VkDeviceSize before = (needs->alignment - begin % needs->alignment) % needs->alignment;
        VkDeviceSize start = range.offset + before;
        if (before > range.bytes || range.bytes - before < needs->size) continue;
        VkDeviceSize after = range.bytes - before - needs->size;
        if (before && after &&
            !add_free_range(gpu, block, i + 1, (struct free_range){ start + needs->size, after })) {
            return false;
        }
        if (before) {
            block->free[i].bytes = before;
        } else if (after) {
            block->free[i] = (struct free_range){ start + needs->size, after };
        } else {
            remove_free_range(block, i);
        }
        *offset = start;
        return true;
    }
    return false;
}

static struct memory_block *find_block(struct gpu *gpu, const VkMemoryRequirements *needs,
                                       uint32_t type, bool linear, bool mapped,
                                       VkDeviceSize *offset)
{
    bool single = needs->size >= LARGE_BYTES;
    struct memory_block *block;
    for (block = gpu->memory.blocks; block && !single; block = block->next) {
        if (block->type != type || block->linear != linear || block->single) continue;
        if (block->device.request.mapped != mapped) continue;
        if (block_take(gpu, block, needs, offset)) return block;
    }
    // A block takes at most an eighth of its heap, unless the allocation needs more.
    const VkPhysicalDeviceMemoryProperties *p = &gpu->memory.properties;
    VkDeviceSize heap = p->memoryHeaps[p->memoryTypes[type].heapIndex].size;
    VkDeviceSize bytes = single ? needs->size : BLOCK_BYTES;
    if (!single && bytes > heap / 8) bytes = heap / 8 > needs->size ? heap / 8 : needs->size;
    struct gpu_memory_request request = { bytes, needs->alignment, type, mapped };
    block = block_new(gpu, &request, linear);
    if (!block && bytes > needs->size) {
        request.bytes = needs->size;
        block = block_new(gpu, &request, linear);
    }
    if (!block) return NULL;
    block->single = single;
    return block_take(gpu, block, needs, offset) ? block : NULL;
}

bool memory_allocate(struct gpu *gpu, const VkMemoryRequirements *needs, enum memory_kind kind,
                     bool linear, const char *name, struct allocation *out)
{
    const VkPhysicalDeviceMemoryProperties *p = &gpu->memory.properties;
    *out = (struct allocation){ .bytes = needs->size };
    if (needs->size > gpu->memory.max_allocation) {
        return host_fail(gpu->host, FAIL_MEMORY,
                         "gpu memory of %s: %llu bytes, the device supports at most %llu", name,
                         (unsigned long long)needs->size,
                         (unsigned long long)gpu->memory.max_allocation);
    }
    uint32_t owner = owner_index(gpu, name);
    if (owner == UINT32_MAX) return false;
    uint32_t left = needs->memoryTypeBits;
    while (left) { // the best type first, then the others
        uint32_t best = UINT32_MAX;
        int best_score = -1;
        for (uint32_t i = 0; i < p->memoryTypeCount; i++) {
            int s = left & 1u << i ? score(p->memoryTypes[i].propertyFlags, kind) : -1;
            if (s > best_score) best_score = s, best = i;
        }
        if (best == UINT32_MAX) break;
        left &= ~(1u << best);
        VkDeviceSize offset;
        struct memory_block *block =
            find_block(gpu, needs, best, linear, kind != MEMORY_DEVICE, &offset);
        if (!block) continue;
        const struct gpu_memory_block *memory = &block->device.block;
        out->block = block;
        out->memory = (VkDeviceMemory)memory->memory;
        out->offset = memory->offset + offset;
        out->mapped = memory->mapped ? (char *)memory->mapped + offset : NULL;
        out->owner = owner;
        out->type = best;
        out->recycled = block->recycled;
        gpu->memory.owners[owner].bytes += needs->size;
        return true;
    }
    return host_fail(gpu->host, FAIL_MEMORY, "gpu memory of %s: no %llu bytes left", name,
                     (unsigned long long)needs->size);
}

static void block_give(struct gpu *gpu, struct memory_block *block, struct free_range range)
{
    uint32_t i = 0;
    while (i < block->free_count && block->free[i].offset < range.offset) i++;
    bool joins_last = i > 0 && block->free[i - 1].offset + block->free[i - 1].bytes == range.offset;
    bool joins_next = i < block->free_count && range.offset + range.bytes == block->free[i].offset;
    if (joins_last && joins_next) {
        block->free[i - 1].bytes += range.bytes + block->free[i].bytes;
        remove_free_range(block, i);
    } else if (joins_last) {
        block->free[i - 1].bytes += range.bytes;
    } else if (joins_next) {
        block->free[i].offset = range.offset;
        block->free[i].bytes += range.bytes;
    } else {
        // On failure the range is lost until the block is freed.
        (void)add_free_range(gpu, block, i, range);
    }
}

static bool is_empty(const struct memory_block *block)
{
    return block->free_count == 1 && block->free[0].bytes == block->bytes;
}

// One empty block of each kind is kept, which saves a call of the driver later.
static bool has_another_empty(const struct gpu *gpu, const struct memory_block *block)
{
    for (const struct memory_block *b = gpu->memory.blocks; b; b = b->next)
        if (b != block && !b->single && is_empty(b) && b->type == block->type &&
            b->linear == block->linear && b->device.request.mapped == block->device.request.mapped)
            return true;
    return false;
}

static void remove_block(struct gpu *gpu, struct memory_block *block)
{
    struct memory_block **at = &gpu->memory.blocks;
    while (*at != block) at = &(*at)->next;
    *at = block->next;
    gpu->memory.block_count--;
    block_free(gpu, block);
}

void memory_free(struct gpu *gpu, struct allocation *allocation)
{
    struct memory_block *block = allocation->block;
    if (!block) return;
    gpu->memory.owners[allocation->owner].bytes -= allocation->bytes;
    block->recycled = true;
    const VkDeviceSize offset = allocation->offset - block->device.block.offset;
    block_give(gpu, block, (struct free_range){ offset, allocation->bytes });
    *allocation = (struct allocation){ 0 };
    if (is_empty(block) && (block->single || has_another_empty(gpu, block)))
        remove_block(gpu, block);
}

void memory_finish(struct gpu *gpu)
{
    while (gpu->memory.blocks) {
        struct memory_block *block = gpu->memory.blocks;
        gpu->memory.blocks = block->next;
        block_free(gpu, block);
    }
    host_free(gpu->host, gpu->memory.owners);
    gpu->memory.owners = NULL;
    gpu->memory.owner_count = 0;
}

static int larger_first(const void *a, const void *b)
{
    const struct gpu_memory *x = a, *y = b;
    if (x->bytes != y->bytes) return x->bytes < y->bytes ? 1 : -1;
    return strcmp(x->owner, y->owner);
}

// Adds an entry to a list of limited length, which keeps the largest ones.
static void list_add(struct gpu_memory *out, int *count, int capacity,
                     const struct gpu_memory *entry)
{
    if (*count < capacity) {
        out[(*count)++] = *entry;
        return;
    }
    int least = 0;
    for (int k = 1; k < *count; k++) {
        if (larger_first(&out[k], &out[least]) > 0) least = k;
    }
    if (*count && larger_first(entry, &out[least]) < 0) out[least] = *entry;
}

// Bytes of all owners of this name; 0 if an earlier entry has it.
static uint64_t bytes_of_name(const struct memory *m, uint32_t first)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < m->owner_count; i++) {
        if (strcmp(m->owners[i].name, m->owners[first].name) != 0) continue;
        if (i < first) return 0;
        bytes += m->owners[i].bytes;
    }
    return bytes;
}

static int list_owners(const struct memory *m, const uint32_t *client, struct gpu_memory *out,
                       int capacity)
{
    int count = 0;
    for (uint32_t i = 0; i < m->owner_count; i++) {
        struct gpu_memory entry = { .bytes = client ? m->owners[i].bytes : bytes_of_name(m, i) };
        if (!entry.bytes || (client && m->owners[i].client != *client)) continue;
        memcpy(entry.owner, m->owners[i].name, sizeof entry.owner);
        list_add(out, &count, capacity, &entry);
    }
    if (count) qsort(out, (size_t)count, sizeof *out, larger_first);
    return count;
}

int gpu_memory_by_owner(const struct gpu *gpu, struct gpu_memory *out, int capacity)
{
    return list_owners(&gpu->memory, NULL, out, capacity);
}

int gpu_client_memory(const struct gpu *gpu, uint32_t client, struct gpu_memory *out, int capacity)
{
    return list_owners(&gpu->memory, &client, out, capacity);
}
