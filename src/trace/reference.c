// The reference renderer: passes of samples over image tiles, and their sums.
//
// A sample depends on its pixel and sample index alone, and sums are added in sample order: results
// are bit-identical for any number of threads and any split of the samples over calls.
#include "trace/reference_state.h"

#include "trace/guide_train.h"

#include "core/hash.h"
#include "core/parallel.h"
#include "core/rng.h"

#include <math.h>

enum {
    CHUNK = 128,   // tiles between progress reports
    MAX_STEP = 16, // samples of a pixel between progress reports
};

struct reference_options reference_options_default(void)
{
    return (
        struct reference_options){ .bounces = -1, .guiding = true, .obscurance_radius_m = 0.5f };
}

// ---- creation and destruction

static void set_camera(struct reference *r, const struct world_camera *camera)
{
    float tan_y = tanf(0.5f * camera->vertical_fov_rad);
    float tan_x = tan_y * (float)r->width / (float)r->height;
    vec3s right = glms_vec3_normalize(glms_vec3_cross(camera->forward, camera->up));
    r->camera_position = camera->eye;
    r->forward = camera->forward;
    r->right = glms_vec3_scale(right, tan_x);
    r->up = glms_vec3_scale(glms_vec3_cross(right, camera->forward), tan_y);
    r->near_m = camera->near_m;
}

static uint64_t key_of(const struct reference *r)
{
    const struct reference_options *o = &r->options;
    const int words[] = { r->width,         r->height,       o->bounces,  o->direct_only,
                          o->indirect_only, o->diffuse_only, o->antialias };
    uint64_t key = hash_bytes(words, sizeof words, r->scene->key);
    const vec3s camera[] = { r->camera_position, r->forward, r->right, r->up,
                             vec3_of(r->near_m, 0, 0) };
    key = hash_bytes(camera, sizeof camera, key);
    key = hash_bytes(&o->seed, sizeof o->seed, key);
    return o->guiding ? key : hash_bytes(&o->guiding, sizeof o->guiding, key);
}

static bool check(struct host *host, int width, int height, const struct reference_options *options)
{
    if (width < 1 || height < 1 || width > IMAGE_MAX_SIZE || height > IMAGE_MAX_SIZE)
        return host_fail(host, FAIL_ARGUMENT, "reference of %dx%d: each must be 1 to %d", width,
                         height, IMAGE_MAX_SIZE);
    if (options->bounces < -1)
        return host_fail(host, FAIL_ARGUMENT,
                         "reference with %d bounces: must be 0 or more, or -1 for no limit",
                         options->bounces);
    if (options->direct_only && options->indirect_only)
        return host_fail(host, FAIL_ARGUMENT,
                         "reference of direct light only and of indirect light only: choose one");
    if (!(options->obscurance_radius_m > 0.0f) || !isfinite(options->obscurance_radius_m))
        return host_fail(host, FAIL_ARGUMENT,
                         "reference with an obscurance radius of %g m: must be above 0",
                         (double)options->obscurance_radius_m);
    if (!(options->occlusion_decay_per_m >= 0.0f) || !isfinite(options->occlusion_decay_per_m))
        return host_fail(host, FAIL_ARGUMENT,
                         "reference with an occlusion decay of %g 1/m: must be 0 or more",
                         (double)options->occlusion_decay_per_m);
    return true;
}

struct reference *reference_create(struct host *host, const struct scene_pose *pose,
                                   const struct world_camera *camera, int width, int height,
                                   const struct reference_options *options)
{
    if (!check(host, width, height, options)) return NULL;
    struct reference *r = host_alloc(host, 1, sizeof *r);
    if (!r) return NULL;
    r->host = host;
    r->options = *options;
    r->width = width;
    r->height = height;
    r->tiles_x = (width + REFERENCE_TILE - 1) / REFERENCE_TILE;
    r->tiles_y = (height + REFERENCE_TILE - 1) / REFERENCE_TILE;
    r->sums = host_alloc(host, (size_t)width * (size_t)height, sizeof *r->sums);
    r->tiles = host_alloc(host, (size_t)r->tiles_x * (size_t)r->tiles_y, sizeof *r->tiles);
    r->scene = r->sums && r->tiles ? trace_scene_create(host, pose) : NULL;
    const bool filtered = r->scene && trace_scene_add_levels(r->scene);
    if (!filtered) {
        reference_destroy(r);
        return NULL;
    }
    set_camera(r, camera);
    r->key = key_of(r);
    uint32_t low = (uint32_t)options->seed, high = (uint32_t)(options->seed >> 32);
    r->settings = (struct path_settings){
        .scene = r->scene,
        .bounces = options->bounces,
        .direct = !options->indirect_only,
        .indirect = !options->direct_only && options->bounces != 0,
        .diffuse_only = options->diffuse_only,
        .seed = pcg_hash(low ^ pcg_hash(high)),
    };
    return r;
}

void reference_destroy(struct reference *r)
{
    if (!r) return;
    trace_scene_destroy(r->scene);
    guide_destroy(r->host, r->guide);
    host_free(r->host, r->sums);
    host_free(r->host, r->tiles);
    host_free(r->host, r->obscurance);
    host_free(r->host, r);
}

uint64_t reference_key(const struct reference *reference)
{
    return reference->key;
}

// ---- rendering

// The ray through an image point in pixels; its direction has the length 1 along the view axis.
static struct ray camera_ray(const struct reference *r, float x, float y)
{
    vec3s d = glms_vec3_muladds(r->right, 2.0f * x / (float)r->width - 1.0f, r->forward);
    d = glms_vec3_muladds(r->up, 1.0f - 2.0f * y / (float)r->height, d);
    return (struct ray){ r->camera_position, d, r->near_m, INFINITY };
}

struct path_start reference_start_at(const struct reference *r, float x, float y, uint64_t *rays)
{
    struct ray ray = camera_ray(r, x, y);
    struct pixel_footprint footprint = {
        .direction = ray.direction,
        .origin = ray.origin,
        .dx = glms_vec3_scale(r->right, 2.0f / (float)r->width),
        .dy = glms_vec3_scale(r->up, -2.0f / (float)r->height),
    };
    return path_begin(&r->settings, &ray, &footprint, rays);
}

static void add_sample(struct pixel_sums *sums, const struct path_light *light)
{
    for (int c = 0; c < 3; c++) {
        double direct = (double)light->direct.raw[c], indirect = (double)light->indirect.raw[c];
        sums->direct[c] += direct;
        sums->indirect[c] += indirect;
        sums->indirect_emitters_sky[c] += (double)light->indirect_emitters_sky.raw[c];
        sums->irradiance[c] += (double)light->irradiance.raw[c];
        sums->irradiance_emitters_sky[c] += (double)light->irradiance_emitters_sky.raw[c];
        sums->squares[c] += (direct + indirect) * (direct + indirect);
    }
}

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

// Adjacent pixels with up to MAX_STEP samples each, filling one batch. Without antialiasing,
// samples of a pixel share one path_start.
struct pixel_run {
    int x, y, width;
    int from, to; // samples
};

static void start_run(const struct reference *r, const struct pixel_run *run,
                      struct path_start starts[PATH_BATCH], struct path_sample *samples,
                      uint64_t *rays)
{
    int count = 0;
    for (int x = run->x; x < run->x + run->width; x++) {
        uint32_t pixel = (uint32_t)run->y * (uint32_t)r->width + (uint32_t)x;
        for (int i = run->from; i < run->to; i++, count++) {
            bool jittered = r->options.antialias;
            vec2s u = { { 0.5f, 0.5f } };
            if (jittered) u = path_subpixel(&r->settings, pixel, (uint32_t)i);
            int start = jittered ? count : x - run->x;
            if (jittered || i == run->from)
                starts[start] = reference_start_at(r, (float)x + u.x, (float)run->y + u.y, rays);
            samples[count] = (struct path_sample){ .start = &starts[start],
                                                   .pixel = pixel,
                                                   .sample = (uint32_t)i };
        }
    }
}

// sums: of the run's first pixel.
static void render_run(const struct reference *r, const struct pixel_run *run,
                       struct pixel_sums *sums, uint64_t *rays)
{
    struct path_start starts[PATH_BATCH];
    struct path_sample samples[PATH_BATCH];
    const int each = run->to - run->from, count = run->width * each;
    start_run(r, run, starts, samples, rays);
    path_trace(&r->settings, samples, count, rays);
    for (int i = 0; i < count; i++) add_sample(&sums[i / each], &samples[i].light);
}

void reference_trace_row(const struct reference *r, const struct reference_row *row,
                         struct pixel_sums *sums, uint64_t *rays)
{
    for (int from = row->from; from < row->to; from += MAX_STEP) {
        const int to = min_int(from + MAX_STEP, row->to), width = PATH_BATCH / (to - from);
        for (int x = 0; x < row->width; x += width) {
            const struct pixel_run run = { row->x + x, row->y, min_int(width, row->width - x), from,
                                           to };
            render_run(r, &run, &sums[x], rays);
        }
    }
}

struct pass {
    struct reference *reference;
    size_t first_tile;
    int samples; // target per pixel
};

static void render_tile(void *user, size_t i)
{
    const struct pass *pass = user;
    struct reference *r = pass->reference;
    size_t index = pass->first_tile + i;
    struct reference_tile *tile = &r->tiles[index];
    if (tile->samples >= pass->samples) return;
    int left = (int)(index % (size_t)r->tiles_x) * REFERENCE_TILE,
        top = (int)(index / (size_t)r->tiles_x) * REFERENCE_TILE;
    unsigned before = embree_flush_denormals();
    uint64_t rays = 0;
    for (int y = top; y < min_int(top + REFERENCE_TILE, r->height); y++) {
        const struct reference_row row = { left, y, min_int(REFERENCE_TILE, r->width - left),
                                           tile->samples, pass->samples };
        reference_trace_row(r, &row, &r->sums[(size_t)y * (size_t)r->width + (size_t)left], &rays);
    }
    embree_restore_denormals(before);
    tile->rays += rays;
    tile->samples = pass->samples;
}

int reference_min_samples(const struct reference *r)
{
    int least = r->tiles[0].samples;
    for (size_t i = 1; i < reference_tile_count(r); i++)
        if (r->tiles[i].samples < least) least = r->tiles[i].samples;
    return least;
}

// Steps grow from 1, so that a first image is available early.
static int next_step(int done, int left)
{
    return min_int(done < 1 ? 1 : min_int(done, MAX_STEP), left);
}

static struct path_start start_of_training(const void *reference, float x, float y, uint64_t *rays)
{
    return reference_start_at(reference, x, y, rays);
}

bool reference_train(struct reference *r)
{
    if (r->trained || !r->options.guiding) return true;
    struct guide_training training = { .host = r->host,
                                       .settings = r->settings,
                                       .width = r->width,
                                       .height = r->height,
                                       .start = start_of_training,
                                       .user = r };
    if (!guide_train(&training, &r->guide, &r->training_rays)) return false;
    r->settings.guide = r->guide;
    r->trained = true;
    return true;
}

bool reference_render(struct reference *r, int samples, bool (*progress)(void *user, double done),
                      void *user)
{
    int done_before = reference_min_samples(r);
    if (samples < 1 || samples > INT32_MAX - done_before)
        return host_fail(r->host, FAIL_ARGUMENT,
                         "reference with %d samples after %d: must be 1 or more", samples,
                         done_before);
    if (!reference_train(r)) return false;
    size_t count = reference_tile_count(r);
    for (int done = done_before; done < done_before + samples;) {
        int step = next_step(done, done_before + samples - done);
        for (size_t first = 0; first < count; first += CHUNK) {
            size_t chunk = count - first < CHUNK ? count - first : CHUNK;
            struct pass pass = { r, first, done + step };
            parallel_for(chunk, 1, render_tile, &pass);
            double share = (double)(first + chunk) / (double)count;
            double all = ((double)(done - done_before) + share * (double)step) / (double)samples;
            if (progress && !progress(user, all))
                return host_fail(r->host, FAIL_CANCELLED, "reference of %s: cancelled",
                                 r->scene->scene->name);
        }
        done += step;
    }
    return true;
}

void reference_log_rays(struct reference *r, struct ray_log *log)
{
    embree_log(r->scene->embree, log);
}
