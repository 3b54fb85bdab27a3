// Block maps as JSON text.
#include "block_map.h"

#include "core/text.h"

#include <jansson.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *number(float value)
{
    char text[32];
    if (value == truncf(value) && fabsf(value) < 1e6f) return json_integer((json_int_t)value);
    text_float(value, text, sizeof text);
    return json_real(strtod(text, NULL));
}

static json_t *vector(vec3s v)
{
    return json_pack("[o, o, o]", number(v.x), number(v.y), number(v.z));
}

static bool is_box(const struct mrt_block *block)
{
    struct mrt_block box = *block;
    mrt_block_set_box(&box, (struct box3){ block->corner[0], block->corner[MRT_CORNERS - 1] });
    for (int c = 0; c < MRT_CORNERS; c++)
        for (int a = 0; a < 3; a++)
            if (box.corner[c].raw[a] != block->corner[c].raw[a]) return false;
    return true;
}

static json_t *corners_of(const struct mrt_block *block)
{
    json_t *corners = json_array();
    for (int c = 0; c < MRT_CORNERS; c++) json_array_append_new(corners, vector(block->corner[c]));
    return corners;
}

// Faces that are open without a neighbour; those of cylinders follow from the shape.
static json_t *open_of(const struct mrt_block *block)
{
    json_t *open = json_array();
    for (int f = 0; f < CUBE_FACES && block->kind == MRT_BLOCK_CUBE; f++)
        if (mrt_block_is_open(block, f) && block->neighbor[f].block < 0)
            json_array_append_new(open, json_string(mrt_face_name(f)));
    return open;
}

static json_t *neighbors_of(const struct mrt_block_map *map, const struct mrt_block *block)
{
    json_t *neighbors = json_object();
    for (int f = 0; f < CUBE_FACES; f++) {
        const int other = block->neighbor[f].block;
        if (other >= 0)
            json_object_set_new(neighbors, mrt_face_name(f), json_string(map->blocks[other].name));
    }
    return neighbors;
}

static json_t *holes_of(const struct mrt_block *block)
{
    json_t *holes = json_object();
    for (int f = 0; f < CUBE_FACES; f++) {
        if (!mrt_block_has_holes(block, f)) continue;
        json_t *shares = json_array();
        for (int p = 0; p < MRT_HOLE_PARTS; p++)
            json_array_append_new(shares, number(block->holes[f].share[p]));
        json_object_set_new(holes, mrt_face_name(f), shares);
    }
    return holes;
}

static void put_unless_empty(json_t *object, const char *name, json_t *value)
{
    if (json_array_size(value) > 0 || json_object_size(value) > 0)
        json_object_set(object, name, value);
    json_decref(value);
}

static json_t *block_of(const struct mrt_block_map *map, const struct mrt_block *block)
{
    json_t *object = json_object();
    json_object_set_new(object, "name", json_string(block->name));
    if (block->kind != MRT_BLOCK_CUBE)
        json_object_set_new(object, "shape", json_string(mrt_kind_name(block->kind)));
    if (is_box(block))
        json_object_set_new(
            object, "box",
            json_pack("[o, o]", vector(block->corner[0]), vector(block->corner[MRT_CORNERS - 1])));
    else
        json_object_set_new(object, "corners", corners_of(block));
    put_unless_empty(object, "open", open_of(block));
    put_unless_empty(object, "neighbors", neighbors_of(map, block));
    put_unless_empty(object, "holes", holes_of(block));
    return object;
}

static json_t *names_of(const struct mrt_block_map *map, bool clutter)
{
    json_t *names = json_array();
    for (int i = 0; i < map->named_count; i++)
        if (map->named[i].clutter == clutter)
            json_array_append_new(names, json_string(map->named[i].node));
    return names;
}

// ---- text: a line for each block

static void write_line(FILE *file, json_t *value)
{
    json_dumpf(value, file, JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(9));
    json_decref(value);
}

static void write_names(FILE *file, const struct mrt_block_map *map, const char *list, bool clutter)
{
    json_t *names = names_of(map, clutter);
    if (json_array_size(names) == 0) {
        json_decref(names);
        return;
    }
    fprintf(file, ",\n  \"%s\": ", list);
    write_line(file, names);
}

static void write_map(FILE *file, const struct mrt_block_map *map)
{
    fputs("{\n  \"afterglow_block_map\": 1,\n  \"blocks\": [", file);
    for (int b = 0; b < map->count; b++) {
        fputs(b ? ",\n    " : "\n    ", file);
        write_line(file, block_of(map, &map->blocks[b]));
    }
    fputs("\n  ]", file);
    write_names(file, map, "clutter", true);
    write_names(file, map, "walls", false);
    fputs("\n}\n", file);
}

char *mrt_block_map_json(struct host *host, const struct mrt_block_map *map)
{
    char *text = NULL, *copy = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    if (file) write_map(file, map);
    if (file && fclose(file) == 0)
        copy = host_strdup(host, text);
    else
        host_fail(host, FAIL_MEMORY, "out of memory");
    free(text);
    return copy;
}
