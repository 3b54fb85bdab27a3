// The stages of a bake, in the order of their waves: rays · transfer, emitters, seams ·
// matrices, probes · compression.
#include "techniques/prt/bake/scene.h"

#include "bake/plan.h"
#include "bake/scene_key.h"

static bool prepare(void *argument, struct host *host)
{
    struct prt_scene *scene = argument;
    if (!scene_statics_init(&scene->statics, host, scene->pose)) return false;
    scene->host = host;
    scene->trace = trace_scene_create(host, &scene->statics.pose);
    if (scene->options.glossy &&
        !prt_lobes_init(&scene->lobes, host, prt_glossy_rays(&scene->options)))
        return false;
    return scene->trace && (scene->receivers.at_vertices ||
                            seam_closing_init(&scene->closing, host, &scene->charts, scene->trace));
}

static void finish(void *argument)
{
    struct prt_scene *scene = argument;
    seam_closing_finish(&scene->closing);
    prt_lobes_finish(&scene->lobes);
    trace_scene_destroy(scene->trace);
    scene_statics_finish(&scene->statics);
    scene->trace = NULL;
}

static void destroy(void *argument)
{
    struct prt_scene *scene = argument;
    prt_receivers_finish(&scene->receivers);
}

static size_t prepared_bytes(const struct prt_receivers *receivers)
{
    enum { OF_TEXEL = 60, OF_VERTEX = 120 };
    const struct charts *charts = receivers->charts;
    return receivers->vertices.triangle_count * TRACE_TRIANGLE_BYTES +
           receivers->vertices.count * (size_t)OF_VERTEX +
           charts->triangle_count * (sizeof *charts->triangles + TRACE_TRIANGLE_BYTES) +
           (size_t)charts->width * charts->height * sizeof *charts->owner +
           (size_t)charts->side_texel_count * OF_TEXEL;
}

static bool plan_at(struct bake_plan *plan, const void *job, float texels_per_m)
{
    const struct prt_scene *scene = job;
    struct prt_options options = scene->options;
    options.density = texels_per_m;
    return prt_bake(plan, &(struct technique_bake){ .pose = scene->pose, .options = &options });
}

static bool add_light_map(struct bake_plan *plan, struct prt_scene *scene)
{
    const struct charts *charts = &scene->charts;
    if (scene->receivers.at_vertices) return true;
    bake_plan_set_light_map(plan, (struct bake_light_map){ charts->count, charts->texels_per_m,
                                                           charts_utilisation(charts), plan_at });
    return light_map_add_walls(plan, &scene->closing, charts) &&
           light_map_add_seams(plan, &scene->closing, charts);
}

static bool add_stages(struct bake_plan *plan, struct prt_scene *scene,
                       const struct scene_pose *statics)
{
    struct prt_receivers *receivers = &scene->receivers;
    bake_plan_depends(plan, scene_key(statics, SCENE_KEY_GEOMETRY | SCENE_KEY_MATERIALS));
    if (!prt_receivers_init(receivers, &scene->charts, bake_plan_host(plan), statics,
                            &scene->options)) {
        prt_receivers_finish(receivers);
        return false;
    }
    bake_plan_set_job(plan, &(struct bake_job){ .job = scene,
                                                .prepare = prepare,
                                                .finish = finish,
                                                .destroy = destroy,
                                                .bytes = prepared_bytes(receivers) });
    return prt_add_rays(plan, scene) && prt_add_transfer(plan, scene) &&
           add_light_map(plan, scene) && prt_add_matrices(plan, scene) &&
           prt_add_probes(plan, scene) && prt_add_compression(plan, scene);
}

bool prt_bake(struct bake_plan *plan, const struct technique_bake *how)
{
    struct prt_scene *scene = bake_plan_alloc(plan, 1, sizeof *scene);
    struct scene_statics statics;
    if (!scene) return false;
    scene->pose = how->pose;
    scene->options = *(const struct prt_options *)how->options;
    if (!scene_statics_init(&statics, bake_plan_host(plan), how->pose)) return false;
    const bool ok = add_stages(plan, scene, &statics.pose);
    scene_statics_finish(&statics);
    return ok;
}
