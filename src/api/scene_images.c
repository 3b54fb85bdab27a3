// Images of scenes that are built by calls, and the textures of their materials.
#include "api/scene_parts.h"

#include "scene/images/image_source.h"

#include <string.h>

_Static_assert((int)AG_WRAP_REPEAT == (int)WRAP_REPEAT && (int)AG_WRAP_MIRROR == (int)WRAP_MIRROR &&
                   (int)AG_WRAP_CLAMP == (int)WRAP_CLAMP,
               "modes are converted by value");

// ---- Images

static enum ag_result texels_check(const char *function, struct ag_context *context,
                                   const struct ag_scene_image_desc *desc)
{
    AG_REQUIRE_FOR(function, context, desc->channels >= 1 && desc->channels <= 4,
                   "channels must be 1 to 4, not %d", desc->channels);
    AG_REQUIRE_FOR(function, context,
                   desc->width >= 1 && desc->width <= SCENE_MAX_IMAGE_SIZE && desc->height >= 1 &&
                       desc->height <= SCENE_MAX_IMAGE_SIZE,
                   "width and height must be 1 to %d, not %d and %d", SCENE_MAX_IMAGE_SIZE,
                   desc->width, desc->height);
    const size_t row = (size_t)desc->width * (size_t)desc->channels;
    AG_REQUIRE_FOR(function, context, desc->row_bytes == 0 || desc->row_bytes >= row,
                   "row_bytes %zu is less than the %zu bytes of a row", desc->row_bytes, row);
    return AG_OK;
}

static enum ag_result image_check(const char *function, struct ag_context *context,
                                  const struct ag_scene_image_desc *desc)
{
    AG_REQUIRE_KNOWN(function, context, desc);
    AG_REQUIRE_FOR(function, context, !desc->pixels != !desc->encoded,
                   "exactly one of pixels and encoded must be given");
    AG_REQUIRE_FOR(function, context, !desc->encoded || desc->encoded_bytes > 0,
                   "encoded_bytes is 0");
    return desc->pixels ? texels_check(function, context, desc) : AG_OK;
}

enum ag_result ag_scene_add_image(struct ag_scene *scene, const struct ag_scene_image_desc *desc,
                                  int *index)
{
    REQUIRE_ADDING(scene, desc, index);
    REQUIRE_NO_BAKE(scene);
    const enum ag_result checked = image_check(__func__, scene->context, desc);
    if (checked != AG_OK) return checked;
    const char *name = desc->name ? desc->name : "image";
    const struct texels texels = { desc->pixels, desc->width, desc->height, desc->channels,
                                   desc->row_bytes ? desc->row_bytes
                                                   : (size_t)desc->width * (size_t)desc->channels };
    const int added = desc->pixels ? scene_add_texels(scene->scene, name, &texels, desc->linear)
                                   : scene_add_encoded_image(scene->scene, name, desc->encoded,
                                                             desc->encoded_bytes, desc->linear);
    return parts_added(scene, added, index);
}

// ---- Textures of materials

enum { MAP_COUNT = 6 };

struct map_pair {
    const char *name;
    struct ag_texture_map *outside;
    struct texture_use *inside;
};

static void pair_maps(struct ag_material_maps *maps, struct material *m,
                      struct map_pair out[MAP_COUNT])
{
    const struct map_pair pairs[MAP_COUNT] = {
        { "base_color", &maps->base_color, &m->base_color_map },
        { "metallic_roughness", &maps->metallic_roughness, &m->metallic_roughness_map },
        { "normal", &maps->normal, &m->normal_map },
        { "emissive", &maps->emissive, &m->emissive_map },
        { "specular", &maps->specular, &m->specular_map },
        { "specular_color", &maps->specular_color, &m->specular_color_map },
    };
    memcpy(out, pairs, sizeof pairs);
}

static void map_out(const struct texture_use *from, struct ag_texture_map *to)
{
    *to = (struct ag_texture_map){ .image = from->image,
                                   .uv_set = from->uv_set,
                                   .wrap_u = (enum ag_wrap)from->wrap_u,
                                   .wrap_v = (enum ag_wrap)from->wrap_v,
                                   .nearest = from->nearest,
                                   .uv_rotation_rad = from->uv_rotation_rad };
    memcpy(to->uv_offset, from->uv_offset, sizeof to->uv_offset);
    memcpy(to->uv_scale, from->uv_scale, sizeof to->uv_scale);
}

static void maps_out(const struct material *material, struct ag_material_maps *out)
{
    struct material from = *material;
    struct map_pair pairs[MAP_COUNT];
    *out = (struct ag_material_maps){ .normal_scale = material->normal_scale };
    pair_maps(out, &from, pairs);
    for (int i = 0; i < MAP_COUNT; i++) map_out(pairs[i].inside, pairs[i].outside);
}

void ag_material_maps_default(struct ag_material_maps *maps)
{
    const struct material none = material_default();
    if (maps) maps_out(&none, maps);
}

enum ag_result ag_scene_get_material_maps(struct ag_scene *scene, int material,
                                          struct ag_material_maps *out)
{
    REQUIRE_CHANGE(scene, out);
    REQUIRE_INDEX(scene, "material", material, material_count);
    maps_out(&scene->scene->materials[material], out);
    return AG_OK;
}

static enum ag_result map_check(const char *function, const struct ag_scene *scene,
                                const char *name, const struct ag_texture_map *map)
{
    struct ag_context *context = scene->context;
    AG_REQUIRE_KNOWN(function, context, map);
    AG_REQUIRE_FOR(function, context,
                   map->image == -1 || (map->image >= 0 && map->image < scene->scene->image_count),
                   "maps->%s: image %d is not one of %d", name, map->image,
                   scene->scene->image_count);
    AG_REQUIRE_FOR(function, context, map->uv_set == 0 || map->uv_set == 1,
                   "maps->%s: uv_set must be 0 or 1, not %d", name, map->uv_set);
    AG_REQUIRE_FOR(function, context,
                   (unsigned)map->wrap_u <= AG_WRAP_CLAMP && (unsigned)map->wrap_v <= AG_WRAP_CLAMP,
                   "maps->%s: wrap_u %d or wrap_v %d is unknown", name, (int)map->wrap_u,
                   (int)map->wrap_v);
    AG_REQUIRE_FOR(function, context,
                   api_finite(map->uv_offset, 2) && api_finite(map->uv_scale, 2) &&
                       api_finite(&map->uv_rotation_rad, 1),
                   "maps->%s: uv_offset, uv_scale or uv_rotation_rad is not finite", name);
    return AG_OK;
}

static void map_in(const struct ag_texture_map *from, struct texture_use *to)
{
    *to = (struct texture_use){ .image = from->image,
                                .uv_set = from->uv_set,
                                .wrap_u = (enum texture_wrap)from->wrap_u,
                                .wrap_v = (enum texture_wrap)from->wrap_v,
                                .nearest = from->nearest,
                                .uv_rotation_rad = from->uv_rotation_rad };
    memcpy(to->uv_offset, from->uv_offset, sizeof to->uv_offset);
    memcpy(to->uv_scale, from->uv_scale, sizeof to->uv_scale);
}

enum ag_result parts_maps(const char *function, const struct ag_scene *scene,
                          const struct ag_material_maps *maps, struct material *out)
{
    struct ag_material_maps given = *maps;
    struct map_pair pairs[MAP_COUNT];
    AG_REQUIRE_KNOWN(function, scene->context, maps);
    AG_REQUIRE_FOR(function, scene->context, api_finite(&maps->normal_scale, 1),
                   "maps->normal_scale is not finite");
    out->normal_scale = maps->normal_scale;
    pair_maps(&given, out, pairs);
    for (int i = 0; i < MAP_COUNT; i++) {
        const enum ag_result checked = map_check(function, scene, pairs[i].name, pairs[i].outside);
        if (checked != AG_OK) return checked;
        map_in(pairs[i].outside, pairs[i].inside);
    }
    return AG_OK;
}
