// Parts of the scene on the GPU, shared by scene_gpu*.c.
#pragma once

#include "frame/scene/scene_gpu.h"

// Positions and tangent frames of one mesh in the format of the GPU.
struct packed_vertices {
    uint32_t capacity;
    uint32_t frames[][2];
};

void scene_gpu_pack_frame(vec3s normal, const vec4s *tangent, uint32_t out[2]);
struct scene_material scene_gpu_pack_material(const struct material *material);

// Each fills empty members. On failure they may be half built.
bool scene_gpu_make_streams(struct scene_gpu *scene);
bool scene_gpu_make_materials(struct scene_gpu *scene);
bool scene_gpu_make_draws(struct scene_gpu *scene);
void scene_gpu_summarize_materials(struct scene_gpu *scene); // of the draws
void scene_gpu_finish_streams(struct scene_gpu *scene);
void scene_gpu_finish_draws(struct scene_gpu *scene);

// scene_gpu_textures.c
bool scene_gpu_make_textures(struct scene_gpu *scene);
void scene_gpu_destroy_textures(struct scene_gpu *scene);
