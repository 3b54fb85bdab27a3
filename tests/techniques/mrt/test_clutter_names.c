// Clutter that a block map or a scene names.
#include "framework/test.h"

#include "techniques/mrt/objects/clutter.h"

#include <string.h>

enum { BOX = 12 }; // triangles

// Triangles of the clutter of two pillars in a cube, with one node named; −1: refused.
static int clutter_of(const char *node, bool clutter, const char *extras_of, const char *extras)
{
    struct scene *scene = scene_load(test_host(), "@maze:blocks=1,pillars=2,light=point");
    struct mrt_block_map map;
    struct scene_pose pose;
    size_t count = 0;
    assert_true(scene && mrt_block_map_of_scene(test_host(), scene, &map));
    for (int i = 0; extras_of && i < scene->node_count; i++)
        if (strcmp(scene->nodes[i].name, extras_of) == 0) scene->nodes[i].extras = extras;
    if (node) {
        map.named = host_alloc(test_host(), 1, sizeof *map.named);
        map.named[map.named_count++] =
            (struct mrt_named_part){ host_strdup(test_host(), node), clutter };
    }
    assert_true(pose_init(&pose, scene, -1, 0.0f));
    bool *is_clutter = host_alloc(test_host(), scene_triangle_count(scene), sizeof *is_clutter);
    test_forget_messages();
    const bool ok = mrt_find_clutter(test_host(), &pose, &map, is_clutter, &count);
    host_free(test_host(), is_clutter);
    pose_finish(&pose);
    mrt_block_map_finish(&map);
    scene_destroy(scene);
    return ok ? (int)count : -1;
}

TEST(names_go_before_what_is_found)
{
    const int found = clutter_of(NULL, true, NULL, NULL);
    CHECK(found == 2 * BOX);
    CHECK(clutter_of("pillar 1", true, NULL, NULL) == found);
    CHECK(clutter_of("pillar 1", false, NULL, NULL) == found - BOX);
    CHECK(clutter_of("ceiling", true, NULL, NULL) > found);
    CHECK(clutter_of("ceiling", false, NULL, NULL) == found);
}

TEST(extras_of_nodes_name_clutter_too)
{
    static const char yes[] = "{\"afterglow_clutter\":true}",
                      no[] = "{\"afterglow_clutter\":false}";
    CHECK(clutter_of(NULL, true, "pillar 0", no) == BOX);
    CHECK(clutter_of(NULL, true, "ceiling", yes) > 2 * BOX);
    CHECK(clutter_of(NULL, true, "pillar 0", "{\"afterglow_clutter\":7}") == 2 * BOX);
    // The map goes before them.
    CHECK(clutter_of("pillar 0", true, "pillar 0", no) == 2 * BOX);
}

TEST(a_name_that_the_scene_lacks_is_refused)
{
    CHECK(clutter_of("pilar 1", true, NULL, NULL) < 0);
    CHECK(strstr(test_last_message(), "clutter") && strstr(test_last_message(), "pilar 1") &&
          strstr(test_last_message(), "did you mean \"pillar 1\""));
    CHECK(clutter_of("staircase of the tower", false, NULL, NULL) < 0);
    CHECK(strstr(test_last_message(), "walls") && !strstr(test_last_message(), "did you mean"));
}
