/// Scenes: from a file, built in, or built by calls. World space is right-handed, +Y up, in metres.
#ifndef AFTERGLOW_SCENE_H
#define AFTERGLOW_SCENE_H

#include <afterglow/context.h>
#include <afterglow/texture.h>

AG_BEGIN

struct ag_scene;

/// Loads a file (glTF 2.0, OBJ, PLY, FBX, X) or a built-in scene, "@name" or "@name:key=value,…".
/// Untrusted input. Skips unsupported features with one warning each. Thread: the context's.
AG_API enum ag_result ag_scene_load(struct ag_context *context, const char *name,
                                    struct ag_scene **out);
/// How a scene is loaded. Zero is the default of all members: there is no
/// ag_scene_load_desc_default.
struct ag_scene_load_desc {
    /// Metres per unit of length of the file, 1e-6…1e6; 0: 1. Multiplies all lengths: of geometry,
    /// skins, animations, cameras, and positions and ranges of lights, by the root nodes: meshes
    /// and other nodes keep the unit of the file. Candela, lux and cd/m² stay.
    float scale;
    uint64_t reserved[8]; ///< 0; see ABI in types.h
};
/// ag_scene_load; desc may be NULL. Thread: the context's.
AG_API enum ag_result ag_scene_load_with(struct ag_context *context, const char *name,
                                         const struct ag_scene_load_desc *desc,
                                         struct ag_scene **out);
/// A scene file in memory. Zero is the default of all members but `bytes` and `size`: there is no
/// ag_scene_memory_desc_default.
struct ag_scene_memory_desc {
    const void *bytes; ///< needed only during the call
    size_t size;
    /// Shown in messages; its extension states the format. Without one glTF, GLB, PLY, FBX and X
    /// are recognised by their content, OBJ is not. NULL: "memory"
    const char *name;
    /// The folder of the files that it refers to: buffers, images, OBJ materials. NULL: none
    const char *folder;
    /// Instead of `folder`: finds the file at a relative path without "..", its percent escapes
    /// decoded; false: there is none. *bytes must stay valid until ag_scene_load_memory returns.
    /// Called on the calling thread, once for each file; not for OBJ materials.
    bool (*read)(void *user, const char *path, const void **bytes, size_t *size);
    void *user;           ///< passed to `read`
    float scale;          ///< as in ag_scene_load_desc
    uint64_t reserved[7]; ///< 0; see ABI in types.h
};
/// ag_scene_load of a file in memory, with the same limits. Untrusted input. A buffer that cannot
/// be found is AG_ERROR_FILE, an image that cannot be found is a warning. Thread: the context's.
AG_API enum ag_result ag_scene_load_memory(struct ag_context *context,
                                           const struct ag_scene_memory_desc *desc,
                                           struct ag_scene **out);
/// An empty scene; fill it with ag_scene_add_…. Thread: the context's.
AG_API enum ag_result ag_scene_create(struct ag_context *context, struct ag_scene **out);
/// A scene that renderers, references, bakes or light maps use stays until the last of them is
/// destroyed: a program that changes it no more may destroy it once they are created.
/// Thread: the context's.
AG_API void ag_scene_destroy(struct ag_scene *scene);
/// Moves a scene to another context, for renderers there: load or build it on another thread in a
/// context of that thread, while this one renders. The call copies nothing but an environment with
/// other uses, and pointers to the scene stay valid. AG_ERROR_ARGUMENT if a renderer, reference or
/// bake uses the scene, or if the contexts differ in `reallocate` or, where that is given, in
/// `user`: the new context frees the scene. Thread: that of both contexts; no other uses
/// either meanwhile.
AG_API enum ag_result ag_scene_transfer(struct ag_scene *scene, struct ag_context *to);

/// How alpha (base_color times its map and the vertex colour) is used, as in glTF.
enum ag_alpha_mode {
    AG_ALPHA_DEFAULT, ///< opaque for a new material; ag_scene_set_material keeps the mode
    AG_ALPHA_OPAQUE,  ///< alpha is ignored
    AG_ALPHA_MASK,    ///< alpha below alpha_cutoff: no surface
    AG_ALPHA_BLEND,   ///< drawn as a mask with cutoff 0.5: there is no transparency
};

struct ag_material_desc {
    float base_color[4];       ///< linear, 0…1; default 0.8 0.8 0.8 1
    float metallic, roughness; ///< default 0, 1
    float emissive[3];         ///< cd/m², default 0
    bool double_sided;
    float ior;      ///< index of refraction of dielectrics: ≥ 1, or 0 for F0 = 1; default 1.5
    float specular; ///< weight of the dielectric's specular lobe, 0…1; 0: purely diffuse; default 1
    float specular_color[3]; ///< F0 = min(((ior − 1)/(ior + 1))² · colour, 1) · specular; ≥ 0,
                             ///< default 1
    bool unlit; ///< shown by its base colour; neither reflects nor emits (docs/units.md)
    enum ag_alpha_mode alpha_mode; ///< default opaque
    float alpha_cutoff;            ///< of AG_ALPHA_MASK, ≥ 0; default 0.5
    /// Needed only during the call. NULL: none for a new material.
    const struct ag_material_maps *maps;
    uint64_t reserved[6]; ///< 0; see ABI in types.h
};
/// Thread: any.
AG_API void ag_material_desc_default(struct ag_material_desc *desc);

/// A triangle mesh. Arrays are copied. Zero is the default of all members: there is no
/// ag_mesh_desc_default.
struct ag_mesh_desc {
    const float *positions; ///< vertex_count × 3, metres
    const float *normals;   ///< vertex_count × 3, unit; NULL: flat shading
    uint32_t vertex_count;
    const uint32_t *indices; ///< counter-clockwise seen from the front
    uint32_t index_count;    ///< a multiple of 3
    int material;            ///< from ag_scene_add_material
    const float *uv[2];      ///< vertex_count × 2: texture coordinates of both sets; NULL: 0 0
    /// vertex_count × 4: a unit vector, and the sign w of bitangent = w · cross(normal, tangent).
    /// Used with normals, by a normal map. NULL: computed where the material has a normal map.
    const float *tangents;
    const float *colors;  ///< vertex_count × 4, linear RGBA, 0…1, multiplies base_color; NULL: 1
    uint64_t reserved[8]; ///< 0; see ABI in types.h
};

enum ag_light_type { AG_LIGHT_SUN, AG_LIGHT_POINT, AG_LIGHT_SPOT };
struct ag_light_desc {
    enum ag_light_type type;
    float position[3];          ///< of points and spots, metres
    float direction[3];         ///< of the emitted light, of suns and spots; any length
    float intensity[3];         ///< linear Rec. 709: lux for suns, candela for points and spots
    float inner_rad, outer_rad; ///< half-angles of a spot, inner < outer ≤ π/2
    bool enabled;               ///< false: emits nothing, but keeps its index; default true
    uint64_t reserved[6];       ///< 0; see ABI in types.h
};
/// A light at the origin that shines down with intensity 1; a spot with half-angles 0 and π/4.
/// Thread: any.
AG_API void ag_light_desc_default(struct ag_light_desc *desc, enum ag_light_type type);

/// Each sets *index (may be NULL) to the index of the new object, or to -1 on failure. Renderers
/// that use the scene show it from their next frame on. Adding a material or a mesh uploads all
/// meshes of the scene again. While a bake uses the scene, only lights and sky may change:
/// AG_ERROR_ARGUMENT. Thread: the context's.
AG_API enum ag_result ag_scene_add_material(struct ag_scene *scene,
                                            const struct ag_material_desc *desc, int *index);
/// Likewise. Thread: the context's.
AG_API enum ag_result ag_scene_add_mesh(struct ag_scene *scene, const struct ag_mesh_desc *desc,
                                        int *index);
/// Adds a static instance of a mesh; world_from_mesh: affine 4×4 matrix, column-major; NULL:
/// identity. An index of a removed instance is used again. Thread: the context's.
AG_API enum ag_result ag_scene_add_instance(struct ag_scene *scene, int mesh,
                                            const float *world_from_mesh, int *index);
/// Likewise. Thread: the context's.
AG_API enum ag_result ag_scene_add_light(struct ag_scene *scene, const struct ag_light_desc *desc,
                                         int *index);
/// A rectangular emitter with uniform radiance on its front and a black back. It is geometry:
/// visible and an occluder. Techniques that gather emission compute its light on other surfaces.
struct ag_area_light_desc {
    float position[3];   ///< of the centre, metres
    float direction[3];  ///< normal of the front; any length
    float width, height; ///< metres, > 0; the width is horizontal (along x if it faces up or down)
    float radiance[3]; ///< linear Rec. 709, cd/m²; flux is π · radiance · width · height lumens
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// One square metre at the origin, facing down, radiance 1. Thread: any.
AG_API void ag_area_light_desc_default(struct ag_area_light_desc *desc);
/// Sets *instance (may be NULL) to the index of the new instance. Thread: the context's.
AG_API enum ag_result ag_scene_add_area_light(struct ag_scene *scene,
                                              const struct ag_area_light_desc *desc, int *instance);
/// Removes all punctual lights; emitters and sky stay. Thread: the context's.
AG_API enum ag_result ag_scene_remove_lights(struct ag_scene *scene);
/// Uniform radiance of the sky: 3 values ≥ 0, cd/m². Thread: the context's.
AG_API enum ag_result ag_scene_set_sky(struct ag_scene *scene, const float *radiance);

/// The functions below change objects that exist, also while renderers use the scene: each renderer
/// shows the change from its next frame on. They allocate nothing after their first call for an
/// object. An index that does not exist, or of a removed instance, is AG_ERROR_ARGUMENT, and so is
/// every change but that of a light while a bake uses the scene. A failed call changes nothing.
///
/// Places an instance: world_from_mesh as in ag_scene_add_instance. It counts as movable from then
/// on, and no node or animation of a file moves it any more. AG_ERROR_ARGUMENT for an instance with
/// a skin. Thread: the context's.
AG_API enum ag_result ag_scene_set_instance_transform(struct ag_scene *scene, int instance,
                                                      const float *world_from_mesh);
/// Techniques compute once what depends on static instances, and in each frame with movement what
/// depends on movable ones. Both may move; the first movement of a static one makes it movable. In
/// glTF: {"afterglow_mobility": "movable"} in a node's extras, for it and its descendants.
enum ag_mobility { AG_MOBILITY_STATIC, AG_MOBILITY_MOVABLE };
/// Thread: the context's.
AG_API enum ag_result ag_scene_set_instance_mobility(struct ag_scene *scene, int instance,
                                                     enum ag_mobility mobility);
/// Its mesh stays, for other instances. Thread: the context's.
AG_API enum ag_result ag_scene_remove_instance(struct ag_scene *scene, int instance);
/// Replaces the vertices of a mesh: positions (metres) and normals (any length), 3 values for each
/// of the ag_mesh_info.vertex_count vertices, in the order in which they were given or stand in the
/// file. normals NULL: flat ones are computed if the mesh was added without, others stay. Tangents
/// are computed from the texture coordinates. Instances of the mesh count as movable from then on.
/// Thread: the context's.
AG_API enum ag_result ag_scene_update_mesh(struct ag_scene *scene, int mesh, const float *positions,
                                           const float *normals);
/// Replaces factors and flags; textures, alpha mode and name stay: `maps` must be NULL, alpha_mode
/// the material's or AG_ALPHA_DEFAULT. Materials that start or stop to emit are allowed.
/// Thread: the context's.
AG_API enum ag_result ag_scene_set_material(struct ag_scene *scene, int material,
                                            const struct ag_material_desc *desc);
/// Replaces a punctual light, of any type; no node or animation of a file moves it any more. Change
/// `position`, `direction`, `intensity` or `enabled` of what ag_scene_get_light returned. Shadow
/// maps stay while only intensity or `enabled` change. Thread: the context's.
AG_API enum ag_result ag_scene_set_light(struct ag_scene *scene, int light,
                                         const struct ag_light_desc *desc);

struct ag_camera {
    float eye[3], target[3]; ///< metres
    float up[3];             ///< any length; need not be orthogonal to the view
    float vertical_fov_rad;  ///< 0 … π, exclusive
    float near_m;            ///< > 0; the far plane is at infinity
};
/// A camera at `eye` looking at `target`; up is +y, near_m depends on the size of the scene.
/// Thread: the context's.
AG_API enum ag_result ag_scene_look_at(struct ag_scene *scene, const float *eye,
                                       const float *target, float vertical_fov_rad,
                                       struct ag_camera *out);
/// Thread: the context's.
AG_API int ag_scene_camera_count(const struct ag_scene *scene);
/// NULL out of range. Thread: the context's.
AG_API const char *ag_scene_camera_name(const struct ag_scene *scene, int index);
/// The named camera at a moment of an animation. An unknown name is AG_ERROR_ARGUMENT; the message
/// lists the cameras. animation: 0…count − 1; 0 is valid in a scene without animations; -1: the
/// rest pose. time_s: seconds, modulo the duration of the animation. Functions below use both
/// likewise. Thread: the context's.
AG_API enum ag_result ag_scene_camera(struct ag_scene *scene, const char *name, int animation,
                                      double time_s, struct ag_camera *out);
/// The first camera of the scene, or a generated one if there is none: outside an object, inside a
/// scene that encloses its centre, in front of its open side if there is only one. Sets *made_up
/// (may be NULL) to true for a generated camera. Thread: the context's.
AG_API enum ag_result ag_scene_default_camera(struct ag_scene *scene, int animation, double time_s,
                                              struct ag_camera *out, bool *made_up);

struct ag_default_lighting {
    bool needed;            ///< the scene has no light, no sky and at most negligible emission
    float sun_direction[3]; ///< of the emitted light
    float sun_lux[3];
    float sky[3];         ///< cd/m²
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// The sun and sky that suit the scene, if it has no light. Thread: the context's.
AG_API enum ag_result ag_scene_default_lighting(struct ag_scene *scene,
                                                struct ag_default_lighting *out);
/// Adds them if `needed`; otherwise changes nothing. out may be NULL. Thread: the context's.
AG_API enum ag_result ag_scene_add_default_lighting(struct ag_scene *scene,
                                                    struct ag_default_lighting *out);

struct ag_scene_info {
    int instances; ///< indices that are or were in use
    int meshes, materials, images, lights, cameras, animations, skins, nodes;
    uint64_t triangles; ///< over instances
    uint64_t vertices;
    uint64_t memory_bytes;              ///< main memory
    float bounds_min[3], bounds_max[3]; ///< at the given moment; min > max for an empty scene
    float sky[3];                       ///< cd/m²
    bool emissive;                      ///< has emissive surfaces
    uint64_t reserved[8];               ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_scene_get_info(struct ag_scene *scene, int animation, double time_s,
                                        struct ag_scene_info *out);

struct ag_instance_info {
    const char *name; ///< of its node; valid until the scene changes
    int mesh;         ///< -1: removed; the other members are then zero
    enum ag_mobility mobility;
    bool skinned;              ///< its joints place it
    float world_from_mesh[16]; ///< column-major, at the given moment; identity for a skin
    uint64_t reserved[4];      ///< 0; see ABI in types.h
};
/// index: 0…ag_scene_info.instances − 1. Thread: the context's.
AG_API enum ag_result ag_scene_get_instance(struct ag_scene *scene, int index, int animation,
                                            double time_s, struct ag_instance_info *out);

struct ag_mesh_info {
    const char *name;      ///< valid until the scene is destroyed
    uint32_t vertex_count; ///< as given to ag_scene_add_mesh, or in the file after its import
    uint32_t index_count;
    int material;
    float bounds_min[3], bounds_max[3]; ///< metres, in the space of the mesh
    uint64_t reserved[4];               ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_scene_get_mesh(struct ag_scene *scene, int index,
                                        struct ag_mesh_info *out);

struct ag_light_info {
    const char *name;           ///< valid until the scene is destroyed
    struct ag_light_desc light; ///< in world space
    uint64_t reserved[2];       ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_scene_get_light(struct ag_scene *scene, int index, int animation,
                                         double time_s, struct ag_light_info *out);

struct ag_animation_info {
    const char *name; ///< valid until the scene is destroyed
    double duration_s;
    uint64_t reserved[4]; ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_scene_get_animation(struct ag_scene *scene, int index,
                                             struct ag_animation_info *out);

struct ag_material_info {
    const char *name;                 ///< valid until the scene is destroyed
    struct ag_material_desc material; ///< `maps` is NULL: see ag_scene_get_material_maps
    bool base_color_map, metallic_roughness_map, normal_map, emissive_map;
    bool specular_map, specular_color_map;
    const char *alpha_mode; ///< "opaque", "mask" or "blend"
    uint64_t reserved[4];   ///< 0; see ABI in types.h
};
/// Thread: the context's.
AG_API enum ag_result ag_scene_get_material(struct ag_scene *scene, int index,
                                            struct ag_material_info *out);

AG_END

#endif
