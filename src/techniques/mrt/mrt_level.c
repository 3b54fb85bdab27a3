// From a scene and a dictionary to the level that the run time lights.
#include "techniques/mrt/mrt_state.h"

#include "techniques/mrt/objects/clutter_operators.h"
#include "techniques/mrt/level/map/make_map.h"

#include <limits.h>
#include <math.h>

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

// No blocks where the scene has no surface; one where it has no volume.
static bool choose_map(struct host *host, const struct scene_pose *pose,
                       const struct mrt_options *options, struct mrt_block_map *map)
{
    const vec3s size = box3_size(pose->bounds);
    *map = (struct mrt_block_map){ 0 };
    const bool flat = !(glms_vec3_min(size) > 0.0f);
    if (!(glms_vec3_max(size) > 0.0f)) return true;
    if (options->blocks.at[0]) return read_map(host, pose, options, map);
    if (options->map == MRT_MAP_SINGLE || flat) return mrt_map_single(host, pose, map);
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

bool mrt_resolve_maze(struct host *host, const struct scene_pose *pose, void *user)
{
    struct mrt_options *options = user;
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

static bool find_clutter(struct mrt_parts *out, const struct mrt *mrt,
                         const struct scene_pose *pose)
{
    const struct mrt_clutter_options options = { CLUTTER_TEXELS, mrt->options.response_modes };
    if (!mrt->delta || mrt->leaves_out_clutter || mrt_block_is_tube(&mrt->map.blocks[0]))
        return true;
    return mrt_clutter_init(&out->clutter, out->host, pose, &mrt->map, &options);
}

static bool wants_light_map_of_clutter(const struct mrt_options *o)
{
    return o->gather && o->reflection && o->vector;
}

static void warn_of_clutter(const struct mrt *mrt, const char *scene)
{
    if (mrt->parts.clutter.is_too_fine && wants_light_map_of_clutter(&mrt->options))
        host_log(mrt->host, LOG_WARNING,
                 "gi drt: objects of %s have %u charts of %u texels, too many for a light map: "
                 "probes light them",
                 scene, mrt->parts.clutter.charts.count, mrt->parts.clutter.charts.texel_count);
}

// May open the map: once, as operators follow from it.
static bool find_clutter_and_open(struct mrt *mrt, const struct scene_pose *pose)
{
    const bool vertical = mrt->options.maze == MRT_MAZE_3D;
    struct mrt_clutter *clutter = &mrt->parts.clutter;
    bool opened;
    if (mrt->delta && mrt_block_is_tube(&mrt->map.blocks[0]))
        host_log(mrt->host, LOG_WARNING,
                 "gi drt: the blocks of %s are tubes, which have no clutter: its light is that of "
                 "mrt; maze=plane has cubes",
                 pose->scene->name);
    if (!find_clutter(&mrt->parts, mrt, pose)) return false;
    if (clutter->triangles == 0 || !mrt->map.is_found) return true;
    if (!mrt_open_clutter_walls(&mrt->map, clutter, vertical, &opened)) return false;
    if (!opened) return true;
    mrt_clutter_finish(clutter);
    return find_clutter(&mrt->parts, mrt, pose);
}

static bool light_clutter(struct mrt_parts *out, const struct mrt *mrt,
                          const struct scene_pose *pose)
{
    if (!mrt_reflectors_init(out->host, &mrt->map, &out->reflectors)) return false;
    if (out->clutter.triangles == 0) return true;
    out->clutter_texels =
        mrt_clutter_light_create(out->host, pose, &out->clutter, &out->reflectors);
    return out->clutter_texels;
}

static struct hash128 hash_of_walls(const struct scene_pose *walls)
{
    const struct scene *scene = walls->scene;
    struct hash128 hash = hash128_add((struct hash128){ 0 }, &scene->revisions.materials,
                                      sizeof scene->revisions.materials);
    for (int i = 0; i < scene->instance_count; i++) {
        const struct mesh *mesh = scene_mesh_of(scene, i);
        if (mesh->index_count == 0) continue;
        const mat4s world_from_mesh = pose_world_from_instance(walls, i);
        const vec3s *deformed = walls->deformed[i].positions;
        const int ids[2] = { i, mesh->material };
        hash = hash128_add(hash, ids, sizeof ids);
        hash = hash128_add(hash, mesh->indices, mesh->index_count * sizeof *mesh->indices);
        hash = hash128_add(hash, deformed ? deformed : mesh->positions,
                           mesh->vertex_count * sizeof *deformed);
        hash = hash128_add(hash, &world_from_mesh, sizeof world_from_mesh);
    }
    return hash;
}

static bool note_walls(struct mrt_parts *out, const struct scene_pose *walls)
{
    out->instance_count = walls->scene->instance_count;
    out->has_walls = host_alloc(out->host, (size_t)out->instance_count, sizeof *out->has_walls);
    for (int i = 0; out->has_walls && i < out->instance_count; i++)
        out->has_walls[i] = scene_mesh_of(walls->scene, i)->index_count > 0;
    return out->has_walls;
}

static bool is_clutter(const void *clutter, int instance, uint32_t triangle)
{
    return mrt_is_clutter(clutter, instance, triangle);
}

static bool make_images(struct mrt_parts *out, const struct mrt *mrt, const struct scene_pose *pose,
                        const struct mrt_parts *last)
{
    const int probes = mrt_runtime_options_of(&mrt->options).probes ? mrt->options.block_probes : 0;
    const struct scene_pose *walls = out->clutter.triangles > 0 ? &out->clutter.walls.pose : pose;
    out->walls = hash_of_walls(walls);
    const bool same = last && hash128_same(last->walls, out->walls);
    // A box that stands for a whole scene is no room: most of its surfaces have no texel.
    if (mrt->options.map != MRT_MAP_SINGLE)
        out->reflectors.own = (struct mrt_own_light){ is_clutter, &out->clutter };
    return (!mrt->delta || note_walls(out, walls)) &&
           mrt_scene_images_init(&out->reflectors, pose, walls, &mrt->atlas, probes,
                                 same ? last->images.geometry : NULL, &out->images);
}

bool mrt_parts_init(struct mrt_parts *out, struct host *host, const struct mrt *mrt,
                    const struct scene_pose *pose, const struct mrt_parts *last)
{
    *out = (struct mrt_parts){ .host = host };
    return find_clutter(out, mrt, pose) && light_clutter(out, mrt, pose) &&
           make_images(out, mrt, pose, last);
}

void mrt_parts_end_inputs(struct mrt_parts *parts)
{
    host_free(parts->host, parts->clutter_texels);
    parts->clutter_texels = NULL;
    mrt_clutter_finish(&parts->clutter);
    mrt_reflectors_finish(&parts->reflectors);
}

void mrt_parts_finish(struct mrt_parts *parts)
{
    if (!parts->host) return;
    mrt_parts_end_inputs(parts);
    mrt_scene_images_finish(&parts->images);
    host_free(parts->host, parts->has_walls);
    *parts = (struct mrt_parts){ 0 };
}

void mrt_parts_replace(struct mrt_parts *to, struct mrt_parts *from)
{
    mrt_parts_finish(to);
    *to = *from;
    *from = (struct mrt_parts){ 0 };
}

// The blocks and, for drt, the clutter.
static bool make_blocks(struct mrt *mrt, const struct scene_pose *pose)
{
    if (!choose_map(mrt->host, pose, &mrt->options, &mrt->map)) return false;
    if (mrt->options.maze == MRT_MAZE_AUTO) mrt->options.maze = (int32_t)maze_of(&mrt->map);
    if (mrt->delta) mrt->map.is_open = false; // clutter shades and lights its block
    mrt->parts = (struct mrt_parts){ .host = mrt->host };
    return mrt->map.count == 0 || find_clutter_and_open(mrt, pose);
}

char *mrt_map_json(struct host *host, const struct mrt_options *options, bool delta,
                   const struct scene_pose *pose)
{
    struct mrt *mrt = host_alloc(host, 1, sizeof *mrt);
    if (!mrt) return NULL;
    mrt->host = host;
    mrt->options = *options;
    mrt->delta = delta;
    char *json = make_blocks(mrt, pose) ? mrt_block_map_json(host, &mrt->map) : NULL;
    mrt_parts_finish(&mrt->parts);
    mrt_block_map_finish(&mrt->map);
    host_free(host, mrt);
    return json;
}

static void log_map(const struct mrt *mrt, const char *scene)
{
    const char *technique = mrt->delta ? "drt" : "mrt";
    if (mrt->map.is_open) {
        host_log(mrt->host, LOG_INFO,
                 "gi %s: no room found in %s: its surfaces have the light of a grid of probes "
                 "outdoors; map=single takes the box around it for a room",
                 technique, scene);
        return;
    }
    int faces[2] = { 0 }; // openings, walls with holes: two faces for each
    for (int b = 0; b < mrt->map.count; b++)
        for (int f = 0; f < CUBE_FACES; f++)
            if (mrt->map.blocks[b].neighbor[f].block >= 0)
                faces[mrt_block_has_holes(&mrt->map.blocks[b], f)]++;
    host_log(
        mrt->host, LOG_INFO,
        "gi %s: blocks of %s: %d, of a mean edge of %.3g m, joined by %d openings and holes in "
        "%d walls%s",
        technique, scene, mrt->map.count, (double)mrt_block_map_mean_edge(&mrt->map), faces[0] / 2,
        faces[1] / 2, mrt->map.is_single ? "; its bounding box is taken for a room" : "");
}

bool mrt_make_map(struct mrt *mrt, const struct scene_pose *pose)
{
    if (!make_blocks(mrt, pose)) return false;
    if (mrt->map.count > 0) log_map(mrt, pose->scene->name);
    warn_of_clutter(mrt, pose->scene->name);
    const int resolution = mrt_face_texels((enum mrt_maze)mrt->options.maze, mrt->options.texels);
    return mrt->map.count == 0 ||
           (mrt_atlas_init(mrt->host, &mrt->map, resolution, &mrt->atlas) &&
            light_clutter(&mrt->parts, mrt, pose) && make_images(&mrt->parts, mrt, pose, NULL) &&
            (!mrt->options.probes || mrt_published_init(&mrt->published, mrt->host, pose, &mrt->map,
                                                        mrt->options.block_probes)));
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
        .specular = options->specular,
    };
}

// Bytes of the largest buffer of operators with clutter.
static uint64_t clutter_bytes(const struct mrt *mrt, const struct mrt_parts *parts,
                              const struct mrt_operators *operators, int *blocks)
{
    return mrt_clutter_numbers(operators, &mrt->map, &parts->clutter, blocks) *
           (mrt_runtime_options_of(&mrt->options).half ? 2 : 4);
}

static bool check_clutter(const struct mrt *mrt, bool *fits)
{
    struct mrt_operators operators;
    const uint64_t most = gpu_limits(mrt->gpu)->max_storage_bytes;
    int blocks = 0;
    *fits = true;
    if (mrt->parts.clutter.triangles == 0) return true;
    const bool ok = mrt_operators_init(&operators, mrt->host, &mrt->level);
    const uint64_t bytes = ok ? clutter_bytes(mrt, &mrt->parts, &operators, &blocks) : 0;
    mrt_operators_finish(&operators);
    if (!ok || bytes <= most) return ok;
    host_log(mrt->host, LOG_WARNING,
             "gi drt: operators of %d blocks with objects take up to %.0f MB in one buffer, of "
             "which the device allows %.0f MB: objects are lit as by mrt; use fewer texels or "
             "response_modes",
             blocks, (double)bytes * 1e-6, (double)most * 1e-6);
    *fits = false;
    return true;
}

static bool add_clutter(const struct mrt *mrt, const struct mrt_parts *parts,
                        const struct mrt_build *how, struct mrt_operators *operators)
{
    const struct mrt_options *options = &mrt->options;
    int blocks;
    if (parts->clutter.triangles == 0) return true;
    if (clutter_bytes(mrt, parts, operators, &blocks) > gpu_limits(mrt->gpu)->max_storage_bytes)
        return host_fail(operators->host, FAIL_MEMORY,
                         "operators of %d blocks with objects exceed the device's buffers", blocks);
    const struct mrt_clutter_changes changes = { .rays = options->delta_rays,
                                                 .depth = options->depth,
                                                 .occlusion = options->occlusion,
                                                 .reflection = options->reflection,
                                                 .gather = wants_light_map_of_clutter(options) &&
                                                           !parts->clutter.is_too_fine,
                                                 .stop = how->stop };
    return mrt_operators_add_clutter(operators, &mrt->level, &parts->clutter, parts->clutter_texels,
                                     how->cache, &changes);
}

bool mrt_make_runtime(const struct mrt *mrt, struct host *host, const struct mrt_parts *parts,
                      const struct mrt_build *how, struct mrt_runtime *out)
{
    struct mrt_operators operators;
    const struct mrt_runtime_options options = mrt_runtime_options_of(&mrt->options);
    const struct mrt_runtime_input input = { .map = &mrt->map,
                                             .atlas = &mrt->atlas,
                                             .images = &parts->images,
                                             .reflectors = &parts->reflectors,
                                             .operators = &operators,
                                             .clutter = &parts->clutter,
                                             .clutter_texels = parts->clutter_texels,
                                             .published = &mrt->published };
    bool ok = mrt_operators_init(&operators, host, &mrt->level) &&
              add_clutter(mrt, parts, how, &operators);
    if (ok)
        ok = how->plan ? mrt_runtime_plan(out, how->plan, &input, &options)
                       : mrt_runtime_init(out, host, mrt->gpu, &input, &options);
    mrt_operators_finish(&operators);
    return ok;
}

static bool make_depths(struct mrt *mrt)
{
    return !mrt->options.probes ||
           probe_depth_create(mrt->host, mrt->gpu, probe_grid_count(mrt->published.grid),
                              mrt->published.depth[0][0], &mrt->probe_depth);
}

static bool start_runtime(struct mrt *mrt)
{
    const struct mrt_build how = { .cache = &mrt->update.cache };
    const bool ok = mrt_make_runtime(mrt, mrt->host, &mrt->parts, &how, &mrt->runtime);
    mrt_parts_end_inputs(&mrt->parts);
    return ok;
}

// Each proportion takes about half a second of a processor: `auto` traces those of a home. A box
// around a scene without a room, and one that is very flat, has surfaces but no walls: light in its
// proportions is no truer than in a cube.
static struct mrt_retrace_limits limits_of(const struct mrt *mrt)
{
    static const struct mrt_retrace_limits LIMITS[] = {
        [MRT_WARP_STRETCH] = { .most = 0 },
        [MRT_WARP_RETRACE] = { .most = INT_MAX, .flattest = INFINITY },
        [MRT_WARP_AUTO] = { .most = 8, .flattest = 16.0f },
    };
    const int32_t warp = mrt->options.warp;
    struct mrt_retrace_limits limits =
        LIMITS[warp == MRT_WARP_AUTO && mrt->map.is_single ? MRT_WARP_STRETCH : warp];
    // Blocks with objects have a fit of their own to walls alone (objects/delta.c).
    limits.openings = mrt->parts.clutter.triangles == 0;
    return limits;
}

static bool init_level(struct mrt *mrt)
{
    const struct mrt_level_options options = { .max_depth = mrt->options.depth,
                                               .retrace = limits_of(mrt) };
    return mrt_level_init(mrt->host, &mrt->map, &mrt->dictionary, &options, &mrt->level);
}

// The map and the level of mrt: walls that clutter has opened are walls again.
static bool leave_out_clutter(struct mrt *mrt)
{
    mrt->leaves_out_clutter = true;
    mrt_level_finish(&mrt->level);
    mrt_parts_finish(&mrt->parts);
    mrt_published_finish(&mrt->published);
    mrt_atlas_finish(&mrt->atlas);
    mrt_block_map_finish(&mrt->map);
    return mrt_make_map(mrt, mrt->pose) && init_level(mrt);
}

bool mrt_make_level(struct mrt *mrt)
{
    const struct mrt_runtime_options runtime = mrt_runtime_options_of(&mrt->options);
    bool fits;
    if (mrt->map.count == 0)
        return mrt_runtime_init_empty(&mrt->runtime, mrt->host, mrt->gpu, &runtime);
    return init_level(mrt) && check_clutter(mrt, &fits) && (fits || leave_out_clutter(mrt)) &&
           start_runtime(mrt) && make_depths(mrt) &&
           (mrt->options.solver == MRT_SOLVER_GPU ||
            mrt_host_solver_init(&mrt->host_solver, mrt->host, mrt->gpu, &mrt->level,
                                 mrt->parts.images.geometry));
}
