/// Light maps as files: the irradiance of static surfaces, of all bounces, for any engine. Texels
/// are those of a technique with a light map (radiosity, ort, prt at texels). Their light is that
/// of a renderer's newest frame, or of a bake by the path tracer (ag_bake_desc.lightmap_samples).
///
/// A map holds irradiance in lux along the interpolated vertex normal, without albedo and 1/π: a
/// diffuse surface reflects albedo/π times that. Rows go down, as v does in glTF. Around each chart
/// two texels repeat its border, so that bilinear lookups meet no others.
#ifndef AFTERGLOW_LIGHTMAP_H
#define AFTERGLOW_LIGHTMAP_H

#include <afterglow/bake.h>
#include <afterglow/image.h>
#include <afterglow/renderer.h>

AG_BEGIN

struct ag_lightmap;

struct ag_lightmap_desc {
    bool indirect_only; ///< without direct light of punctual lights, which engines compute in each
                        ///< frame; default false
    bool denoise;  ///< each chart for itself: with Open Image Denoise, if it is built in; else by a
                   ///< filter of the light of paths, and a warning for other light; default false
    bool no_light; ///< info and positions alone: no ray is traced, and neither a frame nor the
                   ///< GPU is needed; ag_lightmap_read and _write are refused; default false
    bool report;   ///< measure what ag_lightmap_report and _read_layer tell, unless no_light; takes
                   ///< rays; default false
    int page;      ///< divide the map into pages of at most this side in texels, 64 to 16384 and a
                   ///< multiple of 8; all texels of an instance are on one page. AG_ERROR_MEMORY
                   ///< names an instance that is too large. Default 0: one page of any size
    uint64_t reserved[8]; ///< 0; see ABI in types.h
};
/// Thread: any.
AG_API void ag_lightmap_desc_default(struct ag_lightmap_desc *desc);

/// The technique of a GI spec that has a light map; *name is NULL where none has one.
/// Thread: the context's.
AG_API enum ag_result ag_lightmap_technique(struct ag_context *context, const char *gi,
                                            const char **name);

/// The light map of a complete bake with lightmap_samples; bake and scene may be destroyed before
/// the light map. desc NULL: the defaults. Thread: the context's.
AG_API enum ag_result ag_lightmap_from_bake(const struct ag_bake *bake,
                                            const struct ag_lightmap_desc *desc,
                                            struct ag_lightmap **out);
/// The light map of the newest frame; waits for the GPU. AG_ERROR_ARGUMENT if no technique of the
/// renderer has a light map. Direct light of punctual lights is traced on the CPU. If a technique
/// scatters it below surfaces, its map has it already, and indirect_only is AG_ERROR_UNSUPPORTED.
/// Thread: the context's.
AG_API enum ag_result ag_lightmap_from_renderer(struct ag_renderer *renderer,
                                                const struct ag_lightmap_desc *desc,
                                                struct ag_lightmap **out);
/// Accepts NULL. Thread: the context's.
AG_API void ag_lightmap_destroy(struct ag_lightmap *lightmap);

struct ag_lightmap_info {
    int width, height;
    bool has_back;        ///< there is a second map, of the backs of double-sided materials
    int charts, texels;   ///< texels: on surfaces, of one side
    float texels_per_m;   ///< density
    float paths;          ///< of a texel, in the mean; 0: not by paths
    float noise;          ///< of the noisiest chart (ag_bake_desc.lightmap_noise); NaN: not known
    int noisy_charts;     ///< whose noise is above the bound, with the most paths. Small charts of
                          ///< an instance count together, here and for `noise`
    int pages;            ///< at least 1 (ag_lightmap_desc.page)
    int noise_charts;     ///< whose noise is estimated; 0: not known
    int quiet_charts;     ///< of them: below half of the bound by few paths, or without light
    uint64_t reserved[1]; ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_lightmap_get_info(const struct ag_lightmap *lightmap,
                                           struct ag_lightmap_info *out);
/// The pages that a light map of the GI spec would have at time 0 (ag_lightmap_desc.page), and the
/// same errors: its charts are made, but no light. Thread: the context's.
AG_API enum ag_result ag_lightmap_count_pages(struct ag_scene *scene, const char *gi, int page,
                                              int *count);
/// The place of a page in the images that ag_lightmap_read and others return, in texels.
struct ag_lightmap_page {
    int x, y, width, height;
    uint64_t reserved[2]; ///< 0; see ABI in types.h
};
/// page: from 0. Thread: the context's.
AG_API enum ag_result ag_lightmap_get_page(const struct ag_lightmap *lightmap, int page,
                                           struct ag_lightmap_page *out);
/// A copy of a map, 3 channels, lux. Texels of no chart are 0. Thread: the context's.
AG_API enum ag_result ag_lightmap_read(const struct ag_lightmap *lightmap, bool back,
                                       struct ag_image **out);
/// World-space positions of texels, 3 channels, metres: of the middle of the part of a texel that
/// the surface covers. NaN where a texel is on no surface, as in gutters. Both sides of a surface
/// have one position; only texels with a back have one there. Thread: the context's.
AG_API enum ag_result ag_lightmap_positions(const struct ag_lightmap *lightmap, bool back,
                                            struct ag_image **out);
/// The quality of a map that was created with ag_lightmap_desc.report, as a JSON document:
/// density, texels, overlaps, charts, seams, leaks and, by paths, noise. docs/lightmaps.md
/// describes its members. Owned by the light map. Thread: the context's.
AG_API enum ag_result ag_lightmap_report(const struct ag_lightmap *lightmap, const char **json);
/// A value of each texel, of the same measurement.
enum ag_lightmap_layer {
    AG_LIGHTMAP_CHART,   ///< number of its chart, from 0, as in the report
    AG_LIGHTMAP_DENSITY, ///< of its chart, texels per metre; 0: a chart of one texel
    AG_LIGHTMAP_OPEN,    ///< share of its sample points outside geometry; 0: it is filled
    AG_LIGHTMAP_NOISE,   ///< standard error over its light, both of luminance, without direct
                         ///< light of punctual lights; NaN: not by paths
    AG_LIGHTMAP_LEAK     ///< largest step of light to a neighbour behind a wall; 0: none
};
/// 1 channel; NaN where a texel is on no surface. Thread: the context's.
AG_API enum ag_result ag_lightmap_read_layer(const struct ag_lightmap *lightmap,
                                             enum ag_lightmap_layer layer, bool back,
                                             struct ag_image **out);
/// Formats of the maps, to be added up.
enum ag_lightmap_format {
    AG_LIGHTMAP_EXR = 1, ///< irradiance.exr, of several pages irradiance.0.exr and so on: 32-bit
                         ///< floats, lux
    AG_LIGHTMAP_KTX2 =
        2, ///< irradiance.ktx2: VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, lux over a power of two
    AG_LIGHTMAP_PNG = 4 ///< irradiance.png: 8 bits, linear; also the texture of MOZ_lightmap
};
/// Writes the maps in all formats, those of backs with the name irradiance_back, and scene.glb, a
/// copy of the scene with coordinates of the maps, into an existing folder; docs/lightmaps.md
/// describes them. Each file is written completely or not at all. Thread: the context's.
AG_API enum ag_result ag_lightmap_write(const struct ag_lightmap *lightmap, const char *folder);
/// The same in some formats: a sum of enum ag_lightmap_format. Without AG_LIGHTMAP_PNG the copy has
/// no MOZ_lightmap. Thread: the context's.
AG_API enum ag_result ag_lightmap_write_as(const struct ag_lightmap *lightmap, const char *folder,
                                           uint32_t formats);

/// Painted light: first-order irradiance that a program gives the texels of a renderer's light map,
/// in addition to that of lights, the sky and emissive surfaces.
struct ag_light_paint {
    int x, y, width, height; ///< rectangle of texels, as in ag_lightmap_read without pages; default
                             ///< 0: none
    bool back;               ///< of the backs of double-sided materials; default false
    /// [height][width][3] irradiance, lux, finite and at least 0; default NULL: 0. Texels on no
    /// surface, as in gutters, and those inside geometry ignore it.
    const float *lux;
    uint64_t reserved[8]; ///< 0; see ABI in types.h
};
/// Thread: any.
AG_API void ag_light_paint_default(struct ag_light_paint *paint);
/// Replaces the painted light of the rectangle's texels, from the next frame on. It is light from
/// all directions, which bounces and scatters; surfaces show it as they show that of the sky. The
/// direct layer and the path-traced reference do not have it. Does not wait for the GPU.
///
/// Paint lasts until ag_renderer_set_gi creates the technique again, as for options of effect
/// recreate and rebake; options of other effects, frame options and ag_renderer_resize keep it. The
/// first call allocates 20 bytes per texel, and 16 on the GPU.
///
/// AG_ERROR_ARGUMENT, and nothing has changed: no technique of the renderer takes painted light
/// (radiosity and ort do), the rectangle is empty or not in the light map, or a value is wrong.
/// Thread: the context's.
AG_API enum ag_result ag_renderer_paint_light(struct ag_renderer *renderer,
                                              const struct ag_light_paint *paint);

AG_END

#endif
