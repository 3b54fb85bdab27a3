// solver=cpu: reads the direct light of the level's texels back from the GPU, solves on all cores
// and uploads the irradiance. Nothing waits: a frame shows the light of MRT_HOST_DELAY frames
// before, which the GPU has completed (later, where an engine has more frames pending).
#pragma once

#include "gpu/gpu.h"

#include "techniques/mrt/level/geometry.h"
#include "techniques/mrt/level/solver.h"

enum { MRT_HOST_DELAY = GPU_FRAMES_IN_FLIGHT }; // 2

// Direct light that is on its way.
struct mrt_host_slot {
    struct gpu_readback readback;
    uint64_t frame;
    float scale; // radiance_scale
};

struct mrt_host_solver {
    struct host *host;
    struct gpu *gpu;
    struct mrt_solver solver;
    struct mrt_host_slot slots[2]; // take turns
    int texels;
    vec3s *reflectance, *direct, *radiosity, *irradiance; // [texels]
    bool solved;     // since the last call of mrt_host_solver_forget
    uint64_t newest; // frame that was solved last
    float scale;     // its radiance_scale
};

bool mrt_host_solver_init(struct mrt_host_solver *out, struct host *host, struct gpu *gpu,
                          const struct mrt_level *level, const struct mrt_geometry_texel *geometry);
// geometry: of the same texels.
void mrt_host_solver_set_reflectance(struct mrt_host_solver *solver,
                                     const struct mrt_geometry_texel *geometry);
void mrt_host_solver_finish(struct mrt_host_solver *solver); // accepts zero
// Frames before this call are neither solved nor shown.
void mrt_host_solver_forget(struct mrt_host_solver *solver);

struct mrt_host_frame {
    uint64_t index;
    gpu_buffer direct, irradiance; // vec3 per texel
    gpu_buffer radiosity;          // of the last bounce, for probes; none: id 0
    int bounces;
    bool feedback;
    float rest; // of struct mrt_bounces
    float radiance_scale;
};
// Reads `direct`, solves for light that has arrived, and uploads the newest solution into
// `irradiance` and `radiosity`; false: there is none yet.
bool mrt_host_solver_record(struct mrt_host_solver *solver, struct gpu_cmd *cmd,
                            const struct mrt_host_frame *frame);
