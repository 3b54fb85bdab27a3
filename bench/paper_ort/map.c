#include "paper_ort/map.h"

#include "bench.h"

#include <math.h>

enum { ROUNDS = 6, LEAST = 64, MOST = 1048576 };

// By a light map of one path a texel, which is at hand sooner than transfer maps.
static enum ag_result measure(struct ag_scene *scene, const char *options, int texels,
                              struct map_size *out)
{
    char gi[4 * BENCH_TEXT];
    struct ag_bake_desc desc;
    struct ag_bake *bake = NULL;
    struct ag_lightmap *map = NULL;
    struct ag_lightmap_info info = { 0 };
    ag_bake_desc_default(&desc);
    desc.lightmap_samples = 1;
    snprintf(gi, sizeof gi, "ort:texels=%d%s%s", texels, options ? "," : "",
             options ? options : "");
    enum ag_result result = ag_bake_create(scene, gi, &desc, &bake);
    if (result == AG_OK) result = ag_bake_run(bake, NULL, NULL);
    if (result == AG_OK) result = ag_lightmap_from_bake(bake, NULL, &map);
    if (result == AG_OK) result = ag_lightmap_get_info(map, &info);
    out->texels_option = texels;
    out->width = info.width;
    out->height = info.has_back ? 2 * info.height : info.height;
    out->texels = info.texels;
    ag_lightmap_destroy(map);
    ag_bake_destroy(bake);
    return result;
}

// Steps of the logarithm of the size.
static double error_of(const struct map_size *size)
{
    return log((double)size->width * size->height / ((double)size->side * size->side));
}

// The share of the map that texels on surfaces fill changes slowly with its size.
enum ag_result map_size_find(struct ag_scene *scene, const char *options, int side,
                             struct map_size *out)
{
    struct map_size now = { .side = side };
    double texels = 0.6 * side * side;
    *out = now;
    for (int round = 0; round < ROUNDS; round++) {
        const int option = (int)lrint(fmin(fmax(texels, LEAST), MOST));
        if (round > 0 && option == now.texels_option) break;
        const enum ag_result result = measure(scene, options, option, &now);
        if (result != AG_OK) return result;
        if (round == 0 || fabs(error_of(&now)) < fabs(error_of(out))) *out = now;
        if (fabs(error_of(out)) < 0.005) break;
        texels = option * exp(-error_of(&now));
    }
    return AG_OK;
}
