// Block maps as the viewer edits them: faces move with their neighbours, openings follow the
// geometry, and the text is that of a map.
#include "viewer/blocks/blocks.h"

#include "framework/test.h"

#include <stdlib.h>
#include <string.h>

// Three cubes of 2 m in a row, "b" in the middle, and "d" on top of "a".
static const char ROW[] =
    "{\"afterglow_block_map\": 1, \"blocks\": ["
    "{\"name\": \"a\", \"box\": [[0, 0, 0], [2, 2, 2]], \"open\": [\"-x\"],"
    " \"neighbors\": {\"+x\": \"b\", \"+y\": \"d\"}},"
    "{\"name\": \"b\", \"box\": [[2, 0, 0], [4, 2, 2]],"
    " \"neighbors\": {\"-x\": \"a\", \"+x\": \"c\"}},"
    "{\"name\": \"c\", \"box\": [[4, 0, 0], [6, 2, 2]], \"neighbors\": {\"-x\": \"b\"}},"
    "{\"name\": \"d\", \"box\": [[0, 2, 0], [2, 4, 2]], \"neighbors\": {\"-y\": \"a\"}}],"
    "\"clutter\": [\"vase\"]}";
enum { A, B, C, D };
enum { LOW_X, HIGH_X, LOW_Y, HIGH_Y, LOW_Z, HIGH_Z };

static struct blocks row(void)
{
    struct blocks blocks;
    CHECK(blocks_parse(&blocks, ROW) && blocks.count == 4);
    return blocks;
}

static void check_box(const struct block *block, float x0, float x1, float y0, float y1)
{
    float low[3], high[3];
    block_bounds(block, low, high);
    CHECK(block_is_box(block));
    CHECK(low[0] == x0 && high[0] == x1 && low[1] == y0 && high[1] == y1);
}

TEST(a_map_is_written_as_it_was_read)
{
    struct blocks blocks = row(), again;
    char *text = blocks_print(&blocks);
    CHECK(text && blocks_parse(&again, text) && blocks_same(&blocks, &again));
    CHECK(strstr(text, "\"vase\""));
    CHECK(again.at[A].open[LOW_X] && !again.at[A].open[HIGH_X] &&
          again.at[A].neighbor[HIGH_X] == B);
    blocks_move_face(&again, A, LOW_X, (const float[3]){ -1, 0, 0 });
    CHECK(!blocks_same(&blocks, &again));
    free(text);
    blocks_close(&again);
    blocks_close(&blocks);
}

TEST(normals_point_outwards)
{
    struct blocks blocks = row();
    for (int f = 0; f < BLOCK_FACES; f++) {
        float normal[3], middle[3], centre[3];
        block_face_normal(&blocks.at[B], f, normal);
        block_face_centre(&blocks.at[B], f, middle);
        block_centre(&blocks.at[B], centre);
        for (int k = 0; k < 3; k++) {
            const float expected = k == f / 2 ? (f % 2 ? 1.0f : -1.0f) : 0.0f;
            CHECK_NEAR(normal[k], expected, 1e-6);
            CHECK_NEAR(middle[k] - centre[k], expected, 1e-6);
        }
    }
    blocks_close(&blocks);
}

// "a" and "b" share a face; the lid of "a" is shorter than the floor of "d" then.
TEST(a_face_moves_with_that_of_its_neighbor)
{
    struct blocks blocks = row();
    blocks_move_face(&blocks, B, HIGH_X, (const float[3]){ 0.5f, 0, 0 });
    check_box(&blocks.at[B], 2, 4.5f, 0, 2);
    check_box(&blocks.at[C], 4.5f, 6, 0, 2);
    CHECK(blocks_disconnect(&blocks) == 0);
    blocks_move_face(&blocks, B, LOW_X, (const float[3]){ -0.5f, 0, 0 });
    check_box(&blocks.at[A], 0, 1.5f, 0, 2);
    check_box(&blocks.at[D], 0, 2, 2, 4);
    CHECK(blocks_disconnect(&blocks) == 1);
    CHECK(block_opening(&blocks.at[A], HIGH_Y) == OPENING_WALL);
    CHECK(block_opening(&blocks.at[D], LOW_Y) == OPENING_WALL);
    CHECK(blocks.at[A].neighbor[HIGH_X] == B && blocks.at[B].neighbor[LOW_X] == A);
    blocks_close(&blocks);
}

TEST(a_block_that_is_shifted_leaves_its_neighbors)
{
    struct blocks blocks = row();
    blocks_shift(&blocks, B, (const float[3]){ 0, 0.5f, 0 });
    check_box(&blocks.at[B], 2, 4, 0.5f, 2.5f);
    CHECK(blocks_disconnect(&blocks) == 2 && blocks.at[A].neighbor[HIGH_X] == -1);
    blocks_shift(&blocks, B, (const float[3]){ 0, -0.5f, 0 });
    CHECK(blocks_meeting(&blocks, A, HIGH_X) == B && blocks_meeting(&blocks, B, HIGH_X) == C);
    blocks_close(&blocks);
}

TEST(joined_blocks_keep_their_openings)
{
    struct blocks blocks = row();
    blocks_move_joined(&blocks, B, LOW_X, (const float[3]){ -0.5f, 0, 0 });
    check_box(&blocks.at[B], 1.5f, 4, 0, 2);
    check_box(&blocks.at[A], 0, 1.5f, 0, 2);
    CHECK(!block_is_box(&blocks.at[D])); // its floor is as long as the lid of "a"
    CHECK(blocks.at[D].corner[1][0] == 1.5f && blocks.at[D].corner[3][0] == 2.0f);
    CHECK(blocks_disconnect(&blocks) == 0);
    blocks_close(&blocks);
}

TEST(openings_lead_to_blocks_that_meet)
{
    struct blocks blocks = row();
    CHECK(blocks_meeting(&blocks, A, HIGH_X) == B && blocks_meeting(&blocks, C, HIGH_X) == -1);
    CHECK(!blocks_set_opening(&blocks, C, HIGH_X, OPENING_NEIGHBOR));
    CHECK(blocks_set_opening(&blocks, A, HIGH_X, OPENING_WALL));
    CHECK(blocks.at[B].neighbor[LOW_X] == -1);
    CHECK(blocks_set_opening(&blocks, B, LOW_X, OPENING_OPEN));
    CHECK(block_opening(&blocks.at[A], HIGH_X) == OPENING_WALL);
    CHECK(blocks_set_opening(&blocks, A, HIGH_X, OPENING_NEIGHBOR));
    CHECK(blocks.at[B].neighbor[LOW_X] == A && !blocks.at[B].open[LOW_X]);
    // The same faces in the same place look the same way: they are no opening.
    const int copy = blocks_add(&blocks, &blocks.at[C]);
    CHECK(blocks_meeting(&blocks, copy, LOW_X) == -1); // that of "b" leads to "c"
    CHECK(blocks_meeting(&blocks, copy, HIGH_X) == -1);
    blocks_close(&blocks);
}

TEST(blocks_come_and_go)
{
    struct blocks blocks = row();
    const int beyond = blocks_extend(&blocks, C, HIGH_X);
    CHECK(beyond == 4 && blocks.at[C].neighbor[HIGH_X] == beyond);
    check_box(&blocks.at[beyond], 6, 8, 0, 2);
    CHECK(blocks.at[beyond].neighbor[LOW_X] == C && blocks_disconnect(&blocks) == 0);
    CHECK(blocks_extend(&blocks, C, HIGH_X) == -1);
    const int copy = blocks_add(&blocks, &blocks.at[A]);
    CHECK(strcmp(blocks.at[copy].name, "a") != 0 && blocks.at[copy].neighbor[HIGH_X] == -1);
    blocks_remove(&blocks, B);
    CHECK(blocks.count == 5 && strcmp(blocks.at[1].name, "c") == 0);
    CHECK(blocks.at[A].neighbor[HIGH_X] == -1 && blocks.at[A].neighbor[HIGH_Y] == 2);
    CHECK(blocks.at[1].neighbor[LOW_X] == -1 && blocks.at[1].neighbor[HIGH_X] == 3);
    while (blocks.count > 0) blocks_remove(&blocks, 0);
    CHECK(blocks_extend(&blocks, blocks_add(&blocks, &(struct block){ .shape = "cube" }), 0) == 1);
    blocks_close(&blocks);
}

TEST(a_full_map_takes_no_block)
{
    struct blocks blocks = row();
    while (blocks.count < BLOCKS_MOST) CHECK(blocks_add(&blocks, &blocks.at[A]) >= 0);
    CHECK(blocks_add(&blocks, &blocks.at[A]) == -1 && blocks_extend(&blocks, C, HIGH_X) == -1);
    CHECK(blocks.at[C].neighbor[HIGH_X] == -1);
    blocks_close(&blocks);
}
