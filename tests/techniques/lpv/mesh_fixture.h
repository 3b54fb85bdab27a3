// Meshes for an rsm_fixture: a scene made by code, for techniques that read the
// scene's triangles.
#pragma once

#include "frame/scene/scene_gpu.h"
#include "techniques/lpv/lpv_fixture.h"

struct mesh_fixture {
    struct rsm_fixture *rsm;
    struct scene *scene;
    struct scene_pose pose;
    struct scene_gpu scene_gpu;
};

void mesh_fixture_init(struct mesh_fixture *meshes, struct rsm_fixture *rsm);
void mesh_fixture_finish(struct mesh_fixture *meshes);
// Adds a mesh in world space; without indices its triangles are consecutive vertices.
// Returns its instance.
int mesh_fixture_add(struct mesh_fixture *meshes, const vec3s *positions, uint32_t vertex_count,
                     const uint32_t *indices, uint32_t index_count);
// The parallelogram corner + [0,1] across + [0,1] down.
int mesh_fixture_add_wall(struct mesh_fixture *meshes, vec3s corner, vec3s across, vec3s down);
// Random triangles of all sizes over the bounds and beyond, determined by the seed.
int mesh_fixture_add_soup(struct mesh_fixture *meshes, uint32_t seed);
void mesh_fixture_place(struct mesh_fixture *meshes); // on the rsm, when all are added
void mesh_fixture_move(struct mesh_fixture *meshes, int instance,
                       float by); // along x, from the next frame on
// Renders one frame and waits for it.
void mesh_fixture_render(struct mesh_fixture *meshes, struct lpv *lpv);
