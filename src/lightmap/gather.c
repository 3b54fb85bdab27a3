// The reference's light transport (trace/path.c) from the points of a texel, as if they were white
// and diffuse: paths that begin with cosine-distributed directions.
#include "lightmap/gather.h"

#include "core/rng.h"
#include "trace/next_event.h"
#include "trace/share.h"

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

// ---- tiles

static bool is_of_side(const struct charts *charts, uint32_t texel, uint32_t chart, bool back)
{
    return chart_triangle_of(charts, texel)->chart == chart && chart_is_back(charts, texel) == back;
}

// The part of a block that is of the texel's chart. Charts number texels along squares
// (scene/charts/squares.h), so that they are close.
void gather_tile_of(const struct gather_scene *s, uint32_t texel, struct gather_tile *out)
{
    const struct charts *charts = s->charts;
    const uint32_t chart = chart_triangle_of(charts, texel)->chart;
    const uint32_t block = texel - texel % GATHER_TILE;
    const bool back = chart_is_back(charts, texel);
    uint32_t first = texel, end = texel + 1;
    while (first > block && is_of_side(charts, first - 1, chart, back)) first--;
    while (end < block + GATHER_TILE && end < charts->side_texel_count &&
           is_of_side(charts, end, chart, back))
        end++;
    *out = (struct gather_tile){ .first = first, .count = end - first };
    for (uint32_t i = 0; i < out->count; i++) gather_find_points(s, first + i, &out->points[i]);
}

// The paths of texels that share them, or of a group of these paths.
struct member {
    uint32_t index; // in the tile
    uint32_t pixel; // of random numbers
    int start_count;
    struct path_start starts[GATHER_POINTS];
};
struct paths {
    struct path_settings settings;
    uint32_t pixel; // of the first directions
    int count;
    struct member members[GATHER_TILE]; // texels with points outside geometry
};

static void add_member(struct paths *paths, const struct gather_scene *s,
                       const struct gather_points *points, uint32_t index)
{
    struct member *member = &paths->members[paths->count++];
    member->index = index;
    member->pixel = points->pixel;
    member->start_count = points->count;
    for (int k = 0; k < points->count; k++)
        member->starts[k] = start_at(s, &points->at[k], points->back);
}

static void init_paths(struct paths *paths, const struct gather_scene *s,
                       const struct gather_points *points, uint32_t count, uint64_t seed)
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
    paths->count = 0;
    for (uint32_t i = 0; i < count; i++)
        if (points[i].count > 0) add_member(paths, s, &points[i], i);
    paths->pixel = points->pixel;
}

// The number of a path in the sequence of first directions. Runs of each texel are a net, and so
// are those of all.
enum { RUN = 16 };
static uint32_t step_number(const struct paths *paths, uint32_t round, uint32_t member)
{
    return round / RUN * (RUN * (uint32_t)paths->count) + RUN * member + round % RUN;
}

struct batch {
    struct path_sample samples[PATH_BATCH];
    struct path_end ends[PATH_BATCH];
    int count;
};

// A path of each texel.
static void add_round(struct batch *batch, const struct paths *paths, uint32_t group,
                      uint32_t round)
{
    for (int m = 0; m < paths->count; m++) {
        const struct member *member = &paths->members[m];
        struct path_end *end = &batch->ends[batch->count];
        end->pixel = paths->pixel | group << 28;
        end->sample = step_number(paths, round, (uint32_t)m);
        end->directions = sqrtf((float)paths->count);
        batch->samples[batch->count++] =
            (struct path_sample){ .start = &member->starts[round % (uint32_t)member->start_count],
                                  .pixel = member->pixel | group << 28,
                                  .sample = round,
                                  .end = end };
    }
}

// Shares the paths of a round.
static void share_round(const struct paths *paths, const struct path_sample *samples,
                        double (*sums)[3])
{
    const struct path_start *starts[GATHER_TILE];
    vec3s light[GATHER_TILE];
    uint64_t rays = 0;
    for (int m = 0; m < paths->count; m++) {
        starts[m] = samples[m].start;
        light[m] = samples[m].light.irradiance_emitters_sky;
    }
    for (int m = 0; m < paths->count; m++)
        path_share(&paths->settings, starts, paths->count, m, samples[m].end, light, &rays);
    for (int m = 0; m < paths->count; m++)
        for (int c = 0; c < 3; c++) sums[m][c] += (double)light[m].raw[c];
}

// Adds the irradiance of paths `first` to `end` − 1 of each texel.
static void add_paths(const struct paths *paths, uint32_t group, uint32_t first, uint32_t end,
                      double (*sums)[3])
{
    struct batch batch;
    uint64_t rays = 0;
    if (paths->count == 0) return;
    while (first < end) {
        batch.count = 0;
        for (; batch.count + paths->count <= PATH_BATCH && first < end; first++)
            add_round(&batch, paths, group, first);
        path_trace(&paths->settings, batch.samples, batch.count, &rays);
        for (int i = 0; i < batch.count; i += paths->count)
            share_round(paths, &batch.samples[i], sums);
    }
}

enum { VARIANCE_GROUPS = 8 };

static double luminance_of(const double light[3])
{
    return (double)luminance(vec3_of((float)light[0], (float)light[1], (float)light[2]));
}

struct tile_sums {
    double light[GATHER_TILE][3], squares[GATHER_TILE];
};

static void add_group(struct tile_sums *sums, const struct paths *paths, int first, int end)
{
    double part[GATHER_TILE][3] = { 0 };
    add_paths(paths, 0, (uint32_t)first, (uint32_t)end, part);
    for (int m = 0; m < paths->count; m++) {
        for (int c = 0; c < 3; c++) sums->light[m][c] += part[m][c];
        const double mean = luminance_of(part[m]) / (end - first);
        sums->squares[m] += (end - first) * mean * mean;
    }
}

void gather_tile_paths(const struct gather_scene *s, struct gather_tile *tile, int samples,
                       uint64_t seed)
{
    struct paths paths;
    struct tile_sums sums = { 0 };
    const int groups = samples < VARIANCE_GROUPS ? samples : VARIANCE_GROUPS;
    init_paths(&paths, s, tile->points, tile->count, seed);
    for (int g = 0, first = 0; g < groups; g++) {
        const int end = (int)((int64_t)samples * (g + 1) / groups);
        add_group(&sums, &paths, first, end);
        first = end;
    }
    for (int m = 0; m < paths.count; m++) {
        const uint32_t i = paths.members[m].index;
        for (int c = 0; c < 3; c++) sums.light[m][c] /= (double)samples;
        // One group says nothing: a variance as large as its square.
        const double mean = luminance_of(sums.light[m]);
        const double spread =
            groups > 1 ? (sums.squares[m] / samples - mean * mean) / (groups - 1) : mean * mean;
        tile->variance[i] = (float)fmax(spread, 0.0);
        for (int c = 0; c < 3; c++) tile->light[i].raw[c] = (float)sums.light[m][c];
    }
}

// Texels of an atlas are fewer than 2²⁸ (CHART_MAX_SIDE), so that groups have pixels of their own.
void gather_grouped_paths(const struct gather_scene *s, const struct gather_tile *tile,
                          uint32_t before, uint32_t after, uint64_t seed, struct noise_sums *sums)
{
    struct paths paths;
    if (after <= before) return;
    init_paths(&paths, s, tile->points, tile->count, seed);
    for (uint32_t g = 0; g < NOISE_GROUPS; g++) {
        double part[GATHER_TILE][3] = { 0 };
        add_paths(&paths, g, before / NOISE_GROUPS, after / NOISE_GROUPS, part);
        for (int m = 0; m < paths.count; m++) {
            struct noise_sums *out = &sums[paths.members[m].index];
            out->group[g] += (float)luminance_of(part[m]);
            for (int c = 0; c < 3; c++) out->light[c] += (float)part[m][c];
            out->paths = (float)after;
        }
    }
}

vec3s gather_paths(const struct gather_scene *s, const struct gather_points *points, int samples,
                   uint64_t seed)
{
    struct paths paths;
    double sum[1][3] = { { 0.0, 0.0, 0.0 } };
    if (points->count == 0 || samples < 1) return vec3_of(0, 0, 0);
    init_paths(&paths, s, points, 1, seed);
    add_paths(&paths, 0, 0, (uint32_t)samples, sum);
    for (int c = 0; c < 3; c++) sum[0][c] /= (double)samples;
    return vec3_of((float)sum[0][0], (float)sum[0][1], (float)sum[0][2]);
}
