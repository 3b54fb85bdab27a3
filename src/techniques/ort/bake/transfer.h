// R(t, t′): irradiance of texel t by unit first-order irradiance of t′, per area of t′, in 1/m² for
// each colour. Light of one bounce by the form factor between the two points and a shadow ray,
// light of more bounces by patches, light that scatters below the surface by its profile.
#pragma once

#include "techniques/ort/bake/patches.h"
#include "techniques/ort/bake/texels.h"

struct ort_transfer {
    struct ort_texels texels;
    const struct ort_patch *patches;
    const float *bounces; // ORT_BOUNCES
    uint32_t patch_count;
};
bool ort_transfer_init(struct ort_transfer *out, const struct bake_task *task);

// A receiver: hits of its rays, and their light of more than one bounce.
struct ort_receiver {
    uint32_t texel;
    struct ort_texel at;
    float single[3];    // transfer of one bounce: the sum of its row
    float multiple[3];  // and of more
    float scattered[3]; // below the surface
    float *indirect;    // [3][patches] transfer of more than one bounce from each patch
    float *hit;         // [3][patches] of one bounce, by the rays
    float *sent;        // [3][patches] of one bounce, times that of the second: within a call
};
bool ort_receiver_init(struct ort_receiver *out, struct host *host, uint32_t patches);
void ort_receiver_finish(struct ort_receiver *receiver, struct host *host);
// False: the texel is inside geometry.
bool ort_receive(const struct ort_transfer *transfer, uint32_t texel, struct ort_receiver *out);

// From another texel: by one bounce; the same by the mean of its patch; by more bounces; below the
// surface, where there is a kernel.
void ort_transfer_single(const struct ort_transfer *transfer, const struct ort_receiver *to,
                         uint32_t from, float out[3]);
void ort_transfer_patch(const struct ort_transfer *transfer, const struct ort_receiver *to,
                        uint32_t from, float out[3]);
void ort_transfer_multiple(const struct ort_transfer *transfer, const struct ort_receiver *to,
                           uint32_t from, float out[3]);
void ort_transfer_scattered(const struct ort_transfer *transfer, const struct ort_receiver *to,
                            uint32_t from, float out[3]);
