// Specular lobes as rows of a matrix (Sloan, Kautz & Snyder 2002; Hong 2015, section 2.5.1.4). In
// the frame of a normal, +z, a surface reflects the radiance L(ω) towards ω_o as the mean
//
//     M(ω_o) = ∫ L(ω) f(ω, ω_o) cos θ dω / ∫ f(ω, ω_o) cos θ dω
//
// over the GGX lobe f, without Fresnel's factor: the frame has it, with the albedo of the lobe. M
// over the hemisphere of outgoing directions is Σ_k m_k y_k(ω_o). Spherical harmonics y_k are not
// orthonormal there: m_k = ⟨M, ỹ_k⟩ with their dual basis, and from rays ω_s
//
//     m_k = Σ_s rows[k][s] L(ω_s).
#pragma once

#include "core/host.h"
#include "techniques/prt/prt_shared.h"

#include <stddef.h>

enum { PRT_LOBES = 8 }; // roughnesses, in equal steps

//
// With the matrix G of products ⟨y_k, y_j⟩, coefficients √G m have the norm of M.
struct prt_lobes {
    struct host *host;
    float root[PRT_OUTGOING][PRT_OUTGOING], inverse_root[PRT_OUTGOING][PRT_OUTGOING]; // of G
    size_t rays;
    vec3s *direction; // [rays] over the hemisphere, of equal solid angles
    float *rows;      // [PRT_LOBES][PRT_OUTGOING][rays]
};

// prt_lobes_finish accepts zero.
bool prt_lobes_init(struct prt_lobes *out, struct host *host, size_t rays);
void prt_lobes_finish(struct prt_lobes *lobes);
// [PRT_OUTGOING][rays] of a roughness, 0…1.
void prt_lobes_at(const struct prt_lobes *lobes, float roughness, float *out);
// Multiplies the rows of a matrix, [PRT_OUTGOING][width], from the left.
void prt_lobes_transform(const float by[PRT_OUTGOING][PRT_OUTGOING], float *matrix, size_t width);
