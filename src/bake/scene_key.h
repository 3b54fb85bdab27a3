// Hashes of a scene for the key of a bake: XXH3-128 of exactly the parts that the bake depends on.
// Cameras, names and animations are never part of a key, lights and the sky of scene_key_lit alone.
#pragma once

#include "core/hash.h"
#include "scene/pose.h"

enum scene_key_part {
    SCENE_KEY_GEOMETRY = 1,  // triangles of all instances in world space, with their material index
    SCENE_KEY_MATERIALS = 2, // reflectance, textures and emission of materials in use
};

// parts: scene_key_part bits. Continue with hash128_add for block maps and the like.
struct hash128 scene_key(const struct scene_pose *pose, unsigned parts);

// ---- parts of the key, of an instance with a mesh or of a material

// Triangles in world space.
struct hash128 scene_key_add_shape(struct hash128 key, const struct scene_pose *pose, int instance);
// Attributes of the vertices that materials read.
struct hash128 scene_key_add_attributes(struct hash128 key, const struct scene *scene,
                                        int instance);
struct hash128 scene_key_add_material(struct hash128 key, const struct scene *scene, int material);
// Geometry, materials and all light: lights that are on, the sky, the environment.
struct hash128 scene_key_lit(const struct scene_pose *pose);
// A light of a pose: for bakes of light, whose keys have them besides scene_key.
struct hash128 scene_key_add_light(struct hash128 key, const struct world_light *light);
