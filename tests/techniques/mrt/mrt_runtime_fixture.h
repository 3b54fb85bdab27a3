// A level without a scene, for tests of the run time: texels lie on the walls of the blocks.
// Failures end the test.
#pragma once

#include "framework/gpu_test.h"
#include "techniques/mrt/gpu/runtime.h"

struct mrt_runtime_fixture {
    struct mrt_block_map map;
    struct mrt_atlas atlas;
    struct mrt_scene_images images;
    struct mrt_operators operators;
    struct mrt_runtime_input input;
};

// Takes the map. Surfaces of this reflectance, all operators 0, as yet without pairs.
void mrt_runtime_fixture_init(struct mrt_runtime_fixture *f, struct mrt_block_map map,
                              int resolution, int k_b, int k_r, vec3s reflectance);
void mrt_runtime_fixture_finish(struct mrt_runtime_fixture *f);
// Operators of random numbers; each opening receives light of two blocks.
void mrt_runtime_fixture_randomize(struct mrt_runtime_fixture *f, uint32_t seed);
// The operators of a closed cube, from the dictionary; the map is one closed block.
void mrt_runtime_fixture_use_closed_cube(struct mrt_runtime_fixture *f);
// One closed block at these bounds.
struct mrt_block_map mrt_one_block(vec3s min, vec3s max);

// Irradiance after one bounce of this radiosity (3 floats per texel), by the matrices. The caller
// frees both.
float *mrt_runtime_fixture_solve(const struct mrt_runtime_fixture *f, const float *radiosity);
// `vector`: 4 × 3 floats per texel, irradiance by normal.
float *mrt_runtime_fixture_solve_vector(const struct mrt_runtime_fixture *f,
                                        const float *radiosity);
