// Which nodes of a scene are named as clutter or as walls.
#include "techniques/mrt/objects/clutter.h"

#include "core/option.h"

#include <string.h>

static enum mrt_named of_extras(const struct node *node)
{
    bool clutter;
    if (!mrt_clutter_of_extras(node, &clutter)) return MRT_NAMED_NOT;
    return clutter ? MRT_NAMED_CLUTTER : MRT_NAMED_WALL;
}

static enum mrt_named of_map(const struct mrt_block_map *map, const struct node *node, bool *found)
{
    enum mrt_named named = MRT_NAMED_NOT;
    for (int i = 0; i < map->named_count; i++) {
        if (strcmp(map->named[i].node, node->name) != 0) continue;
        found[i] = true;
        named = map->named[i].clutter ? MRT_NAMED_CLUTTER : MRT_NAMED_WALL;
    }
    return named;
}

static bool fail_name(struct host *host, const struct scene *scene,
                      const struct mrt_named_part *part)
{
    const size_t count = (size_t)scene->node_count;
    const char **known = host_alloc(host, count, sizeof *known);
    if (!known) return false;
    for (size_t i = 0; i < count; i++) known[i] = scene->nodes[i].name;
    const char *nearest = nearest_name(part->node, known, count);
    host_fail(host, FAIL_FORMAT, "block map: %s: %s has no node \"%.200s\"%s%.200s%s",
              part->clutter ? "clutter" : "walls", scene->name, part->node,
              nearest ? "; did you mean \"" : "", nearest ? nearest : "", nearest ? "\"?" : "");
    host_free(host, known);
    return false;
}

static bool name_nodes(const struct scene *scene, const struct mrt_block_map *map,
                       unsigned char *named, bool *found)
{
    for (int i = 0; i < scene->node_count; i++) {
        const struct node *node = &scene->nodes[i];
        named[i] = (unsigned char)of_map(map, node, found);
        if (named[i] == MRT_NAMED_NOT) named[i] = (unsigned char)of_extras(node);
        if (named[i] == MRT_NAMED_NOT && node->parent >= 0) named[i] = named[node->parent];
    }
    for (int i = 0; i < map->named_count; i++)
        if (!found[i]) return fail_name(map->host, scene, &map->named[i]);
    return true;
}

unsigned char *mrt_named_nodes(struct host *host, const struct scene *scene,
                               const struct mrt_block_map *map)
{
    unsigned char *named = host_alloc(host, (size_t)scene->node_count, sizeof *named);
    bool *found = host_alloc(host, (size_t)map->named_count, sizeof *found);
    const bool ok = named && found && name_nodes(scene, map, named, found);
    host_free(host, found);
    if (ok) return named;
    host_free(host, named);
    return NULL;
}
