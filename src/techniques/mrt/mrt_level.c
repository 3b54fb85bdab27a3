// From a scene and a dictionary to the level that the run time lights.
#include "techniques/mrt/mrt_state.h"

#include "techniques/mrt/level/make_map.h"
#include "techniques/mrt/runtime/clutter/cluttered.h"
#include "techniques/mrt/runtime/turned.h"

// ---- the map

// Positions in the free space: cameras and lights.
static bool make_auto(struct host *host, const struct scene_pose *pose, struct mrt_block_map *map)
{
    const struct scene *scene = pose->scene;
    size_t count = 0, most = (size_t)scene->camera_count + (size_t)scene->light_count;
    vec3s *seeds = host_alloc(host, most, sizeof *seeds);
    if (!seeds) return false;
    for (int i = 0; i < scene->camera_count; i++) seeds[count++] = pose_camera(pose, i).eye;
    for (int i = 0; i < scene->light_count; i++) {
        const struct world_light light = pose_light(pose, i);
        if (light.type != LIGHT_SUN) seeds[count++] = light.position;
    }
    bool ok = mrt_map_auto(host, pose, seeds, count, map);
    host_free(host, seeds);
    map->is_found = ok;
    return ok;
}

static bool read_map(struct host *host, const struct scene_pose *pose,
                     const struct mrt_options *options, struct mrt_block_map *map)
{
    const char *what = options->blocks.at[0] ? options->blocks.at : pose->scene->name;
    const bool cubes = options->maze != MRT_MAZE_AUTO && options->maze != MRT_TUNNEL;
    const bool ok = options->blocks.at[0] ? mrt_block_map_read(host, options->blocks.at, map)
                                          : mrt_block_map_of_scene(host, pose->scene, map);
    if (!ok || (!cubes && mrt_block_map_is_tunnel(map))) return ok;
    if (mrt_block_map_as_cubes(what, map)) return true;
    mrt_block_map_finish(map);
    return false;
}

// No blocks where the scene has no volume: there is no room to light.
static bool choose_map(struct host *host, const struct scene_pose *pose,
                       const struct mrt_options *options, struct mrt_block_map *map)
{
    const vec3s size = box3_size(pose->bounds);
    *map = (struct mrt_block_map){ 0 };
    if (!(size.x > 0.0f && size.y > 0.0f && size.z > 0.0f)) return true;
    if (options->blocks.at[0]) return read_map(host, pose, options, map);
    if (options->map == MRT_MAP_SINGLE) return mrt_map_single(host, pose, map);
    if (options->map == MRT_MAP_SCENE) {
        if (!read_map(host, pose, options, map)) return false;
        if (map->count > 0) return true;
        mrt_block_map_finish(map);
    }
    return make_auto(host, pose, map);
}

// The smallest dictionary with all shapes of the map.
static enum mrt_maze maze_of(const struct mrt_block_map *map)
{
    if (mrt_block_map_is_tunnel(map)) return MRT_TUNNEL;
    return mrt_block_map_is_plane(map) ? MRT_MAZE_2D : MRT_MAZE_3D;
}

bool mrt_resolve_maze(struct host *host, const struct scene_pose *pose, struct mrt_options *options)
{
    struct mrt_block_map map = { 0 };
    if (options->maze != MRT_MAZE_AUTO) return true;
    const bool ok = !pose || choose_map(host, pose, options, &map);
    if (ok) options->maze = (int32_t)maze_of(&map);
    mrt_block_map_finish(&map);
    return ok;
}

// Texels of clutter along an edge of a block: with 12 or 16 the error is the same (bench/results/
// paper-drt.md), and the light map takes the more time.
static const float CLUTTER_TEXELS = 10.0f;

static bool find_clutter(struct mrt *mrt, const struct scene_pose *pose)
{
    const struct mrt_clutter_options options = { CLUTTER_TEXELS, mrt->options.response_modes };
    const bool vertical = mrt->options.maze == MRT_MAZE_3D;
    bool opened;
    if (!mrt_clutter_init(&mrt->clutter, mrt->host, pose, &mrt->map, &options)) return false;
    if (mrt->clutter.triangles == 0 || !mrt->map.is_found) return true;
    if (!mrt_open_clutter_walls(&mrt->map, &mrt->clutter, vertical, &opened)) return false;
    if (!opened) return true;
    mrt_clutter_finish(&mrt->clutter);
    return mrt_clutter_init(&mrt->clutter, mrt->host, pose, &mrt->map, &options);
}

// May open the map.
static bool make_clutter(struct mrt *mrt, const struct scene_pose *pose)
{
    if (!mrt->delta || mrt_block_is_tube(&mrt->map.blocks[0])) return true;
    if (!find_clutter(mrt, pose)) return false;
    if (mrt->clutter.triangles == 0) return true;
    mrt->clutter_texels = mrt_clutter_light_create(mrt->host, pose, &mrt->clutter);
    return mrt->clutter_texels;
}

static bool make_images(struct mrt *mrt, const struct scene_pose *pose)
{
    const int probes = mrt_runtime_options_of(&mrt->options).probes ? mrt->options.block_probes : 0;
    const struct scene_pose *walls = mrt->clutter.triangles > 0 ? &mrt->clutter.walls.pose : pose;
    return mrt_scene_images_init(mrt->host, pose, walls, &mrt->map, &mrt->atlas, probes,
                                 &mrt->images);
}

bool mrt_make_map(struct mrt *mrt, const struct scene_pose *pose)
{
    if (!choose_map(mrt->host, pose, &mrt->options, &mrt->map)) return false;
    if (mrt->options.maze == MRT_MAZE_AUTO) mrt->options.maze = (int32_t)maze_of(&mrt->map);
    const int resolution = mrt_face_texels((enum mrt_maze)mrt->options.maze, mrt->options.texels);
    return mrt->map.count == 0 || (make_clutter(mrt, pose) &&
                                   mrt_atlas_init(mrt->host, &mrt->map, resolution, &mrt->atlas) &&
                                   make_images(mrt, pose));
}

// ---- operators

struct mrt_runtime_options mrt_runtime_options_of(const struct mrt_options *options)
{
    return (struct mrt_runtime_options){
        .half = options->precision == MRT_PRECISION_HALF,
        .vector = options->vector && options->solver == MRT_SOLVER_GPU,
        .probes = options->clutter == MRT_CLUTTER_PROBES || options->probes,
        .clutter = options->clutter == MRT_CLUTTER_PROBES,
        .publish = options->probes,
    };
}

static bool start_cluttered(struct mrt *mrt, struct mrt_turned *turned,
                            const struct mrt_runtime_options *options)
{
    const struct mrt_cluttered_options how = { .rays = mrt->options.delta_rays,
                                               .depth = mrt->options.depth,
                                               .occlusion = mrt->options.occlusion,
                                               .reflection = mrt->options.reflection,
                                               .gather = mrt->options.gather &&
                                                         mrt->options.reflection &&
                                                         mrt->options.vector };
    struct mrt_cluttered cluttered;
    const bool ok = mrt_cluttered_init(&cluttered, mrt->host, turned, &mrt->level, &mrt->clutter,
                                       mrt->clutter_texels, &how) &&
                    mrt_runtime_init(&mrt->runtime, mrt->host, mrt->gpu, &cluttered.input, options);
    mrt_cluttered_finish(&cluttered);
    return ok;
}

static bool start_runtime(struct mrt *mrt)
{
    struct mrt_turned turned;
    const struct mrt_runtime_options options = mrt_runtime_options_of(&mrt->options);
    bool ok = mrt_turned_init(mrt->host, &mrt->level, &turned);
    if (ok) {
        turned.input.atlas = &mrt->atlas;
        turned.input.images = &mrt->images;
        ok = mrt->clutter.triangles > 0
                 ? start_cluttered(mrt, &turned, &options)
                 : mrt_runtime_init(&mrt->runtime, mrt->host, mrt->gpu, &turned.input, &options);
    }
    mrt_turned_finish(&turned);
    return ok;
}

bool mrt_make_level(struct mrt *mrt)
{
    const struct mrt_level_options options = { .max_depth = mrt->options.depth,
                                               .retrace = mrt->options.warp == MRT_WARP_RETRACE };
    const struct mrt_runtime_options runtime = mrt_runtime_options_of(&mrt->options);
    if (mrt->map.count == 0)
        return mrt_runtime_init_empty(&mrt->runtime, mrt->host, mrt->gpu, &runtime);
    return mrt_level_init(mrt->host, &mrt->map, &mrt->dictionary, &options, &mrt->level) &&
           start_runtime(mrt) &&
           (mrt->options.solver == MRT_SOLVER_GPU ||
            mrt_host_solver_init(&mrt->host_solver, mrt->host, mrt->gpu, &mrt->level,
                                 mrt->images.geometry));
}
