// Overhead of the path tracer over Embree: millions of rays per second of `afterglow reference`,
// and of Embree alone with the same rays, alternating. Seconds are CPU time of all cores together,
// which hardly depends on other load.
//
//     rays [--size WxH] [--spp N] [--rounds N] [SCENE]…
#include "command_line.h"
#include "core/parallel.h"
#include "scene/dark.h"
#include "scene/view/defaults.h"
#include "trace/trace_scene.h"

#if AG_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { LOG_SIZE = 1 << 20, CHUNK = 4096 }; // rays

struct bench {
    struct bench_scenes scenes;
    int width, height, samples, rounds;
    struct host host;
};

static double core_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// ---- Embree alone

struct embree_only {
    RTCDevice device;
    RTCScene scene;
    const struct ray_log *log;
    size_t count;
    atomic_size_t hits; // keeps the compiler from removing calls
};

static void add_mesh(struct embree_only *embree, const struct embree_geometry *mesh)
{
    RTCGeometry g = rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh->positions, 0,
                               mesh->stride, mesh->vertex_count);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->indices, 0,
                               3 * sizeof(uint32_t), mesh->triangle_count);
    rtcCommitGeometry(g);
    rtcAttachGeometry(embree->scene, g);
    rtcReleaseGeometry(g);
}

// Alpha masks are ignored: they belong to the path tracer.
static bool begin_embree(struct embree_only *embree, const struct trace_scene *scene)
{
    embree->device = rtcNewDevice(NULL);
    if (embree->device) embree->scene = rtcNewScene(embree->device);
    if (!embree->scene) return false;
    rtcSetSceneFlags(embree->scene, RTC_SCENE_FLAG_ROBUST);
    for (uint32_t i = 0; i < scene->mesh_count; i++) add_mesh(embree, &scene->meshes[i].geometry);
    rtcCommitScene(embree->scene);
    return rtcGetDeviceError(embree->device) == RTC_ERROR_NONE;
}

static void finish_embree(struct embree_only *embree)
{
    if (embree->scene) rtcReleaseScene(embree->scene);
    if (embree->device) rtcReleaseDevice(embree->device);
}

static bool trace(const struct embree_only *embree, const struct logged_ray *logged)
{
    const struct ray *ray = &logged->ray;
    struct RTCRayHit r;
    r.ray = (struct RTCRay){ .org_x = ray->origin.x,
                             .org_y = ray->origin.y,
                             .org_z = ray->origin.z,
                             .tnear = ray->near,
                             .dir_x = ray->direction.x,
                             .dir_y = ray->direction.y,
                             .dir_z = ray->direction.z,
                             .tfar = ray->far,
                             .mask = 0xffffffffu };
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if AG_EMBREE == 4
    if (logged->occlusion)
        rtcOccluded1(embree->scene, &r.ray, NULL);
    else
        rtcIntersect1(embree->scene, &r, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (logged->occlusion)
        rtcOccluded1(embree->scene, &context, &r.ray);
    else
        rtcIntersect1(embree->scene, &context, &r);
#endif
    return logged->occlusion ? r.ray.tfar < 0.0f : r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

static void trace_chunk(void *user, size_t chunk)
{
    struct embree_only *embree = user;
    size_t hits = 0,
           end = (chunk + 1) * CHUNK < embree->count ? (chunk + 1) * CHUNK : embree->count;
    for (size_t i = chunk * CHUNK; i < end; i++) hits += trace(embree, &embree->log->rays[i]);
    atomic_fetch_add(&embree->hits, hits);
}

// Rays per second.
static double embree_only_rate(struct embree_only *embree)
{
    double begun = core_s();
    parallel_for((embree->count + CHUNK - 1) / CHUNK, 1, trace_chunk, embree);
    return (double)embree->count / (core_s() - begun);
}

// ---- the path tracer

static double reference_rate(struct reference *reference, int samples)
{
    uint64_t before = reference_info(reference).rays;
    double begun = core_s();
    if (!reference_render(reference, samples, NULL, NULL)) return 0.0;
    double seconds = core_s() - begun;
    return (double)(reference_info(reference).rays - before) / seconds;
}

// The log holds the rays of the first tiles, in the order in which they were traced.
static bool measure(struct bench *bench, const char *name, struct reference *reference,
                    struct trace_scene *scene, struct ray_log *log)
{
    struct embree_only embree = { .log = log };
    reference_log_rays(reference, log);
    bool ok = reference_render(reference, 2, NULL, NULL) && begin_embree(&embree, scene);
    reference_log_rays(reference, NULL);
    size_t logged = atomic_load(&log->count), occlusion = 0;
    embree.count = logged < log->capacity ? logged : log->capacity;
    for (size_t i = 0; i < embree.count; i++) occlusion += log->rays[i].occlusion;
    double best = 0.0, best_embree = 0.0;
    for (int i = 0; ok && i < bench->rounds; i++) {
        double rate = reference_rate(reference, bench->samples),
               embree_rate = embree_only_rate(&embree);
        best = rate > best ? rate : best;
        best_embree = embree_rate > best_embree ? embree_rate : best_embree;
    }
    if (ok)
        printf("%-32s %10.2f %10.2f %9.0f %% %9.0f %%\n", name, best * 1e-6, best_embree * 1e-6,
               100.0 * best / best_embree, 100.0 * (double)occlusion / (double)embree.count);
    fflush(stdout);
    finish_embree(&embree);
    return ok;
}

static bool add_default_lighting(struct scene *scene)
{
    struct scene_pose pose = { 0 };
    if (!pose_init(&pose, scene, -1, 0.0f)) return false;
    const bool dark = pose_is_dark(&pose);
    struct default_lighting lighting =
        dark ? default_lighting(&pose) : (struct default_lighting){ 0 };
    pose_finish(&pose);
    if (!dark) return true;
    int node = scene_add_node_looking(scene, "sun", vec3_of(0, 0, 0), lighting.sun_direction);
    struct light sun = {
        .name = "sun", .type = LIGHT_SUN, .node = node, .intensity = lighting.sun_lux
    };
    scene->environment.sky = lighting.sky;
    return node >= 0 && scene_add_light(scene, &sun) >= 0;
}

static bool measure_scene(struct bench *bench, const char *name)
{
    struct scene_pose pose = { 0 };
    struct reference *reference = NULL;
    struct trace_scene *traced = NULL;
    struct ray_log log = { .capacity = LOG_SIZE };
    struct reference_options options = reference_options_default();
    struct scene *scene = scene_load(&bench->host, name);
    bool ok = scene && add_default_lighting(scene) && pose_init(&pose, scene, -1, 0.0f);
    if (ok) {
        struct world_camera camera =
            scene->camera_count > 0 ? pose_camera(&pose, 0) : default_camera(&pose);
        reference =
            reference_create(&bench->host, &pose, &camera, bench->width, bench->height, &options);
        traced = trace_scene_create(&bench->host, &pose);
        log.rays = host_alloc(&bench->host, log.capacity, sizeof *log.rays);
    }
    ok = ok && reference && traced && log.rays && measure(bench, name, reference, traced, &log);
    host_free(&bench->host, log.rays);
    reference_destroy(reference);
    trace_scene_destroy(traced);
    pose_finish(&pose);
    scene_destroy(scene);
    return ok;
}

// ---- main

static bool parse_option(void *user, const char *name, const char *value)
{
    struct bench *bench = user;
    if (strcmp(name, "--size") == 0) return parse_size(value, &bench->width, &bench->height);
    if (strcmp(name, "--spp") == 0) return parse_int(value, 1, 1000000, &bench->samples);
    if (strcmp(name, "--rounds") == 0) return parse_int(value, 1, 1000000, &bench->rounds);
    return false;
}

static bool parse(struct bench *bench, int argc, char **argv)
{
    if (!command_line_parse(argc, argv, parse_option, bench, &bench->scenes)) return false;
    default_scenes(&bench->scenes, "@cornell", "@atrium");
    return true;
}

static void print_error(void *user, enum log_level level, const char *message)
{
    (void)user;
    (void)level;
    fprintf(stderr, "rays: %s\n", message);
}

int main(int argc, char **argv)
{
    static struct bench bench = { .width = 256, .height = 256, .samples = 16, .rounds = 5 };
    bench.host = host_default();
    bench.host.log = print_error;
    bench.host.log_up_to = LOG_ERROR;
    if (!parse(&bench, argc, argv)) {
        fprintf(stderr, "usage: rays [--size WxH] [--spp N] [--rounds N] [SCENE]...\n");
        return 2;
    }
    printf("%-32s %10s %10s %11s %11s\n", "million rays per core second", "reference", "Embree",
           "ratio", "shadow rays");
    for (int i = 0; i < bench.scenes.count; i++)
        if (!measure_scene(&bench, bench.scenes.names[i])) return 1;
    return 0;
}
