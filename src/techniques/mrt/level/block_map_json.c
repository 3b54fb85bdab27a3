// Block maps as JSON (docs/block-maps.schema.json): a file of its own, or the extras of nodes.
// Untrusted input.
#include "block_map.h"

#include "core/files/file.h"
#include "core/option.h"

#include "scene/limits.h"
#include "scene/pose.h"

#include <jansson.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const EXTRAS_KEY = "afterglow_block";
static const char *const CLUTTER_KEY = "afterglow_clutter";
static const char *const TOO_MANY = "too many blocks are before it";

// One block of the source. `json` is borrowed.
struct source_block {
    const json_t *json;
    const char *name;
    mat4s world_from_block;
};

struct source {
    struct host *host;
    const char *what; // file or scene
    struct source_block *blocks;
    size_t count;
};

static bool wrong(const struct source *source, const char *name, const char *why)
{
    return host_fail(source->host, FAIL_FORMAT, "%s: block %.*s: %s", source->what,
                     MRT_NAME_BYTES - 1, name, why);
}

// ---- members

static bool is_one_of(const char *name, const char *const *known, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(name, known[i]) == 0) return true;
    return false;
}

static const char *unknown_member(const json_t *json, const char *const *known, size_t count)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)json, key, value)
    {
        if (!is_one_of(key, known, count)) return key;
    }
    return NULL;
}

// `where` is a part of `what`: "block hall".
static bool check_members(struct host *host, const char *what, const char *where,
                          const json_t *json, const char *const *known, size_t count)
{
    const char *key = unknown_member(json, known, count);
    const char *nearest = key ? nearest_name(key, known, count) : NULL;
    if (nearest)
        return host_fail(host, FAIL_FORMAT, "%s: %s: unknown member %.100s: did you mean %s?", what,
                         where, key, nearest);
    return !key || host_fail(host, FAIL_FORMAT, "%s: %s: unknown member %.100s; remove it", what,
                             where, key);
}

static bool check_block(const struct source *source, const struct source_block *from)
{
    static const char *const known[] = { "name", "shape",     "corners", "box",
                                         "open", "neighbors", "holes" };
    char where[sizeof "block " + MRT_NAME_BYTES];
    snprintf(where, sizeof where, "block %.*s", MRT_NAME_BYTES - 1, from->name);
    return check_members(source->host, source->what, where, from->json, known,
                         sizeof known / sizeof *known);
}

// ---- one block

static bool read_vector(const json_t *json, vec3s *out)
{
    if (json_array_size(json) != 3) return false;
    for (size_t a = 0; a < 3; a++) {
        const json_t *number = json_array_get(json, a);
        if (!json_is_number(number)) return false;
        out->raw[a] = (float)json_number_value(number);
    }
    return true;
}

static bool read_box(const json_t *json, struct mrt_block *block)
{
    struct box3 box;
    if (json_array_size(json) != 2 || !read_vector(json_array_get(json, 0), &box.min) ||
        !read_vector(json_array_get(json, 1), &box.max))
        return false;
    mrt_block_set_box(block, box);
    return true;
}

static bool read_corners(const json_t *json, struct mrt_block *block)
{
    if (json_array_size(json) != MRT_CORNERS) return false;
    for (size_t c = 0; c < MRT_CORNERS; c++)
        if (!read_vector(json_array_get(json, c), &block->corner[c])) return false;
    return true;
}

static bool read_geometry(const struct source *source, const struct source_block *from,
                          struct mrt_block *block)
{
    const json_t *corners = json_object_get(from->json, "corners");
    const json_t *box = json_object_get(from->json, "box");
    mrt_block_set_box(block,
                      (struct box3){ vec3_of(-0.5f, -0.5f, -0.5f), vec3_of(0.5f, 0.5f, 0.5f) });
    if (corners && box) return wrong(source, block->name, "it has corners and a box");
    if (corners && !read_corners(corners, block))
        return wrong(source, block->name, "its corners are not 8 arrays of 3 numbers");
    if (box && !read_box(box, block))
        return wrong(source, block->name, "its box is not 2 arrays of 3 numbers");
    for (int c = 0; c < MRT_CORNERS; c++) {
        block->corner[c] = mat4_point(from->world_from_block, block->corner[c]);
        if (limits_vertex(block->corner[c])) continue;
        return host_fail(
            source->host, FAIL_FORMAT,
            "%s: block %s reaches beyond the largest coordinate, %g m; make it smaller",
            source->what, block->name, (double)SCENE_MAX_COORDINATE_M);
    }
    return true;
}

static bool read_kind(const struct source *source, const struct source_block *from,
                      struct mrt_block *block)
{
    const json_t *shape = json_object_get(from->json, "shape");
    const char *name = shape ? json_string_value(shape) : mrt_kind_name(MRT_BLOCK_CUBE);
    for (int k = 0; name && k < MRT_BLOCK_KINDS; k++) {
        if (strcmp(name, mrt_kind_name(k)) != 0) continue;
        mrt_block_init(block, "", k);
        return true;
    }
    return wrong(source, from->name, "its shape is not cube, straight, left or right");
}

static bool read_open(const struct source *source, const struct source_block *from,
                      struct mrt_block *block)
{
    const json_t *open = json_object_get(from->json, "open"), *value;
    if (open && !json_is_array(open)) return wrong(source, block->name, "open is not an array");
    for (size_t i = 0; i < json_array_size(open); i++) {
        value = json_array_get(open, i);
        int face = json_is_string(value) ? mrt_face_of_name(json_string_value(value)) : -1;
        if (face < 0) return wrong(source, block->name, "open has a face that does not exist");
        block->open |= 1u << face;
    }
    return true;
}

static bool read_block(const struct source *source, const struct source_block *from,
                       struct mrt_block *block)
{
    if (!check_block(source, from) || !read_kind(source, from, block)) return false;
    snprintf(block->name, MRT_NAME_BYTES, "%s", from->name);
    return read_geometry(source, from, block) && read_open(source, from, block);
}

// ---- connections

static int find_block(const struct source *source, const char *name)
{
    for (size_t i = 0; i < source->count; i++)
        if (strcmp(source->blocks[i].name, name) == 0) return (int)i;
    return -1;
}

// *has: false where no holes of this face are given.
static bool read_holes(const struct source *source, int i, int face, bool *has,
                       struct mrt_holes *out)
{
    const json_t *holes = json_object_get(source->blocks[i].json, "holes");
    const json_t *shares = json_object_get(holes, mrt_face_name(face));
    *has = shares;
    if (!shares) return true;
    bool ok = json_array_size(shares) == MRT_HOLE_PARTS;
    float sum = 0.0f;
    for (size_t p = 0; ok && p < MRT_HOLE_PARTS; p++) {
        const json_t *share = json_array_get(shares, p);
        out->share[p] = (float)json_number_value(share);
        ok = json_is_number(share) && out->share[p] >= 0.0f && out->share[p] <= 1.0f;
        sum += out->share[p];
    }
    return (ok && sum > 0.0f) ||
           host_fail(source->host, FAIL_FORMAT,
                     "%s: block %s: holes of its face %s are not %d numbers from 0 to 1, some "
                     "above 0",
                     source->what, source->blocks[i].name, mrt_face_name(face), MRT_HOLE_PARTS);
}

// The neighbour has named this block before. Holes are given by both or by one.
static bool check_holes(const struct source *source, const struct mrt_block_map *map, int i,
                        int face)
{
    const struct mrt_block *block = &map->blocks[i];
    struct mrt_holes holes;
    bool has, same = true;
    if (!read_holes(source, i, face, &has, &holes)) return false;
    for (int p = 0; has && p < MRT_HOLE_PARTS; p++)
        same = same && fabsf(holes.share[p] - block->holes[face].share[p]) < 1e-3f;
    return same || host_fail(source->host, FAIL_FORMAT,
                             "%s: block %s: holes of its face %s differ from those of block %s",
                             source->what, block->name, mrt_face_name(face),
                             map->blocks[block->neighbor[face].block].name);
}

static bool connect(const struct source *source, struct mrt_block_map *map, int i, int face,
                    const char *name)
{
    struct mrt_holes holes;
    bool has_holes;
    struct mrt_block *block = &map->blocks[i];
    int other = name ? find_block(source, name) : -1;
    if (other < 0 || other == i)
        return wrong(source, block->name, "it has a neighbor that does not exist");
    if (block->neighbor[face].block == other) return check_holes(source, map, i, face);
    int other_face = mrt_meeting_face(block, face, &map->blocks[other]);
    if (other_face >= 0)
        return read_holes(source, i, face, &has_holes, &holes) &&
               (has_holes
                    ? mrt_connect_by_holes(source->what, map, i, face, other, other_face, &holes)
                    : mrt_connect(source->what, map, i, face, other, other_face));
    return host_fail(source->host, FAIL_FORMAT,
                     "%s: block %s: its face %s does not meet a face of block %s", source->what,
                     block->name, mrt_face_name(face), map->blocks[other].name);
}

static bool connect_block(const struct source *source, struct mrt_block_map *map, int i)
{
    json_t *neighbors = json_object_get(source->blocks[i].json, "neighbors"), *name;
    json_t *holes = json_object_get(source->blocks[i].json, "holes");
    const char *key;
    if (neighbors && !json_is_object(neighbors))
        return wrong(source, map->blocks[i].name, "neighbors is not an object");
    if (holes && !json_is_object(holes))
        return wrong(source, map->blocks[i].name, "holes is not an object");
    json_object_foreach(holes, key, name)
    {
        if (!json_object_get(neighbors, key))
            return wrong(source, map->blocks[i].name, "it has holes of a face without neighbor");
    }
    json_object_foreach(neighbors, key, name)
    {
        int face = mrt_face_of_name(key);
        if (face < 0)
            return wrong(source, map->blocks[i].name, "neighbors has a face that does not exist");
        if (!connect(source, map, i, face, json_string_value(name))) return false;
    }
    return true;
}

static bool read_source(const struct source *source, struct mrt_block_map *map)
{
    if (!mrt_block_map_init(source->host, source->what, source->count, map)) return false;
    for (size_t i = 0; i < source->count; i++)
        if (!read_block(source, &source->blocks[i], &map->blocks[i])) return false;
    // Before connections: corners that are not finite meet no face.
    if (!mrt_block_map_check(source->what, map)) return false;
    for (int i = 0; i < map->count; i++)
        if (!connect_block(source, map, i)) return false;
    return mrt_block_map_check(source->what, map);
}

// ---- names of clutter

static bool wrong_list(const char *path, struct mrt_block_map *map, const char *list,
                       const char *why)
{
    return host_fail(map->host, FAIL_FORMAT, "%s: %s: %s", path, list, why);
}

static bool is_named(const struct mrt_block_map *map, const char *node)
{
    for (int i = 0; i < map->named_count; i++)
        if (strcmp(map->named[i].node, node) == 0) return true;
    return false;
}

static bool add_names(const char *path, const json_t *root, const char *list, bool clutter,
                      struct mrt_block_map *map)
{
    const json_t *names = json_object_get(root, list);
    if (names && !json_is_array(names)) return wrong_list(path, map, list, "it is not an array");
    if (json_array_size(names) > MRT_MAX_NAMED)
        return wrong_list(path, map, list, "it has too many names");
    for (size_t i = 0; i < json_array_size(names); i++) {
        const char *node = json_string_value(json_array_get(names, i));
        if (!node || !node[0]) return wrong_list(path, map, list, "it is not an array of names");
        if (is_named(map, node))
            return host_fail(map->host, FAIL_FORMAT, "%s: %s: %.200s is named twice", path, list,
                             node);
        char *copy = host_strdup(map->host, node);
        if (!copy) return false;
        map->named[map->named_count++] = (struct mrt_named_part){ copy, clutter };
    }
    return true;
}

static bool read_names(const char *path, const json_t *root, struct mrt_block_map *map)
{
    const size_t count = json_array_size(json_object_get(root, "clutter")) +
                         json_array_size(json_object_get(root, "walls"));
    if (count > 0 && count <= 2 * (size_t)MRT_MAX_NAMED)
        map->named = host_alloc(map->host, count, sizeof *map->named);
    if (count > 0 && count <= 2 * (size_t)MRT_MAX_NAMED && !map->named) return false;
    return add_names(path, root, "clutter", true, map) &&
           add_names(path, root, "walls", false, map);
}

// ---- a file

static bool check_root(struct host *host, const char *path, const json_t *root)
{
    static const char *const known[] = { "$schema", "afterglow_block_map", "blocks", "clutter",
                                         "walls" };
    return check_members(host, path, "the map", root, known, sizeof known / sizeof *known);
}

static bool read_document(struct host *host, const char *path, const json_t *root,
                          struct mrt_block_map *map)
{
    const json_t *array = json_object_get(root, "blocks");
    struct source source = { host, path, NULL, json_array_size(array) };
    if (json_integer_value(json_object_get(root, "afterglow_block_map")) != 1 ||
        !json_is_array(array) || source.count == 0)
        return host_fail(host, FAIL_FORMAT, "%s: it is not a block map of version 1", path);
    if (!check_root(host, path, root)) return false;
    source.blocks = host_alloc(host, source.count, sizeof *source.blocks);
    bool ok = source.blocks != NULL;
    for (size_t i = 0; ok && i < source.count; i++) {
        const json_t *json = json_array_get(array, i);
        const char *name = json_string_value(json_object_get(json, "name"));
        source.blocks[i] = (struct source_block){ json, name, glms_mat4_identity() };
        if (!name || !name[0] || strlen(name) >= MRT_NAME_BYTES)
            ok = host_fail(host, FAIL_FORMAT, "%s: block %zu: its name has not 1 to %d bytes", path,
                           i, MRT_NAME_BYTES - 1);
        else if (i >= MRT_MAX_BLOCKS)
            ok = wrong(&source, name, TOO_MANY);
    }
    ok = ok && read_source(&source, map) && read_names(path, root, map);
    host_free(host, source.blocks);
    return ok;
}

bool mrt_block_map_parse(struct host *host, const char *what, const char *text, size_t size,
                         struct mrt_block_map *map)
{
    json_error_t error;
    *map = (struct mrt_block_map){ 0 };
    json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
    bool ok = root ? read_document(host, what, root, map)
                   : host_fail(host, FAIL_FORMAT, "%s: line %d: %s", what, error.line, error.text);
    json_decref(root);
    if (!ok) mrt_block_map_finish(map);
    return ok;
}

bool mrt_block_map_read(struct host *host, const char *path, struct mrt_block_map *map)
{
    enum { MAX_BYTES = 4 << 20 };
    struct file_bytes bytes;
    *map = (struct mrt_block_map){ 0 };
    if (!file_read(host, path, MAX_BYTES, &bytes)) return false;
    const bool ok = mrt_block_map_parse(host, path, (const char *)bytes.data, bytes.size, map);
    file_bytes_finish(host, &bytes);
    return ok;
}

// ---- nodes of a scene

bool mrt_clutter_of_extras(const struct node *node, bool *clutter)
{
    if (!node->extras || !strstr(node->extras, CLUTTER_KEY)) return false;
    json_t *extras = json_loads(node->extras, 0, NULL);
    const json_t *value = json_object_get(extras, CLUTTER_KEY);
    const bool has_value = json_is_boolean(value);
    *clutter = json_is_true(value);
    json_decref(extras);
    return has_value;
}

struct node_blocks {
    struct source source;
    json_t **extras; // owned, one for each block
};

static bool add_node(struct node_blocks *blocks, const struct scene_pose *pose, int node)
{
    const struct node *from = &pose->scene->nodes[node];
    if (!from->extras || !strstr(from->extras, EXTRAS_KEY)) return true;
    json_t *extras = json_loads(from->extras, 0, NULL);
    json_t *json = json_object_get(extras, EXTRAS_KEY);
    if (!json) {
        json_decref(extras);
        return true;
    }
    size_t i = blocks->source.count++;
    blocks->extras[i] = extras;
    blocks->source.blocks[i] =
        (struct source_block){ json, from->name, pose->world_from_node[node] };
    if (!json_is_object(json)) return wrong(&blocks->source, from->name, "it is not an object");
    if (strlen(from->name) >= MRT_NAME_BYTES)
        return wrong(&blocks->source, from->name, "its name is too long");
    if (blocks->source.count > MRT_MAX_BLOCKS) return wrong(&blocks->source, from->name, TOO_MANY);
    return true;
}

static bool read_nodes(struct node_blocks *blocks, const struct scene_pose *pose,
                       struct mrt_block_map *map)
{
    for (int i = 0; i < pose->scene->node_count; i++)
        if (!add_node(blocks, pose, i)) return false;
    return blocks->source.count == 0 || read_source(&blocks->source, map);
}

bool mrt_block_map_of_scene(struct host *host, const struct scene *scene, struct mrt_block_map *map)
{
    struct node_blocks blocks = { .source = { .host = host, .what = scene->name } };
    struct scene_pose pose = { 0 };
    size_t nodes = (size_t)scene->node_count;
    *map = (struct mrt_block_map){ .host = host };
    blocks.source.blocks = host_alloc(host, nodes, sizeof *blocks.source.blocks);
    blocks.extras = host_alloc(host, nodes, sizeof *blocks.extras);
    bool ok = blocks.source.blocks && blocks.extras && pose_init(&pose, scene, -1, 0.0f) &&
              read_nodes(&blocks, &pose, map);
    for (size_t i = 0; i < blocks.source.count; i++) json_decref(blocks.extras[i]);
    host_free(host, blocks.extras);
    host_free(host, blocks.source.blocks);
    pose_finish(&pose);
    if (!ok) mrt_block_map_finish(map);
    return ok;
}
