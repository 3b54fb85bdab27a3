// Diagnostics: scenes without extent, cells too large for the detail of indirect light, lights
// outside of the grid.
#include "techniques/lpv/lpv_diagnostics.h"

#include "techniques/lpv/lpv_grid.h"
#include "techniques/lpv/lpv_options.h"

#include <stdio.h>

// Larger cells blur the indirect light of rooms and streets.
static const float COARSE_M = 2.0f;

// Cell size of the finest cascade, or of the only grid. `side`: of one grid over the scene.
static double finest_cell(const struct lpv_options *options, double side)
{
    if (options->cascades == 1) return side;
    return options->cell > 0.0f ? (double)options->cell : 0.5 * side;
}

// Cell size of the finest of all cascades when the coarsest is one grid over the scene.
static double smallest_cell(double side)
{
    return side / (1 << (LPV_MAX_CASCADES - 1));
}

static void diagnose_cells(struct host *host, const char *technique,
                           const struct lpv_options *options, const struct lpv_grid *grid,
                           const char *scene)
{
    const int32_t *cells = grid->cells;
    const double side = (double)grid->cell_m, finest = finest_cell(options, side);
    char cascades[64] = "", remedy[96] = "";
    if (options->cascades > 1)
        snprintf(cascades, sizeof cascades, ", in %d cascades from %.3g m near the camera",
                 (int)options->cascades, finest);
    if (finest <= (double)COARSE_M) {
        host_log(host, LOG_INFO, "gi %s: %s: %d x %d x %d cells of %.3g m%s", technique, scene,
                 (int)cells[0], (int)cells[1], (int)cells[2], side, cascades);
        return;
    }
    if (finest > 1.01 * smallest_cell(side))
        snprintf(remedy, sizeof remedy,
                 "; cascades=%d,cell=%.3g gives smaller cells near the camera", LPV_MAX_CASCADES,
                 smallest_cell(side));
    host_log(host, LOG_WARNING,
             "gi %s: %s is %.3g m long: with dim=%d a cell is %.3g m%s, and indirect light has no "
             "finer detail%s",
             technique, scene, side * (double)options->dim, (int)options->dim, side, cascades,
             remedy);
}

static bool is_inside(const struct lpv_grid *grid, vec3s position)
{
    for (int axis = 0; axis < 3; axis++) {
        const float cell = (position.raw[axis] - grid->origin_m.raw[axis]) / grid->cell_m;
        if (!(cell >= 0.0f && cell <= (float)grid->cells[axis])) return false;
    }
    return true;
}

static void diagnose_lights(struct host *host, const char *technique, const struct lpv_grid *grid,
                            const struct scene_pose *pose)
{
    for (int i = 0; i < pose_light_count(pose); i++) {
        const struct world_light light = pose_light(pose, i);
        if (light.type == LIGHT_SUN || is_inside(grid, light.position)) continue;
        host_log(host, LOG_INFO,
                 "gi %s: light %d of %s is outside of the grid: the surfaces that it lights inside "
                 "are injected as usual",
                 technique, i, pose->scene->name);
    }
}

void lpv_diagnose(struct host *host, const char *technique, const struct lpv_options *options,
                  const struct scene_pose *pose)
{
    struct lpv_grid grid;
    const char *scene = pose->scene->name;
    if (!lpv_grid_fit(pose->bounds, options->dim,
                      lpv_margin(options, environment_mean(&pose->scene->environment)), &grid)) {
        host_log(host, LOG_WARNING,
                 "gi %s: %s has no extent for a grid: there is no indirect light", technique,
                 scene);
        return;
    }
    diagnose_cells(host, technique, options, &grid, scene);
    diagnose_lights(host, technique, &grid, pose);
}
