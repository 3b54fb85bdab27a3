// solver=cpu: reads the direct light of the level's texels back from the GPU, solves on all cores
// and uploads the irradiance. Nothing waits: the light that a frame shows is that of the newest
// frame that the GPU has completed.
#pragma once

#include "gpu/gpu.h"

#include "techniques/mrt/level/geometry.h"
#include "techniques/mrt/level/solver.h"

struct mrt_host_solver {
    struct host *host;
    struct gpu *gpu;
    struct mrt_solver solver;
    struct gpu_readback readback;
    int texels;
    vec3s *albedo, *direct, *radiosity, *irradiance; // [texels]
    float scale; // of the frame that was read last, radiance_scale
    float newest_scale;
    bool solved;
};

bool mrt_host_solver_init(struct mrt_host_solver *out, struct host *host, struct gpu *gpu,
                          const struct mrt_level *level, const struct mrt_geometry_texel *geometry);
void mrt_host_solver_finish(struct mrt_host_solver *solver); // accepts zero

struct mrt_host_frame {
    gpu_buffer direct, irradiance; // vec3 per texel
    gpu_buffer radiosity;          // of the last bounce, for probes; none: id 0
    int bounces;
    bool feedback;
    float radiance_scale;
};
// Solves what has arrived, uploads it into `irradiance` and `radiosity` and asks for `direct`.
void mrt_host_solver_record(struct mrt_host_solver *solver, struct gpu_cmd *cmd,
                            const struct mrt_host_frame *frame);
