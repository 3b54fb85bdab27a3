/// Scenes: loaded from a file, built in, or built by calls. World space is right-handed, +Y up,
/// metres.
#ifndef AFTERGLOW_SCENE_H
#define AFTERGLOW_SCENE_H

#include <afterglow/context.h>

AG_BEGIN

struct ag_scene;

/// Loads a file (glTF 2.0 first; OBJ, PLY, FBX, X) or a built-in scene, "@name" or
/// "@name:key=value,…". Files are untrusted. What is not supported is left out and named once in a
/// warning.
AG_API enum ag_result ag_scene_load(struct ag_context *context, const char *name,
                                    struct ag_scene **out);
/// An empty scene to be filled by ag_scene_add_*.
AG_API enum ag_result ag_scene_create(struct ag_context *context, struct ag_scene **out);
AG_API void ag_scene_destroy(struct ag_scene *scene);

struct ag_material_desc {
    float base_color[4];       ///< linear, 0…1; default 0.8 0.8 0.8 1
    float metallic, roughness; ///< default 0, 1
    float emissive[3];         ///< cd/m², default 0
    bool double_sided;
};
AG_API void ag_material_desc_default(struct ag_material_desc *desc);

/// Triangles; arrays are copied. normals may be NULL (flat normals are made).
struct ag_mesh_desc {
    const float *positions; ///< vertex_count × 3, metres
    const float *normals;   ///< vertex_count × 3, unit, or NULL
    uint32_t vertex_count;
    const uint32_t *indices; ///< counter-clockwise from outside
    uint32_t index_count;    ///< a multiple of 3
    int material;            ///< from ag_scene_add_material
};

enum ag_light_type { AG_LIGHT_SUN, AG_LIGHT_POINT, AG_LIGHT_SPOT };
struct ag_light_desc {
    enum ag_light_type type;
    float position[3];          ///< points and spots, metres
    float direction[3];         ///< the way the light shines; suns and spots; need not be unit
    float intensity[3];         ///< linear Rec. 709: lux for suns, candela for points and spots
    float inner_rad, outer_rad; ///< half-angles of a spot, inner < outer ≤ π/2
};
/// Downwards from the origin, intensity 1, a spot from 0 to π/4.
AG_API void ag_light_desc_default(struct ag_light_desc *desc, enum ag_light_type type);

/// Each sets *index (which may be NULL) to the new object's index. While a renderer uses the scene,
/// only lights can be added and removed.
AG_API enum ag_result ag_scene_add_material(struct ag_scene *scene,
                                            const struct ag_material_desc *desc, int *index);
AG_API enum ag_result ag_scene_add_mesh(struct ag_scene *scene, const struct ag_mesh_desc *desc,
                                        int *index);
/// Places a mesh; world_from_mesh is column-major 4×4, NULL for identity.
AG_API enum ag_result ag_scene_add_instance(struct ag_scene *scene, int mesh,
                                            const float *world_from_mesh, int *index);
AG_API enum ag_result ag_scene_add_light(struct ag_scene *scene, const struct ag_light_desc *desc,
                                         int *index);
/// A rectangle that glows evenly on its front, as a panel or a window does. It is part of the
/// geometry: seen, in the way of other light, and it lights others through the techniques that
/// gather emission. The back is dark.
struct ag_area_light_desc {
    float position[3];   ///< its centre, metres
    float direction[3];  ///< of its front; need not be unit
    float width, height; ///< metres, > 0; the width lies level (along x where it faces up or down)
    float radiance[3]; ///< linear Rec. 709, cd/m²; the rectangle shines π · radiance · width ·
                       ///< height lumens
};
/// A square metre at the origin that faces down, radiance 1.
AG_API void ag_area_light_desc_default(struct ag_area_light_desc *desc);
/// Sets *instance (may be NULL) to the instance that was added.
AG_API enum ag_result ag_scene_add_area_light(struct ag_scene *scene,
                                              const struct ag_area_light_desc *desc, int *instance);
/// Removes the punctual lights.
AG_API enum ag_result ag_scene_remove_lights(struct ag_scene *scene);
/// Uniform radiance from outside, cd/m², 3 values ≥ 0.
AG_API enum ag_result ag_scene_set_sky(struct ag_scene *scene, const float *radiance);

struct ag_camera {
    float eye[3], target[3]; ///< metres
    float up[3];             ///< need not be orthogonal
    float vertical_fov_rad;  ///< 0 … π, exclusive
    float near_m;            ///< > 0; the far plane is at infinity
};
/// "Looking from eye at target": up is +y; near suits the scene's size.
AG_API enum ag_result ag_scene_look_at(struct ag_scene *scene, const float *eye,
                                       const float *target, float vertical_fov_rad,
                                       struct ag_camera *out);
AG_API int ag_scene_camera_count(const struct ag_scene *scene);
AG_API const char *ag_scene_camera_name(const struct ag_scene *scene,
                                        int index); ///< NULL out of range
/// Questions about a moment name an animation and a time in seconds, which wraps around the
/// animation's duration. Animations are numbered from 0; 0 is allowed where there is none, -1 is
/// the rest pose.
///
/// The named camera at a moment; an unknown name is an error that names those present.
AG_API enum ag_result ag_scene_camera(struct ag_scene *scene, const char *name, int animation,
                                      double time_s, struct ag_camera *out);
/// The first camera of the scene or, where it has none, one that suits it: from outside where the
/// scene is an object, from inside where geometry surrounds its middle. *made_up (may be NULL) says
/// which.
AG_API enum ag_result ag_scene_default_camera(struct ag_scene *scene, int animation, double time_s,
                                              struct ag_camera *out, bool *made_up);

struct ag_default_lighting {
    bool needed;            ///< the scene has no light, no emission and no sky
    float sun_direction[3]; ///< the way it shines
    float sun_lux[3];
    float sky[3]; ///< cd/m²
};
/// What a dark scene would get.
AG_API enum ag_result ag_scene_default_lighting(struct ag_scene *scene,
                                                struct ag_default_lighting *out);
/// Adds a sun and a faint sky to a scene that is dark; does nothing to another. out (may be NULL)
/// says what.
AG_API enum ag_result ag_scene_add_default_lighting(struct ag_scene *scene,
                                                    struct ag_default_lighting *out);

struct ag_scene_info {
    int meshes, instances, materials, images, lights, cameras, animations, skins, nodes;
    uint64_t triangles; ///< over instances
    uint64_t vertices;
    uint64_t memory_bytes;              ///< in main memory
    float bounds_min[3], bounds_max[3]; ///< at the given moment; min > max for an empty scene
    float sky[3];                       ///< cd/m²
    bool emissive;                      ///< something glows
};
AG_API enum ag_result ag_scene_get_info(struct ag_scene *scene, int animation, double time_s,
                                        struct ag_scene_info *out);

struct ag_light_info {
    const char *name;           ///< valid while the scene lives
    struct ag_light_desc light; ///< in world space
};
AG_API enum ag_result ag_scene_get_light(struct ag_scene *scene, int index, int animation,
                                         double time_s, struct ag_light_info *out);

struct ag_animation_info {
    const char *name; ///< valid while the scene lives
    double duration_s;
};
AG_API enum ag_result ag_scene_get_animation(struct ag_scene *scene, int index,
                                             struct ag_animation_info *out);

struct ag_material_info {
    const char *name;                 ///< valid while the scene lives
    struct ag_material_desc material; ///< the factors
    bool base_color_map, metallic_roughness_map, normal_map, emissive_map;
    const char *alpha_mode; ///< "opaque", "mask" or "blend"
};
AG_API enum ag_result ag_scene_get_material(struct ag_scene *scene, int index,
                                            struct ag_material_info *out);

AG_END

#endif
