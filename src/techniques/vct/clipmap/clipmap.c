#include "techniques/vct/clipmap/clipmap.h"

#include "frame/scene/scene_gpu.h"

#include <math.h>

static bool same_grid(const struct vct_grid *a, const struct vct_grid *b)
{
    bool same = a->cell_m == b->cell_m;
    for (int axis = 0; axis < 3; axis++)
        same = same && a->cells[axis] == b->cells[axis] &&
               a->origin_m.raw[axis] == b->origin_m.raw[axis];
    return same;
}

// Texels along the border of a level's cone box over which it blends into the next coarser level.
// With resolution=64 the border is 13 texels from the camera.
static float fade_of(int resolution)
{
    return fminf((float)resolution / 16.0f, 4.0f);
}

static void place_around_camera(struct vct_clipmap *map, int dim, const struct frame_view *view)
{
    const struct vct_grid *scene = &map->levels[0].grid;
    for (int i = 1; i < map->count; i++) {
        struct vct_clip *clip = &map->levels[i];
        const struct vct_grid previous = clip->grid;
        clip->grid = vct_grid_around(scene, dim, i, view->camera.eye);
        clip->cone_box = vct_grid_cone_box(scene, dim, i, view->camera.eye, 2.0f * fade_of(dim));
        clip->moved = !same_grid(&clip->grid, &previous);
    }
}

// Whether a grid contains the bounds with voxels at most 1.14 times as large as a fitted one's. The
// bounds of moving geometry change in each frame: a new grid would discard all light.
static bool still_fits(const struct vct_grid *grid, const struct vct_grid *fitted,
                       struct box3 bounds)
{
    if (grid->cell_m > 1.14f * fitted->cell_m) return false;
    for (int axis = 0; axis < 3; axis++) {
        const float low = grid->origin_m.raw[axis];
        if (bounds.min.raw[axis] < low) return false;
        if (bounds.max.raw[axis] > low + (float)grid->cells[axis] * grid->cell_m) return false;
    }
    return true;
}

// Bounds of a scene that has grown out of its grid: on the sides where it did, with a margin, since
// it may grow on; on the others, those of the grid.
static struct box3 grown_bounds(const struct vct_grid *grid, struct box3 bounds)
{
    for (int axis = 0; axis < 3; axis++) {
        const float low = grid->origin_m.raw[axis],
                    high = low + (float)grid->cells[axis] * grid->cell_m,
                    margin = (bounds.max.raw[axis] - bounds.min.raw[axis]) / 16.0f;
        const bool below = bounds.min.raw[axis]<low, above = bounds.max.raw[axis]> high;
        bounds.min.raw[axis] = below ? bounds.min.raw[axis] - margin : low;
        bounds.max.raw[axis] = above ? bounds.max.raw[axis] + margin : high;
    }
    return bounds;
}

// The grid of the previous frame if that still fits; otherwise one with room to grow, or the fitted
// one where that would be much coarser.
static struct vct_grid next_grid(int resolution, const struct vct_grid *previous,
                                 const struct vct_grid *fitted, struct box3 bounds)
{
    struct vct_grid grown;
    if (still_fits(previous, fitted, bounds)) return *previous;
    const bool fits = vct_grid_fit(grown_bounds(previous, bounds), resolution, &grown);
    return fits && still_fits(&grown, fitted, bounds) ? grown : *fitted;
}

uint32_t vct_clipmap_update(struct vct_clipmap *map, int resolution, const struct frame_view *view)
{
    struct vct_grid *grid = &map->levels[0].grid;
    const struct vct_grid previous = *grid;
    if (!vct_grid_fit(view->bounds, resolution, grid)) return VCT_NO_EXTENT;
    const bool known = view->index > 0 && view->pose->scene == map->scene;
    const bool other_draws = !known || map->draw_list != view->scene->draw_list;
    if (known) *grid = next_grid(resolution, &previous, grid, view->bounds);
    place_around_camera(map, resolution, view);
    map->scene = view->pose->scene;
    map->draw_list = view->scene->draw_list;
    map->levels[0].moved = !known || !same_grid(grid, &previous);
    for (int i = 1; i < map->count; i++) map->levels[i].moved |= map->levels[0].moved;
    return (other_draws ? VCT_OTHER_DRAWS : 0) | (map->levels[0].moved ? VCT_OTHER_GRID : 0);
}

void vct_clipmap_note_lit(struct vct_clipmap *map)
{
    for (int i = 0; i < map->count; i++) map->levels[i].lit_grid = map->levels[i].grid;
}

float vct_clipmap_texel_m(const struct vct_clipmap *map)
{
    return 2.0f * map->levels[map->count - 1].grid.cell_m;
}

float vct_clipmap_longest_side_m(const struct vct_clipmap *map)
{
    const struct vct_grid *grid = &map->levels[0].grid;
    int cells = grid->cells[0];
    for (int axis = 1; axis < 3; axis++)
        if (grid->cells[axis] > cells) cells = grid->cells[axis];
    return (float)cells * grid->cell_m;
}

// ---- The uniform block --------------------------------------------------------------------------

// box: in voxels of the grid, from the corner of the scene's grid.
static struct vct_clip_level level_of(const struct vct_grid *grid, const struct vct_grid *lit,
                                      struct box3 box, int level)
{
    struct vct_clip_level out;
    const float voxel = 0.5f * (float)(1 << level); // in texels of the finest level
    for (int axis = 0; axis < 3; axis++) {
        out.corner.raw[axis] = (float)grid->first[axis] * voxel;
        out.lit_corner.raw[axis] = (float)lit->first[axis] * voxel;
        out.size.raw[axis] = (float)(grid->cells[axis] / 2);
        out.low.raw[axis] = box.min.raw[axis] * voxel;
        out.high.raw[axis] = box.max.raw[axis] * voxel;
    }
    return out;
}

// A grid without its outermost voxel, half a texel. On the border of the scene the box extends far
// beyond it instead.
static struct box3 box_of(const struct vct_grid *grid)
{
    struct box3 box;
    for (int axis = 0; axis < 3; axis++) {
        const int32_t first = grid->first[axis], last = first + grid->cells[axis],
                      scene = grid->scene[axis];
        box.min.raw[axis] = (float)(first > 0 ? first + 1 : -scene);
        box.max.raw[axis] = (float)(last < scene ? last - 1 : 2 * scene);
    }
    return box;
}

struct vct_clip_table vct_clipmap_table(const struct vct_clipmap *map, int resolution,
                                        enum vct_clip_table_of of)
{
    const bool lit = of == VCT_OF_VOXEL_CONES;
    const struct vct_clip *first = &map->levels[0];
    struct vct_clip_table table = { .origin_m =
                                        lit ? first->lit_grid.origin_m : first->grid.origin_m,
                                    .fade = fade_of(resolution) };
    for (int i = 0; i < map->count; i++) {
        const struct vct_clip *clip = &map->levels[i];
        const struct vct_grid *grid = lit ? &clip->lit_grid : &clip->grid;
        const int level = map->count - 1 - i;
        const struct box3 box = of != VCT_OF_PIXELS || i == 0 ? box_of(grid) : clip->cone_box;
        table.levels[level] = level_of(grid, &clip->lit_grid, box, level);
    }
    const int coarsest = map->count - 1;
    table.size = glms_vec3_scale(table.levels[coarsest].size, (float)(1 << coarsest));
    return table;
}
