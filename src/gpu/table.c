// Handle tables: ids of pointers, with a generation that detects stale ids.
#include "gpu/vk.h"

#include <string.h>

enum { INDEX_BITS = 20, INDEX_MASK = (1 << INDEX_BITS) - 1, GENERATION_MASK = (1 << 12) - 1 };

static bool grow(struct host *host, struct table *table)
{
    uint32_t capacity = table->capacity ? 2 * table->capacity : 32;
    if (capacity > INDEX_MASK) {
        return host_fail(host, FAIL_MEMORY, "gpu objects: more than %d at once", INDEX_MASK / 2);
    }
    void **objects = host_realloc(host, table->objects, capacity, sizeof *objects);
    if (!objects) return false;
    table->objects = objects;
    uint32_t *generations = host_realloc(host, table->generations, capacity, sizeof *generations);
    if (!generations) return false;
    table->generations = generations;
    for (uint32_t i = table->capacity; i < capacity; i++) {
        objects[i] = NULL;
        generations[i] = 0;
    }
    table->capacity = capacity;
    return true;
}

uint32_t table_add(struct host *host, struct table *table, void *object)
{
    uint32_t i = 0;
    if (table->live < table->count) {
        while (table->objects[i]) i++;
    } else {
        if (table->count == table->capacity && !grow(host, table)) return 0;
        i = table->count++;
    }
    table->objects[i] = object;
    table->live++;
    return table->generations[i] << INDEX_BITS | (i + 1);
}

static bool find(const struct table *table, uint32_t id, uint32_t *index)
{
    uint32_t i = (id & INDEX_MASK) - 1;
    if (!id || i >= table->count || !table->objects[i]) return false;
    if (table->generations[i] != id >> INDEX_BITS) return false;
    *index = i;
    return true;
}

void *table_get(const struct table *table, uint32_t id)
{
    uint32_t i;
    return find(table, id, &i) ? table->objects[i] : NULL;
}

void *table_remove(struct table *table, uint32_t id)
{
    uint32_t i;
    if (!find(table, id, &i)) return NULL;
    void *object = table->objects[i];
    table->objects[i] = NULL;
    table->generations[i] = (table->generations[i] + 1) & GENERATION_MASK;
    table->live--;
    return object;
}

void table_finish(struct host *host, struct table *table)
{
    host_free(host, table->objects);
    host_free(host, table->generations);
    memset(table, 0, sizeof *table);
}
