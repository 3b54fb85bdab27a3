// view: the block map is edited, written and used.
#include "cli/view/view_run.h"

#define MAZE    "view @maze --quiet --size 480x360 --scale 0.25 --exposure 8 --camera far"
#define METHOD  "mrt:texels=6,rays=1024,modes=12,response_modes=12"
#define BLOCKED " --gi " METHOD

static double bound_of(const char *path, size_t block, size_t side, size_t axis)
{
    json_t *map = json_load_file(path, 0, NULL);
    const json_t *box =
        json_object_get(json_array_get(json_object_get(map, "blocks"), block), "box");
    if (json_array_size(box) != 2) fail_msg("%s: block %zu has no box", path, block);
    const double value = json_number_value(json_array_get(json_array_get(box, side), axis));
    json_decref(map);
    return value;
}

// The map that the scene has gives the image that it gave, whoever wrote it.
TEST(a_written_map_is_used)
{
    require_display();
    run_expect(0, "info @maze --blocks as-info.json", NULL);
    view(MAZE BLOCKED,
         "settle\nsave first.png\nblocks read\nblocks write same.json\nsettle\nsave same.png\n"
         "blocks choose 0\nblocks move +y -1\nblocks write low.json\nsettle\nsave low.png\n"
         "command command.sh\n");
    check_equal("as-info.json", "same.json");
    check_equal("first.png", "same.png");
    check_differ("first.png", "low.png");
    CHECK_NEAR(bound_of("low.json", 0, 1, 1), bound_of("same.json", 0, 1, 1) - 1.0, 1e-5);
    run_expect(0, "info @maze --gi mrt:blocks=low.json --blocks again.json", NULL);
    check_equal("low.json", "again.json");
    view(MAZE " --gi mrt:blocks=low.json,texels=6,rays=1024,modes=12,response_modes=12",
         "settle\nsave loaded.png\n");
    check_equal("low.png", "loaded.png");
}

TEST(a_file_that_is_written_again_is_read_again)
{
    require_display();
    view(MAZE BLOCKED, "settle\nsave first.png\nblocks read\nblocks choose 0\n"
                       "blocks open +x open\nblocks write again.json\nsettle\nsave one.png\n"
                       "blocks choose 1\nblocks open +x open\nblocks write again.json\nsettle\n"
                       "save two.png\nundo\nblocks write again.json\nsettle\nsave last.png\n");
    check_differ("first.png", "one.png");
    check_differ("one.png", "two.png");
    check_equal("one.png", "last.png");
}

// A drag of the handle at the right face of a box widens it; its numbers and openings are edited by
// the panel.
TEST(faces_have_handles)
{
    require_display();
    view("view @maze --quiet --size 900x900 --scale 0.1" BLOCKED,
         "look 0,1.4,1 0,1.4,-4\nsettle\ntab Method\nclick Edit the blocks\nblocks choose 1\n"
         "blocks write before.json\nwait 2\ndrag +x 40 0\nblocks write after.json\n"
         "undo\nundo\nblocks write last.json\n");
    CHECK(bound_of("after.json", 1, 1, 0) > bound_of("before.json", 1, 1, 0) + 0.05);
    CHECK_NEAR(bound_of("after.json", 1, 0, 0), bound_of("before.json", 1, 0, 0), 0);
    check_equal("before.json", "last.json");
}

TEST(blocks_are_added_connected_and_removed)
{
    require_display();
    view(MAZE " --gi none", "fails blocks read\nsays mrt, drt\n"
                            "gi " METHOD "\nsettle\nblocks read\nblocks choose 0\n"
                            "blocks extend +y\nblocks rename attic\nblocks open +y open\n"
                            "blocks write attic.json\nsettle\nblocks duplicate\n"
                            "blocks shift 0,9,0\nblocks remove\nblocks choose 11\n"
                            "blocks remove\n"
                            "blocks write without.json\n");
    json_t *map = json_load_file("attic.json", 0, NULL);
    const json_t *blocks = json_object_get(map, "blocks");
    const json_t *attic = json_array_get(blocks, json_array_size(blocks) - 1);
    CHECK_STRING(json_string_value(json_object_get(attic, "name")), "attic");
    const json_t *below = json_object_get(json_object_get(attic, "neighbors"), "-y");
    CHECK_STRING(json_string_value(below),
                 json_string_value(json_object_get(json_array_get(blocks, 0), "name")));
    CHECK(json_array_size(json_object_get(attic, "open")) == 1);
    json_decref(map);
    run_expect(0, "info @maze --blocks as-info.json", NULL);
    check_equal("without.json", "as-info.json");
}

TEST(a_change_that_is_wrong_leaves_the_map)
{
    require_display();
    view(MAZE BLOCKED,
         "settle\nsave first.png\nfails blocks write none.json\nsays no blocks\n"
         "fails blocks move +x 1\nsays choose a block\nblocks read\nfails blocks choose 999\n"
         "says block 999 is not one of\nblocks choose 0\nfails blocks move +x -100\n"
         "says its corners are mirrored\nfails blocks rename block 1\nsays another has this name\n"
         "fails blocks open +y connect\nsays no face of another block\n"
         "fails blocks corner 0 nan,0,0\nsays not finite\nfails blocks move up 1\nsays a face is\n"
         "fails blocks write missing/a.json\nsays missing/a.json\n"
         "blocks write kept.json\nsettle\nsave last.png\ngi none\nfails blocks write lost.json\n"
         "says choose mrt or drt\n");
    run_expect(0, "info @maze --blocks as-info.json", NULL);
    check_equal("kept.json", "as-info.json");
    check_equal("first.png", "last.png");
    CHECK(!file_exists("lost.json") && !file_exists("none.json"));
}
