// Block maps through the public interface: the text is a file that gives the same map.
#include "framework/test.h"

#include <afterglow/afterglow.h>

#include <stdio.h>
#include <string.h>

static struct ag_context *context;
static struct ag_scene *scene;

static void open_scene(const char *name)
{
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    assert_int_equal(ag_scene_load(context, name, &scene), AG_OK);
}

static void close_scene(void)
{
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

static struct ag_block_map *map_of(const char *gi)
{
    struct ag_block_map *map = NULL;
    if (ag_block_map_create(scene, gi, 0, 0.0, &map) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(context));
    return map;
}

static void write_map(const char *name, const char *text)
{
    FILE *file = fopen(test_path(name), "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static int count_in(const char *text, const char *part)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, part)); at++) count++;
    return count;
}

static void check_round_trip(const char *name, const char *technique, const char *options,
                             int least)
{
    char gi[1024];
    open_scene(name);
    snprintf(gi, sizeof gi, "%s%s", technique, options);
    struct ag_block_map *map = map_of(gi);
    const char *text = ag_block_map_json(map);
    write_map("map.json", text);
    snprintf(gi, sizeof gi, "%s:blocks=%s", technique, test_path("map.json"));
    struct ag_block_map *again = map_of(gi), *parsed = NULL;
    if (count_in(text, "\"name\"") < least) fail_msg("%s: too few blocks: %s", name, text);
    CHECK_STRING(ag_block_map_json(again), text);
    ag_block_map_destroy(again);
    if (ag_block_map_parse(context, text, &parsed) != AG_OK)
        fail_msg("%s", ag_context_last_error(context));
    CHECK_STRING(ag_block_map_json(parsed), text);
    ag_block_map_destroy(parsed);
    close_scene();
    CHECK(count_in(ag_block_map_json(map), "\"name\"") >= least); // without scene and context
    ag_block_map_destroy(map);
}

TEST(a_written_map_is_read_as_the_same_map)
{
    check_round_trip("@cornell", "mrt", ":map=single", 1);
    check_round_trip("@maze", "mrt", "", 8);
    check_round_trip("@maze", "drt", "", 8);
    check_round_trip("@maze", "mrt", ":map=auto", 2);
    check_round_trip("@tunnel", "mrt", "", 3);
    check_round_trip("@tunnel", "mrt", ":maze=plane", 3);
}

TEST(names_of_clutter_are_kept)
{
    open_scene("@cornell:light=point");
    struct ag_scene_info info;
    struct ag_instance_info first;
    char text[512], gi[512];
    assert_int_equal(ag_scene_get_info(scene, -1, 0.0, &info), AG_OK);
    assert_int_equal(ag_scene_get_instance(scene, 0, -1, 0.0, &first), AG_OK);
    snprintf(text, sizeof text,
             "{\"afterglow_block_map\": 1, \"blocks\": [{\"name\": \"a\", \"box\": [[0, 0, 0], "
             "[1.1, 2, 3]], \"open\": [\"+y\"]}], \"clutter\": [\"%s\"]}",
             first.name);
    write_map("named.json", text);
    snprintf(gi, sizeof gi, "mrt:blocks=%s", test_path("named.json"));
    struct ag_block_map *map = map_of(gi);
    const char *json = ag_block_map_json(map);
    CHECK(strstr(json, "\"clutter\"") && strstr(json, first.name) && strstr(json, "1.1,"));
    CHECK(strstr(json, "\"+y\"") && !strstr(json, "\"walls\"") && !strstr(json, "\"neighbors\""));
    ag_block_map_destroy(map);
    close_scene();
}

static void check_refused(const char *gi, enum ag_result expected, const char *names)
{
    struct ag_block_map *map = (struct ag_block_map *)1;
    assert_int_equal(ag_block_map_create(scene, gi, 0, 0.0, &map), expected);
    assert_null(map);
    if (!strstr(ag_context_last_error(context), names))
        fail_msg("%s: %s", gi, ag_context_last_error(context));
}

TEST(what_has_no_map_is_refused)
{
    char gi[512];
    struct ag_block_map *map = NULL;
    open_scene("@cornell");
    check_refused("lpv+vo", AG_ERROR_ARGUMENT, "these have: mrt, drt");
    check_refused("mtr", AG_ERROR_ARGUMENT, "mrt");
    check_refused(NULL, AG_ERROR_ARGUMENT, "gi is NULL");
    check_refused("mrt:map=single,blocks=a.json", AG_ERROR_ARGUMENT, "two maps");
    write_map("broken.json", "{\"afterglow_block_map\": 1, \"blocks\": [{\"name\": \"a\", "
                             "\"box\": [[0, 0, 0], [0, 1, 1]]}]}");
    snprintf(gi, sizeof gi, "drt:blocks=%s", test_path("broken.json"));
    check_refused(gi, AG_ERROR_FORMAT, "block a: ");
    assert_int_equal(ag_block_map_create(scene, "mrt", 9, 0.0, &map), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_block_map_create(NULL, "mrt", 0, 0.0, &map), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_block_map_create(scene, "mrt", 0, 0.0, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_block_map_parse(context, "{\n[", &map), AG_ERROR_FORMAT);
    CHECK(strstr(ag_context_last_error(context), "block map: line 2"));
    assert_int_equal(ag_block_map_parse(context, "{\"blocks\": []}", &map), AG_ERROR_FORMAT);
    assert_null(map);
    assert_int_equal(ag_block_map_parse(context, NULL, &map), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_block_map_parse(NULL, "{}", &map), AG_ERROR_ARGUMENT);
    assert_null(ag_block_map_json(NULL));
    ag_block_map_destroy(NULL);
    close_scene();
}
