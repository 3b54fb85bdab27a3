// Things that stand on a stage: a scene of meshes made by code, for techniques that read the
// scene's triangles.
#pragma once

#include "frame/scene_gpu.h"
#include "techniques/lpv_fixture.h"

struct props {
    struct stage *stage;
    struct scene *scene;
    struct scene_pose pose;
    struct scene_gpu scene_gpu;
};

void props_init(struct props *props, struct stage *stage);
void props_finish(struct props *props);
// Adds a mesh where it stands; its triangles are vertices in a row where there are no indices.
// Returns its instance.
int props_add(struct props *props, const vec3s *positions, uint32_t vertex_count,
              const uint32_t *indices, uint32_t index_count);
// The parallelogram corner + [0,1] across + [0,1] down.
int props_add_wall(struct props *props, vec3s corner, vec3s across, vec3s down);
// Triangles large and small all over the stage's bounds and beyond, the same for the same seed.
int props_add_soup(struct props *props, uint32_t seed);
void props_place(struct props *props);                        // on the stage, when all are added
void props_move(struct props *props, int instance, float by); // along x, from the next frame on
// One frame, waited for.
void props_render(struct props *props, struct lpv *lpv);
