/// Light maps as files: the irradiance of static surfaces, of all bounces, for any engine. Texels
/// are those of a technique with a light map (radiosity). Their light is that of a renderer's
/// newest frame, or of a bake by the path tracer (ag_bake_desc.lightmap_samples).
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
    bool denoise;       ///< each chart for itself, with Open Image Denoise; default false
    uint64_t reserved[8]; ///< 0; see ABI in types.h
};
AG_API void ag_lightmap_desc_default(struct ag_lightmap_desc *desc);

/// The technique of a GI spec that has a light map; *name is NULL where none has one.
AG_API enum ag_result ag_lightmap_technique(struct ag_context *context, const char *gi,
                                            const char **name);

/// Of a complete bake with lightmap_samples. The scene must outlive it. desc NULL: the defaults.
AG_API enum ag_result ag_lightmap_from_bake(const struct ag_bake *bake,
                                            const struct ag_lightmap_desc *desc,
                                            struct ag_lightmap **out);
/// Of the newest frame; waits for the GPU. AG_ERROR_ARGUMENT where no technique of the renderer has
/// a light map. Direct light of punctual lights is traced on the CPU.
AG_API enum ag_result ag_lightmap_from_renderer(struct ag_renderer *renderer,
                                                const struct ag_lightmap_desc *desc,
                                                struct ag_lightmap **out);
AG_API void ag_lightmap_destroy(struct ag_lightmap *lightmap); ///< accepts NULL

struct ag_lightmap_info {
    int width, height;
    bool has_back;        ///< there is a second map, of the backs of double-sided materials
    int charts, texels;   ///< texels: on surfaces, of one side
    float texels_per_m;   ///< density
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
AG_API enum ag_result ag_lightmap_get_info(const struct ag_lightmap *lightmap,
                                           struct ag_lightmap_info *out);
/// A copy of a map, 3 channels, lux. Texels of no chart are 0.
AG_API enum ag_result ag_lightmap_read(const struct ag_lightmap *lightmap, bool back,
                                       struct ag_image **out);
/// Writes the maps, irradiance.exr and irradiance_back.exr, and scene.glb, a copy of the scene with
/// coordinates of the maps, into an existing folder; docs/lightmaps.md describes them. Each file is
/// written completely or not at all.
AG_API enum ag_result ag_lightmap_write(const struct ag_lightmap *lightmap, const char *folder);

AG_END

#endif
