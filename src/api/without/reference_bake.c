// In place of api/reference_bake.c, in a library without the reference or without bakes.
#include "api/without/absent.h"

enum ag_result ag_bake_create_reference(struct ag_scene *scene, const struct ag_reference_desc *of,
                                        int samples, const struct ag_bake_desc *desc,
                                        struct ag_bake **out)
{
    (void)of;
    (void)samples;
    (void)desc;
    if (out) *out = NULL;
    return api_absent(scene ? scene->context : NULL, __func__, "the reference or without bakes",
                      "AFTERGLOW_REFERENCE=OFF or AFTERGLOW_BAKES");
}

enum ag_result ag_reference_from_bake(const struct ag_bake *bake, struct ag_reference **out)
{
    (void)bake;
    if (out) *out = NULL;
    return api_absent(NULL, __func__, "the reference or without bakes",
                      "AFTERGLOW_REFERENCE=OFF or AFTERGLOW_BAKES");
}
