// Remarks on scenes without extent, on voxels so large that little is left of the light's detail,
// and on surfaces for which there is no room.
#include "techniques/vct/vct_diagnostics.h"

#include "techniques/vct/vct_state.h"

// Doors, furniture and people are larger than this, and their light with them.
static const float COARSE_M = 1.0f;

static const char *what_is_found(const struct vct_options *options)
{
    return options->occlusion ? "ambient occlusion" : "indirect light";
}

static void remark_on_voxels(struct host *host, const char *technique,
                             const struct vct_options *options, const struct vct_grid *grid,
                             const char *scene)
{
    const int32_t *cells = grid->cells;
    const double side = (double)grid->cell_m;
    if (grid->cell_m <= COARSE_M)
        host_log(host, LOG_INFO, "gi %s: %s: %d x %d x %d voxels of %.3g m", technique, scene,
                 (int)cells[0], (int)cells[1], (int)cells[2], side);
    else
        host_log(host, LOG_WARNING,
                 "gi %s: %s is %.3g m long: with resolution=%d a voxel is %.3g m, and %s "
                 "has no finer detail",
                 technique, scene, side * (double)options->resolution, (int)options->resolution,
                 side, what_is_found(options));
}

static void remark_on_room(struct host *host, const char *technique,
                           const struct vct_options *options, const struct vct_grid *grid,
                           const struct scene_pose *pose)
{
    const uint32_t room = vct_capacity(options);
    uint32_t touched = 0;
    if (!vct_count_touched(host, pose, grid, options->resolution, room, &touched)) return;
    if (touched > room)
        host_log(host, LOG_WARNING,
                 "gi %s: surfaces of %s fill more than %u voxels, for which there is room: what "
                 "lies beyond them along z is left out; with a lower resolution it is less",
                 technique, pose->scene->name, (unsigned)room);
}

// About the first camera: where the eye will go is not known.
static void remark_on_parts(struct host *host, const char *technique,
                            const struct vct_options *options, const struct vct_grid *scene,
                            const struct scene_pose *pose)
{
    const uint32_t room = vct_capacity(options);
    const vec3s eye =
        pose->scene->camera_count > 0 ? pose_camera(pose, 0).eye : box3_centre(pose->bounds);
    for (int i = 1; i < options->levels; i++) {
        const struct vct_grid grid = vct_grid_about(scene, options->resolution, i, eye);
        uint32_t touched = 0;
        if (!vct_count_touched(host, pose, &grid, options->resolution, room, &touched)) return;
        host_log(host, LOG_INFO, "gi %s: level %d has voxels of %.3g m", technique, i + 1,
                 (double)grid.cell_m);
        if (touched > room)
            host_log(host, LOG_WARNING,
                     "gi %s: in level %d, voxels of %.3g m, surfaces of %s about its first camera "
                     "fill more than %u voxels, for which there is room: what lies beyond them "
                     "along z is left out there",
                     technique, i + 1, (double)grid.cell_m, pose->scene->name, (unsigned)room);
    }
}

void vct_remark_on_scene(struct host *host, const char *technique,
                         const struct vct_options *options, const struct scene_pose *pose)
{
    struct vct_grid grid;
    if (!vct_grid_fit(pose->bounds, options->resolution, &grid)) {
        host_log(host, LOG_WARNING,
                 "gi %s: %s has no extent that a grid could cover: there is no %s", technique,
                 pose->scene->name, what_is_found(options));
        return;
    }
    remark_on_voxels(host, technique, options, &grid, pose->scene->name);
    remark_on_room(host, technique, options, &grid, pose);
    remark_on_parts(host, technique, options, &grid, pose);
}
