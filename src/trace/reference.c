// The reference renderer: passes of samples over image tiles, their sums, and the layers.
//
// A sample depends on its pixel and sample index alone, and sums are added in sample order: results
// are bit-identical for any number of threads and any split of the samples over calls.
#include "trace/path.h"

#include "trace/guide_train.h"
#include "trace/obscurance.h"

#include "core/hash.h"
#include "core/parallel.h"
#include "core/rng.h"

#include <math.h>
#include <string.h>

enum {
    TILE = 16,     // pixels: neighbouring rays hit the same triangles
    CHUNK = 128,   // tiles between progress reports
    MAX_STEP = 16, // samples of a pixel between progress reports
};

struct pixel_sums {
    double direct[3], indirect[3], indirect_emitters_sky[3];
    double irradiance[3], irradiance_emitters_sky[3];
    double squares[3]; // of direct + indirect
};

struct tile {
    int samples; // per pixel so far
    uint64_t rays;
};

struct reference {
    struct host *host;
    struct trace_scene *scene;
    struct path_settings settings;
    struct reference_options options;
    int width, height, tiles_x, tiles_y;
    vec3s camera_position, forward, right, up; // right, up: to the image's edge at distance 1
    float near_m;
    struct pixel_sums *sums;            // [height][width]
    struct tile *tiles;                 // [tiles_y][tiles_x]
    struct obscurance_sums *obscurance; // [height][width]; NULL before the first read
    bool trained;
    struct guide *guide; // NULL: not guided
    uint64_t training_rays;
    uint64_t key;
};

struct reference_options reference_options_default(void)
{
    return (
        struct reference_options){ .bounces = -1, .guiding = true, .obscurance_radius_m = 0.5f };
}

static const char *const layer_names[REFERENCE_LAYER_COUNT] = {
    [REFERENCE_COLOR] = "color",
    [REFERENCE_DIRECT] = "direct",
    [REFERENCE_INDIRECT] = "indirect",
    [REFERENCE_IRRADIANCE] = "irradiance",
    [REFERENCE_INDIRECT_EMITTERS_SKY] = "indirect_emitters_sky",
    [REFERENCE_IRRADIANCE_EMITTERS_SKY] = "irradiance_emitters_sky",
    [REFERENCE_ALBEDO] = "albedo",
    [REFERENCE_NORMAL] = "normal",
    [REFERENCE_DEPTH] = "depth",
    [REFERENCE_POSITION] = "position",
    [REFERENCE_ERROR] = "error",
    [REFERENCE_SAMPLES] = "samples",
    [REFERENCE_OBSCURANCE] = "obscurance",
    [REFERENCE_AMBIENT_OCCLUSION] = "ambient_occlusion",
};

const char *reference_layer_name(int layer)
{
    return layer >= 0 && layer < REFERENCE_LAYER_COUNT ? layer_names[layer] : NULL;
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
    r->tiles_x = (width + TILE - 1) / TILE;
    r->tiles_y = (height + TILE - 1) / TILE;
    r->sums = host_alloc(host, (size_t)width * (size_t)height, sizeof *r->sums);
    r->tiles = host_alloc(host, (size_t)r->tiles_x * (size_t)r->tiles_y, sizeof *r->tiles);
    r->scene = r->sums && r->tiles ? trace_scene_create(host, pose) : NULL;
    if (!r->scene) {
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

static struct path_start start_at(const struct reference *r, float x, float y, uint64_t *rays)
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
                starts[start] = start_at(r, (float)x + u.x, (float)run->y + u.y, rays);
            samples[count] = (struct path_sample){ .start = &starts[start],
                                                   .pixel = pixel,
                                                   .sample = (uint32_t)i };
        }
    }
}

static void render_run(const struct reference *r, const struct pixel_run *run, uint64_t *rays)
{
    struct path_start starts[PATH_BATCH];
    struct path_sample samples[PATH_BATCH];
    int count = run->width * (run->to - run->from);
    start_run(r, run, starts, samples, rays);
    path_trace(&r->settings, samples, count, rays);
    for (int i = 0; i < count; i++) add_sample(&r->sums[samples[i].pixel], &samples[i].light);
}

struct pass {
    struct reference *reference;
    size_t first_tile;
    int samples; // target per pixel
};

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

static void render_tile(void *user, size_t i)
{
    const struct pass *pass = user;
    struct reference *r = pass->reference;
    size_t index = pass->first_tile + i;
    struct tile *tile = &r->tiles[index];
    if (tile->samples >= pass->samples) return;
    int left = (int)(index % (size_t)r->tiles_x) * TILE,
        top = (int)(index / (size_t)r->tiles_x) * TILE;
    unsigned before = embree_flush_denormals();
    uint64_t rays = 0;
    for (int from = tile->samples; from < pass->samples; from += MAX_STEP) {
        int to = min_int(from + MAX_STEP, pass->samples), width = PATH_BATCH / (to - from);
        for (int y = top; y < min_int(top + TILE, r->height); y++)
            for (int x = left, end = min_int(left + TILE, r->width); x < end; x += width) {
                struct pixel_run run = { x, y, min_int(width, end - x), from, to };
                render_run(r, &run, &rays);
            }
    }
    embree_restore_denormals(before);
    tile->rays += rays;
    tile->samples = pass->samples;
}

static size_t tile_count(const struct reference *r)
{
    return (size_t)r->tiles_x * (size_t)r->tiles_y;
}

static int min_samples(const struct reference *r)
{
    int least = r->tiles[0].samples;
    for (size_t i = 1; i < tile_count(r); i++)
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
    return start_at(reference, x, y, rays);
}

static bool train(struct reference *r)
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
    int done_before = min_samples(r);
    if (samples < 1 || samples > INT32_MAX - done_before)
        return host_fail(r->host, FAIL_ARGUMENT,
                         "reference with %d samples after %d: must be 1 or more", samples,
                         done_before);
    if (!train(r)) return false;
    size_t count = tile_count(r);
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

// ---- reading

static int samples_of(const struct reference *r, int x, int y)
{
    return r->tiles[(size_t)(y / TILE) * (size_t)r->tiles_x + (size_t)(x / TILE)].samples;
}

static const struct pixel_sums *sums_of(const struct reference *r, int x, int y)
{
    return &r->sums[(size_t)y * (size_t)r->width + (size_t)x];
}

static float mean_of(double sum, int samples)
{
    return samples > 0 ? (float)(sum / samples) : 0.0f;
}

// Squared standard error of the mean: the unbiased sample variance over n.
static double variance_of_mean(double sum, double squares, int samples)
{
    if (samples < 2) return INFINITY;
    double n = samples;
    return fmax(0.0, squares - sum * sum / n) / (n * (n - 1.0));
}

static void read_sums(const struct reference *r, enum reference_layer layer, int x, int y,
                      float *out)
{
    const struct pixel_sums *s = sums_of(r, x, y);
    int n = samples_of(r, x, y);
    for (int c = 0; c < 3; c++) {
        float direct = mean_of(s->direct[c], n), indirect = mean_of(s->indirect[c], n);
        if (layer == REFERENCE_COLOR) out[c] = direct + indirect;
        if (layer == REFERENCE_DIRECT) out[c] = direct;
        if (layer == REFERENCE_INDIRECT) out[c] = indirect;
        if (layer == REFERENCE_IRRADIANCE) out[c] = mean_of(s->irradiance[c], n);
        if (layer == REFERENCE_INDIRECT_EMITTERS_SKY)
            out[c] = mean_of(s->indirect_emitters_sky[c], n);
        if (layer == REFERENCE_IRRADIANCE_EMITTERS_SKY)
            out[c] = mean_of(s->irradiance_emitters_sky[c], n);
        if (layer == REFERENCE_ERROR)
            out[c] = (float)sqrt(variance_of_mean(s->direct[c] + s->indirect[c], s->squares[c], n));
    }
    if (layer == REFERENCE_SAMPLES) out[0] = (float)n;
}

static struct path_start centre_of(const struct reference *r, int x, int y)
{
    uint64_t rays = 0;
    struct reference bare = *r;
    bare.settings.direct = false;
    return start_at(&bare, (float)x + 0.5f, (float)y + 0.5f, &rays);
}

static void read_obscurance(const struct reference *r, enum reference_layer layer, int x, int y,
                            float *out)
{
    struct path_start start = centre_of(r, x, y);
    *out = 1.0f;
    if (!start.hit) return;
    const struct obscurance_settings settings = { .scene = r->scene,
                                                  .radius_m = r->options.obscurance_radius_m,
                                                  .sphere = r->options.obscurance_sphere,
                                                  .decay_per_m = r->options.occlusion_decay_per_m,
                                                  .seed = r->settings.seed };
    uint32_t pixel = (uint32_t)y * (uint32_t)r->width + (uint32_t)x;
    struct obscurance_sums *sums = &r->obscurance[pixel];
    obscurance_add(&settings, &start.surface, pixel, samples_of(r, x, y), sums);
    if (sums->samples == 0) return;
    const double sum = layer == REFERENCE_OBSCURANCE ? sums->volume : sums->ambient;
    *out = (float)(sum / sums->samples);
}

static void read_surface(const struct reference *r, enum reference_layer layer, int x, int y,
                         float *out)
{
    struct path_start start = centre_of(r, x, y);
    if (!start.hit) return;
    vec3s v = layer == REFERENCE_ALBEDO   ? start.surface.material.albedo
              : layer == REFERENCE_NORMAL ? start.surface.normal
                                          : start.surface.position;
    if (layer == REFERENCE_DEPTH) {
        out[0] =
            glms_vec3_dot(glms_vec3_sub(start.surface.position, r->camera_position), r->forward);
        return;
    }
    for (int c = 0; c < 3; c++) out[c] = v.raw[c];
}

static bool is_of_surface(enum reference_layer layer)
{
    return layer == REFERENCE_ALBEDO || layer == REFERENCE_NORMAL || layer == REFERENCE_DEPTH ||
           layer == REFERENCE_POSITION;
}

static bool is_obscurance(enum reference_layer layer)
{
    return layer == REFERENCE_OBSCURANCE || layer == REFERENCE_AMBIENT_OCCLUSION;
}

struct read_job {
    const struct reference *reference;
    enum reference_layer layer;
    const struct image *out;
};

static void read_row(void *user, size_t y)
{
    const struct read_job *job = user;
    const struct reference *r = job->reference;
    unsigned before = embree_flush_denormals();
    for (int x = 0; x < r->width; x++) {
        float *out = image_at(job->out, x, (int)y);
        if (is_obscurance(job->layer))
            read_obscurance(r, job->layer, x, (int)y, out);
        else if (is_of_surface(job->layer))
            read_surface(r, job->layer, x, (int)y, out);
        else
            read_sums(r, job->layer, x, (int)y, out);
    }
    embree_restore_denormals(before);
}

static int channels_of(enum reference_layer layer)
{
    return layer == REFERENCE_DEPTH || layer == REFERENCE_SAMPLES || is_obscurance(layer) ? 1 : 3;
}

bool reference_read(struct reference *r, enum reference_layer layer, struct image *out)
{
    if ((unsigned)layer >= REFERENCE_LAYER_COUNT)
        return host_fail(r->host, FAIL_ARGUMENT, "reference layer %d: unknown", (int)layer);
    if (is_obscurance(layer) && !r->obscurance) {
        r->obscurance =
            host_alloc(r->host, (size_t)r->width * (size_t)r->height, sizeof *r->obscurance);
        if (!r->obscurance) return false;
    }
    if (!image_init(out, r->host, r->width, r->height, channels_of(layer))) return false;
    struct read_job job = { r, layer, out };
    parallel_for((size_t)r->height, 4, read_row, &job);
    return true;
}

struct reference_info reference_info(const struct reference *r)
{
    static const double weights[3] = { 0.2126, 0.7152, 0.0722 };
    struct reference_info info = { .samples = min_samples(r), .rays = r->training_rays };
    for (size_t i = 0; i < tile_count(r); i++) info.rays += r->tiles[i].rays;
    double variance = 0.0;
    for (int y = 0; y < r->height; y++) {
        for (int x = 0; x < r->width; x++) {
            const struct pixel_sums *s = sums_of(r, x, y);
            int n = samples_of(r, x, y);
            double error = 0.0; // for fully correlated channels: an upper bound
            for (int c = 0; c < 3; c++) {
                double sum = s->direct[c] + s->indirect[c];
                info.mean += n > 0 ? weights[c] * sum / n : 0.0;
                error += weights[c] * sqrt(variance_of_mean(sum, s->squares[c], n));
            }
            variance += error * error;
        }
    }
    double pixels = (double)r->width * (double)r->height;
    info.mean /= pixels;
    info.error = sqrt(variance / pixels);
    return info;
}

// ---- resuming

const enum reference_layer reference_kept_layers[REFERENCE_KEPT_COUNT] = {
    [KEPT_DIRECT] = REFERENCE_DIRECT,
    [KEPT_INDIRECT] = REFERENCE_INDIRECT,
    [KEPT_INDIRECT_EMITTERS_SKY] = REFERENCE_INDIRECT_EMITTERS_SKY,
    [KEPT_IRRADIANCE] = REFERENCE_IRRADIANCE,
    [KEPT_IRRADIANCE_EMITTERS_SKY] = REFERENCE_IRRADIANCE_EMITTERS_SKY,
    [KEPT_ERROR] = REFERENCE_ERROR,
    [KEPT_SAMPLES] = REFERENCE_SAMPLES,
};

// Sample counts must be integers, equal within a tile.
static bool restore_tile(struct reference *r, size_t index, const struct image *samples)
{
    int left = (int)(index % (size_t)r->tiles_x) * TILE,
        top = (int)(index / (size_t)r->tiles_x) * TILE;
    float n = image_at(samples, left, top)[0];
    if (!(n >= 0.0f && n < 0x1p24f && n == floorf(n))) return false;
    for (int y = top; y < top + TILE && y < r->height; y++)
        for (int x = left; x < left + TILE && x < r->width; x++)
            if (image_at(samples, x, y)[0] != n) return false;
    r->tiles[index].samples = (int)n;
    return true;
}

static bool restore_sums(const struct image *image, int x, int y, int samples, double sums[3])
{
    const float *mean = image_at(image, x, y);
    bool finite = true;
    for (int c = 0; c < 3; c++) {
        sums[c] = (double)mean[c] * samples;
        finite = finite && isfinite(sums[c]);
    }
    return finite;
}

static bool restore_pixel(struct reference *r, int x, int y,
                          const struct image layers[REFERENCE_KEPT_COUNT])
{
    struct pixel_sums *s = &r->sums[(size_t)y * (size_t)r->width + (size_t)x];
    int n = samples_of(r, x, y);
    bool ok =
        restore_sums(&layers[KEPT_DIRECT], x, y, n, s->direct) &&
        restore_sums(&layers[KEPT_INDIRECT], x, y, n, s->indirect) &&
        restore_sums(&layers[KEPT_INDIRECT_EMITTERS_SKY], x, y, n, s->indirect_emitters_sky) &&
        restore_sums(&layers[KEPT_IRRADIANCE], x, y, n, s->irradiance) &&
        restore_sums(&layers[KEPT_IRRADIANCE_EMITTERS_SKY], x, y, n, s->irradiance_emitters_sky);
    const float *error = image_at(&layers[KEPT_ERROR], x, y);
    for (int c = 0; ok && c < 3; c++) {
        double sum = s->direct[c] + s->indirect[c], deviation = (double)error[c];
        s->squares[c] = n > 0 ? sum * sum / n : 0.0;
        if (n > 1) s->squares[c] += deviation * deviation * n * (n - 1.0);
        ok = isfinite(s->squares[c]);
    }
    return ok;
}

bool reference_restore(struct reference *r, const struct image layers[REFERENCE_KEPT_COUNT])
{
    for (int i = 0; i < REFERENCE_KEPT_COUNT; i++)
        if (layers[i].width != r->width || layers[i].height != r->height ||
            layers[i].channels != channels_of(reference_kept_layers[i]))
            return host_fail(r->host, FAIL_FORMAT, "reference to resume: layer %s is not %dx%d",
                             layer_names[reference_kept_layers[i]], r->width, r->height);
    bool ok = true;
    for (size_t i = 0; ok && i < tile_count(r); i++) ok = restore_tile(r, i, &layers[KEPT_SAMPLES]);
    for (int y = 0; ok && y < r->height; y++)
        for (int x = 0; ok && x < r->width; x++) ok = restore_pixel(r, x, y, layers);
    if (ok) return true;
    memset(r->sums, 0, (size_t)r->width * (size_t)r->height * sizeof *r->sums);
    memset(r->tiles, 0, tile_count(r) * sizeof *r->tiles);
    return host_fail(r->host, FAIL_FORMAT, "reference to resume: damaged layers");
}
