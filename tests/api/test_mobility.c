// Static and movable instances: the flag in glTF extras, and what a technique says that follows no
// movement.
#include "api/renderer_fixture.h"

#include <stdio.h>
#include <string.h>

// ---- glTF extras

#define TRIANGLE                                                                                   \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"                                   \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3',"                   \
    "'min':[0,0,0],'max':[1,1,0]}],'bufferViews':[{'buffer':0,'byteLength':36}],"                  \
    "'buffers':[{'byteLength':36,'uri':'data:application/octet-stream;base64,"                     \
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]"
#define EXTRAS(value) "'extras':{'afterglow_mobility':" value "}"

static struct ag_scene *load(struct ag_context *context, const char *nodes)
{
    char json[4096];
    struct ag_scene *scene = NULL;
    snprintf(json, sizeof json,
             "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[%s]," TRIANGLE
             "}",
             nodes);
    for (char *c = json; *c; c++)
        if (*c == '\'') *c = '"';
    const struct ag_scene_memory_desc desc = { .bytes = json, .size = strlen(json) };
    if (ag_scene_load_memory(context, &desc, &scene) != AG_OK)
        fail_msg("%s", ag_context_last_error(context));
    return scene;
}

static void check_mobility(struct ag_scene *scene, const char *node, enum ag_mobility expected)
{
    struct ag_instance_info info;
    for (int i = 0; ag_scene_get_instance(scene, i, -1, 0.0, &info) == AG_OK; i++) {
        if (strcmp(info.name, node) != 0) continue;
        if (info.mobility != expected) fail_msg("%s is %d", node, (int)info.mobility);
        return;
    }
    fail_msg("no instance at %s", node);
}

TEST(instances_inherit_the_mobility_of_the_nearest_node_that_states_one)
{
    struct ag_context *context = fixture_context();
    fixture_last_warning[0] = 0;
    struct ag_scene *scene = load(
        context,
        "{'name':'root','mesh':0,'children':[1,4]},"
        "{'name':'car','mesh':0,'children':[2]," EXTRAS(
            "'movable'") "},"
                         "{'name':'wheel','mesh':0,'children':[3]},"
                         "{'name':'track','mesh':0," EXTRAS(
                             "'static'") "},"
                                         "{'name':'house','mesh':0,'extras':{'note':'movable'}}");
    check_mobility(scene, "root", AG_MOBILITY_STATIC);
    check_mobility(scene, "car", AG_MOBILITY_MOVABLE);
    check_mobility(scene, "wheel", AG_MOBILITY_MOVABLE);
    check_mobility(scene, "track", AG_MOBILITY_STATIC);
    check_mobility(scene, "house", AG_MOBILITY_STATIC);
    CHECK_STRING(fixture_last_warning, "");
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

TEST(another_mobility_is_ignored_with_a_warning)
{
    static const char *const values[] = { "'dynamic'", "true", "{}" };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        char node[128];
        struct ag_context *context = fixture_context();
        fixture_last_warning[0] = 0;
        snprintf(node, sizeof node, "{'name':'box','mesh':0," EXTRAS("%s") "}", values[i]);
        struct ag_scene *scene = load(context, node);
        check_mobility(scene, "box", AG_MOBILITY_STATIC);
        CHECK(strstr(fixture_last_warning, "afterglow_mobility other than static and movable"));
        ag_scene_destroy(scene);
        ag_context_destroy(context);
    }
}

// ---- Modular radiance transfer keeps the surfaces of its creation

static void open_mrt(struct renderer_fixture *s)
{
    char gi[FIXTURE_SPEC];
    struct ag_technique_info info;
    struct ag_bake *bake = NULL;
    int technique = 0;
    while (ag_technique_get(technique, &info) && strcmp(info.name, "mrt") != 0) technique++;
    *s = fixture_open_lit(NULL);
    fixture_print_base(technique, &info, gi);
    assert_int_equal(ag_bake_create(s->scene, gi, NULL, &bake), AG_OK);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    const struct ag_bake *bakes[1] = { bake };
    desc.bakes = bakes;
    desc.bake_count = 1;
    if (ag_renderer_create(s->device, s->scene, &desc, &s->renderer) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    ag_bake_destroy(bake);
}

// The warning of the next frame; "" for none.
static const char *warning_of_frame(struct renderer_fixture *s)
{
    fixture_last_warning[0] = 0;
    assert_int_equal(ag_renderer_render(s->renderer, &s->frame), AG_OK);
    return fixture_last_warning;
}

static void move_first_instance(struct renderer_fixture *s, float x)
{
    const float matrix[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1 };
    assert_int_equal(ag_scene_set_instance_transform(s->scene, 0, matrix), AG_OK);
}

TEST(mrt_warns_once_of_instances_that_move)
{
    struct renderer_fixture s;
    const float sky[3] = { 1, 2, 3 };
    open_mrt(&s);
    CHECK_STRING(warning_of_frame(&s), "");
    assert_int_equal(ag_scene_set_sky(s.scene, sky), AG_OK); // light is followed
    CHECK_STRING(warning_of_frame(&s), "");
    move_first_instance(&s, 0.25f);
    CHECK(strstr(warning_of_frame(&s), "mrt: the scene's geometry changed"));
    move_first_instance(&s, 0.5f); // it is movable by now
    CHECK_STRING(warning_of_frame(&s), "");
    fixture_close(&s);
}

TEST(lpv_does_not_warn_of_instances_that_move)
{
    struct renderer_fixture s = fixture_open_lit("lpv:dim=8,cascades=1");
    CHECK_STRING(warning_of_frame(&s), "");
    move_first_instance(&s, 0.25f);
    CHECK_STRING(warning_of_frame(&s), "");
    fixture_close(&s);
}
