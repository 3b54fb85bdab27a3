#include "lightmap/lightmap_fixture.h"

bool fixture_charts(const struct scene_pose *statics, const void *options, struct host *host,
                    struct charts *out)
{
    const int *texels = options;
    const struct charts_options how = { .texels_per_m = 1e3f,
                                        .max_texels = 1 << 18,
                                        .surface_texels = (uint32_t)*texels };
    return charts_init(out, host, statics, &how);
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
    CHECK(bake && lightmap_add_stages(bake_plan_of(bake), &how));
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
