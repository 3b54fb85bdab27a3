// The scene on the GPU: vertex streams, materials, textures, and the draws that show it. Passes
// that rasterise, and techniques that walk the triangles in compute, share it. One draw is one
// instance of one mesh, which has one material.
#pragma once

#include "gpu/gpu.h"
#include "scene/pose.h"

#include "frame/scene_gpu_shared.h"

// Pipelines are specialised for the maps that a material has: a bit for each SCENE_CONSTANT_….
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
    bool deformed;      // vertices come anew each frame, in world space
    bool mirrored;      // this frame's transform turns triangles over
    bool moves;         // its vertices have moved since the scene was set; what has not is still
    bool moved;         // since the last frame
    struct box3 bounds; // this frame's, world space
    struct box3 swept;  // this frame's and the last one's
};

struct scene_gpu {
    struct host *host;
    struct gpu *gpu;
    const struct scene *scene;
    float max_emissive; // the strongest channel of any instanced material, cd/m²

    // Static: positions (vec3), tangent frames (two words, see scene.glsl), surfaces, indices,
    // materials.
    gpu_buffer positions, frames, surfaces, indices, materials;
    size_t *index_offset; // [mesh_count] bytes
    // Textures: [image_count] as colours (sRGB) and as data; none where no material uses them so.
    gpu_image *color_textures, *data_textures;
    gpu_image white, flat_normal;                // 1×1 stand-ins
    struct gpu_binding (*maps)[SCENE_MAP_COUNT]; // [material_count]
    struct gpu_binding *reads;                   // all textures, to be announced to renderings
    int read_count;

    struct scene_draw *draws; // sorted: opaque before masked, then by variant and material
    int draw_count;
    uint32_t variants_used; // bit v: some draw has variant v

    // Per frame, filled by scene_gpu_update.
    struct scene_instance *instances; // [instance_count]
    struct scene_instance *previous;  // last frame's, to see what moved
    uint32_t deformed_vertex_count;
    vec3s *deformed_positions, *deformed_previous; // [deformed_vertex_count]
    uint32_t (*deformed_frames)[2];
    bool has_previous, moved;
    uint64_t updates; // so many moments have been uploaded
    int moving_count; // draws that move
    struct gpu_binding instances_binding, deformed_positions_binding, deformed_previous_binding,
        deformed_frames_binding;
};

// The scene must outlive this. False after a failure; scene_gpu_finish accepts the half-built rest.
bool scene_gpu_init(struct scene_gpu *out, struct host *host, struct gpu *gpu,
                    const struct scene *scene);
void scene_gpu_finish(struct scene_gpu *scene); // accepts zero

// Uploads a moment. With `forget`, everything counts as having stood where it is. Sets `moved`, and
// that and `moves` of the draws.
void scene_gpu_update(struct scene_gpu *scene, struct gpu_cmd *cmd, const struct scene_pose *pose,
                      bool forget);

// Whether nothing that has moved since the last update is or was inside of this clip volume.
bool scene_gpu_still_in(const struct scene_gpu *scene, mat4s clip_from_world);

// Records one draw. push: starts with a scene_push, which this fills. bindings: the pass's own.
struct scene_draw_call {
    gpu_pipeline pipeline;
    const struct scene_draw *draw;
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
    bool drawn; // it is a graphics pipeline instead: three vertices for each triangle, into the
                // rendering that is open
    const struct scene_draw *draw;
    const struct gpu_binding *bindings; // the pass's own
    int binding_count;                  // ≤ 8
    // What `pipeline` puts off, if it does: `rest` follows with the same bindings, in as many
    // workgroups as `pipeline` says in rest_groups: x, y, z, which are 0, 1, 1 before it, and a
    // word of the pass's own, which is 0.
    gpu_pipeline rest;
    gpu_buffer rest_groups;
};
void scene_gpu_dispatch(const struct scene_gpu *scene, struct gpu_cmd *cmd,
                        const struct scene_dispatch_call *call);

// scene_gpu_textures.c
bool scene_gpu_make_textures(struct scene_gpu *scene);
void scene_gpu_destroy_textures(struct scene_gpu *scene);
