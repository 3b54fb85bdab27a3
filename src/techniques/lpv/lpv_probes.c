// The probe volume: its pass and its grid.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/lpv/lpv_bindings.h"

static const struct lpv *finest_covering_scene(const struct lpv *lpv)
{
    while (lpv->grid.open && lpv->coarser) lpv = lpv->coarser;
    return lpv;
}

static struct frame_probes probe_grid(const struct lpv *finest)
{
    const struct lpv_grid *grid = &finest_covering_scene(finest)->grid;
    const int32_t slab = finest->options.dim;
    if (!finest->lit)
        return (struct frame_probes){
            .spacing_m = 1, .count_x = 1, .count_y = 1, .count_z = 1, .slab = slab
        };
    return (struct frame_probes){
        .first_m = glms_vec3_adds(grid->origin_m, 0.5f * grid->cell_m),
        .spacing_m = grid->cell_m,
        .count_x = grid->cells[0],
        .count_y = grid->cells[1],
        .count_z = grid->cells[2],
        .slab = slab,
    };
}

void lpv_record_probes(struct lpv *finest, struct gpu_cmd *cmd)
{
    const gpu_image volume = finest->volumes.probes;
    if (!finest->options.probes) return;
    if (!finest->lit) {
        gpu_clear_image(cmd, volume, (const float[4]){ 0 });
        return;
    }
    const struct frame_probes grid = probe_grid(finest);
    const struct lpv *from = finest_covering_scene(finest);
    gpu_scope_begin(cmd, "probes");
    lpv_dispatch_cells_push(from, cmd, finest->pipelines.probes,
                            GPU_BIND(lpv_grid_binding(from, cmd),
                                     { .name = "light", .image = from->volumes.light },
                                     { .name = "probes", .image = volume },
                                     { .name = "lpv_walls", .buffer = lpv_walls(from) }),
                            &grid, sizeof grid);
    gpu_scope_end(cmd);
}

bool lpv_probes_publish(const struct lpv *finest, struct probe_volume *out)
{
    if (!finest->options.probes) return false;
    *out = (struct probe_volume){ .image = finest->volumes.probes,
                                  .grid = probe_grid(finest),
                                  .walls = finest->options.geometry == LPV_GEOMETRY_SCENE };
    return true;
}
