// Light maps: checks arguments and forwards to lightmap/ and the techniques.
#include "api/lightmap_state.h"
#include "api/renderer/state.h"

#include "lightmap/denoise.h"

#include <math.h>
#include <string.h>

void ag_lightmap_desc_default(struct ag_lightmap_desc *desc)
{
    if (desc) *desc = (struct ag_lightmap_desc){ 0 };
}

enum ag_result ag_lightmap_technique(struct ag_context *context, const char *gi, const char **name)
{
    AG_REQUIRE_OUT(context, name);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE_POINTER(context, gi);
    struct gi_spec spec;
    const bool ok = gi_spec_parse(&spec, &context->host, gi);
    const int term = ok ? api_lightmap_term(&spec) : -1;
    if (term >= 0) *name = spec.technique[term]->name;
    gi_spec_finish(&spec);
    return api_done(context, ok);
}

// ---- creation

// 0: the options give a number of texels.
static float wanted_density(const struct technique *technique, const void *options)
{
    const struct option_row *row = option_find(&technique->options, "density");
    return row && row->type == OPTION_TYPE_float32
               ? *(const float *)((const char *)options + row->offset)
               : 0.0f;
}

// known: the charts, made before; NULL: they are made.
static bool make_map(struct ag_lightmap *l, const struct gi_spec *spec, int term,
                     const struct scene_pose *pose, const struct charts *known)
{
    struct host *host = &l->context->host;
    struct scene_statics statics;
    struct charts charts = { 0 };
    if (!scene_statics_init(&statics, host, pose)) return false;
    bool ok = known ? charts_copy(&charts, known, pose->scene->instance_count)
                    : spec->technique[term]->charts(&statics.pose, spec->options[term], host, NULL,
                                                    &charts);
    ok = ok && lightmap_init(&l->map, &charts, pose->scene);
    scene_statics_finish(&statics);
    l->gi = ok ? gi_spec_print(spec) : NULL;
    l->wanted_density = wanted_density(spec->technique[term], spec->options[term]);
    l->facts.gi = l->gi;
    return l->gi;
}

static enum ag_result begin(const char *function, struct ag_scene *scene,
                            const struct ag_lightmap_desc *desc, struct ag_lightmap **out)
{
    struct ag_context *context = scene->context;
    AG_REQUIRE_KNOWN(function, context, desc);
    const enum ag_result checked =
        desc->page == 0 ? AG_OK : api_lightmap_check_page(function, context, desc->page);
    if (checked != AG_OK) return checked;
    struct ag_lightmap *l = host_alloc(&context->host, 1, sizeof *l);
    if (!l) return api_done(context, false);
    l->context = context;
    l->scene = scene;
    l->noise.largest = NAN;
    l->facts.punctual = !desc->indirect_only;
    l->no_light = desc->no_light;
    api_scene_use(scene, &scene->bakes);
    *out = l;
    return AG_OK;
}

static bool denoise(struct ag_lightmap *l, const struct ag_lightmap_desc *desc)
{
    const bool filtered = l->facts.samples > 0 && !lightmap_has_denoiser();
    return !desc->denoise || filtered || lightmap_denoise(&l->map);
}

// report: measures the quality, too.
static bool close_seams(struct ag_lightmap *l, bool report)
{
    struct seam_closing closing;
    bool ok =
        seam_closing_init(&closing, &l->context->host, &l->map.charts, l->tracing.scene.trace);
    if (report) ok = ok && quality_begin(&l->quality, &l->map, &closing);
    ok = ok && lightmap_close(&l->map, &closing);
    if (report)
        ok = ok && quality_measure(&l->quality, &l->map, &closing, &l->tracing, l->wanted_density);
    seam_closing_finish(&closing);
    return ok && (!report || api_lightmap_write_report(l));
}

static enum ag_result done(struct ag_lightmap *l, const struct ag_lightmap_desc *desc, bool ok,
                           struct ag_lightmap **out)
{
    if (desc->page > 0)
        ok = ok && lightmap_set_pages(&l->map, l->scene->scene, (uint32_t)desc->page);
    if (!desc->no_light) ok = ok && denoise(l, desc) && close_seams(l, desc->report);
    lightmap_tracing_finish(&l->tracing);
    const enum ag_result result = api_done(l->context, ok);
    if (ok)
        *out = l;
    else
        ag_lightmap_destroy(l);
    return result;
}

enum ag_result ag_lightmap_from_bake(const struct ag_bake *bake,
                                     const struct ag_lightmap_desc *desc, struct ag_lightmap **out)
{
    struct ag_context *context = bake ? bake->context : NULL;
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, bake, "bake is NULL");
    AG_REQUIRE(context, bake->lightmap_samples > 0,
               "the bake is of a technique: set lightmap_samples");
    AG_REQUIRE(context, bake_is_complete(bake->bake), "the bake is incomplete: run it first");
    const struct ag_lightmap_desc fallback = { 0 };
    struct ag_lightmap *l = NULL;
    if (!desc) desc = &fallback;
    const enum ag_result begun = begin(__func__, bake->scene, desc, &l);
    if (begun != AG_OK) return begun;
    l->facts.samples = bake->lightmap_samples;
    bool ok = make_map(l, &bake->spec, bake->term, &bake->pose, bake->charts);
    if (!desc->no_light)
        ok = ok && lightmap_tracing_init(&l->tracing, &bake->pose, &l->map.charts) &&
             lightmap_set_paths(&l->map, bake_tensors(bake->bake), !desc->indirect_only,
                                desc->denoise && !lightmap_has_denoiser()) &&
             lightmap_noise_read(&l->map, bake_tensors(bake->bake), bake->lightmap_samples,
                                 bake->lightmap_noise, &l->noise) &&
             api_update_record(bake, &l->map.charts, &l->record);
    if (ok && !desc->no_light) l->facts.record = &l->record;
    return done(l, desc, ok, out);
}

// ---- of a renderer

enum { CHANNELS = 4 };

static bool download(struct ag_renderer *r, const struct lightmap *map, gpu_image image,
                     float *pixels, struct lightmap_layers *out)
{
    struct gpu *gpu = r->device->gpu;
    const size_t count = (size_t)map->charts.width * map->charts.height * CHANNELS;
    *out = (struct lightmap_layers){ .scale = frame_radiance_scale(r->main.frame) };
    for (int side = 0; side < (map->has_back ? 2 : 1); side++)
        for (int c = 0; c < 3; c++) {
            float *at = pixels + count * (size_t)(3 * side + c);
            out->at[side][c] = at;
            if (!gpu_image_download_float(gpu, image, 0, (uint32_t)(3 * side + c), at, CHANNELS,
                                          count))
                return false;
        }
    return true;
}

static bool has_size_of(const struct lightmap *map, const struct gpu_image_desc *size)
{
    return size->width == map->charts.width && size->height == map->charts.height;
}

// Whether the technique's map has the direct light of punctual lights, as where light scatters.
static bool has_direct_light(const struct ag_renderer *r)
{
    return (gi_spec_needs(&r->spec) & FRAME_NEEDS_DIRECT_IRRADIANCE) != 0;
}

static bool set_layers(struct ag_lightmap *l, struct ag_renderer *r, gpu_image image)
{
    struct host *host = &l->context->host;
    struct lightmap_layers layers;
    if (!has_size_of(&l->map, gpu_image_info(r->device->gpu, image)))
        return host_fail(host, FAIL_ARGUMENT, "light map of %s: its static surfaces have changed",
                         l->scene->scene->name);
    if (l->no_light) return true;
    const size_t texels = (size_t)l->map.charts.width * l->map.charts.height;
    float *pixels = host_alloc(host, texels * 6, CHANNELS * sizeof *pixels);
    const bool ok = pixels && download(r, &l->map, image, pixels, &layers) &&
                    lightmap_tracing_init(&l->tracing, &r->pose, &l->map.charts) &&
                    lightmap_set_layers(&l->map, &l->tracing, &layers,
                                        l->facts.punctual && !has_direct_light(r));
    host_free(host, pixels);
    return ok;
}

enum ag_result ag_lightmap_from_renderer(struct ag_renderer *r, const struct ag_lightmap_desc *desc,
                                         struct ag_lightmap **out)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, r, "renderer is NULL");
    const struct ag_lightmap_desc fallback = { 0 };
    struct ag_lightmap *l = NULL;
    gpu_image image;
    int term;
    if (!desc) desc = &fallback;
    AG_REQUIRE(context, r->main.rendered || desc->no_light, "no frame has been rendered");
    if (!gi_light_map(r->gi, &term, &image)) return api_done(context, false);
    if (desc->indirect_only && !desc->no_light && has_direct_light(r))
        return api_done(context, host_fail(&context->host, FAIL_UNSUPPORTED,
                                           "light map of %s: direct light has scattered and cannot "
                                           "be left out; set indirect_only to false",
                                           r->spec.technique[term]->name));
    enum ag_result result = desc->no_light ? AG_OK : ag_renderer_wait(r);
    if (result == AG_OK) result = begin(__func__, r->scene, desc, &l);
    if (result != AG_OK) return result;
    return done(l, desc, make_map(l, &r->spec, term, &r->pose, NULL) && set_layers(l, r, image),
                out);
}

void ag_lightmap_destroy(struct ag_lightmap *l)
{
    if (!l) return;
    struct ag_scene *scene = l->scene;
    report_destroy(l->report);
    quality_finish(&l->quality);
    lightmap_finish(&l->map);
    lightmap_record_finish(&l->record);
    host_free(&l->context->host, l->gi);
    host_free(&l->context->host, l);
    api_scene_release(scene, &scene->bakes);
}

// ---- results

enum ag_result ag_lightmap_get_info(const struct ag_lightmap *l, struct ag_lightmap_info *out)
{
    struct ag_context *context = api_lightmap_context(l);
    AG_REQUIRE(context, l, "lightmap is NULL");
    AG_REQUIRE_POINTER(context, out);
    const struct charts *charts = &l->map.charts;
    *out = (struct ag_lightmap_info){ .width = (int)charts->width,
                                      .height = (int)charts->height,
                                      .has_back = l->map.has_back,
                                      .charts = (int)charts->count,
                                      .texels = (int)charts->texel_count,
                                      .texels_per_m = charts->texels_per_m,
                                      .paths = l->noise.paths,
                                      .noise = l->noise.largest,
                                      .noisy_charts = l->noise.above,
                                      .pages = (int)charts_page_count(charts),
                                      .noise_charts = l->noise.units,
                                      .quiet_charts = l->noise.quiet };
    return AG_OK;
}

enum ag_result ag_lightmap_read(const struct ag_lightmap *l, bool back, struct ag_image **out)
{
    struct ag_context *context = api_lightmap_context(l);
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, l, "lightmap is NULL");
    AG_REQUIRE(context, !back || l->map.has_back, "no material is double-sided");
    AG_REQUIRE(context, !l->no_light, "the light map was created with no_light");
    const struct image *map = &l->map.irradiance[back ? LIGHTMAP_BACK : LIGHTMAP_FRONT];
    struct image copy = { 0 };
    const bool ok = image_init(&copy, &context->host, map->width, map->height, map->channels);
    if (ok)
        memcpy(copy.pixels, map->pixels,
               (size_t)map->width * (size_t)map->height * 3 * sizeof *copy.pixels);
    return api_give_image(context, ok, &copy, out);
}

enum ag_result ag_lightmap_positions(const struct ag_lightmap *l, bool back, struct ag_image **out)
{
    struct ag_context *context = api_lightmap_context(l);
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, l, "lightmap is NULL");
    AG_REQUIRE(context, !back || l->map.has_back, "no material is double-sided");
    struct image positions = { 0 };
    const bool ok = lightmap_positions(&l->map, back ? LIGHTMAP_BACK : LIGHTMAP_FRONT, &positions);
    return api_give_image(context, ok, &positions, out);
}

_Static_assert((int)AG_LIGHTMAP_EXR == LIGHTMAP_EXR && (int)AG_LIGHTMAP_KTX2 == LIGHTMAP_KTX2 &&
                   (int)AG_LIGHTMAP_PNG == LIGHTMAP_PNG,
               "formats are passed on");

static enum ag_result write_files(const char *function, const struct ag_lightmap *l,
                                  const char *folder, uint32_t formats)
{
    struct ag_context *context = api_lightmap_context(l);
    AG_REQUIRE_FOR(function, context, l, "lightmap is NULL");
    AG_REQUIRE_FOR(function, context, folder && folder[0], "folder is empty");
    AG_REQUIRE_FOR(function, context, formats > 0 && formats <= LIGHTMAP_FORMATS,
                   "formats is no sum of AG_LIGHTMAP_EXR, _KTX2 and _PNG");
    AG_REQUIRE_FOR(function, context, !l->no_light, "the light map was created with no_light");
    return api_done(context, lightmap_write(&l->map, l->scene->scene, &l->facts, formats, folder));
}

enum ag_result ag_lightmap_write(const struct ag_lightmap *l, const char *folder)
{
    return write_files(__func__, l, folder, LIGHTMAP_FORMATS);
}

enum ag_result ag_lightmap_write_as(const struct ag_lightmap *l, const char *folder,
                                    uint32_t formats)
{
    return write_files(__func__, l, folder, formats);
}
