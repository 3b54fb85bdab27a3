// @maze: cubes on a square plan, each connected to an earlier one by a missing face (the
// two-dimensional mazes of Loos 2015, chapter 3). Other neighbours have a wall between them. The
// light is in the first block. Pillars are objects inside blocks (chapter 5).
#include "scene/builtin/parts.h"

#include "core/rng.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct maze_options {
#define OPTION OPTION_FIELD
#include "maze_options.def"
#undef OPTION
};

#define OPTION(...) OPTION_ROW(struct maze_options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "maze_options.def"
};
#undef OPTION

static const float WALL_FRACTION = 0.08f; // of a block's edge length

enum { MAX_BLOCKS = 128, PLAN = 2 * MAX_BLOCKS + 1, MAX_PLANES = 2 * PLAN + 2 };

struct maze {
    int count;
    int x[MAX_BLOCKS], z[MAX_BLOCKS], parent[MAX_BLOCKS]; // parent[0] is -1
    // The plan: odd indices are blocks, even ones the walls between. Block (x, z) is at
    // [2 x + 1][2 z + 1].
    bool open[2 * PLAN + 1][2 * PLAN + 1];
    int low[2], high[2]; // used range of `open`, including outer walls
};

static bool is_block(const struct maze *maze, int x, int z)
{
    return maze->open[2 * x + 1][2 * z + 1];
}

static void add_block(struct maze *maze, int x, int z, int parent)
{
    int b = maze->count++;
    maze->x[b] = x;
    maze->z[b] = z;
    maze->parent[b] = parent;
    maze->open[2 * x + 1][2 * z + 1] = true;
    if (parent >= 0) maze->open[x + maze->x[parent] + 1][z + maze->z[parent] + 1] = true;
}

// Random growth from the centre: draws an earlier block and a side until that side is free.
static void lay_maze(struct maze *maze, int blocks, uint32_t seed)
{
    static const int sides[4][2] = { { 1, 0 }, { 0, 1 }, { -1, 0 }, { 0, -1 } };
    struct rng rng = rng_for(seed, 0, 0);
    add_block(maze, MAX_BLOCKS, MAX_BLOCKS, -1);
    while (maze->count < blocks) {
        int from = (int)(rng_u32(&rng) % (uint32_t)maze->count);
        const int *side = sides[rng_u32(&rng) % 4u];
        int x = maze->x[from] + side[0], z = maze->z[from] + side[1];
        if (!is_block(maze, x, z)) add_block(maze, x, z, from);
    }
    for (int axis = 0; axis < 2; axis++) {
        const int *at = axis ? maze->z : maze->x;
        maze->low[axis] = maze->high[axis] = 2 * at[0] + 1;
        for (int b = 0; b < blocks; b++) {
            int cell = 2 * at[b] + 1;
            if (cell - 1 < maze->low[axis]) maze->low[axis] = cell - 1;
            if (cell + 1 > maze->high[axis]) maze->high[axis] = cell + 1;
        }
    }
}

enum part { FLOOR = 1, CEILING, WALLS, FIRST_COLOUR, PART_COUNT = FIRST_COLOUR + 4 };

// Whether this cell or one of its 8 neighbours is open.
static bool near_open(const struct maze *maze, int i, int k)
{
    for (int di = -1; di <= 1; di++) {
        for (int dk = -1; dk <= 1; dk++) {
            int x = i + di, z = k + dk;
            if (x < 0 || z < 0 || x > 2 * PLAN || z > 2 * PLAN) continue;
            if (maze->open[x][z]) return true;
        }
    }
    return false;
}

// Whether the cell is part of the building: open cells, and closed walls and posts beside open
// cells. Unused blocks and the surroundings stay empty.
static bool is_covered(const struct maze *maze, int i, int k)
{
    if (maze->open[i][k]) return true;
    bool between_blocks = i % 2 == 0 || k % 2 == 0;
    return between_blocks && near_open(maze, i, k);
}

static int maze_part(const void *user, int i, int j, int k)
{
    const struct maze *maze = user;
    i += maze->low[0];
    k += maze->low[1];
    if (!is_covered(maze, i, k)) return 0;
    if (j == 0) return FLOOR;
    if (j == 2) return CEILING;
    if (maze->open[i][k]) return 0;
    bool post = i % 2 == 0 && k % 2 == 0;
    // Every third wall is coloured, by its distance from the first block.
    int dx = i - 2 * MAX_BLOCKS + 128, dz = k - 2 * MAX_BLOCKS + 128;
    uint32_t hash = pcg_hash((uint32_t)(dx * 4099 + dz));
    return post || hash % 3u != 0 ? WALLS : FIRST_COLOUR + (int)((hash >> 8) % 4u);
}

// Planes of the used range along one axis; the origin is the centre of the first block.
static int lay_planes(const struct maze *maze, int axis, float size, float *plane)
{
    int middle = axis ? maze->z[0] : maze->x[0], count = 0;
    float half_wall = 0.5f * WALL_FRACTION * size;
    for (int cell = maze->low[axis]; cell <= maze->high[axis] + 1; cell++) {
        // An even cell is the wall before block cell / 2, an odd cell the inside of a block.
        float border = ((float)(cell / 2 - middle) - 0.5f) * size;
        plane[count++] = cell % 2 == 0 ? border - half_wall : border + half_wall;
    }
    return count - 1;
}

static bool build_walls(struct scene *scene, const struct maze *maze, float size)
{
    static const struct {
        const char *name;
        vec3s colour;
    } parts[PART_COUNT] = {
        [FLOOR] = { "floor", { { 0.45f, 0.43f, 0.40f } } },
        [CEILING] = { "ceiling", { { 0.78f, 0.78f, 0.78f } } },
        [WALLS] = { "walls", { { 0.73f, 0.71f, 0.68f } } },
        [FIRST_COLOUR] = { "red walls", { { 0.65f, 0.10f, 0.08f } } },
        { "green walls", { { 0.14f, 0.48f, 0.12f } } },
        { "blue walls", { { 0.12f, 0.22f, 0.65f } } },
        { "yellow walls", { { 0.70f, 0.55f, 0.12f } } },
    };
    float x[MAX_PLANES], z[MAX_PLANES];
    float wall = WALL_FRACTION * size;
    const float y[4] = { -wall, 0, size - wall, size };
    struct shape_grid grid = { .x = x, .y = y, .z = z, .ny = 3, .part = maze_part, .user = maze };
    grid.nx = lay_planes(maze, 0, size, x);
    grid.nz = lay_planes(maze, 1, size, z);
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int part = FLOOR; part < PART_COUNT; part++) {
        shape_blocks(&builder, &grid, part);
        if (builder.index_count == 0) { // a small maze may not use every colour
            shape_discard(&builder);
            continue;
        }
        int material = builtin_diffuse(scene, parts[part].name, parts[part].colour);
        if (material < 0 || shape_emit(&builder, parts[part].name, material) < 0) {
            shape_discard(&builder);
            return false;
        }
    }
    return true;
}

static vec3s block_middle(const struct maze *maze, int block, float size, float height)
{
    return vec3_of((float)(maze->x[block] - maze->x[0]) * size, height * size,
                   (float)(maze->z[block] - maze->z[0]) * size);
}

// `main` is at the far side of the second block and faces the first one; `far` is in the last block
// and faces the one before it.
static bool build_cameras(struct scene *scene, const struct maze *maze, float size)
{
    vec3s light_block = block_middle(maze, 0, size, 0.45f);
    vec3s position = vec3_of(0.35f * size, 0.5f * size, 0.35f * size);
    if (maze->count > 1) {
        vec3s beside = block_middle(maze, 1, size, 0.5f);
        vec3s away = glms_vec3_sub(beside, block_middle(maze, 0, size, 0.5f));
        position = glms_vec3_muladds(away, 0.38f, beside);
    }
    if (!builtin_camera(scene, "main", position, light_block, glm_rad(70.0f))) return false;
    if (maze->count == 1) return true;
    int last = maze->count - 1;
    vec3s end = block_middle(maze, last, size, 0.5f);
    vec3s towards = block_middle(maze, maze->parent[last], size, 0.45f);
    vec3s back = glms_vec3_sub(end, towards);
    struct camera camera = { .name = "far", .vertical_fov_rad = glm_rad(70.0f), .near_m = 0.01f };
    camera.node = scene_add_node_looking(scene, "far", glms_vec3_muladds(back, 0.38f, end),
                                         glms_vec3_negate(back));
    return camera.node >= 0 && scene_add_camera(scene, &camera) >= 0;
}

// Between the middle of a block and its walls; of the edge length.
static const float PILLAR_PLACE = 0.22f, PILLAR_WIDTH = 0.14f, PILLAR_HEIGHT = 0.7f;

// They stand on the floor and end below the ceiling (Loos 2015, section 5.4: pillars of five
// faces).
static bool build_pillars(struct scene *scene, const struct maze *maze,
                          const struct maze_options *o)
{
    static const float corners[4][2] = { { 1, 1 }, { -1, -1 }, { 1, -1 }, { -1, 1 } };
    const int count = o->pillars * maze->count;
    const int material =
        count > 0 ? builtin_diffuse(scene, "pillars", vec3_of(0.70f, 0.66f, 0.60f)) : 0;
    const float half = 0.5f * PILLAR_WIDTH * o->size, place = PILLAR_PLACE * o->size;
    bool ok = material >= 0;
    for (int i = 0; ok && i < count; i++) {
        const float *corner = corners[i % o->pillars];
        const vec3s middle = block_middle(maze, i / o->pillars, o->size, 0.0f);
        const vec3s foot = glms_vec3_add(middle, vec3_of(place * corner[0], 0, place * corner[1]));
        char name[32];
        struct shape_builder builder;
        snprintf(name, sizeof name, "pillar %d", i);
        shape_begin(&builder, scene);
        shape_box(&builder, glms_vec3_add(foot, vec3_of(-half, 0, -half)),
                  glms_vec3_add(foot, vec3_of(half, PILLAR_HEIGHT * o->size, half)));
        ok = shape_emit(&builder, name, material) >= 0;
    }
    return ok;
}

// One block of the block map for each cube, from floor to ceiling, up to the middle of the walls.
static bool build_blocks(struct scene *scene, const struct maze *maze, float size)
{
    float height = size * (1.0f - WALL_FRACTION);
    for (int b = 0; b < maze->count; b++) {
        char name[32], neighbors[64] = "";
        snprintf(name, sizeof name, "block %d", b);
        int parent = maze->parent[b];
        if (parent >= 0) {
            int dx = maze->x[parent] - maze->x[b], dz = maze->z[parent] - maze->z[b];
            snprintf(neighbors, sizeof neighbors, "\"%c%c\":\"block %d\"", dx + dz > 0 ? '+' : '-',
                     dx ? 'x' : 'z', parent);
        }
        mat4s at = glms_translate_make(block_middle(maze, b, size, 0.0f));
        at.m31 = 0.5f * height;
        mat4s block = glms_mat4_mul(at, glms_scale_make(vec3_of(size, height, size)));
        if (!builtin_block(scene, name, block, "cube", neighbors)) return false;
    }
    return true;
}

static bool build_maze(struct scene *scene, const void *options)
{
    const struct maze_options *o = options;
    struct maze *maze = host_alloc(scene->host, 1, sizeof *maze);
    if (!maze) return false;
    lay_maze(maze, o->blocks, (uint32_t)o->seed);
    bool ok =
        build_walls(scene, maze, o->size) && build_pillars(scene, maze, o) &&
        builtin_sphere_light(scene, vec3_of(0, 0.62f * o->size, 0), o->light == 1, o->lumens) &&
        build_cameras(scene, maze, o->size) && build_blocks(scene, maze, o->size);
    host_free(scene->host, maze);
    return ok;
}

const struct builtin_scene builtin_maze = {
    .name = "maze",
    .title = "cubes connected by missing faces, with the light in one of them",
    .options = OPTION_TABLE(struct maze_options, rows, NULL),
    .build = build_maze,
};
