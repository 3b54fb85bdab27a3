// The scene on the GPU: vertex streams, materials, textures and draws, for rasterising passes and
// for compute passes over triangles. A draw is one instance of one mesh, which has one material.
#pragma once

#include "gpu/gpu.h"
#include "scene/pose.h"

#include "frame/scene/scene_gpu_shared.h"

// Pipeline variants: bit SCENE_CONSTANT_… per map that a material has.
enum scene_variant {
    VARIANT_BASE_COLOR_MAP = 1 << SCENE_CONSTANT_BASE_COLOR_MAP,
    VARIANT_METALLIC_ROUGHNESS_MAP = 1 << SCENE_CONSTANT_METALLIC_ROUGHNESS_MAP,
    VARIANT_NORMAL_MAP = 1 << SCENE_CONSTANT_NORMAL_MAP,
    VARIANT_EMISSIVE_MAP = 1 << SCENE_CONSTANT_EMISSIVE_MAP,
    VARIANT_MASKED = 1 << SCENE_CONSTANT_MASKED,
    VARIANT_COUNT = 1 << SCENE_CONSTANT_COUNT,
};

struct scene_draw {
    int instance, mesh, material;
    uint32_t variant; // scene_variant bits
    struct scene_push push;
    bool deformed;      // vertices are uploaded each frame, in world space
    bool mirrored;      // the transform reverses the winding order in this frame
    bool dynamic;       // expected to move (scene/statics.h), or has moved since the scene was set
    bool left;          // movable, and neither sends nor occludes a source's light: a delta does
    bool moved;         // since the previous frame: its vertices, its alpha test, or `left`
    bool recolored;     // its material changed since the previous frame
    bool reshaped;      // its mesh has other vertices than in the previous frame
    bool movable;       // expected to move
    bool seen;          // in an earlier frame
    uint64_t added;     // of the instance
    struct box3 bounds; // world space
    struct box3 swept;  // union of this frame's and the previous frame's bounds
};

struct scene_gpu {
    struct host *host;
    struct gpu *gpu;
    const struct scene *scene;
    float max_emissive; // largest channel of all instanced materials, cd/m²
    bool has_unlit;
    bool has_dielectrics; // a drawn material has another specular lobe than the default

    // Uploaded data: positions (vec3), tangent frames (two words, see scene.glsl), surfaces,
    // indices, materials.
    gpu_buffer positions, frames, surfaces, indices, materials;
    size_t *index_offset; // [mesh_count] bytes
    // Textures: [image_count] as colours (sRGB) and as data; empty if no material uses them so.
    gpu_image *color_textures, *data_textures, *normal_textures;
    gpu_image white, flat_normal;                // 1×1 placeholders
    struct gpu_binding (*maps)[SCENE_MAP_COUNT]; // [material_count]
    struct gpu_binding *reads;                   // all textures, see gpu_render_desc.reads
    int read_count;
    int image_count; // of the arrays of textures

    struct scene_draw *draws; // sorted: opaque before masked, then by variant and material
    int draw_count;
    uint32_t variants_used; // bit v: some draw has variant v

    // Per frame, filled by scene_gpu_update.
    struct scene_instance *instances; // [instance_count]
    uint32_t deformed_vertex_count;
    vec3s *deformed_positions, *deformed_previous; // [deformed_vertex_count]
    uint32_t (*deformed_frames)[2];
    bool has_previous, moved, recolored;
    bool leaves_dynamic; // set before an update: see scene_draw.left
    uint64_t updates;    // number of uploaded poses
    int dynamic_count;   // number of dynamic draws
    // Counts changes of the list of draws, and of what static draws look like: what is computed of
    // them is valid while it stays.
    uint64_t draw_list, static_set;

    // Changes of the scene since it was set (scene_gpu_follow).
    struct scene_revisions followed; // the lists and arrays above are of these
    uint64_t uploaded;               // newest revision in the buffers
    gpu_buffer previous_positions;   // of meshes whose vertices changed; none before the first
    struct packed_vertices *packed;  // room for the largest of these meshes
    struct box3 *removed;            // bounds of draws of the last frame that are gone
    int removed_count;
    uint64_t removed_at; // the value of `updates` in the frame without them
    struct gpu_binding instances_binding, deformed_positions_binding, deformed_previous_binding,
        deformed_frames_binding;
};

// The scene must outlive this. On failure (false) call scene_gpu_finish.
bool scene_gpu_init(struct scene_gpu *out, struct host *host, struct gpu *gpu,
                    const struct scene *scene);
void scene_gpu_finish(struct scene_gpu *scene); // accepts zero

// Adapts buffers, textures and draws to changes of the scene, before scene_gpu_update; allocates.
// false: out of memory or too large for the device; call it again before the next frame.
bool scene_gpu_follow(struct scene_gpu *scene);

// Uploads a pose and the vertices and materials that changed. reset_motion: previous positions
// become the current ones. Updates `moved` and `dynamic` of the scene and its draws.
void scene_gpu_update(struct scene_gpu *scene, struct gpu_cmd *cmd, const struct scene_pose *pose,
                      bool reset_motion);

// Whether nothing that moved or was removed in the last update is or was inside this clip volume;
// with `materials`, nor anything whose material changed.
bool scene_gpu_unchanged_in(const struct scene_gpu *scene, mat4s clip_from_world, bool materials);
// The same of the shadows that instances cast inside a box, but for the `count` from `first` on.
bool scene_gpu_unchanged_around(const struct scene_gpu *scene, struct box3 box, uint32_t first,
                                uint32_t count);

// Part of a draw's triangles, whose indices fit into one binding of every device.
struct scene_triangle_range {
    uint32_t first_triangle, triangle_count;
    uint32_t first_index;       // of the first triangle, in the binding
    struct gpu_binding indices; // "scene_indices"
};
// The first part if *range is 0, else the next one. false: there is none.
bool scene_gpu_next_range(const struct scene_gpu *scene, const struct scene_draw *draw,
                          struct scene_triangle_range *range);

// Records one draw. push: starts with a scene_push, which this fills. bindings: of the pass.
struct scene_draw_call {
    gpu_pipeline pipeline;
    const struct scene_draw *draw;
    // NULL: an indexed draw of all triangles; else the vertex shader reads these indices.
    const struct scene_triangle_range *range;
    void *push;
    size_t push_bytes;
    enum gpu_cull cull;
    const struct gpu_binding *bindings;
    int binding_count; // ≤ 4
};
void scene_gpu_draw(const struct scene_gpu *scene, struct gpu_cmd *cmd,
                    const struct scene_draw_call *call);

// Records a compute dispatch over the triangles of one draw; the shader includes
// scene_triangles.glsl.
struct scene_dispatch_call {
    gpu_pipeline pipeline;
    bool rasterize; // `pipeline` is a graphics pipeline: draws the triangles in the open rendering
    const struct scene_draw *draw;
    const struct gpu_binding *bindings; // of the pass
    int binding_count;                  // ≤ 8
    // Optional second dispatch for work that `pipeline` queues, with the same bindings. Its work
    // group counts x, y, z are in deferred_groups, initialised to 0, 1, 1; a fourth word, 0, is for
    // the pass.
    gpu_pipeline deferred;
    gpu_buffer deferred_groups;
};
void scene_gpu_dispatch(const struct scene_gpu *scene, struct gpu_cmd *cmd,
                        const struct scene_dispatch_call *call);
