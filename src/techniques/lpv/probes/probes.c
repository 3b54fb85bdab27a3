// The probe volume: its pass and its grid.
#include "techniques/lpv/probes/probes.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"

static const struct lpv_cascade *finest_covering_scene(const struct lpv_cascade *cascade)
{
    while (cascade->grid.open && cascade->coarser) cascade = cascade->coarser;
    return cascade;
}

static struct frame_probes grid_of(const struct lpv_grid *grid, int32_t slab)
{
    return (struct frame_probes){
        .first_m = glms_vec3_adds(grid->origin_m, 0.5f * grid->cell_m),
        .spacing_m = grid->cell_m,
        .count_x = grid->cells[0],
        .count_y = grid->cells[1],
        .count_z = grid->cells[2],
        .slab = slab,
    };
}

void lpv_probes_create(struct lpv_probe_volume *probes, const struct lpv_options *options)
{
    probes->grid = (struct frame_probes){
        .spacing_m = 1, .count_x = 1, .count_y = 1, .count_z = 1, .slab = options->dim
    };
}

static void clear(struct lpv_probe_volume *probes, const struct lpv_frame *frame)
{
    lpv_probes_create(probes, frame->options);
    gpu_clear_image(frame->cmd, probes->image, (const float[4]){ 0 });
}

void lpv_record_probes(struct lpv_probe_volume *probes, const struct lpv_frame *frame,
                       const struct lpv_cascade *finest)
{
    if (!frame->options->probes) return;
    if (!finest) {
        clear(probes, frame);
        return;
    }
    const struct lpv_cascade *from = finest_covering_scene(finest);
    probes->grid = grid_of(&from->grid, frame->options->dim);
    gpu_scope_begin(frame->cmd, "probes");
    lpv_dispatch_cells_push(from, frame->cmd, probes->pipeline,
                            GPU_BIND(lpv_grid_binding(from, frame->cmd),
                                     { .name = "light", .image = from->light },
                                     { .name = "probes", .image = probes->image },
                                     { .name = "lpv_walls", .buffer = lpv_walls(frame, from) }),
                            &probes->grid, sizeof probes->grid);
    gpu_scope_end(frame->cmd);
}

bool lpv_probes_publish(const struct lpv_probe_volume *probes, const struct lpv_options *options,
                        struct probe_volume *out)
{
    if (!options->probes) return false;
    *out = (struct probe_volume){ .image = probes->image,
                                  .grid = probes->grid,
                                  .walls = options->geometry == LPV_GEOMETRY_SCENE };
    return true;
}
