// Block maps: checks arguments and forwards to the technique that has one.
#include "api/objects.h"

#include "techniques/gi.h"
#include "techniques/registry.h"

enum { LIST_SIZE = 256 };

struct ag_block_map {
    struct ag_context *context;
    char *json;
};

static bool has_block_map(const struct technique *technique)
{
    return technique->block_map != NULL;
}

static enum ag_result give(struct ag_context *context, char *json, struct ag_block_map **out)
{
    struct ag_block_map *map = json ? host_alloc(&context->host, 1, sizeof *map) : NULL;
    if (!map) {
        host_free(&context->host, json);
        return api_done(context, false);
    }
    map->context = context;
    map->json = json;
    api_context_use(context);
    *out = map;
    return AG_OK;
}

static char *make(struct ag_scene *scene, const struct gi_spec *spec, int animation, double time_s)
{
    struct host *host = &scene->context->host;
    char list[LIST_SIZE];
    int term = 0;
    while (term < spec->count && !has_block_map(spec->technique[term])) term++;
    if (term == spec->count) {
        technique_list(has_block_map, list, sizeof list);
        host_fail(host, FAIL_ARGUMENT,
                  "block map: no technique of the GI spec has one; these have: %s", list);
        return NULL;
    }
    struct scene_pose pose = { 0 };
    char *json = NULL;
    if (api_pose_at(scene, &pose, animation, time_s))
        json = spec->technique[term]->block_map(host, &pose, spec->options[term]);
    pose_finish(&pose);
    return json;
}

enum ag_result ag_block_map_create(struct ag_scene *scene, const char *gi, int animation,
                                   double time_s, struct ag_block_map **out)
{
    struct ag_context *context = scene ? scene->context : NULL;
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, scene, "scene is NULL");
    AG_REQUIRE_POINTER(context, gi);
    AG_REQUIRE(context, api_animation_exists(scene, animation), "animation %d is not one of %d",
               animation, scene->scene->animation_count);
    AG_REQUIRE(context, isfinite(time_s), "time_s is not finite");
    struct gi_spec spec;
    char *json =
        gi_spec_parse(&spec, &context->host, gi) ? make(scene, &spec, animation, time_s) : NULL;
    gi_spec_finish(&spec);
    return give(context, json, out);
}

static char *parse(struct host *host, const char *json)
{
    for (size_t i = 0; techniques[i]; i++)
        if (techniques[i]->read_block_map) return techniques[i]->read_block_map(host, json);
    host_fail(host, FAIL_UNSUPPORTED, "block map: the library was built without mrt and drt");
    return NULL;
}

enum ag_result ag_block_map_parse(struct ag_context *context, const char *json,
                                  struct ag_block_map **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE_POINTER(context, json);
    return give(context, parse(&context->host, json), out);
}

void ag_block_map_destroy(struct ag_block_map *map)
{
    if (!map) return;
    struct ag_context *context = map->context;
    host_free(&context->host, map->json);
    host_free(&context->host, map);
    api_context_release(context);
}

const char *ag_block_map_json(const struct ag_block_map *map)
{
    return map ? map->json : NULL;
}
