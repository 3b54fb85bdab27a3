// Options of modular radiance transfer that depend on the scene: maze=auto and block maps in files.
#include "framework/test.h"
#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"

#include <stdio.h>
#include <string.h>

struct loaded {
    struct scene *scene;
    struct scene_pose pose;
};

static struct loaded load(const char *spec)
{
    struct loaded loaded = { .scene = scene_load(test_host(), spec) };
    CHECK(loaded.scene && pose_init(&loaded.pose, loaded.scene, -1, 0.0f));
    return loaded;
}

static void unload(struct loaded *loaded)
{
    pose_finish(&loaded->pose);
    scene_destroy(loaded->scene);
}

// The bake's options; NULL: refused.
static char *bake_options(const char *gi, const char *scene)
{
    struct loaded loaded = load(scene);
    struct gi_spec spec;
    test_forget_messages();
    CHECK(gi_spec_parse(&spec, test_host(), gi));
    const struct technique_bake how = { .pose = &loaded.pose, .options = spec.options[0] };
    struct bake *bake = gi_bake_create(test_host(), spec.technique[0], &how,
                                       (struct bake_identity){ .program = "test" });
    char *text = bake ? host_strdup(test_host(), bake_options_text(bake)) : NULL;
    bake_destroy(bake);
    gi_spec_finish(&spec);
    unload(&loaded);
    return text;
}

static void check_maze(const char *gi, const char *scene, const char *maze)
{
    char expected[64];
    char *text = bake_options(gi, scene);
    snprintf(expected, sizeof expected, "maze=%s,", maze);
    if (!text || strncmp(text, expected, strlen(expected)) != 0)
        fail_msg("%s %s: %s, not %s (%s)", gi, scene, text ? text : "refused", expected,
                 test_last_message());
    host_free(test_host(), text);
}

// The key of the cache has the dictionary that was chosen, so scenes share it.
TEST(the_bake_has_the_dictionary_that_the_blocks_need)
{
    check_maze("mrt", "@maze:blocks=5", "plane");
    check_maze("mrt:map=auto", "@corridor", "plane");
    check_maze("mrt", "@corridor", "plane");
    check_maze("mrt:map=auto", "@atrium", "space");
    check_maze("mrt:map=single", "@atrium", "plane");
    check_maze("mrt:maze=space", "@maze:blocks=5", "space");
    check_maze("mrt:map=single,maze=tunnel", "@cornell", "tunnel");
    check_maze("mrt", "@tunnel", "tunnel");
    check_maze("mrt:maze=plane", "@tunnel", "plane");
    check_maze("mrt:map=single", "@tunnel", "plane");
}

static void write_map(const char *path, const char *blocks)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "{ \"afterglow_block_map\": 1, \"blocks\": [ %s ] }", blocks);
    fclose(file);
}

TEST(a_block_map_comes_from_a_file)
{
    write_map("mrt-a,b+c%d.json", "{ \"name\": \"hall\", \"box\": [[-1, 0, -1], [1, 2, 1]], "
                                  "\"open\": [\"+y\"] }");
    check_maze("mrt:blocks=mrt-a%2Cb%2Bc%25d.json", "@cornell", "space");
    write_map("mrt-a,b+c%d.json", "{ \"name\": \"hall\", \"box\": [[-1, 0, -1], [1, 2, 1]], "
                                  "\"open\": [\"+z\"] }");
    check_maze("mrt:blocks=mrt-a%2Cb%2Bc%25d.json", "@cornell", "plane");
    remove("mrt-a,b+c%d.json");
}

TEST(a_wrong_file_is_refused_by_its_name_and_that_of_the_block)
{
    CHECK(!bake_options("mrt:blocks=mrt-none.json", "@cornell"));
    CHECK(strstr(test_last_message(), "mrt-none.json"));
    write_map("mrt-folded.json", "{ \"name\": \"hall\", \"box\": [[1, 0, -1], [-1, 2, 1]] }");
    CHECK(!bake_options("mrt:blocks=mrt-folded.json", "@cornell"));
    CHECK_STRING(test_last_message(),
                 "mrt-folded.json: block hall: its corners are mirrored, flat or fold over");
    assert_int_equal(test_host()->failure, FAIL_FORMAT);
    remove("mrt-folded.json");
}

TEST(a_file_and_another_map_are_refused)
{
    struct gi_spec spec;
    struct loaded loaded = load("@cornell");
    CHECK(gi_spec_parse(&spec, test_host(), "mrt:map=auto,blocks=a.json"));
    const struct technique_create how = { .host = test_host(),
                                          .pose = &loaded.pose,
                                          .options = spec.options[0] };
    CHECK(!spec.technique[0]->check(&how));
    CHECK_STRING(test_last_message(),
                 "gi mrt: map and blocks=a.json are two maps; leave out one of them");
    gi_spec_finish(&spec);
    unload(&loaded);
}
