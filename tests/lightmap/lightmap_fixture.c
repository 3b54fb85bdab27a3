#include "lightmap/lightmap_fixture.h"

#include "scene/charts/squares.h"

#include <math.h>

bool fixture_charts(const struct scene_pose *statics, const void *options, struct host *host,
                    const struct charts_search *begin, struct charts *out)
{
    const int *texels = options;
    (void)begin; // the density is given
    const struct charts_options how = { .texels_per_m = 1e3f,
                                        .max_texels = 1 << 18,
                                        .surface_texels = (uint32_t)*texels };
    return charts_init(out, host, statics, &how) && charts_order_by_squares(out);
}

struct fixture_box fixture_box(vec3s size, bool inside)
{
    struct fixture_box out;
    for (uint32_t side = 0; side < 6; side++) {
        const int a = (int)side / 2, b = (a + 1) % 3, c = (a + 2) % 3;
        const float sign = side % 2 ? -0.5f : 0.5f;
        for (uint32_t k = 0; k < 4; k++) {
            vec3s *p = &out.at[4 * side + k];
            p->raw[a] = sign * size.raw[a];
            p->raw[b] = (k == 1 || k == 2 ? 0.5f : -0.5f) * size.raw[b];
            p->raw[c] = (k > 1 ? 0.5f : -0.5f) * size.raw[c];
        }
        const bool turned = (sign < 0.0f) != inside;
        const uint32_t order[2][6] = { { 0, 1, 2, 0, 2, 3 }, { 0, 2, 1, 0, 3, 2 } };
        for (uint32_t k = 0; k < 6; k++) out.indices[6 * side + k] = 4 * side + order[turned][k];
    }
    return out;
}

struct bake *fixture_bake(const struct fixture_bake *of)
{
    const struct bake_identity identity = {
        .technique = LIGHTMAP_NAME, .version = 1, .options = "", .program = "test", .seed = of->seed
    };
    const struct lightmap_bake how = { .pose = of->pose,
                                       .samples = of->samples,
                                       .noise = of->noise,
                                       .charts = fixture_charts,
                                       .options = &of->texels };
    struct bake *bake = bake_create(test_host(), &identity);
    CHECK(bake && lightmap_add_stages(bake_plan_of(bake), &how, NULL));
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = of->threads }));
    return bake;
}

const float *fixture_tensor(const struct bake *bake, const char *name)
{
    const struct tensor *tensor = tensors_find(bake_tensors(bake), name);
    assert_non_null(tensor);
    return tensor->data;
}

double fixture_luminance(const float *rest, size_t texel)
{
    const float *row = rest + LIGHTMAP_COLUMNS * texel;
    return (double)luminance(vec3_of(row[0], row[1], row[2]));
}

vec3s fixture_lookup(const struct image *map, vec2s uv)
{
    const float x = uv.x * (float)map->width - 0.5f, y = uv.y * (float)map->height - 0.5f;
    vec3s sum = vec3_of(0, 0, 0);
    for (int k = 0; k < 4; k++) {
        const float column = floorf(x) + (float)(k & 1), row = floorf(y) + (float)(k >> 1);
        const float weight = (1.0f - fabsf(x - column)) * (1.0f - fabsf(y - row));
        if (!(weight > 0.0f)) continue;
        CHECK(column >= 0 && row >= 0 && column < (float)map->width && row < (float)map->height);
        const float *at = image_at(map, (int)column, (int)row);
        sum = glms_vec3_muladds(vec3_of(at[0], at[1], at[2]), weight, sum);
    }
    return sum;
}
