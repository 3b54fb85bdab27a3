// Painted light of random texels: the light map of the GPU has it and what the bake transfers of
// it.
#include "techniques/ort/bake_fixture.h"
#include "techniques/trials/paint_fixture.h"

#include <math.h>
#include <stdlib.h>

struct gpu_side {
    struct baked_fixture run; // its stack alone
    struct paint_fixture paint;
};

static void open_stack(struct gpu_side *g, struct ort_fixture *f, const struct ort_baked *baked,
                       struct gpu *gpu, const char *text)
{
    struct frame_fixture *s = &f->s;
    const struct gi_bakes bakes = { .of_term = { baked->tensors } };
    *g = (struct gpu_side){ 0 };
    s->gpu = gpu;
    fixture_open_frame(s);
    CHECK(gi_spec_parse(&g->run.spec, test_host(), text));
    g->run.gi =
        gi_create_baked(test_host(), gpu, &g->run.spec, &bakes, &s->pose, s->width, s->height);
    assert_non_null(g->run.gi);
    s->indirect = gi_hook(g->run.gi);
    paint_fixture_open(&g->paint, s, &g->run);
}

static void close_stack(struct gpu_side *g)
{
    paint_fixture_close(&g->paint);
    gi_destroy(g->run.gi);
    gi_spec_finish(&g->run.spec);
}

// Irradiance of texels in the light map, [texels][3]. The caller frees it.
static float *read_light_map(const struct gpu_side *g, const struct ort_fixture *f)
{
    int term;
    gpu_image image;
    const struct charts *charts = &f->map.charts;
    const size_t count = 4 * (size_t)charts->width * charts->height;
    float *out = ort_texel_floats(f), *layer = calloc(count, sizeof *layer);
    assert_non_null(layer);
    CHECK(gi_light_map(g->run.gi, &term, &image));
    for (uint32_t c = 0; c < 3; c++) {
        CHECK(gpu_image_download_float(f->s.gpu, image, 0, c, layer, 4, count));
        for (uint32_t i = 0; i < f->map.texel_count; i++) {
            const struct chart_texel *t = chart_texel_of(charts, i);
            out[3 * i + c] =
                layer[4 * ((size_t)t->y * charts->width + t->x)] / frame_radiance_scale(f->s.frame);
        }
    }
    free(layer);
    return out;
}

static double worst_difference(struct ort_fixture *f, const struct ort_baked *baked,
                               struct gpu_side *g, uint32_t seed)
{
    float *light = ort_texel_floats(f), *indirect = ort_texel_floats(f);
    double worst = 0.0;
    ort_random_light(f, seed % 2 ? ORT_SPOTS : ORT_SMOOTH, seed, light);
    ort_indirect_prefiltered(f, baked, light, indirect);
    paint_fixture_set(&g->paint, light);
    fixture_render(&f->s);
    float *e = read_light_map(g, f);
    for (size_t i = 0; i < 3 * (size_t)f->map.texel_count; i++) {
        const double expected = (double)light[i] + (double)indirect[i];
        worst = fmax(worst, fabs((double)e[i] - expected) / expected);
    }
    free(e);
    free(light);
    free(indirect);
    return worst;
}

TEST_GPU(light_map_has_paint_and_its_transfer)
{
    enum { SEEDS = 4 };
    // Half floats of the light, of six passes of its levels, and of texels.
    const double rounding = (3 + 6) * 0x1p-11;
    struct ort_fixture f;
    struct gpu_side g;
    ort_fixture_boxes(&f);
    ort_fixture_open(&f, "texels=1024,offsets=100,seams=false");
    struct ort_baked baked = ort_fixture_bake(&f, "", 0);
    open_stack(&g, &f, &baked, gpu, "ort:texels=1024,offsets=100,seams=false");
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        const double worst = worst_difference(&f, &baked, &g, seed);
        print_message("seed %u: differs by %.2g\n", seed, worst);
        CHECK(worst <= rounding);
    }
    close_stack(&g);
    ort_baked_finish(&baked);
    ort_fixture_close(&f);
}
