// Wrapper of Embree 3 and 4, which pass a query's flags and context differently.
#include "trace/embree.h"

#if AG_EMBREE == 4
#include <embree4/rtcore.h>
#define FLAG_QUERY_FILTER RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS
#else
#include <embree3/rtcore.h>
#define FLAG_QUERY_FILTER RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
#endif

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include <assert.h>

struct embree {
    struct host *host;
    RTCDevice device;
    RTCScene scene;
    struct ray_log *log; // NULL: none
};

static bool fail(const struct embree *embree, const char *doing)
{
    enum RTCError code = rtcGetDeviceError(embree->device);
    bool memory = code == RTC_ERROR_OUT_OF_MEMORY;
    return host_fail(embree->host, memory ? FAIL_MEMORY : FAIL_UNSUPPORTED,
                     "cannot %s for rays: %s (Embree's error %d)", doing,
                     memory ? "out of memory" : "refused by the library", (int)code);
}

struct embree *embree_create(struct host *host)
{
    struct embree *embree = host_alloc(host, 1, sizeof *embree);
    if (!embree) return NULL;
    embree->host = host;
    embree->device = rtcNewDevice(NULL);
    if (embree->device) embree->scene = rtcNewScene(embree->device);
    if (!embree->scene) {
        fail(embree, "begin a scene");
        embree_destroy(embree);
        return NULL;
    }
    // Robust: no ray slips through an edge that two triangles share. The other flag lets a query
    // bring a filter.
    rtcSetSceneFlags(embree->scene, RTC_SCENE_FLAG_ROBUST | FLAG_QUERY_FILTER);
    return embree;
}

void embree_destroy(struct embree *embree)
{
    if (!embree) return;
    if (embree->scene) rtcReleaseScene(embree->scene);
    if (embree->device) rtcReleaseDevice(embree->device);
    host_free(embree->host, embree);
}

// ---- alpha-masked geometry

struct query {
#if AG_EMBREE == 4
    struct RTCRayQueryContext context;
#else
    struct RTCIntersectContext context;
#endif
    const void *view;
    embree_hit *each; // of embree_all_hits
    void *user;
};

// Queries are of one ray each, so hits have the layout of RTCHit.
static void filter(const struct RTCFilterFunctionNArguments *arguments)
{
    const struct embree_geometry *geometry = arguments->geometryUserPtr;
    const struct query *query = (const struct query *)arguments->context;
    const struct RTCHit *hit = (const struct RTCHit *)arguments->hit;
    assert(arguments->N == 1);
    if (arguments->valid[0] &&
        !geometry->solid(geometry->user, hit->primID, hit->u, hit->v, query->view))
        arguments->valid[0] = 0;
}

bool embree_add(struct embree *embree, const struct embree_geometry *geometry)
{
    RTCGeometry g = rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!g) return fail(embree, "add triangles");
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, geometry->positions,
                               0, geometry->stride, geometry->vertex_count);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, geometry->indices, 0,
                               3 * sizeof(uint32_t), geometry->triangle_count);
    if (geometry->solid) {
        rtcSetGeometryUserData(g, (void *)(uintptr_t)geometry);
        rtcSetGeometryIntersectFilterFunction(g, filter);
        rtcSetGeometryOccludedFilterFunction(g, filter);
    }
    rtcCommitGeometry(g);
    rtcAttachGeometry(embree->scene, g);
    rtcReleaseGeometry(g);
    return rtcGetDeviceError(embree->device) == RTC_ERROR_NONE || fail(embree, "add triangles");
}

bool embree_commit(struct embree *embree)
{
    rtcCommitScene(embree->scene);
    enum RTCError code = rtcGetDeviceError(embree->device);
    if (code == RTC_ERROR_NONE) return true;
    return host_fail(embree->host, code == RTC_ERROR_OUT_OF_MEMORY ? FAIL_MEMORY : FAIL_UNSUPPORTED,
                     "cannot sort triangles for rays: Embree's error %d", (int)code);
}

// ---- queries

void embree_log(struct embree *embree, struct ray_log *log)
{
    embree->log = log;
}

static void log_ray(struct ray_log *log, const struct ray *ray, bool occlusion)
{
    size_t i = atomic_fetch_add_explicit(&log->count, 1, memory_order_relaxed);
    if (i < log->capacity) log->rays[i] = (struct logged_ray){ *ray, occlusion };
}

static struct RTCRay rtc_ray(const struct ray *ray)
{
    return (struct RTCRay){ .org_x = ray->origin.x,
                            .org_y = ray->origin.y,
                            .org_z = ray->origin.z,
                            .tnear = ray->near,
                            .dir_x = ray->direction.x,
                            .dir_y = ray->direction.y,
                            .dir_z = ray->direction.z,
                            .tfar = ray->far,
                            .mask = 0xffffffffu };
}

bool embree_closest(const struct embree *embree, const struct ray *ray, const void *view,
                    bool coherent, struct ray_hit *hit)
{
    if (embree->log) log_ray(embree->log, ray, false);
    struct query query;
    query.view = view;
    struct RTCRayHit r;
    r.ray = rtc_ray(ray);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if AG_EMBREE == 4
    rtcInitRayQueryContext(&query.context);
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &query.context;
    if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect1(embree->scene, &r, &arguments);
#else
    rtcInitIntersectContext(&query.context);
    if (coherent) query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect1(embree->scene, &query.context, &r);
#endif
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    *hit = (struct ray_hit){ r.ray.tfar, r.hit.geomID, r.hit.primID, r.hit.u, r.hit.v };
    return true;
}

// on_hit: called for each hit, or NULL.
static bool occluded(const struct embree *embree, const struct ray *ray, struct query *query,
                     RTCFilterFunctionN on_hit)
{
    if (embree->log) log_ray(embree->log, ray, true);
    query->view = NULL;
    struct RTCRay r = rtc_ray(ray);
#if AG_EMBREE == 4
    rtcInitRayQueryContext(&query->context);
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &query->context;
    if (on_hit) {
        arguments.filter = on_hit;
        arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    }
    rtcOccluded1(embree->scene, &r, &arguments);
#else
    rtcInitIntersectContext(&query->context);
    query->context.filter = on_hit;
    rtcOccluded1(embree->scene, &query->context, &r);
#endif
    return r.tfar < 0.0f; // −∞ when occluded
}

bool embree_occluded(const struct embree *embree, const struct ray *ray)
{
    struct query query;
    return occluded(embree, ray, &query, NULL);
}

// Hands the hit over and rejects it, so that the ray goes on.
static void hand_over(const struct RTCFilterFunctionNArguments *arguments)
{
    const struct query *query = (const struct query *)arguments->context;
    const struct RTCHit *h = (const struct RTCHit *)arguments->hit;
    const float distance = ((const struct RTCRay *)arguments->ray)->tfar;
    assert(arguments->N == 1);
    if (!arguments->valid[0]) return;
    query->each(query->user, &(struct ray_hit){ distance, h->geomID, h->primID, h->u, h->v });
    arguments->valid[0] = 0;
}

void embree_all_hits(const struct embree *embree, const struct ray *ray, embree_hit *each,
                     void *user)
{
    struct query query;
    query.each = each;
    query.user = user;
    occluded(embree, ray, &query, hand_over);
}

// ---- the floating-point unit

enum { FLUSH_TO_ZERO = 0x8000, DENORMALS_ARE_ZERO = 0x0040 }; // bits of MXCSR

unsigned embree_flush_denormals(void)
{
#ifdef __SSE2__
    unsigned before = _mm_getcsr();
    _mm_setcsr(before | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
    return before;
#else
    return 0;
#endif
}

void embree_restore_denormals(unsigned before)
{
#ifdef __SSE2__
    _mm_setcsr(before);
#else
    (void)before;
#endif
}
