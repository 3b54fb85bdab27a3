// The stages of a bake, in the order of their waves: texels · bounces, seams, links · offsets ·
// areas · maps.
#include "techniques/ort/bake/stages.h"

#include "bake/plan.h"
#include "bake/scene_key.h"
#include "techniques/ort/bake/bounces.h"
#include "techniques/ort/bake/patches.h"
#include "techniques/ort/bake/texels.h"

static bool prepare_scattering(struct ort_scene *scene, struct host *host)
{
    if (scene->options.transfer == ORT_RADIOSITY) return true;
    scene->kernel = host_alloc(host, 1, sizeof *scene->kernel);
    if (!scene->kernel) return false;
    ort_kernel_init(scene->kernel, &scene->options);
    scene->strips = ort_make_strips(host, &scene->map.charts);
    return scene->strips && ort_near_init(&scene->near, &scene->map, scene->kernel->reach_m);
}

static bool prepare(void *argument, struct host *host)
{
    struct ort_scene *scene = argument;
    if (!scene_statics_init(&scene->statics, host, scene->pose) ||
        !scene_statics_free_factors(&scene->statics, false))
        return false;
    scene->host = host;
    scene->trace = trace_scene_create(host, &scene->statics.pose);
    if (!scene->trace) return false;
    scene->patch_of = ort_make_patches(&scene->map, scene->trace);
    return scene->patch_of && prepare_scattering(scene, host) &&
           seam_closing_init(&scene->closing, host, &scene->map.charts, scene->trace);
}

static void finish(void *argument)
{
    struct ort_scene *scene = argument;
    seam_closing_finish(&scene->closing);
    host_free(scene->map.host, scene->patch_of);
    if (scene->kernel) host_free(scene->host, scene->kernel);
    ort_near_finish(&scene->near);
    if (scene->strips) host_free(scene->host, scene->strips);
    scene->strips = NULL;
    trace_scene_destroy(scene->trace);
    scene_statics_finish(&scene->statics);
    scene->patch_of = NULL;
    scene->kernel = NULL;
    scene->trace = NULL;
}

static void destroy(void *argument)
{
    struct ort_scene *scene = argument;
    ort_map_finish(&scene->map);
}

// The trace scene, and the map of each place and texel, of which some are sorted by cells.
static size_t prepared_bytes(const struct ort_map *map)
{
    enum { OF_PLACE = 8, OF_TEXEL = 92 };
    return map->charts.triangle_count * (sizeof *map->charts.triangles + TRACE_TRIANGLE_BYTES) +
           (size_t)map->width * map->height * OF_PLACE + (size_t)map->texel_count * OF_TEXEL;
}

static bool plan_at(struct bake_plan *plan, const void *job, float texels_per_m)
{
    const struct ort_scene *scene = job;
    struct ort_options options = scene->options;
    options.density = texels_per_m;
    return ort_bake(plan, &(struct technique_bake){ .pose = scene->pose, .options = &options });
}

static bool add_stages(struct bake_plan *plan, struct ort_scene *scene,
                       const struct scene_statics *of)
{
    const struct scene_pose *statics = &of->pose;
    scene->columns = emission_basis_rows(&of->emission);
    bake_plan_depends(plan, scene_key(statics, SCENE_KEY_GEOMETRY | SCENE_KEY_MATERIALS));
    if (!ort_map_init(&scene->map, bake_plan_host(plan), statics, &scene->options)) return false;
    const struct ort_map *map = &scene->map;
    bake_plan_set_job(plan, &(struct bake_job){ .job = scene,
                                                .prepare = prepare,
                                                .finish = finish,
                                                .destroy = destroy,
                                                .bytes = prepared_bytes(map) });
    bake_plan_set_light_map(plan,
                            (struct bake_light_map){ map->charts.count, map->charts.texels_per_m,
                                                     charts_utilisation(&map->charts), plan_at });
    return ort_add_texels(plan, scene) && ort_add_bounces(plan, scene) &&
           light_map_add_walls(plan, &scene->closing, &map->charts) &&
           light_map_add_seams(plan, &scene->closing, &map->charts) && ort_add_links(plan, scene) &&
           ort_add_offsets(plan, scene) && ort_add_areas(plan, scene) && ort_add_maps(plan, scene);
}

bool ort_bake(struct bake_plan *plan, const struct technique_bake *how)
{
    struct ort_scene *scene = bake_plan_alloc(plan, 1, sizeof *scene);
    struct scene_statics statics;
    if (!scene) return false;
    scene->pose = how->pose;
    scene->options = *(const struct ort_options *)how->options;
    if (!scene_statics_init(&statics, bake_plan_host(plan), how->pose)) return false;
    const bool ok =
        scene_statics_free_factors(&statics, false) && add_stages(plan, scene, &statics);
    scene_statics_finish(&statics);
    return ok;
}
