// In place of api/reference.c, in a library without the path-traced reference. No function has a
// reference, so that only ag_reference_create has a context for its message.
#include "api/without/absent.h"

static enum ag_result absent(struct ag_context *context, const char *function)
{
    return api_absent(context, function, "the path-traced reference", "AFTERGLOW_REFERENCE");
}

void ag_reference_desc_default(struct ag_reference_desc *desc)
{
    if (desc) *desc = (struct ag_reference_desc){ 0 };
}

enum ag_result ag_reference_create(struct ag_scene *scene, const struct ag_reference_desc *desc,
                                   struct ag_reference **out)
{
    (void)desc;
    if (out) *out = NULL;
    return absent(scene ? scene->context : NULL, __func__);
}

void ag_reference_destroy(struct ag_reference *reference)
{
    (void)reference;
}

enum ag_result ag_reference_render(struct ag_reference *reference, int samples,
                                   bool (*progress)(void *user, double done), void *user)
{
    (void)reference;
    (void)samples;
    (void)progress;
    (void)user;
    return absent(NULL, __func__);
}

const char *ag_reference_layer_name(int index)
{
    (void)index;
    return NULL;
}

enum ag_result ag_reference_read(struct ag_reference *reference, const char *layer,
                                 struct ag_image **out)
{
    (void)reference;
    (void)layer;
    if (out) *out = NULL;
    return absent(NULL, __func__);
}

enum ag_result ag_reference_get_info(const struct ag_reference *reference,
                                     struct ag_reference_info *out)
{
    (void)reference;
    (void)out;
    return absent(NULL, __func__);
}

const char *ag_reference_checkpoint(const struct ag_reference *reference)
{
    (void)reference;
    return "";
}

enum ag_result ag_reference_resume(struct ag_reference *reference, const char *path)
{
    (void)reference;
    (void)path;
    return absent(NULL, __func__);
}
