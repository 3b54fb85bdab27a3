// A scene: meshes, materials, textures, nodes, instances, lights, cameras, skins, animations.
// Plain arrays in the scene's arena; objects refer to each other by index, -1 is none. Changed only
// by scene_add_* and the functions of scene_edit.h, which count the changes (scene_revisions).
// World space is right-handed, +Y up, metres. Colours are linear Rec. 709.
#pragma once

#include "core/arena.h"
#include "core/vec.h"
#include "scene/environment.h"

#include <stdatomic.h>
#include <stdint.h>

enum texture_wrap { WRAP_REPEAT, WRAP_MIRROR, WRAP_CLAMP };

// Decoded pixels, 8 bits, 4 channels, top row first, encoded as in the file (colours: sRGB).
struct scene_image {
    const char *name;
    int width, height; // both ≤ SCENE_MAX_IMAGE_SIZE
    uint8_t *rgba;
    bool has_alpha; // some texel is not opaque
    bool linear;    // colours are linear instead
};
#define SCENE_MAX_IMAGE_SIZE 8192

// A material's reference to an image (glTF textureInfo): texture coordinate set, transform
// (KHR_texture_transform), sampler.
struct texture_use {
    int image; // -1: none
    int uv_set;
    enum texture_wrap wrap_u, wrap_v;
    bool nearest;                                     // nearest-neighbour magnification
    float uv_offset[2], uv_scale[2], uv_rotation_rad; // identity: 0 0, 1 1, 0
};

enum alpha_mode { ALPHA_OPAQUE, ALPHA_MASK, ALPHA_BLEND };

// glTF 2.0 metallic-roughness with KHR_materials_specular, _ior and _unlit (docs/materials.md).
// Factors multiply their textures; an absent texture is white.
struct material {
    const char *name;
    vec4s base_color;
    float metallic, roughness;
    // The dielectric's specular lobe: F90 = weight, F0 = min(((ior − 1)/(ior + 1))² · colour, 1) ·
    // weight. Weight 0 is purely diffuse.
    float ior;            // ≥ 1, or 0 for F0 = 1
    float specular;       // weight, 0…1
    vec3s specular_color; // ≥ 0
    vec3s emissive;       // cd/m², strength included
    float normal_scale;
    float alpha_cutoff; // for ALPHA_MASK; ALPHA_BLEND is drawn as a mask at 0.5
    enum alpha_mode alpha_mode;
    bool double_sided;
    bool unlit; // shown as base_color × unlit_white (unlit.h); occludes, neither reflects nor emits
    struct texture_use base_color_map, metallic_roughness_map, normal_map, emissive_map;
    struct texture_use specular_map;       // A: weight
    struct texture_use specular_color_map; // RGB
    uint64_t revision;                     // of its last change
};

struct morph_target {
    vec3s *positions, *normals; // offsets from the base mesh; normals may be NULL
};

// A glTF primitive: triangles of one material. All arrays but indices have vertex_count elements.
struct mesh {
    const char *name;
    uint32_t vertex_count;
    uint32_t index_count; // a multiple of 3
    vec3s *positions;
    vec3s *normals;  // unit length; flat where the file has none
    vec4s *tangents; // bitangent = w · cross(normal, tangent), w = ±1; NULL without a normal map
    vec2s *uv[2];    // NULL where absent; v grows downwards as in glTF
    vec4s *colors;   // linear RGBA that multiplies base_color, NULL where absent
    uint16_t (*joints)[4]; // skinned meshes: indices into the skin's joints; NULL else
    vec4s *weights;        // sum 1
    uint32_t *indices;     // < vertex_count; counter-clockwise from outside
    struct morph_target *morphs;
    int morph_count;
    int material; // always valid: a default material is added where the file has none
    struct box3 bounds;
    // Vertices as they were given, before some were duplicated: vertex v is a copy of source[v].
    uint32_t *source; // NULL: v
    uint32_t source_count;
    bool flat_normals; // made from the triangles
    bool own_arrays;   // no other mesh shares positions, normals and tangents
    uint64_t revision; // of the last change of its vertices
};

enum node_mobility { MOBILITY_INHERITED, MOBILITY_STATIC, MOBILITY_MOVABLE };

struct node {
    const char *name;
    enum node_mobility mobility; // of a file, for the instances at the node and its descendants
    int parent;                  // -1, or less than the node's own index: parents come first
    vec3s translation;
    versors rotation;
    vec3s scale;
    bool has_matrix; // then `matrix` replaces the three above
    mat4s matrix;
    const char *extras; // JSON text of glTF's application-specific data, an object; NULL: none
    int next_free;      // of a node that is not in use: the next one, -1 for the last
};

// A mesh at a node. Skinned meshes ignore the node's transform, as glTF says.
struct instance {
    // skin -1: rigid; mesh -1: removed, and its index free for another instance. Read meshes
    // through scene_mesh_of.
    int node, mesh, skin;
    float *morph_weights; // rest weights, morph_count of the mesh; NULL when it has none
    bool movable;         // is expected to move: techniques keep it apart from static geometry
    bool own_node;        // nothing else is at the node
    uint64_t added;       // revision at which it took its index
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
    bool off;                   // emits nothing
    bool own_node;              // nothing else is at the node
};

struct camera {
    const char *name;
    int node; // viewing direction is the node's -z, up its +y
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

// Allocated lengths of the scene's arrays, maintained by scene_add_*. Importers set arrays directly
// and leave 0: scene_add_* then copies the array before it appends.
struct scene_capacity {
    int images, materials, meshes, nodes, instances, lights, cameras;
};

// `newest` counts all changes since creation or loading; the others have its value at the last
// change of their part. Users of the scene compare them with those that they know.
struct scene_revisions {
    uint64_t newest;
    uint64_t layout;     // nodes or instances added, the mesh of an instance replaced
    uint64_t instances;  // added, removed, their mobility
    uint64_t statics;    // static instances added or removed
    uint64_t resources;  // meshes, materials or images added
    uint64_t transforms; // instances placed elsewhere
    uint64_t vertices;   // mesh.revision has which
    uint64_t materials;  // material.revision has which
    uint64_t lights;     // punctual lights and sky
};

struct scene {
    struct host *host;
    struct arena arena;
    struct scene_capacity capacity;
    struct scene_revisions revisions;
    int free_node;           // first node that is not in use, -1: none
    int free_instance_count; // removed ones
    int first_free_instance; // at most the lowest index of a removed one
    const char *name;        // file name or "@builtin:…"
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
    struct environment environment;
    uint64_t file_environment; // environment_map_use_key of the environment that the file has
    uint64_t content_hash; // of the file's bytes or of the built-in's name, and of another scale
    float scale;           // metres per unit of length of the file (rescale.h)
    // Broken unwraps were warned of: light maps are planned several times. Shared with
    // copies of this struct.
    atomic_bool *warned_of_unwraps;
};

// Loads a file (glTF 2.0, .glb; OBJ, PLY, FBX, X) or a built-in, "@name" or "@name:key=value,…".
// Files are untrusted. NULL on failure. One warning lists the features that are ignored.
struct scene *scene_load(struct host *host, const char *name);
// The same, with another scale than 1 (rescale.h).
struct scene *scene_load_scaled(struct host *host, const char *name, float scale);
// An empty scene, for scene_add_*.
struct scene *scene_create(struct host *host, const char *name);
void scene_destroy(struct scene *scene);
// Another host of the same memory. The scene has no poses.
void scene_set_host(struct scene *scene, struct host *host);

// Appends a deep copy. Returns the new index; -1 on failure (invalid index, value out of range or
// not finite, out of memory).
int scene_add_image(struct scene *scene, const struct scene_image *image);
int scene_add_material(struct scene *scene, const struct material *material);
// Generates missing normals, the tangents that a normal map needs, and bounds.
int scene_add_mesh(struct scene *scene, const struct mesh *mesh);
int scene_add_node(struct scene *scene, const struct node *node);
int scene_add_instance(struct scene *scene, const struct instance *instance);
int scene_add_light(struct scene *scene, const struct light *light);
int scene_add_camera(struct scene *scene, const struct camera *camera);
// A node at `position` whose -z points along `direction`.
int scene_add_node_looking(struct scene *scene, const char *name, vec3s position, vec3s direction);

struct material material_default(void);
#define MATERIAL_DEFAULT_IOR 1.5f // F0 = 0.04
// Unlit materials do not emit: their colour is not light (KHR_materials_unlit).
void material_clear_emission(struct material *material);
// ((ior − 1)/(ior + 1))² · specular colour, before the clamp to 1 and the weight.
vec3s material_specular_f0(const struct material *material);
// Whether both reflect the same light, of equal maps.
bool material_reflects_alike(const struct material *a, const struct material *b);
bool material_has_default_specular(const struct material *material); // factors and textures
struct node node_default(void);
struct texture_use texture_use_none(void);

// The mesh of an instance; without vertices for a removed one.
const struct mesh *scene_mesh_of(const struct scene *scene, int instance);
size_t scene_triangle_count(const struct scene *scene); // sum over instances
bool scene_has_emission(const struct scene *scene); // some instanced mesh has an emissive material
size_t scene_memory_bytes(const struct scene *scene);
