// In place of api/lightmap.c, in a library without bakes.
#include "api/renderer/state.h"
#include "api/without/absent.h"

static enum ag_result absent(struct ag_context *context, const char *function)
{
    return api_absent(context, function, "light maps", "AFTERGLOW_BAKES");
}

void ag_lightmap_desc_default(struct ag_lightmap_desc *desc)
{
    if (desc) *desc = (struct ag_lightmap_desc){ 0 };
}

enum ag_result ag_lightmap_technique(struct ag_context *context, const char *gi, const char **name)
{
    (void)gi;
    if (name) *name = NULL;
    return absent(context, __func__);
}

enum ag_result ag_lightmap_count_pages(struct ag_scene *scene, const char *gi, int page, int *count)
{
    (void)gi;
    (void)page;
    if (count) *count = 0;
    return absent(scene ? scene->context : NULL, __func__);
}

enum ag_result ag_lightmap_from_bake(const struct ag_bake *bake,
                                     const struct ag_lightmap_desc *desc, struct ag_lightmap **out)
{
    (void)bake;
    (void)desc;
    if (out) *out = NULL;
    return absent(NULL, __func__);
}

enum ag_result ag_lightmap_from_renderer(struct ag_renderer *renderer,
                                         const struct ag_lightmap_desc *desc,
                                         struct ag_lightmap **out)
{
    (void)desc;
    if (out) *out = NULL;
    return absent(renderer_context(renderer), __func__);
}

void ag_lightmap_destroy(struct ag_lightmap *lightmap)
{
    (void)lightmap;
}

enum ag_result ag_lightmap_get_page(const struct ag_lightmap *lightmap, int page,
                                    struct ag_lightmap_page *out)
{
    (void)lightmap;
    (void)page;
    (void)out;
    return absent(NULL, __func__);
}

enum ag_result ag_lightmap_get_info(const struct ag_lightmap *lightmap,
                                    struct ag_lightmap_info *out)
{
    (void)lightmap;
    (void)out;
    return absent(NULL, __func__);
}

enum ag_result ag_lightmap_read(const struct ag_lightmap *lightmap, bool back,
                                struct ag_image **out)
{
    (void)lightmap;
    (void)back;
    if (out) *out = NULL;
    return absent(NULL, __func__);
}

enum ag_result ag_lightmap_positions(const struct ag_lightmap *lightmap, bool back,
                                     struct ag_image **out)
{
    return ag_lightmap_read(lightmap, back, out);
}

enum ag_result ag_lightmap_report(const struct ag_lightmap *lightmap, const char **json)
{
    (void)lightmap;
    if (json) *json = NULL;
    return absent(NULL, __func__);
}

enum ag_result ag_lightmap_read_layer(const struct ag_lightmap *lightmap,
                                      enum ag_lightmap_layer layer, bool back,
                                      struct ag_image **out)
{
    (void)layer;
    return ag_lightmap_read(lightmap, back, out);
}

enum ag_result ag_lightmap_write(const struct ag_lightmap *lightmap, const char *folder)
{
    (void)lightmap;
    (void)folder;
    return absent(NULL, __func__);
}

enum ag_result ag_lightmap_write_as(const struct ag_lightmap *lightmap, const char *folder,
                                    uint32_t formats)
{
    (void)formats;
    return ag_lightmap_write(lightmap, folder);
}
