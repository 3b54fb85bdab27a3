// The reference's light transport (trace/path.c) from the points of a texel, as if they were white
// and diffuse: paths that begin with cosine-distributed directions.
#include "lightmap/gather.h"

#include "core/rng.h"
#include "trace/next_event.h"

#include <math.h>

// Reflections of the sun in narrower lobes than texels resolve would be single bright texels.
static const float MIN_PUNCTUAL_ROUGHNESS = 0.4f;

bool gather_scene_init(struct gather_scene *s, struct host *host, const struct scene_pose *pose,
                       const struct charts *charts)
{
    *s = (struct gather_scene){ .host = host, .charts = charts };
    s->trace = trace_scene_create(host, pose);
    return s->trace && gather_list_triangles(s);
}

void gather_scene_finish(struct gather_scene *s)
{
    if (!s->host) return;
    trace_scene_destroy(s->trace);
    host_free(s->host, s->first);
    host_free(s->host, s->meeting);
    *s = (struct gather_scene){ 0 };
}

static struct path_start start_at(const struct gather_scene *s, const struct gather_point *point,
                                  bool back)
{
    struct path_start start = { .hit = true, .surface = gather_surface(s, point, back) };
    start.bsdf = surface_bsdf(&start.surface, start.surface.normal, true);
    return start;
}

// The reflected radiance of a white surface is E/π.
vec3s gather_punctual(const struct gather_scene *s, const struct gather_points *points)
{
    vec3s sum = vec3_of(0, 0, 0);
    uint64_t rays = 0;
    if (points->count == 0 || s->trace->lights.punctual_count == 0) return sum;
    for (int k = 0; k < points->count; k++) {
        const struct path_start start = start_at(s, &points->at[k], points->back);
        sum = glms_vec3_add(sum,
                            next_event_all_punctual(s->trace, &start.surface, &start.bsdf, &rays));
    }
    return glms_vec3_scale(sum, GLM_PIf / (float)points->count);
}

// The paths of a texel, or of a group of them.
struct paths {
    struct path_settings settings;
    struct path_start starts[GATHER_POINTS];
    int start_count;
    uint32_t pixel; // of random numbers
};

static void init_paths(struct paths *paths, const struct gather_scene *s,
                       const struct gather_points *points, uint64_t seed)
{
    paths->settings = (struct path_settings){
        .scene = s->trace,
        .bounces = -1,
        .direct = true,
        .indirect = true,
        .stratified = true,
        .min_punctual_roughness = MIN_PUNCTUAL_ROUGHNESS,
        .seed = (uint32_t)(rng_mix(seed + points->back) >> 32),
    };
    paths->pixel = points->pixel;
    paths->start_count = points->count;
    for (int k = 0; k < points->count; k++)
        paths->starts[k] = start_at(s, &points->at[k], points->back);
}

// Adds the irradiance of paths `first` to `end` − 1.
static void add_paths(const struct paths *paths, uint32_t first, uint32_t end, double sum[3])
{
    struct path_sample batch[PATH_BATCH];
    uint64_t rays = 0;
    while (first < end) {
        int count = 0;
        for (; count < PATH_BATCH && first < end; count++, first++)
            batch[count] =
                (struct path_sample){ .start = &paths->starts[first % (uint32_t)paths->start_count],
                                      .pixel = paths->pixel,
                                      .sample = first };
        path_trace(&paths->settings, batch, count, &rays);
        for (int i = 0; i < count; i++)
            for (int c = 0; c < 3; c++)
                sum[c] += (double)batch[i].light.irradiance_emitters_sky.raw[c];
    }
}

enum { VARIANCE_GROUPS = 8 };

static double luminance_of(const double light[3])
{
    return (double)luminance(vec3_of((float)light[0], (float)light[1], (float)light[2]));
}

vec3s gather_paths(const struct gather_scene *s, const struct gather_points *points, int samples,
                   uint64_t seed, float *variance)
{
    struct paths paths;
    double sum[3] = { 0.0, 0.0, 0.0 }, squares = 0.0;
    if (points->count == 0 || samples < 1) return vec3_of(0, 0, 0);
    init_paths(&paths, s, points, seed);
    const int groups = samples < VARIANCE_GROUPS ? samples : VARIANCE_GROUPS;
    for (int g = 0, first = 0; g < groups; g++) {
        double part[3] = { 0.0, 0.0, 0.0 };
        const int end = (int)((int64_t)samples * (g + 1) / groups);
        add_paths(&paths, (uint32_t)first, (uint32_t)end, part);
        for (int c = 0; c < 3; c++) sum[c] += part[c];
        const double mean = luminance_of(part) / (end - first);
        squares += (end - first) * mean * mean;
        first = end;
    }
    for (int c = 0; c < 3; c++) sum[c] /= (double)samples;
    // One group says nothing: a variance as large as its square.
    const double mean = luminance_of(sum);
    const double spread =
        groups > 1 ? (squares / samples - mean * mean) / (groups - 1) : mean * mean;
    if (variance) *variance = (float)fmax(spread, 0.0);
    return vec3_of((float)sum[0], (float)sum[1], (float)sum[2]);
}

// Texels of an atlas are fewer than 2²⁸ (CHART_MAX_SIDE), so that groups have pixels of their own.
void gather_grouped_paths(const struct gather_scene *s, const struct gather_points *points,
                          uint32_t before, uint32_t after, uint64_t seed, struct noise_sums *sums)
{
    struct paths paths;
    double all[3] = { 0.0, 0.0, 0.0 };
    if (points->count == 0 || after <= before) return;
    init_paths(&paths, s, points, seed);
    for (uint32_t g = 0; g < NOISE_GROUPS; g++) {
        double sum[3] = { 0.0, 0.0, 0.0 };
        paths.pixel = points->pixel | g << 28;
        add_paths(&paths, before / NOISE_GROUPS, after / NOISE_GROUPS, sum);
        sums->group[g] += (float)luminance_of(sum);
        for (int c = 0; c < 3; c++) all[c] += sum[c];
    }
    for (int c = 0; c < 3; c++) sums->light[c] += (float)all[c];
    sums->paths = (float)after;
}
