// Environments: checks arguments and forwards to scene/.
#include "api/objects.h"

#include "scene/environment/environment_map.h"
#include "scene/limits.h"
#include "scene/scene_edit.h"

#include <math.h>

static const float STRONGEST = 1e6f;

struct ag_environment {
    struct ag_context *context;
    const struct environment_map *map;
};

// Passes a map to the caller; NULL: it could not be made.
static enum ag_result give(struct ag_context *context, struct environment_map *map,
                           struct ag_environment **out)
{
    struct ag_environment *made = map ? host_alloc(&context->host, 1, sizeof *made) : NULL;
    if (made) *made = (struct ag_environment){ context, map };
    if (made) api_context_use(context);
    if (!made) environment_map_release(map);
    *out = made;
    return api_done(context, made);
}

enum ag_result ag_environment_load(struct ag_context *context, const char *path,
                                   struct ag_environment **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE_POINTER(context, path);
    return give(context, environment_map_load(&context->host, path), out);
}

enum ag_result ag_environment_from_image(struct ag_context *context, const struct ag_image *image,
                                         struct ag_environment **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    AG_REQUIRE_POINTER(context, image);
    AG_REQUIRE(context,
               image->width >= 1 && image->width <= IMAGE_MAX_SIZE && image->height >= 1 &&
                   image->height <= IMAGE_MAX_SIZE && image->channels >= 1 &&
                   image->channels <= 4 && image->pixels,
               "image of %d x %d pixels with %d channels: it must be 1 to %d pixels wide and high, "
               "with 1 to 4 channels",
               image->width, image->height, image->channels, IMAGE_MAX_SIZE);
    const struct image from = { image->width, image->height, image->channels, image->pixels };
    return give(context, environment_map_create(&context->host, "of an image", &from), out);
}

void ag_sun_sky_desc_default(struct ag_sun_sky_desc *desc)
{
    if (!desc) return;
    *desc = (struct ag_sun_sky_desc){ .elevation = GLM_PI_4f,
                                      .turbidity = 3.0f,
                                      .ground_albedo = { 0.2f, 0.2f, 0.2f } };
}

enum ag_result ag_environment_from_sun_sky(struct ag_context *context,
                                           const struct ag_sun_sky_desc *desc,
                                           struct ag_environment **out)
{
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE_POINTER(context, context);
    struct ag_sun_sky_desc defaults;
    ag_sun_sky_desc_default(&defaults);
    if (!desc) desc = &defaults;
    AG_REQUIRE_KNOWN(__func__, context, desc);
    AG_REQUIRE(context, fabsf(desc->elevation) <= GLM_PI_2f,
               "elevation %g is not within -pi/2 to pi/2", (double)desc->elevation);
    AG_REQUIRE(context, isfinite(desc->azimuth), "azimuth is not finite");
    AG_REQUIRE(context,
               desc->turbidity >= SUN_SKY_MIN_TURBIDITY && desc->turbidity <= SUN_SKY_MAX_TURBIDITY,
               "turbidity %g is not within %g to %g", (double)desc->turbidity,
               (double)SUN_SKY_MIN_TURBIDITY, (double)SUN_SKY_MAX_TURBIDITY);
    for (int c = 0; c < 3; c++)
        AG_REQUIRE(context, desc->ground_albedo[c] >= 0.0f && desc->ground_albedo[c] <= 1.0f,
                   "ground_albedo[%d] %g is not within 0 to 1", c, (double)desc->ground_albedo[c]);
    const struct sun_sky sky = { .elevation_rad = desc->elevation,
                                 .azimuth_rad = desc->azimuth,
                                 .turbidity = desc->turbidity,
                                 .ground_albedo = api_vec3(desc->ground_albedo) };
    return give(context, environment_map_of_sky(&context->host, &sky), out);
}

void ag_environment_destroy(struct ag_environment *environment)
{
    if (!environment) return;
    struct ag_context *context = environment->context;
    environment_map_release(environment->map);
    host_free(&context->host, environment);
    api_context_release(context);
}

enum ag_result ag_environment_get_info(const struct ag_environment *environment,
                                       struct ag_environment_info *out)
{
    AG_REQUIRE(NULL, environment, "environment is NULL");
    AG_REQUIRE_POINTER(environment->context, out);
    const struct environment_map *map = environment->map;
    const struct environment light = { .map = map, .strength = 1.0f };
    *out = (struct ag_environment_info){ .width = map->radiance.width,
                                         .height = map->radiance.height,
                                         .has_sun = map->sun.found,
                                         .sun_radius = map->sun.radius_rad };
    api_store(out->mean, environment_mean(&light));
    api_store(out->to_sun, map->sun.to_sun);
    api_store(out->sun_lux, map->sun.illuminance_lux);
    for (int i = 0; i < 4; i++) out->sh_error[i] = map->sh_error[i];
    return AG_OK;
}

void ag_environment_use_default(struct ag_environment_use *use)
{
    if (use) *use = (struct ag_environment_use){ .strength = 1.0f };
}

enum ag_result ag_scene_set_environment(struct ag_scene *scene,
                                        const struct ag_environment *environment,
                                        const struct ag_environment_use *use)
{
    AG_REQUIRE(NULL, scene, "scene is NULL");
    struct ag_environment_use defaults;
    ag_environment_use_default(&defaults);
    if (!use) use = &defaults;
    AG_REQUIRE_KNOWN(__func__, scene->context, use);
    AG_REQUIRE(scene->context, !environment || environment->context == scene->context,
               "the environment is of another context");
    AG_REQUIRE(scene->context, use->strength >= 0.0f && use->strength <= STRONGEST,
               "strength %g is not within 0 to %g", (double)use->strength, (double)STRONGEST);
    AG_REQUIRE(scene->context,
               !environment || environment_map_strongest(environment->map) * use->strength <=
                                   SCENE_MAX_RADIANCE,
               "strength %g makes it brighter than %g cd/m² or lux", (double)use->strength,
               (double)SCENE_MAX_RADIANCE);
    AG_REQUIRE(scene->context, isfinite(use->rotation), "rotation is not finite");
    scene_set_environment_map(scene->scene, environment ? environment->map : NULL, use->strength,
                              fmodf(use->rotation, 2.0f * GLM_PIf));
    return AG_OK;
}

enum ag_result ag_scene_get_environment(const struct ag_scene *scene, struct ag_environment **out,
                                        struct ag_environment_use *use)
{
    AG_REQUIRE_OUT(NULL, out);
    AG_REQUIRE(NULL, scene, "scene is NULL");
    const struct environment *environment = &scene->scene->environment;
    if (use)
        *use = (struct ag_environment_use){ .strength = environment->strength,
                                            .rotation = environment->rotation_rad };
    if (!environment->map) return AG_OK;
    struct ag_environment *made = host_alloc(&scene->context->host, 1, sizeof *made);
    if (!made) return api_done(scene->context, NULL);
    environment_map_retain(environment->map);
    api_context_use(scene->context);
    *made = (struct ag_environment){ scene->context, environment->map };
    *out = made;
    return AG_OK;
}
