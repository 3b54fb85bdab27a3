// The private state of radiosity.
#pragma once

#include "techniques/radiosity/probes/probes.h"
#include "techniques/radiosity/radiosity_follow.h"
#include "techniques/radiosity/radiosity_seams.h"
#include "techniques/radiosity/radiosity_shared.h"
#include "techniques/radiosity/radiosity_tensors.h"

struct radiosity_buffers {
    gpu_buffer texels, factors;                           // of texels
    gpu_buffer clusters, members, nodes, cluster_factors; // of clusters
    gpu_buffer points;                                    // of texels, for `smooth`
    gpu_buffer owners, instances, triangles;              // of the light map
    gpu_buffer places, seams;                             // beside seams
    gpu_buffer labels;                                    // of texels, for debug views
    gpu_buffer flux, light, smoothed;                     // [texels] of the newest light
    gpu_buffer sent, radiosity[2];                        // [clusters and nodes] likewise
    gpu_image light_map;
};

// Rows of form factors in one binding: a table may have more bytes than a binding.
struct radiosity_block {
    uint32_t first, count; // rows
    size_t offset, bytes;
};

struct radiosity_pipelines {
    gpu_pipeline direct, clusters, nodes, solve, gather, smooth, map, seams, apply, view;
};

struct radiosity {
    struct host *host;
    struct gpu *gpu;
    struct radiosity_options options;
    struct radiosity_map map; // without texels: an empty scene
    uint32_t instances, sides;
    uint32_t seam_places;
    float spectral_radius; // of ρ F, at least
    struct radiosity_buffers buffers;
    struct radiosity_pipelines pipelines;
    gpu_sampler linear;
    gpu_buffer solution; // one of the buffers: the radiosity of all bounces
    struct radiosity_probes probes;
    struct radiosity_followed followed;
    // What the light of the newest frame was computed from.
    struct {
        bool valid;
        uint64_t index, light; // of the frame; hash
    } inputs;
};

// ---- radiosity_upload.c, radiosity_factors.c

// Tables of the light map and of a bake on the GPU.
bool radiosity_upload(struct radiosity *state, const struct tensors *bake);
// Both tables of form factors, block after block. Rows are those of a bake.
bool radiosity_upload_factors(struct radiosity *state, const uint32_t *source,
                              const uint16_t *factor, const uint32_t *cluster_source,
                              const uint16_t *cluster_factor);

// The block that begins with a row.
struct radiosity_block radiosity_texel_block(const struct radiosity *state, uint32_t first);
struct radiosity_block radiosity_cluster_block(const struct radiosity *state, uint32_t first);

// ---- radiosity_record.c

void radiosity_record_light(struct radiosity *state, struct gpu_cmd *cmd,
                            const struct frame_view *view);
void radiosity_record_apply(struct radiosity *state, struct gpu_cmd *cmd,
                            const struct frame_view *view);

// ---- radiosity_view.c

extern const struct technique_debug_view radiosity_views[];
// points: [texels] position (m), share, of a bake.
bool radiosity_view_init(struct radiosity *state, const float *points);
void radiosity_view_record(struct radiosity *state, struct gpu_cmd *cmd,
                           const struct frame_view *view, const char *name, gpu_image out);
