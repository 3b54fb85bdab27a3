// Data that all tasks of a bake share.
#pragma once

#include "bake/plan.h"
#include "scene/statics.h"
#include "techniques/prt/bake/lobes.h"
#include "techniques/prt/prt_tensors.h"
#include "trace/texels/close.h"
#include "trace/texels/light.h"
#include "trace/texels/texels.h"

struct prt_scene {
    struct host *host;
    const struct scene_pose *pose;
    struct prt_options options;
    // Made while planning:
    struct charts charts; // of the receivers
    struct prt_receivers receivers;
    // Between prepare and finish:
    struct scene_statics statics;
    struct trace_scene *trace;
    struct seam_closing closing;
    struct prt_lobes lobes; // with `glossy`
};

// Tensors that live during the bake alone.
#define PRT_HITS "texels/hit"    // U32 [texels][rays]: the one that a ray meets; CHART_NONE: none
#define PRT_ROWS "texels/direct" // F32 [texels][coefficients]: transfer without bounces

// Irradiance of unit coefficients by a whole sky: the clamped cosine around the normal.
static inline void prt_unshadowed(int bands, vec3s normal, float *out)
{
    float zonal[SH_MAX_BANDS];
    zh_clamped_cosine(bands, zonal);
    zh_rotate(bands, zonal, normal, out);
}

// ---- sample.c: receivers in the traced scene

// The sample point of a receiver, and the share of it that is not inside geometry; 0: none is.
struct texel_point prt_receiver_point(const struct prt_scene *scene, uint32_t receiver);
// Offset of rays that leave it.
float prt_receiver_reach(const struct prt_scene *scene, uint32_t receiver);
// As texel_reflectance; at vertices the cosines are those to the vertex's normal.
vec4s prt_receiver_reflectance(const struct prt_scene *scene, uint32_t receiver);

// ---- rays.c: rays of all receivers
bool prt_add_rays(struct bake_plan *plan, const struct prt_scene *scene);

// ---- transfer.c: transfer vectors with bounces, by coefficient
bool prt_add_transfer(struct bake_plan *plan, const struct prt_scene *scene);

// ---- matrices.c: transfer matrices of texels, with `glossy`
enum { PRT_MATRICES_WAVE = 2 };
bool prt_add_matrices(struct bake_plan *plan, const struct prt_scene *scene);

// ---- probes.c: transfer matrices of points in free space
bool prt_add_probes(struct bake_plan *plan, const struct prt_scene *scene);

// ---- compression.c: of vectors and matrices, if there is one
enum { PRT_COMPRESSION_WAVE = 3 };
// How long a tensor stays that is compressed.
static inline int prt_keep(const struct prt_options *options)
{
    return prt_clusters(options) > 0 ? PRT_COMPRESSION_WAVE : BAKE_SAVED;
}
bool prt_add_compression(struct bake_plan *plan, const struct prt_scene *scene);
