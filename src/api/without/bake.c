// In place of api/bake.c and bake_export.c, in a library without bakes. No function has a bake:
// only those with a scene or a context have one for their message.
#include "api/without/absent.h"

static enum ag_result absent(struct ag_context *context, const char *function)
{
    return api_absent(context, function, "bakes", "AFTERGLOW_BAKES");
}

void ag_bake_desc_default(struct ag_bake_desc *desc)
{
    if (desc) *desc = (struct ag_bake_desc){ 0 };
}

// ---- with a context

enum ag_result ag_bake_technique(struct ag_context *context, const char *gi, int index,
                                 const char **name)
{
    (void)gi;
    (void)index;
    if (!name) return absent(context, __func__);
    *name = NULL; // none bakes
    return context ? AG_OK : AG_ERROR_ARGUMENT;
}

enum ag_result ag_bake_technique_in_file(struct ag_context *context, const char *gi, int index,
                                         const char **name)
{
    return ag_bake_technique(context, gi, index, name);
}

enum ag_result ag_bake_file_technique(struct ag_context *context, const char *path, char name[32])
{
    (void)path;
    if (name) name[0] = 0;
    return absent(context, __func__);
}

enum ag_result ag_bake_create(struct ag_scene *scene, const char *gi,
                              const struct ag_bake_desc *desc, struct ag_bake **out)
{
    (void)gi;
    (void)desc;
    if (out) *out = NULL;
    return absent(scene ? scene->context : NULL, __func__);
}

enum ag_result ag_bake_partial_origin(struct ag_context *context, const char *path,
                                      struct ag_bake_origin *out)
{
    (void)path;
    (void)out;
    return absent(context, __func__);
}

// ---- with a bake

void ag_bake_destroy(struct ag_bake *bake)
{
    (void)bake;
}

enum ag_result ag_bake_estimate_cost(struct ag_bake *bake, bool probe, struct ag_bake_estimate *out)
{
    (void)bake;
    (void)probe;
    (void)out;
    return absent(NULL, __func__);
}

enum ag_result ag_bake_estimate(struct ag_bake *bake, bool probe, struct ag_bake_estimate *out)
{
    return ag_bake_estimate_cost(bake, probe, out);
}

enum ag_result ag_bake_set_checkpoint(struct ag_bake *bake, const char *path)
{
    (void)bake;
    (void)path;
    return absent(NULL, __func__);
}

enum ag_result ag_bake_run(struct ag_bake *bake,
                           bool (*progress)(void *user, const struct ag_bake_progress *progress),
                           void *user)
{
    (void)bake;
    (void)progress;
    (void)user;
    return absent(NULL, __func__);
}

void ag_bake_team_default(struct ag_bake_team *team)
{
    if (team) *team = (struct ag_bake_team){ .count = 1 };
}

enum ag_result
ag_bake_run_team(struct ag_bake *bake, const struct ag_bake_team *team,
                 bool (*progress)(void *user, const struct ag_bake_progress *progress), void *user)
{
    (void)bake;
    (void)team;
    (void)progress;
    (void)user;
    return absent(NULL, __func__);
}

enum ag_result ag_bake_save(struct ag_bake *bake, const char *path, bool record_seconds)
{
    (void)bake;
    (void)path;
    (void)record_seconds;
    return absent(NULL, __func__);
}

enum ag_result ag_bake_export(const struct ag_bake *bake, const char *folder)
{
    (void)bake;
    (void)folder;
    return absent(NULL, __func__);
}

enum ag_result ag_bake_load(struct ag_bake *bake, const char *path)
{
    return ag_bake_set_checkpoint(bake, path);
}

enum ag_result ag_bake_remove_checkpoint(struct ag_bake *bake)
{
    (void)bake;
    return absent(NULL, __func__);
}

enum ag_result ag_bake_save_partial(struct ag_bake *bake, const char *path)
{
    return ag_bake_set_checkpoint(bake, path);
}

enum ag_result ag_bake_merge(struct ag_bake *bake, const char *path)
{
    return ag_bake_set_checkpoint(bake, path);
}

enum ag_result ag_bake_get_update(const struct ag_bake *bake, struct ag_bake_update_info *out)
{
    (void)bake;
    (void)out;
    return absent(NULL, __func__);
}

enum ag_result ag_bake_get_info(const struct ag_bake *bake, struct ag_bake_info *out)
{
    (void)bake;
    (void)out;
    return absent(NULL, __func__);
}

enum ag_result ag_bake_get_part(const struct ag_bake *bake, int index, struct ag_bake_part *out)
{
    (void)bake;
    (void)index;
    (void)out;
    return absent(NULL, __func__);
}

enum ag_result ag_bake_load_part(struct ag_bake *bake, int index, const char *path)
{
    (void)index;
    return ag_bake_set_checkpoint(bake, path);
}

enum ag_result ag_bake_save_part(struct ag_bake *bake, int index, const char *path,
                                 bool record_seconds)
{
    (void)index;
    (void)record_seconds;
    return ag_bake_set_checkpoint(bake, path);
}

enum ag_result ag_bake_report(struct ag_bake *bake, const char **json)
{
    (void)bake;
    if (json) *json = NULL;
    return absent(NULL, __func__);
}
