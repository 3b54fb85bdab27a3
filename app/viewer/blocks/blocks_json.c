// Block maps from and to JSON. The library checks them.
#include "blocks.h"

#include "shell/json_values.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char CUBE[] = "cube";

// ---- reading

static void read_point(const json_t *json, float out[3])
{
    for (size_t a = 0; a < 3; a++) out[a] = (float)json_number_value(json_array_get(json, a));
}

static void read_corners(const json_t *json, struct block *out)
{
    const json_t *box = json_object_get(json, "box"), *corners = json_object_get(json, "corners");
    float low[3], high[3];
    for (size_t c = 0; corners && c < BLOCK_CORNERS; c++)
        read_point(json_array_get(corners, c), out->corner[c]);
    if (corners) return;
    read_point(json_array_get(box, 0), low);
    read_point(json_array_get(box, 1), high);
    block_set_box(out, low, high);
}

static void read_open(const json_t *json, struct block *out)
{
    const json_t *open = json_object_get(json, "open");
    for (size_t i = 0; i < json_array_size(open); i++) {
        const int face = block_face_find(json_string_value(json_array_get(open, i)));
        if (face >= 0) out->open[face] = true;
    }
}

static void read_holes(const json_t *json, struct block *out)
{
    const json_t *holes = json_object_get(json, "holes");
    for (int f = 0; f < BLOCK_FACES; f++) {
        const json_t *shares = json_object_get(holes, block_faces[f]);
        for (size_t p = 0; shares && p < BLOCK_HOLES; p++)
            out->holes[f][p] = (float)json_number_value(json_array_get(shares, p));
    }
}

static void read_block(const json_t *json, struct block *out)
{
    const char *shape = json_string_value(json_object_get(json, "shape"));
    *out = (struct block){ 0 };
    snprintf(out->name, sizeof out->name, "%s", json_string_value(json_object_get(json, "name")));
    snprintf(out->shape, sizeof out->shape, "%s", shape ? shape : CUBE);
    read_corners(json, out);
    read_open(json, out);
    read_holes(json, out);
    for (int f = 0; f < BLOCK_FACES; f++) out->neighbor[f] = -1;
}

static int find(const struct blocks *blocks, const char *name)
{
    for (int i = 0; name && i < blocks->count; i++)
        if (strcmp(blocks->at[i].name, name) == 0) return i;
    return -1;
}

static void read_neighbors(const json_t *json, const struct blocks *blocks, struct block *out)
{
    const json_t *neighbors = json_object_get(json, "neighbors");
    for (int f = 0; f < BLOCK_FACES; f++)
        out->neighbor[f] =
            find(blocks, json_string_value(json_object_get(neighbors, block_faces[f])));
}

static char *read_names(const json_t *root, const char *list)
{
    const json_t *names = json_object_get(root, list);
    return names ? json_dumps(names, 0) : NULL;
}

bool blocks_parse(struct blocks *out, const char *json)
{
    json_t *root = json_loads(json, 0, NULL);
    const json_t *array = json_object_get(root, "blocks");
    const size_t count = json_array_size(array);
    *out = (struct blocks){ .at = malloc((count + 1) * sizeof *out->at) };
    for (size_t i = 0; out->at && i < count; i++)
        read_block(json_array_get(array, i), &out->at[out->count++]);
    for (int i = 0; i < out->count; i++)
        read_neighbors(json_array_get(array, (size_t)i), out, &out->at[i]);
    out->clutter = read_names(root, "clutter");
    out->walls = read_names(root, "walls");
    json_decref(root);
    return out->at && (size_t)out->count == count;
}

// ---- writing

static json_t *corners_of(const struct block *block)
{
    json_t *corners = json_array();
    for (int c = 0; c < BLOCK_CORNERS; c++)
        json_array_append_new(corners, json_floats(block->corner[c], 3));
    return corners;
}

static json_t *print_block(const struct blocks *blocks, const struct block *block)
{
    json_t *object = json_object(), *open = json_array();
    json_t *neighbors = json_object(), *holes = json_object();
    const bool cube = strcmp(block->shape, CUBE) == 0;
    json_object_set_new(object, "name", json_text(block->name));
    if (!cube) json_object_set_new(object, "shape", json_text(block->shape));
    json_object_set_new(object, "corners", corners_of(block));
    for (int f = 0; f < BLOCK_FACES; f++) {
        const enum opening opening = block_opening(block, f);
        if (opening == OPENING_OPEN && cube)
            json_array_append_new(open, json_string(block_faces[f]));
        if (opening == OPENING_NEIGHBOR)
            json_object_set_new(neighbors, block_faces[f],
                                json_text(blocks->at[block->neighbor[f]].name));
        if (block_has_holes(block, f))
            json_object_set_new(holes, block_faces[f], json_floats(block->holes[f], BLOCK_HOLES));
    }
    json_object_set_new(object, "open", open);
    json_object_set_new(object, "neighbors", neighbors);
    json_object_set_new(object, "holes", holes);
    return object;
}

static void put_names(json_t *root, const char *list, const char *names)
{
    if (names) json_object_set_new(root, list, json_loads(names, 0, NULL));
}

char *blocks_print(const struct blocks *blocks)
{
    json_t *root = json_object(), *array = json_array();
    for (int i = 0; i < blocks->count; i++)
        json_array_append_new(array, print_block(blocks, &blocks->at[i]));
    json_object_set_new(root, "afterglow_block_map", json_integer(1));
    json_object_set_new(root, "blocks", array);
    put_names(root, "clutter", blocks->clutter);
    put_names(root, "walls", blocks->walls);
    char *text = json_dumps(root, JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(12));
    json_decref(root);
    return text;
}
