// The probe volume: its image, its pass and its place.
#include "techniques/lpv/lpv_probes.h"

#include "techniques/lpv/lpv_state.h"

#include "technique_shaders.h"

enum { LOCAL = 8 };

bool lpv_probes_create(struct lpv *lpv)
{
    if (!lpv->options.probes) return true;
    const uint32_t dim = (uint32_t)lpv->options.dim;
    const struct gpu_image_desc volume = { .name = lpv->names->probes,
                                           .dimension = GPU_3D,
                                           .format = GPU_RGBA16F,
                                           .width = dim,
                                           .height = dim,
                                           .depth = dim * FRAME_PROBE_SLABS,
                                           .usage = GPU_SAMPLED | GPU_STORAGE };
    const struct gpu_constant bands = { LPV_CONSTANT_BANDS, (uint32_t)lpv->options.bands };
    return gpu_image_create(lpv->gpu, &volume, &lpv->probes.volume) &&
           gpu_compute_pipeline_create(lpv->gpu, lpv->names->probes, &shader_lpv_probes_comp,
                                       &bands, 1, &lpv->probes.pipeline);
}

void lpv_probes_destroy(struct lpv *lpv)
{
    gpu_image_destroy(lpv->gpu, &lpv->probes.volume);
    gpu_pipeline_destroy(lpv->gpu, &lpv->probes.pipeline);
}

uint64_t lpv_probes_bytes(const struct lpv_options *options)
{
    const uint64_t dim = (uint64_t)options->dim;
    if (!options->probes) return 0;
    return dim * dim * dim * FRAME_PROBE_SLABS * (uint64_t)gpu_format_bytes(GPU_RGBA16F);
}

// The finest cascade that covers all of the scene.
static const struct lpv *whole_of(const struct lpv *lpv)
{
    while (lpv->grid.open && lpv->coarser) lpv = lpv->coarser;
    return lpv;
}

static struct frame_probes place_of(const struct lpv *lpv)
{
    const struct lpv_grid *grid = &whole_of(lpv)->grid;
    if (!lpv->lit)
        return (struct frame_probes){
            .spacing_m = 1, .count_x = 1, .count_y = 1, .count_z = 1, .slab = lpv->options.dim
        };
    return (struct frame_probes){
        .first_m = glms_vec3_adds(grid->origin_m, 0.5f * grid->cell_m),
        .spacing_m = grid->cell_m,
        .count_x = grid->cells[0],
        .count_y = grid->cells[1],
        .count_z = grid->cells[2],
        .slab = lpv->options.dim,
    };
}

void lpv_record_probes(struct lpv *lpv, struct gpu_cmd *cmd)
{
    if (!lpv->options.probes) return;
    if (!lpv->lit) {
        gpu_clear_image(cmd, lpv->probes.volume, (const float[4]){ 0 });
        return;
    }
    const struct frame_probes place = place_of(lpv);
    const struct lpv *from = whole_of(lpv);
    gpu_scope_begin(cmd, lpv->names->probes);
    gpu_dispatch(cmd, lpv->probes.pipeline,
                 GPU_BIND(gpu_transient(cmd, "lpv_grid", &from->params, sizeof from->params),
                          { .name = "light", .image = from->light },
                          { .name = "probes", .image = lpv->probes.volume }),
                 &place, sizeof place, gpu_groups((uint32_t)place.count_x, LOCAL),
                 gpu_groups((uint32_t)place.count_y, LOCAL), (uint32_t)place.count_z);
    gpu_scope_end(cmd);
}

bool lpv_probes_publish(const struct lpv *lpv, struct probe_volume *out)
{
    if (!lpv->options.probes) return false;
    *out = (struct probe_volume){ lpv->probes.volume, place_of(lpv) };
    return true;
}
