/// Textures of scenes that are built by calls: images, and how materials read them. Roles and
/// defaults are those of glTF 2.0, with KHR_texture_transform and KHR_materials_specular.
#ifndef AFTERGLOW_TEXTURE_H
#define AFTERGLOW_TEXTURE_H

#include <afterglow/types.h>

AG_BEGIN

struct ag_scene;

/// Texels, or an encoded file: exactly one of `pixels` and `encoded`. Zero is the default of all
/// members: there is no ag_scene_image_desc_default.
struct ag_scene_image_desc {
    const char *name;      ///< NULL: "image"
    const uint8_t *pixels; ///< `height` rows of `width` texels, top row first
    int width, height;     ///< 1…8192
    int channels;          ///< bytes of a texel: 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
    size_t row_bytes;      ///< from row to row; 0: width · channels
    const void *encoded;   ///< a PNG or JPEG file, decoded to 8 bits a channel. Untrusted input
    size_t encoded_bytes;
    /// Maps of colours (base_color, emissive, specular_color) read linear values; false: sRGB, as
    /// in glTF. All other maps read linear values in either case. Alpha is always linear.
    bool linear;
    uint64_t reserved[8]; ///< 0; see ABI in types.h
};
/// Copies the image, with 4 bytes a texel, until the scene is destroyed. Mip levels are generated.
/// Sets *index (may be NULL), -1 on failure. AG_ERROR_FORMAT: `encoded` cannot be decoded.
/// Thread: the context's.
AG_API enum ag_result ag_scene_add_image(struct ag_scene *scene,
                                         const struct ag_scene_image_desc *desc, int *index);

enum ag_wrap { AG_WRAP_REPEAT, AG_WRAP_MIRROR, AG_WRAP_CLAMP };

/// How a material reads an image. Texture coordinates are transformed by
/// offset + rotation · scale · uv; (0, 0) is the upper left corner of the image.
struct ag_texture_map {
    int image;                   ///< from ag_scene_add_image; -1: none, reads white
    int uv_set;                  ///< 0 or 1: which of ag_mesh_desc.uv
    enum ag_wrap wrap_u, wrap_v; ///< default repeat
    bool nearest;                ///< nearest texel of the nearest level; false: trilinear filter
    float uv_offset[2];          ///< default 0 0
    float uv_scale[2];           ///< default 1 1
    float uv_rotation_rad;       ///< counter-clockwise; default 0
    uint64_t reserved[2];        ///< 0; see ABI in types.h
};

/// The textures of a material. Each multiplies the factor of its name in ag_material_desc.
struct ag_material_maps {
    struct ag_texture_map base_color;         ///< RGB, and alpha for alpha_mode
    struct ag_texture_map metallic_roughness; ///< G: roughness, B: metallic
    struct ag_texture_map normal;             ///< tangent space, 0…255 for -1…1
    struct ag_texture_map emissive;           ///< RGB
    struct ag_texture_map specular;           ///< A
    struct ag_texture_map specular_color;     ///< RGB
    float normal_scale;                       ///< of the normal map's x and y; default 1
    uint64_t reserved[8];                     ///< 0; see ABI in types.h
};
/// No texture. Thread: any.
AG_API void ag_material_maps_default(struct ag_material_maps *maps);
/// The textures of a material, of a file or as they were given. Thread: the context's.
AG_API enum ag_result ag_scene_get_material_maps(struct ag_scene *scene, int material,
                                                 struct ag_material_maps *out);

AG_END

#endif
