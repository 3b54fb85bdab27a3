// Private state of the technique.
#pragma once

#include "techniques/technique.h"

#include "techniques/dnrt/dnrt_object.h"
#include "techniques/dnrt/dnrt_options.h"

#include "core/hash.h"
#include "frame/frame_shared.h"
#include "frame/shadow/shadow_casters.h"
#include "techniques/dnrt/dnrt_shared.h"

// The bounding sphere of a baked shape and its bounding box, in the object's frame.
struct dnrt_volume {
    vec3s centre;
    float radius;
    vec3s box_centre, box_half;
};

// Parts of `light`: that of the probes, two that bounces fill by turns, that of punctual lights.
enum { DNRT_LIGHT_PUNCTUAL = 3, DNRT_LIGHT_PARTS };

// The depth maps of an object: six layers, of the directions around its centre.
struct dnrt_map {
    vec3s centre;
    float radius, reach; // m
    uint32_t first_instance, instance_count;
    uint64_t updates; // scene_gpu.updates when they were last valid; 0: never
};

// The patches of a volume in their buffer.
struct dnrt_patch_range {
    uint32_t first, count;
};

struct dnrt {
    struct dnrt_options options;
    struct host *host;
    struct gpu *gpu;
    struct dnrt_objects baked;        // of the pose of `create`: their shapes are in the bake
    struct dnrt_objects objects;      // of the newest pose; shape: in `baked`, −1: none
    struct scene_revisions revisions; // of the scene when `objects` were found
    int without;                      // a volume, of the objects
    bool warned;                      // of them
    struct material *materials;       // [material_count] of the pose of `create`
    int material_count;
    bool warned_materials;       // that one of an object has changed
    int animation;               // of the key frames
    struct dnrt_volume *volumes; // [baked.volume_count]
    struct hash128 *keys;        // [baked.volume_count], of their tensors
    struct dnrt_frame *frames;   // [baked.shape_count] of their objects in the pose of `create`
    int slots[3];                // of objects along x, y, z of the image
    gpu_buffer shapes, samples, light, changed;
    bool stale;      // all volumes of `image`
    gpu_image image; // volumes of all objects in their light
    gpu_sampler linear;
    gpu_pipeline light_pipeline[2]; // [probes with depths]
    gpu_pipeline bounce_pipeline, volumes_pipeline;
    gpu_pipeline punctual_pipeline;    // of the option `direct`
    gpu_pipeline apply_pipeline[2][2]; // [with FRAME_ID][with depth maps]
    gpu_pipeline self_pipeline;        // of the option `self`
    gpu_buffer patch_buffer, point_buffer;
    struct dnrt_patch_range *patches; // [baked.volume_count]
    struct dnrt_own_instance *own;    // [own_count] of the scene's instances, of the frame
    uint32_t own_count;
    uint32_t newest_light; // first entry of `light` that the volumes have
    struct shadow_casters casters;
    gpu_image map_image;                 // D32F array; empty: intrusion=off
    struct dnrt_map *maps;               // [map_count]
    int map_count;                       // of the first objects
    int views;                           // one more than the largest number of a view
    struct probe_volume source;          // of the newest `set_probes`
    struct dnrt_gpu_object *gpu_objects; // [DNRT_MAX_OBJECTS] of the frame
    uint32_t *tiles;                     // scratch memory for the tiles of a view
    size_t most_tiles;                   // of a view
    size_t tiles_words;                  // allocated
};

// ---- dnrt_upload.c

bool dnrt_upload(struct dnrt *s, const struct tensors *bake);

// ---- dnrt_follow.c

// Finds the objects of the pose, and makes their volumes and tiles. Without memory there are none.
bool dnrt_find_objects(struct dnrt *s, const struct scene_pose *pose);
bool dnrt_make_tiles(struct dnrt *s);
void dnrt_follow(void *state, const struct scene_pose *pose, bool wait);
bool dnrt_lacks_bake(const void *state);

// ---- dnrt_intrusion.c

// Makes depth maps for all objects, none of them valid.
bool dnrt_make_maps(struct dnrt *s);
// Draws those that are not valid.
void dnrt_record_maps(struct dnrt *s, struct gpu_cmd *cmd, const struct frame_view *view);

// ---- dnrt_self.c

bool dnrt_upload_self(struct dnrt *s, const struct tensors *bake);
// Allocates the table of a scene's instances.
bool dnrt_make_own(struct dnrt *s, const struct scene *scene);
// After all objects of the frame have been placed.
void dnrt_place_own(struct dnrt *s, const struct scene *scene);
// Nothing without FRAME_ID or the option `self`. objects, tiles: of the pass `apply`.
void dnrt_record_self(const struct dnrt *s, struct gpu_cmd *cmd, const struct frame_view *view,
                      struct gpu_binding objects, struct gpu_binding tiles,
                      const struct dnrt_self_push *push, uint32_t tile_count);

// ---- dnrt_tiles.c

// Whether its outer volume is inside of the view.
bool dnrt_in_view(const struct dnrt *s, const struct frame_view *view, int object);

// Tiles that an object reaches, and those of them that may have pixels of an object.
struct dnrt_tile_counts {
    uint32_t all, own;
};

// Writes [tile][DNRT_TILE_BITS + words], tiles that may have pixels of an object first.
struct dnrt_tile_counts dnrt_find_tiles(const struct dnrt *s, const struct frame_view *view,
                                        uint32_t words, uint32_t *tiles);
