// Materials, cameras and lights shared by the built-in scenes. Internal to src/scene/builtin.
#pragma once

#include "scene/builtin/builtin.h"
#include "scene/builtin/shapes.h"

extern const struct builtin_scene builtin_cornell, builtin_corridor, builtin_maze, builtin_tunnel,
    builtin_spheres, builtin_diagonal, builtin_atrium, builtin_planter;

// A diffuse material without textures; -1 on failure.
int builtin_diffuse(struct scene *scene, const char *name, vec3s reflectance);
// A black emissive material, cd/m²; -1 on failure.
int builtin_emitter(struct scene *scene, const char *name, vec3s radiance);
// A node and a camera at it, near plane 1 cm. The first camera of a scene is called "main".
bool builtin_camera(struct scene *scene, const char *name, vec3s position, vec3s target,
                    float vertical_fov_rad);
// A node and a point light (candela) at it.
bool builtin_point_light(struct scene *scene, const char *name, vec3s position, vec3s candela);
// A node at `position` and a sun (lux) that shines along `direction`.
bool builtin_sun(struct scene *scene, const char *name, vec3s position, vec3s direction, vec3s lux);
// A warm white light: an emissive sphere of 12 cm radius, or a point light of the same luminous
// flux.
bool builtin_sphere_light(struct scene *scene, vec3s centre, bool as_point, float lumens);
// A node with a block of the block map (docs/block-maps.md): the unit cube under this transform.
// `neighbors`: members of the JSON object.
bool builtin_block(struct scene *scene, const char *name, mat4s world_from_block, const char *shape,
                   const char *neighbors);
