/// Environment light: an image of the light that arrives at a scene from all directions, or an
/// analytic clear sky. Scenes share environments, and may turn and dim them in every frame.
#ifndef AFTERGLOW_ENVIRONMENT_H
#define AFTERGLOW_ENVIRONMENT_H

#include <afterglow/context.h>
#include <afterglow/image.h>
#include <afterglow/scene.h>

AG_BEGIN

struct ag_environment;

/// Reads a .hdr (RGBE) or .exr file: an equirectangular image of any size, radiance in cd/m²,
/// linear Rec. 709. The top row is +y, the centre of the image −z, and columns grow towards +x.
/// Untrusted input. Images wider than 4096 are averaged to that width. Values that are negative or
/// not finite are 0, with a warning.
///
/// A small bright sun becomes a directional light with shadows (docs/environment.md): techniques
/// and the reference get its illuminance from there, and the rest from the image.
/// Thread: the context's.
AG_API enum ag_result ag_environment_load(struct ag_context *context, const char *path,
                                          struct ag_environment **out);
/// The same from an image in memory, of which 1 or 3 channels are used. It is copied.
/// Thread: the context's.
AG_API enum ag_result ag_environment_from_image(struct ag_context *context,
                                                const struct ag_image *image,
                                                struct ag_environment **out);

/// A clear sky with its sun (Preetham, Shirley & Smits 1999).
struct ag_sun_sky_desc {
    float elevation; ///< of the sun above the horizon, radians, −π/2 to π/2; default π/4
    float azimuth;   ///< of the sun from −z towards +x, radians; default 0
    float turbidity; ///< of the air, 2 (clear) to 10 (haze); default 3
    float ground_albedo[3]; ///< of the ground below the horizon, 0 to 1; default 0.2
    uint64_t reserved[4];   ///< 0; see ABI in types.h
};
/// Thread: any.
AG_API void ag_sun_sky_desc_default(struct ag_sun_sky_desc *desc);
/// Thread: the context's.
AG_API enum ag_result ag_environment_from_sun_sky(struct ag_context *context,
                                                  const struct ag_sun_sky_desc *desc,
                                                  struct ag_environment **out);
/// Scenes that use it keep what they need. Accepts NULL. Thread: the context's.
AG_API void ag_environment_destroy(struct ag_environment *environment);

struct ag_environment_info {
    int width, height;
    float mean[3]; ///< radiance over all directions without the sun, cd/m²
    bool has_sun;
    float to_sun[3];      ///< unit vector
    float sun_lux[3];     ///< illuminance at normal incidence
    float sun_radius;     ///< of its disc, radians
    float sh_error[4];    ///< of projections to spherical harmonics of order 2 to 5 (4 to 25
                          ///< coefficients): RMS of the difference over RMS of the radiance, which
                          ///< the sun is no part of
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_environment_get_info(const struct ag_environment *environment,
                                              struct ag_environment_info *out);

/// How a scene uses an environment.
struct ag_environment_use {
    float strength;       ///< factor of all of its light, 0 to 1e6; default 1
    float rotation;       ///< about +y, radians, counterclockwise seen from above; default 0
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// Thread: any.
AG_API void ag_environment_use_default(struct ag_environment_use *use);
/// Replaces the environment of a scene; its uniform sky and its lights stay. NULL: none. use NULL:
/// the defaults. Renderers show it from their next frame on; another use of the same environment
/// allocates nothing. Bakes do not depend on it. AG_ERROR_ARGUMENT, and nothing has changed: a
/// value is wrong, or the environment is of another context. Thread: the context's.
AG_API enum ag_result ag_scene_set_environment(struct ag_scene *scene,
                                               const struct ag_environment *environment,
                                               const struct ag_environment_use *use);
/// The environment that a scene has, set or read from its file, and its use, which may be NULL. The
/// caller destroys it. *out NULL: the scene has none. Thread: the context's.
AG_API enum ag_result ag_scene_get_environment(const struct ag_scene *scene,
                                               struct ag_environment **out,
                                               struct ag_environment_use *use);

AG_END

#endif
