// Remarks on scenes without extent, on cells so large that little is left of the light's detail,
// and on lights outside of the grid.
#include "techniques/lpv/lpv_remarks.h"

#include "techniques/lpv/lpv_state.h"

// Rooms, streets and trees are larger than this, and their light with them; not much else is.
static const float COARSE_M = 2.0f;

static void remark_on_cells(struct host *host, const char *technique,
                            const struct lpv_options *options, const struct lpv_grid *grid,
                            const char *scene)
{
    const int32_t *cells = grid->cells;
    const double side = (double)grid->cell_m;
    if (grid->cell_m <= COARSE_M)
        host_log(host, LOG_INFO, "gi %s: %s: %d x %d x %d cells of %.3g m", technique, scene,
                 (int)cells[0], (int)cells[1], (int)cells[2], side);
    else
        host_log(
            host, LOG_WARNING,
            "gi %s: %s is %.3g m long: with dim=%d a cell is %.3g m, and indirect light has no "
            "finer detail",
            technique, scene, side * (double)options->dim, (int)options->dim, side);
}

static bool is_inside(const struct lpv_grid *grid, vec3s position)
{
    for (int axis = 0; axis < 3; axis++) {
        const float cell = (position.raw[axis] - grid->origin_m.raw[axis]) / grid->cell_m;
        if (!(cell >= 0.0f && cell <= (float)grid->cells[axis])) return false;
    }
    return true;
}

static void remark_on_lights(struct host *host, const char *technique, const struct lpv_grid *grid,
                             const struct scene_pose *pose)
{
    for (int i = 0; i < pose->scene->light_count; i++) {
        const struct world_light light = pose_light(pose, i);
        if (light.type == LIGHT_SUN || is_inside(grid, light.position)) continue;
        host_log(host, LOG_INFO,
                 "gi %s: light %d of %s is outside of the grid: the surfaces that it lights send "
                 "light on as others do",
                 technique, i, pose->scene->name);
    }
}

void lpv_remark_on_scene(struct host *host, const char *technique,
                         const struct lpv_options *options, const struct scene_pose *pose)
{
    struct lpv_grid grid;
    const char *scene = pose->scene->name;
    if (!lpv_grid_fit(pose->bounds, options->dim, lpv_margin(options, pose->scene->sky), &grid)) {
        host_log(host, LOG_WARNING,
                 "gi %s: %s has no extent that a grid could cover: there is no indirect light",
                 technique, scene);
        return;
    }
    remark_on_cells(host, technique, options, &grid, scene);
    remark_on_lights(host, technique, &grid, pose);
}
