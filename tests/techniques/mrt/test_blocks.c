// Block maps of modular radiance transfer: warps, files, extras of nodes, and what is refused.
#include "framework/test.h"
#include "techniques/mrt/mrt_map_fixture.h"

#include "core/rng.h"

#include "scene/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static vec3s random_vector(struct rng *rng, float reach)
{
    vec3s v;
    for (int a = 0; a < 3; a++) v.raw[a] = reach * (2.0f * rng_float(rng) - 1.0f);
    return v;
}

// The unit cube with corners that are moved by up to a fifth of its edge.
static void random_block(struct rng *rng, struct mrt_block *block)
{
    mrt_block_init(block, "random", MRT_BLOCK_CUBE);
    mrt_block_set_box(block, (struct box3){ vec3_of(1, 2, 3), vec3_of(2, 3, 4) });
    for (int c = 0; c < MRT_CORNERS; c++)
        block->corner[c] = glms_vec3_add(block->corner[c], random_vector(rng, 0.2f));
}

// ---- geometry

TEST(corners_of_the_cell_are_those_of_the_block)
{
    struct rng rng = rng_for(1, 0, 0);
    struct mrt_block block;
    random_block(&rng, &block);
    for (int c = 0; c < MRT_CORNERS; c++) {
        vec3s cell = vec3_of(c & 1 ? 0.5f : -0.5f, c & 2 ? 0.5f : -0.5f, c & 4 ? 0.5f : -0.5f);
        CHECK_NEAR(glms_vec3_distance(mrt_warp_point(block.corner, cell), block.corner[c]), 0,
                   1e-5);
    }
}

TEST(the_jacobian_is_the_derivative_of_the_warp)
{
    struct rng rng = rng_for(2, 0, 0);
    for (int i = 0; i < 100; i++) {
        struct mrt_block block;
        random_block(&rng, &block);
        vec3s p = random_vector(&rng, 0.5f);
        mat3s j = mrt_warp_jacobian(block.corner, p);
        for (int a = 0; a < 3; a++) {
            vec3s low = p, high = p;
            low.raw[a] -= 0.05f;
            high.raw[a] += 0.05f;
            vec3s d = glms_vec3_sub(mrt_warp_point(block.corner, high),
                                    mrt_warp_point(block.corner, low));
            CHECK_NEAR(glms_vec3_distance(glms_vec3_scale(d, 10.0f), j.col[a]), 0, 1e-4);
        }
    }
}

TEST(the_inverse_of_the_warp_finds_the_point_of_the_cell)
{
    struct rng rng = rng_for(3, 0, 0);
    for (int i = 0; i < 100; i++) {
        struct mrt_block block;
        random_block(&rng, &block);
        vec3s p = random_vector(&rng, 0.6f), found = vec3_of(9, 9, 9);
        CHECK(mrt_warp_inverse(block.corner, mrt_warp_point(block.corner, p), &found));
        CHECK_NEAR(glms_vec3_distance(p, found), 0, 1e-4);
    }
}

TEST(face_normals_point_out_of_the_block)
{
    struct rng rng = rng_for(4, 0, 0);
    for (int i = 0; i < 50; i++) {
        struct mrt_block block;
        random_block(&rng, &block);
        vec3s middle = mrt_warp_point(block.corner, vec3_of(0, 0, 0));
        for (int f = 0; f < CUBE_FACES; f++) {
            vec3s cell = cube_face_point(f, rng_float(&rng), rng_float(&rng));
            vec3s n = mrt_warp_face_normal(block.corner, f, cell);
            vec3s out = glms_vec3_sub(mrt_warp_point(block.corner, cell), middle);
            CHECK(glms_vec3_dot(n, out) > 0.0f);
            CHECK_NEAR(glms_vec3_norm(n), 1, 1e-5);
        }
    }
}

TEST(a_warp_that_mirrors_flattens_or_folds_is_found)
{
    struct rng rng = rng_for(5, 0, 0);
    struct mrt_block block;
    for (int i = 0; i < 100; i++) {
        random_block(&rng, &block);
        CHECK(!mrt_warp_folds(block.corner));
    }
    mrt_block_set_box(&block, (struct box3){ vec3_of(1, 0, 0), vec3_of(0, 1, 1) });
    CHECK(mrt_warp_folds(block.corner)); // mirrored
    mrt_block_set_box(&block, (struct box3){ vec3_of(0, 0, 0), vec3_of(0, 1, 1) });
    CHECK(mrt_warp_folds(block.corner)); // flat
    mrt_block_set_box(&block, (struct box3){ vec3_of(0, 0, 0), vec3_of(1, 1, 1) });
    block.corner[7] = vec3_of(0.3f, 0.3f, 0.3f); // pushed through the diagonal of its neighbours
    CHECK(mrt_warp_folds(block.corner));
    mrt_block_set_box(&block, (struct box3){ vec3_of(0, 0, 0), vec3_of(1, 1, 1) });
    for (int c = 4; c < 8; c++) // the top is turned by half a turn: it folds inside only
        block.corner[c] = vec3_of(c & 1 ? 0.0f : 1.0f, c & 2 ? 0.0f : 1.0f, 1.0f);
    CHECK(mrt_warp_folds(block.corner));
}

TEST(every_edge_of_a_face_has_one_other_face)
{
    for (int f = 0; f < CUBE_FACES; f++) {
        unsigned seen = 0;
        for (int i = 0; i < 4; i++) seen |= 1u << mrt_face_across_edge(f, i);
        CHECK(seen == (CUBE_ALL_FACES & ~(1u << f) & ~(1u << cube_opposite(f))));
    }
}

// ---- connections

TEST(faces_meet_in_every_orientation_of_the_blocks)
{
    for (int orientation = 0; orientation < MRT_ORIENTATIONS; orientation++) {
        struct mrt_block_map map;
        CHECK(mrt_block_map_init(test_host(), "test", 2, &map));
        struct mrt_block *a = &map.blocks[0], *b = &map.blocks[1];
        mrt_block_init(a, "a", MRT_BLOCK_CUBE);
        mrt_block_set_box(a, (struct box3){ vec3_of(0, 0, 0), vec3_of(1, 1, 1) });
        mrt_block_init(b, "b", MRT_BLOCK_CUBE);
        mrt_block_set_box(b, (struct box3){ vec3_of(1, 0, 0), vec3_of(3, 1, 1) });
        mrt_turn_block(b, orientation);
        int face = mrt_meeting_face(a, CUBE_RIGHT, b);
        CHECK(face >= 0 && mrt_connect("test", &map, 0, CUBE_RIGHT, 1, face));
        for (int i = 0; i < 4; i++) {
            int here = mrt_face_corner(CUBE_RIGHT, i);
            int there = mrt_neighbor_corner(a, CUBE_RIGHT, here);
            CHECK(glms_vec3_distance(a->corner[here], b->corner[there]) == 0.0f);
            CHECK(mrt_neighbor_corner(b, face, there) == here);
        }
        for (int f = 0; f < CUBE_FACES; f++)
            CHECK(f == CUBE_RIGHT || mrt_meeting_face(a, f, b) < 0);
        mrt_block_map_finish(&map);
    }
}

// ---- JSON

// ' stands for ". False with a message where the map is refused.
static bool read_map(const char *text, struct mrt_block_map *map)
{
    const char *path = test_path("blocks.json");
    FILE *file = fopen(path, "wb");
    CHECK(file);
    for (const char *c = text; *c; c++) fputc(*c == '\'' ? '"' : *c, file);
    CHECK(fclose(file) == 0);
    test_forget_messages();
    return mrt_block_map_read(test_host(), path, map);
}

#define MAP(blocks) "{'afterglow_block_map':1,'blocks':[" blocks "]}"
#define NAMED(lists)                                                                               \
    "{'afterglow_block_map':1," lists ",'blocks':[{'name':'a','box':[[0,0,0],[1,1,1]]}]}"
#define BOX_A "'name':'hall','box':[[0,0,0],[2,1,1]]"
#define BOX_B "'name':'room','box':[[2,0,0],[3,1,1]]"

TEST(a_file_gives_blocks_with_their_openings)
{
    struct mrt_block_map map;
    CHECK(read_map(MAP("{" BOX_A ",'open':['+y'],'neighbors':{'+x':'room'}},{" BOX_B "}"), &map));
    CHECK(map.count == 2);
    CHECK_STRING(map.blocks[0].name, "hall");
    CHECK(map.blocks[0].open == (1u << CUBE_RIGHT | 1u << CUBE_TOP));
    CHECK(map.blocks[1].open == 1u << CUBE_LEFT);
    CHECK(map.blocks[0].neighbor[CUBE_RIGHT].block == 1);
    CHECK(map.blocks[1].neighbor[CUBE_LEFT].block == 0);
    CHECK(map.blocks[0].neighbor[CUBE_TOP].block == -1);
    mrt_block_map_finish(&map);
}

TEST(malformed_maps_are_refused_with_the_name_of_the_block)
{
    static const struct {
        const char *text, *name, *why;
    } cases[] = {
        { MAP("{" BOX_A ",'shape':'sphere'}"), "hall", "shape" },
        { MAP("{" BOX_A ",'neighbors':{'+x':'room'}},{'name':'room','box':[[2.1,0,0],[3,1,1]]}"),
          "hall", "does not meet" },
        { MAP("{" BOX_A ",'neighbors':{'-x':'room'}},{" BOX_B "}"), "hall", "does not meet" },
        { MAP("{" BOX_A ",'neighbors':{'+x':'cellar'}},{" BOX_B "}"), "hall", "neighbor" },
        { MAP("{" BOX_A ",'neighbors':{'+x':'hall'}}"), "hall", "neighbor" },
        { MAP("{" BOX_A ",'neighbors':{'+w':'room'}},{" BOX_B "}"), "hall", "face" },
        { MAP("{" BOX_A ",'neighbors':{'+x':7}}"), "hall", "neighbor" },
        { MAP("{" BOX_A ",'neighbors':3}"), "hall", "neighbors" },
        { MAP("{'name':'fold','corners':[[1,0,0],[0,0,0],[0,1,0],[1,1,0],[0,0,1],[1,0,1],[0,1,1],"
              "[1,1,1]]}"),
          "fold", "fold over" },
        { MAP("{'name':'flat','box':[[0,0,0],[1,0,1]]}"), "flat", "flat" },
        { MAP("{'name':'far','box':[[0,0,0],[1e39,1,1]]}"), "far", "largest coordinate, 1e+08 m" },
        { MAP("{'name':'far','box':[[0,0,0],[1e20,1,1]]}"), "far", "largest coordinate" },
        { MAP("{'name':'far','box':[[0,-1.1e8,0],[1,1,1]]}"), "far", "largest coordinate" },
        { MAP("{'name':'far','corners':[[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0,0,1],[1,0,1],[0,1,1],"
              "[1,1,1e9]]}"),
          "far", "largest coordinate" },
        { MAP("{'name':'short','box':[[0,0,0],[1,1]]}"), "short", "box" },
        { MAP("{'name':'few','corners':[[0,0,0]]}"), "few", "corners" },
        { MAP("{" BOX_A "},{" BOX_A "}"), "hall", "name" },
        { MAP("{" BOX_A ",'colour':'red'}"), "hall", "unknown member colour; remove it" },
        { MAP("{" BOX_A ",'neighbours':{}}"), "hall",
          "unknown member neighbours: did you mean neighbors?" },
        { NAMED("'cluter':['table']"), "the map", "unknown member cluter: did you mean clutter?" },
        { NAMED("'comment':'a'"), "the map", "unknown member comment; remove it" },
        { MAP("{" BOX_A ",'open':['-x','+x','-y','+y','-z','+z']}"), "hall", "no wall" },
        { MAP("{'name':'pipe','shape':'straight','open':['+x'],'box':[[0,0,0],[1,1,1]]}"), "pipe",
          "openings" },
        { MAP("{'box':[[0,0,0],[1,1,1]]}"), "block 0", "name" },
        { NAMED("'clutter':'table'"), "clutter", "array" },
        { NAMED("'walls':[7]"), "walls", "array of names" },
        { NAMED("'walls':['']"), "walls", "array of names" },
        { NAMED("'clutter':['table','table']"), "clutter", "table is named twice" },
        { NAMED("'clutter':['table'],'walls':['table']"), "walls", "table is named twice" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct mrt_block_map map;
        CHECK(!read_map(cases[i].text, &map));
        CHECK(map.blocks == NULL && map.named == NULL);
        if (!strstr(test_last_message(), cases[i].name) ||
            !strstr(test_last_message(), cases[i].why))
            fail_msg("case %zu: %s", i, test_last_message());
    }
}

TEST(too_many_blocks_are_refused_with_the_name_of_the_first_beyond)
{
    size_t size = 64 * (MRT_MAX_BLOCKS + 2), length;
    char *text = host_alloc(test_host(), size, 1);
    CHECK(text);
    length = (size_t)snprintf(text, size, "{'afterglow_block_map':1,'blocks':[");
    for (int i = 0; i <= MRT_MAX_BLOCKS; i++)
        length += (size_t)snprintf(text + length, size - length,
                                   "%s{'name':'n%d','box':[[%d,0,0],[%d,1,1]]}", i ? "," : "", i, i,
                                   i + 1);
    snprintf(text + length, size - length, "]}");
    struct mrt_block_map map;
    CHECK(!read_map(text, &map));
    CHECK(strstr(test_last_message(), "n1024") && strstr(test_last_message(), "too many"));
    host_free(test_host(), text);
}

TEST(a_file_names_clutter_and_walls)
{
    struct mrt_block_map map;
    CHECK(read_map(NAMED("'clutter':['table','lamp'],'walls':['door']"), &map));
    CHECK(map.named_count == 3);
    CHECK_STRING(map.named[1].node, "lamp");
    CHECK_STRING(map.named[2].node, "door");
    CHECK(map.named[1].clutter && !map.named[2].clutter);
    mrt_block_map_finish(&map);
}

TEST(a_file_may_name_its_schema)
{
    struct mrt_block_map map;
    CHECK(read_map(NAMED("'$schema':'block-maps.schema.json'"), &map));
    mrt_block_map_finish(&map);
}

// Every prefix, and every byte changed: refused or read, under the sanitizers.
TEST(damaged_files_do_not_crash)
{
    static const char text[] =
        "{'afterglow_block_map':1,'clutter':['table'],'walls':['door'],'blocks':["
        "{" BOX_A ",'open':['+y'],'neighbors':{'+x':'room'}},{" BOX_B "}]}";
    for (size_t i = 0; i + 1 < sizeof text; i++) {
        char copy[sizeof text];
        struct mrt_block_map map;
        memcpy(copy, text, sizeof text);
        copy[i] = '\0';
        CHECK(!read_map(copy, &map));
        memcpy(copy, text, sizeof text);
        copy[i] ^= 1;
        if (read_map(copy, &map)) mrt_block_map_finish(&map);
    }
}

// ---- scenes

static struct mrt_block_map map_of(const char *spec)
{
    struct scene *scene = scene_load(test_host(), spec);
    struct mrt_block_map map;
    CHECK(scene);
    CHECK(mrt_block_map_of_scene(test_host(), scene, &map));
    scene_destroy(scene);
    return map;
}

static int connections(const struct mrt_block_map *map)
{
    int count = 0;
    for (int b = 0; b < map->count; b++)
        for (int f = 0; f < CUBE_FACES; f++) {
            const struct mrt_neighbor *n = &map->blocks[b].neighbor[f];
            CHECK((n->block >= 0) <= mrt_block_is_open(&map->blocks[b], f));
            if (n->block < 0) continue;
            CHECK(map->blocks[n->block].neighbor[n->face].block == b);
            count++;
        }
    return count / 2;
}

TEST(mazes_of_any_size_are_trees_of_cubes)
{
    for (int blocks = 1; blocks <= 101; blocks += 20) {
        char spec[64];
        snprintf(spec, sizeof spec, "@maze:blocks=%d,seed=%d", blocks, blocks);
        struct mrt_block_map map = map_of(spec);
        CHECK(map.count == blocks);
        CHECK(connections(&map) == blocks - 1);
        mrt_block_map_finish(&map);
    }
}

TEST(tunnels_are_chains_of_cylinders_that_can_be_warped_cubes)
{
    for (int seed = 1; seed < 5; seed++) {
        char spec[64];
        snprintf(spec, sizeof spec, "@tunnel:pieces=20,seed=%d", seed);
        struct mrt_block_map map = map_of(spec);
        CHECK(map.count == 20);
        CHECK(connections(&map) == 19 && mrt_block_map_is_tunnel(&map));
        CHECK(mrt_block_map_as_cubes(spec, &map));
        CHECK(connections(&map) == 19 && !mrt_block_map_is_tunnel(&map));
        for (int b = 0; b < map.count; b++) {
            CHECK(map.blocks[b].kind == MRT_BLOCK_CUBE);
            // Ends are walls, the others are open at both ends.
            bool end = b == 0 || b == 19;
            CHECK(map.blocks[b].open == (b == 0 ? 1u << CUBE_FRONT
                                         : end  ? 1u << CUBE_BACK
                                                : 1u << CUBE_FRONT | 1u << CUBE_BACK));
        }
        mrt_block_map_finish(&map);
    }
}

TEST(a_cylinder_beside_a_cube_has_no_cube_that_meets_it)
{
    struct mrt_block_map map;
    CHECK(read_map(MAP("{'name':'pipe','shape':'straight','box':[[0,0,0],[1,1,1]],"
                       "'neighbors':{'+z':'room'}},{'name':'room','box':[[0,0,1],[1,1,2]]}"),
                   &map));
    CHECK(!mrt_block_map_is_tunnel(&map) && !mrt_block_map_as_cubes("the map", &map));
    mrt_block_map_finish(&map);
    CHECK(strstr(test_last_message(), "pipe") && strstr(test_last_message(), "room"));
}

TEST(a_scene_without_blocks_has_an_empty_map)
{
    struct mrt_block_map map = map_of("@cornell");
    CHECK(map.count == 0);
    mrt_block_map_finish(&map);
}

// ' stands for ".
static const char *write_gltf(const char *text)
{
    const char *path = test_path("blocks.gltf");
    FILE *file = fopen(path, "wb");
    CHECK(file);
    for (const char *c = text; *c; c++) fputc(*c == '\'' ? '"' : *c, file);
    CHECK(fclose(file) == 0);
    return path;
}

#define GLTF(nodes)                                                                                \
    "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[" nodes "]}"

TEST(blocks_come_from_the_extras_of_gltf_nodes)
{
    static const char text[] =
        GLTF("{'name':'group','translation':[10,0,0],'children':[1,2],'extras':'text'},"
             "{'name':'a','scale':[2,2,2],'extras':{'other':1,'afterglow_block':"
             "{'neighbors':{'+x':'b'}}}},"
             "{'name':'b','translation':[2,0,0],'scale':[2,2,2],'extras':{'afterglow_block':{}}}");
    struct mrt_block_map map = map_of(write_gltf(text));
    CHECK(map.count == 2 && connections(&map) == 1);
    CHECK_NEAR(map.blocks[0].corner[0].x, 9, 1e-5);
    CHECK_NEAR(map.blocks[1].corner[7].x, 13, 1e-5);
    mrt_block_map_finish(&map);
}

// Corners are in the unit of the file, as nodes are.
TEST(blocks_of_a_scaled_scene_are_scaled)
{
    struct scene *scene = scene_load_scaled(test_host(), "@maze:blocks=3", 2);
    struct mrt_block_map scaled, original = map_of("@maze:blocks=3");
    CHECK(scene && mrt_block_map_of_scene(test_host(), scene, &scaled));
    assert_int_equal(scaled.count, original.count);
    for (int b = 0; b < scaled.count; b++)
        for (int c = 0; c < MRT_CORNERS; c++)
            for (int k = 0; k < 3; k++)
                CHECK_NEAR(scaled.blocks[b].corner[c].raw[k],
                           2 * original.blocks[b].corner[c].raw[k], 1e-5);
    assert_int_equal(connections(&scaled), connections(&original));
    mrt_block_map_finish(&scaled);
    mrt_block_map_finish(&original);
    scene_destroy(scene);
}

static void check_refused(const char *gltf, const char *why)
{
    struct scene *scene = scene_load(test_host(), write_gltf(gltf));
    struct mrt_block_map map;
    CHECK(scene);
    test_forget_messages();
    CHECK(!mrt_block_map_of_scene(test_host(), scene, &map));
    if (!strstr(test_last_message(), why)) fail_msg("%s", test_last_message());
    scene_destroy(scene);
}

TEST(malformed_blocks_in_extras_are_refused_with_the_name_of_the_node)
{
    check_refused(GLTF("{'name':'a','extras':{'afterglow_block':{'box':[[0,0,0],[1e20,1,1]]}}}"),
                  "block a reaches beyond the largest coordinate");
    check_refused(GLTF("{'name':'a','scale':[3e8,1,1],'extras':{'afterglow_block':{}}}"),
                  "block a reaches beyond the largest coordinate");
    check_refused(GLTF("{'name':'a','extras':{'afterglow_block':{'opne':['+y']}}}"),
                  "block a: unknown member opne: did you mean open?");
}
