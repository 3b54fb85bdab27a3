#include "environments.h"

#include <stdio.h>
#include <string.h>

const char *const environment_sources[3] = { "scene", "none", "file" };

bool environment_choices_same(const struct environment_choice *a,
                              const struct environment_choice *b)
{
    return a->source == b->source && a->strength == b->strength && a->rotation == b->rotation &&
           (a->source != ENVIRONMENT_FILE || strcmp(a->path, b->path) == 0);
}

enum ag_result environments_begin(struct environments *e, struct ag_context *context,
                                  struct ag_scene *scene, struct environment_choice *first)
{
    struct ag_environment_use use;
    *e = (struct environments){ .context = context, .scene = scene };
    const enum ag_result result = ag_scene_get_environment(scene, &e->first, &use);
    if (result != AG_OK || !e->first) ag_environment_use_default(&use);
    *first =
        (struct environment_choice){ .source = e->first ? ENVIRONMENT_OF_SCENE : ENVIRONMENT_NONE,
                                     .strength = use.strength,
                                     .rotation = use.rotation };
    return result;
}

void environments_end(struct environments *e)
{
    ag_environment_destroy(e->first);
    ag_environment_destroy(e->loaded);
    *e = (struct environments){ 0 };
}

static enum ag_result load(struct environments *e, const char *path)
{
    struct ag_environment *loaded = NULL;
    if (e->loaded && strcmp(path, e->path) == 0) return AG_OK;
    const enum ag_result result = ag_environment_load(e->context, path, &loaded);
    if (result != AG_OK) return result;
    ag_environment_destroy(e->loaded);
    e->loaded = loaded;
    snprintf(e->path, sizeof e->path, "%s", path);
    return AG_OK;
}

enum ag_result environments_set(struct environments *e, const struct environment_choice *choice)
{
    struct ag_environment_use use;
    ag_environment_use_default(&use);
    use.strength = choice->strength;
    use.rotation = choice->rotation;
    const enum ag_result result =
        choice->source == ENVIRONMENT_FILE ? load(e, choice->path) : AG_OK;
    if (result != AG_OK) return result;
    return ag_scene_set_environment(e->scene,
                                    choice->source == ENVIRONMENT_FILE       ? e->loaded
                                    : choice->source == ENVIRONMENT_OF_SCENE ? e->first
                                                                             : NULL,
                                    &use);
}
