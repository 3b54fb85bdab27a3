#include "paper_prt/compression.h"

#include "paper_prt/report.h"

#include <math.h>

enum { MOST_CLUSTERS = 4096 }; // of the option

static const double HALF_BYTES = 2.0;

const char *const prt_methods[PRT_METHODS] = { "vq", "pca", "cpca" };
const struct prt_subject prt_subjects[PRT_SUBJECTS] = {
    { "vectors", "coefficients=25,transfer=interreflected", false, 4 * 25, 32, 1.0 / 3.0,
      "compression", "vector_bytes", "compressed_bytes", "squared_error" },
    { "matrices", "coefficients=25,transfer=shadowed,glossy=true", true, 25 * 25, 25, 1.0,
      "compression of matrices", "matrix_bytes", "compressed_matrix_bytes",
      "matrix_squared_error" },
};

static void print_gi(const struct prt_compression *c, const struct prt_setting *setting,
                     char out[GI_SIZE])
{
    char compression[BENCH_TEXT] = "none";
    if (setting)
        snprintf(compression, sizeof compression, "%s,clusters=%d,vectors=%d",
                 prt_methods[setting->method], setting->clusters > 0 ? setting->clusters : 1,
                 setting->vectors > 0 ? setting->vectors : 1);
    snprintf(out, GI_SIZE, "prt:%s,texels=%d,compression=%s%s%s", c->subject->options, c->texels,
             compression, c->options ? "," : "", c->options ? c->options : "");
}

enum ag_result prt_compression_open(struct prt_compression *c, const char *scene)
{
    char gi[GI_SIZE];
    print_gi(c, NULL, gi);
    const enum ag_result result = prt_view_open(&c->view, scene, c->subject->metal);
    return result == AG_OK ? prt_baseline_create(&c->view, gi, &c->baseline) : result;
}

void prt_compression_close(struct prt_compression *c)
{
    prt_baseline_destroy(&c->view, &c->baseline);
    prt_view_close(&c->view);
}

static enum ag_result read_report(const struct prt_compression *c, struct ag_bake *bake,
                                  struct prt_compressed *out)
{
    const char *json = NULL;
    const enum ag_result result = ag_bake_report(bake, &json);
    if (result != AG_OK) return result;
    out->whole_bytes = report_number_of(json, c->subject->whole_bytes);
    out->bytes = report_number_of(json, c->subject->bytes);
    out->error = report_number_of(json, c->subject->error);
    out->seconds = report_seconds_of(json, c->subject->stage);
    out->texels = out->whole_bytes / (HALF_BYTES * c->subject->numbers);
    return AG_OK;
}

enum ag_result prt_compression_measure(const struct prt_compression *c,
                                       const struct prt_setting *setting,
                                       struct prt_compressed *out)
{
    char gi[GI_SIZE];
    const struct prt_view *view = &c->view;
    struct bench_bakes bakes;
    struct ag_renderer *renderer = NULL;
    *out = (struct prt_compressed){ .setting = *setting };
    print_gi(c, setting, gi);
    enum ag_result result = bench_bakes_prepare(&bakes, view->bench->context, view->scene, gi);
    if (result == AG_OK) result = read_report(c, bakes.owned[0], out);
    if (result == AG_OK)
        result = bench_create_baked(view->bench, view->scene, gi, NULL, &bakes, &renderer);
    bench_bakes_finish(&bakes);
    if (result == AG_OK) result = prt_baseline_flip(view, &c->baseline, renderer, &out->flip);
    ag_renderer_destroy(renderer);
    return result;
}

// ---- settings

// A texel has one cluster and v weights, a cluster 1 + v rows of as many numbers as a texel: v does
// not matter.
int prt_clusters_for(const struct prt_compression *c)
{
    const int clusters = (int)(c->subject->codebook * c->texels / c->subject->numbers);
    return clusters > 1 ? clusters : 1;
}

struct prt_setting prt_setting_of_bytes(const struct prt_compression *c, enum prt_method method,
                                        const struct prt_compressed *other)
{
    const double halves = other->bytes / HALF_BYTES, texels = other->texels,
                 numbers = c->subject->numbers;
    struct prt_setting out = { .method = method };
    if (method == PRT_VQ)
        out.clusters = (int)fmin(fmax((halves - texels) / numbers, 1.0), MOST_CLUSTERS);
    else
        out.vectors = (int)fmin(fmax(round(halves / (texels + numbers)) - 1.0, 1.0),
                                c->subject->most_vectors);
    if (method == PRT_PCA) out.clusters = 1;
    return out;
}
