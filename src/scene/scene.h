// A scene: meshes, materials, textures, nodes, instances, lights, cameras, skins, animations.
// Plain arrays owned by the scene's arena; indices refer to them, -1 is none. Immutable after
// loading but for scene_add_*. World space is right-handed, +Y up, metres. Colours are linear Rec.
// 709.
#pragma once

#include "core/arena.h"
#include "core/vec.h"

#include <stdint.h>

enum texture_wrap { WRAP_REPEAT, WRAP_MIRROR, WRAP_CLAMP };

// Decoded pixels, 8 bits, 4 channels, top row first, encoded as in the file (base colour and
// emissive: sRGB).
struct scene_image {
    const char *name;
    int width, height; // both ≤ SCENE_MAX_IMAGE_SIZE
    uint8_t *rgba;
    bool has_alpha; // some texel is not opaque
};
#define SCENE_MAX_IMAGE_SIZE 8192

// Use of an image by a material: which texture coordinates, how they are moved
// (KHR_texture_transform), the sampler.
struct texture_use {
    int image; // -1: none
    int uv_set;
    enum texture_wrap wrap_u, wrap_v;
    bool nearest;                                     // no filtering (magnification)
    float uv_offset[2], uv_scale[2], uv_rotation_rad; // identity: 0 0, 1 1, 0
};

enum alpha_mode { ALPHA_OPAQUE, ALPHA_MASK, ALPHA_BLEND };

// glTF 2.0 metallic-roughness. A factor multiplies its texture (white where there is none).
struct material {
    const char *name;
    vec4s base_color;
    float metallic, roughness;
    vec3s emissive; // cd/m², strength included
    float normal_scale;
    float alpha_cutoff; // for ALPHA_MASK; ALPHA_BLEND is drawn as a mask at 0.5
    enum alpha_mode alpha_mode;
    bool double_sided, unlit;
    struct texture_use base_color_map, metallic_roughness_map, normal_map, emissive_map;
};

struct morph_target {
    vec3s *positions, *normals; // differences; normals may be NULL
};

// One primitive: triangles with one material. Arrays of vertex_count but for indices.
struct mesh {
    const char *name;
    uint32_t vertex_count,
        index_count; // index_count is a multiple of 3, every index < vertex_count
    vec3s *positions;
    vec3s *normals;  // unit; made flat where the file has none
    vec4s *tangents; // w = ±1: bitangent = w · cross(normal, tangent); made where a normal map
                     // needs them, else NULL
    vec2s *uv[2];    // NULL where absent; v grows downwards as in glTF
    vec4s *colors;   // linear RGBA that multiplies base_color, NULL where absent
    uint16_t (*joints)[4]; // skinned meshes: indices into the skin's joints; NULL else
    vec4s *weights;        // sum 1
    uint32_t *indices;     // counter-clockwise from outside
    struct morph_target *morphs;
    int morph_count;
    int material; // always valid: materials[0] is made where the file has none
    struct box3 bounds;
};

struct node {
    const char *name;
    int parent; // -1, or less than the node's own index: parents come first
    vec3s translation;
    versors rotation;
    vec3s scale;
    bool has_matrix; // then `matrix` stands for the three above
    mat4s matrix;
};

// A mesh at a node. Skinned meshes ignore the node's transform, as glTF says.
struct instance {
    int node, mesh, skin; // skin -1: rigid
    float *morph_weights; // rest weights, morph_count of the mesh; NULL when it has none
};

enum light_type { LIGHT_SUN, LIGHT_POINT, LIGHT_SPOT };

// Punctual light at a node, shining along the node's -z (KHR_lights_punctual).
struct light {
    const char *name;
    enum light_type type;
    int node;
    vec3s intensity;            // colour × intensity: lux for suns, candela for points and spots
    float inner_rad, outer_rad; // half-angles of a spot, inner < outer ≤ π/2
    float range_m;              // 0: unlimited
};

struct camera {
    const char *name;
    int node; // looks along the node's -z, +y up
    float vertical_fov_rad;
    float near_m; // far is infinite
};

struct skin {
    int joint_count;
    int *joints;            // nodes
    mat4s *joint_from_mesh; // inverse bind matrices
};

enum channel_path { PATH_TRANSLATION, PATH_ROTATION, PATH_SCALE, PATH_WEIGHTS };
enum channel_interpolation { INTERPOLATE_STEP, INTERPOLATE_LINEAR, INTERPOLATE_CUBIC };

struct animation_channel {
    int node;
    enum channel_path path;
    enum channel_interpolation interpolation;
    int key_count, width; // width: floats per value (3, 4, or the number of morph targets)
    float *times_s;       // ascending
    float *values;        // key_count × width; CUBIC: in-tangent, value, out-tangent for each key
};

struct animation {
    const char *name;
    float duration_s;
    struct animation_channel *channels;
    int channel_count;
};

// Room in the scene's arrays, kept by scene_add_*. Whoever sets an array itself may leave its room
// at 0: the array is then copied before anything is appended.
struct scene_room {
    int images, materials, meshes, nodes, instances, lights, cameras;
};

struct scene {
    struct host *host;
    struct arena arena;
    struct scene_room room;
    const char *name; // file name or "@builtin:…"
    struct scene_image *images;
    int image_count;
    struct material *materials;
    int material_count;
    struct mesh *meshes;
    int mesh_count;
    struct node *nodes;
    int node_count;
    struct instance *instances;
    int instance_count;
    struct light *lights;
    int light_count;
    struct camera *cameras;
    int camera_count;
    struct skin *skins;
    int skin_count;
    struct animation *animations;
    int animation_count;
    vec3s sky;             // uniform radiance from outside, cd/m²
    uint64_t content_hash; // of the file's bytes or of the built-in's name
};

// Loads a file (glTF 2.0, .glb; OBJ, PLY, FBX, X) or a built-in, "@name" or "@name:key=value,…".
// Files are untrusted. NULL on failure. One warning names each thing that is left out.
struct scene *scene_load(struct host *host, const char *name);
// An empty scene to be filled by scene_add_*.
struct scene *scene_create(struct host *host, const char *name);
void scene_destroy(struct scene *scene);

// Appends a copy; the arrays that it points to are copied too. Returns the new index, -1 on failure
// (bad index, not finite, out of memory).
int scene_add_image(struct scene *scene, const struct scene_image *image);
int scene_add_material(struct scene *scene, const struct material *material);
int scene_add_mesh(struct scene *scene,
                   const struct mesh *mesh); // makes normals, tangents and bounds where missing
int scene_add_node(struct scene *scene, const struct node *node);
int scene_add_instance(struct scene *scene, const struct instance *instance);
int scene_add_light(struct scene *scene, const struct light *light);
int scene_add_camera(struct scene *scene, const struct camera *camera);
// A node at `position` whose -z points along `direction`.
int scene_add_node_looking(struct scene *scene, const char *name, vec3s position, vec3s direction);
void scene_remove_lights(struct scene *scene); // the punctual ones

struct material material_default(void);
struct node node_default(void);
struct texture_use texture_use_none(void);

size_t scene_triangle_count(const struct scene *scene); // over instances
bool scene_has_emission(const struct scene *scene); // some instanced mesh has an emissive material
size_t scene_memory_bytes(const struct scene *scene);
