// Disjoint sets of vertices (Tarjan 1975, path halving): vertices of equal position are joined by
// a hash table, then the corners of each triangle.
#include "scene/mesh_parts.h"

#include "core/hash.h"

#include <string.h>

static const uint32_t NONE = UINT32_MAX;

static uint32_t root_of(uint32_t *parent, uint32_t vertex)
{
    while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
    return vertex;
}

// The smaller root remains: the sets do not depend on the order.
static void join(uint32_t *parent, uint32_t a, uint32_t b)
{
    const uint32_t root_a = root_of(parent, a), root_b = root_of(parent, b);
    if (root_a < root_b)
        parent[root_b] = root_a;
    else
        parent[root_a] = root_b;
}

static bool same_position(vec3s a, vec3s b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

// Adding 0 turns −0 into 0, which is equal.
static uint64_t hash_of(vec3s position)
{
    const float key[3] = { position.x + 0.0f, position.y + 0.0f, position.z + 0.0f };
    return hash_bytes(key, sizeof key, 0);
}

// table: `size` entries, a power of two greater than the number of vertices.
static void join_equal_positions(const struct mesh *mesh, uint32_t *parent, uint32_t *table,
                                 size_t size)
{
    memset(table, 0xff, size * sizeof *table);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        size_t at = (size_t)hash_of(mesh->positions[v]) & (size - 1);
        while (table[at] != NONE && !same_position(mesh->positions[table[at]], mesh->positions[v]))
            at = (at + 1) & (size - 1);
        if (table[at] == NONE)
            table[at] = v;
        else
            parent[v] = table[at];
    }
}

// Replaces the roots of triangles by consecutive numbers. number: one for each vertex.
static int number_parts(const struct mesh *mesh, uint32_t *parent, uint32_t *number, uint32_t *out)
{
    int count = 0;
    memset(number, 0xff, mesh->vertex_count * sizeof *number);
    for (uint32_t t = 0; t < mesh->index_count / 3; t++) {
        const uint32_t root = root_of(parent, mesh->indices[3 * t]);
        if (number[root] == NONE) number[root] = (uint32_t)count++;
        out[t] = number[root];
    }
    return count;
}

int mesh_parts(struct host *host, const struct mesh *mesh, uint32_t *part_of_triangle)
{
    size_t size = 2;
    while (size < 2 * (size_t)mesh->vertex_count) size *= 2;
    uint32_t *parent = host_alloc(host, mesh->vertex_count, sizeof *parent),
             *table = host_alloc(host, size, sizeof *table);
    int count = -1;
    if (parent && table) {
        for (uint32_t v = 0; v < mesh->vertex_count; v++) parent[v] = v;
        join_equal_positions(mesh, parent, table, size);
        for (uint32_t i = 0; i < mesh->index_count; i += 3) {
            join(parent, mesh->indices[i], mesh->indices[i + 1]);
            join(parent, mesh->indices[i], mesh->indices[i + 2]);
        }
        count = number_parts(mesh, parent, table, part_of_triangle);
    }
    host_free(host, parent);
    host_free(host, table);
    return count;
}
