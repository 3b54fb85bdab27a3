// Changes of a scene after its creation. Each checks its arguments before it changes the scene, and
// counts the change in scene->revisions. Memory of removed objects is used again.
#pragma once

#include "scene/scene.h"

// Places an instance in the world. It leaves its node, with the node's animation and children, and
// counts as movable from then on. False: it is skinned, or out of memory.
bool scene_set_instance_transform(struct scene *scene, int instance, mat4s world_from_mesh);
void scene_set_instance_movable(struct scene *scene, int instance, bool movable);
// Its index is given to the next instance that is added.
void scene_remove_instance(struct scene *scene, int instance);
// Adds an instance at a node of its own; -1 on failure.
int scene_add_placed_instance(struct scene *scene, int mesh, mat4s world_from_mesh, bool movable);

// Replaces the vertices of a mesh: positions and normals of source_count vertices (vertex_count
// where `source` is NULL). normals NULL: flat ones are computed, others stay. Tangents are computed
// where a normal map needs them. Instances of the mesh count as movable from then on.
bool scene_update_mesh(struct scene *scene, int mesh, const vec3s *positions, const vec3s *normals);

// Replaces the factors and flags of a material; name, maps and alpha mode stay.
bool scene_set_material(struct scene *scene, int material, const struct material *values);

// A punctual light and where it is; `node` of the light is ignored, its name is a literal.
struct placed_light {
    struct light light;
    vec3s position, direction; // direction: any length
};
int scene_add_placed_light(struct scene *scene, const struct placed_light *light);
// The light leaves its node. Its name stays.
bool scene_set_light(struct scene *scene, int light, const struct placed_light *values);
void scene_remove_lights(struct scene *scene); // all punctual lights
void scene_set_sky(struct scene *scene, vec3s radiance);
// The scene keeps a reference to the map. NULL: no map.
void scene_set_environment_map(struct scene *scene, const struct environment_map *map,
                               float strength, float rotation_rad);
