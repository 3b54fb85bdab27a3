// A block map: the connected blocks that stand for a scene (Loos 2015, sections 3.5.2 and 4.3.1).
// It is read from a JSON file or from the scene's nodes (docs/block-maps.md), or made.
#pragma once

#include "scene/scene.h"

#include "techniques/mrt/level/block.h"

// A node whose meshes, with those of its descendants, are clutter, or walls, whatever is found
// (objects/clutter.h).
enum { MRT_MAX_NAMED = 1024 }; // of each kind
struct mrt_named_part {
    char *node;
    bool clutter;
};

struct mrt_block_map {
    struct host *host;
    struct mrt_block *blocks;
    int count;
    bool is_found;  // in the free space of a scene
    bool is_single; // one block stands for the scene
    bool is_open;   // the scene has no room: no surface belongs to a block
    struct mrt_named_part *named;
    int named_count;
};

// At most MRT_MAX_BLOCKS blocks, all zero. `what` names the map in messages.
bool mrt_block_map_init(struct host *host, const char *what, size_t count,
                        struct mrt_block_map *map);
void mrt_block_map_finish(struct mrt_block_map *map); // accepts zero

// Moves all blocks of `more`, with their neighbours, to the end of `map`. Names must differ.
bool mrt_block_map_append(const char *what, struct mrt_block_map *map, struct mrt_block_map *more);

// Opens two faces to each other. FAIL_FORMAT, with the names of the blocks, where one of them is
// taken or their corners do not coincide.
bool mrt_connect(const char *what, struct mrt_block_map *map, int block, int face, int other,
                 int other_face);
// The same through holes of both walls, which stay; `holes` as this face has them.
bool mrt_connect_by_holes(const char *what, struct mrt_block_map *map, int block, int face,
                          int other, int other_face, const struct mrt_holes *holes);
// Both faces become walls without a neighbour.
void mrt_disconnect(struct mrt_block_map *map, int block, int face);
// The face of `other` whose corners coincide with those of this face; −1: none.
int mrt_meeting_face(const struct mrt_block *block, int face, const struct mrt_block *other);

// FAIL_FORMAT with the name of the first block that is wrong: two blocks of one name, corners that
// are not finite or a warp that folds over, openings that its shape lacks or a cube without walls.
bool mrt_block_map_check(const char *what, const struct mrt_block_map *map);

// Edge of a cube of the blocks' mean volume, in metres.
float mrt_block_map_mean_edge(const struct mrt_block_map *map);

// Whether a dictionary for two-dimensional mazes has all cubes: no opening at the bottom or top of
// a cell, no neighbours that are tilted against each other.
bool mrt_block_map_is_plane(const struct mrt_block_map *map);

// Whether a dictionary of tubes has all blocks: cylinders that are not tilted against each other.
bool mrt_block_map_is_tunnel(const struct mrt_block_map *map);

// ---- cylinder.c

// Replaces cylinders by cubes that are warped along them. A level is all tubes or all cubes. Ends
// without a neighbour become walls. FAIL_UNSUPPORTED where a cylinder is connected with a block of
// another kind.
bool mrt_block_map_as_cubes(const char *what, struct mrt_block_map *map);

// ---- block_map_json.c: FAIL_FORMAT where the JSON is malformed.

bool mrt_block_map_read(struct host *host, const char *path, struct mrt_block_map *map);
// `what` names the text in messages.
bool mrt_block_map_parse(struct host *host, const char *what, const char *text, size_t size,
                         struct mrt_block_map *map);
// Whether the `extras` of a node say that it is clutter, or that it is not.
bool mrt_clutter_of_extras(const struct node *node, bool *clutter);
// From the `extras` of nodes in the default pose. A scene without blocks gives an empty map.
bool mrt_block_map_of_scene(struct host *host, const struct scene *scene,
                            struct mrt_block_map *map);

// ---- block_map_write.c

// JSON text that mrt_block_map_read reads, owned by the caller. NULL: out of memory.
char *mrt_block_map_json(struct host *host, const struct mrt_block_map *map);
