// The layers of a reference, from the sums of its samples.
#include "trace/reference_state.h"

#include "trace/obscurance.h"

#include "core/parallel.h"

#include <math.h>

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
    int n = reference_samples_of(r, x, y);
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
    return reference_start_at(&bare, (float)x + 0.5f, (float)y + 0.5f, &rays);
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
    obscurance_add(&settings, &start.surface, pixel, reference_samples_of(r, x, y), sums);
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

int reference_layer_channels(enum reference_layer layer)
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
    if (!image_init(out, r->host, r->width, r->height, reference_layer_channels(layer)))
        return false;
    struct read_job job = { r, layer, out };
    parallel_for((size_t)r->height, 4, read_row, &job);
    return true;
}

struct reference_info reference_info(const struct reference *r)
{
    static const double weights[3] = { 0.2126, 0.7152, 0.0722 };
    struct reference_info info = { .samples = reference_min_samples(r), .rays = r->training_rays };
    for (size_t i = 0; i < reference_tile_count(r); i++) info.rays += r->tiles[i].rays;
    double variance = 0.0;
    for (int y = 0; y < r->height; y++) {
        for (int x = 0; x < r->width; x++) {
            const struct pixel_sums *s = sums_of(r, x, y);
            int n = reference_samples_of(r, x, y);
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
