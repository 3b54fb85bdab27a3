#include "frame/environment_map.h"

#include "core/half.h"
#include "core/parallel.h"
#include "frame/frame_shared.h"
#include "scene/environment/environment_map.h"
#include "scene/environment/equirect.h"

#include <math.h>
#include <string.h>

// Level l has lobes of standard deviation (π/4) / side(l), half a texel's angle, for each of two
// axes. The last has a side of 1, and a lobe of 45°. Lookups, which interpolate between texels of
// that size, see lobes √2 as wide.
enum { LEAST_SIDE = 16, MOST_SIDE = 512, FACES = 6, TAPS = 24, LEAST_WIDTH = 16 };

static const int PEAK_EXPONENT = 15; // texels are below 2¹⁵

static uint32_t side_of(int width)
{
    uint32_t side = LEAST_SIDE;
    while (side < MOST_SIDE && 2 * side < (uint32_t)width) side *= 2;
    return side;
}

static uint32_t levels_of(uint32_t side)
{
    uint32_t levels = 1;
    while (side >> levels) levels++;
    return levels;
}

// ---- levels: equirectangular images, so that interpolation meets no edges

// Directions of a lobe about +y, as a von Mises–Fisher distribution of sharpness 1/σ²: heights at
// the middles of equal shares, azimuths by the golden angle.
static void make_taps(float sigma, vec3s taps[TAPS])
{
    const float sharpness = 1.0f / (sigma * sigma), golden = GLM_PIf * (3.0f - sqrtf(5.0f));
    for (int i = 0; i < TAPS; i++) {
        const float u = ((float)i + 0.5f) / TAPS;
        const float y =
            fmaxf(1.0f + logf(u + (1.0f - u) * expf(-2.0f * sharpness)) / sharpness, -1.0f);
        const float radius = sqrtf(fmaxf(1.0f - y * y, 0.0f));
        taps[i] = vec3_of(radius * cosf(golden * (float)i), y, radius * sinf(golden * (float)i));
    }
}

struct level_job {
    const struct environment_map *from;
    struct image *to;
    vec3s taps[TAPS];
};

static vec3s lobe_mean(const struct level_job *job, vec3s direction)
{
    vec3s sum = vec3_of(0, 0, 0), tangent, bitangent;
    basis_of(direction, &tangent, &bitangent);
    for (int i = 0; i < TAPS; i++) {
        vec3s d = glms_vec3_scale(direction, job->taps[i].y);
        d = glms_vec3_muladds(tangent, job->taps[i].x, d);
        d = glms_vec3_muladds(bitangent, job->taps[i].z, d);
        sum = glms_vec3_add(sum, environment_map_radiance(job->from, d));
    }
    return glms_vec3_divs(sum, TAPS);
}

static void level_row(void *user, size_t y)
{
    const struct level_job *job = user;
    const int width = job->to->width, height = job->to->height;
    for (int x = 0; x < width; x++) {
        const vec2s uv = equirect_texel_uv(width, height, x, (int)y);
        const vec3s mean = lobe_mean(job, equirect_direction(uv));
        memcpy(image_at(job->to, x, (int)y), mean.raw, sizeof mean.raw);
    }
}

static bool blur(struct host *host, const struct environment_map *from, uint32_t side, float sigma,
                 struct image *to)
{
    const int width = 4 * side > LEAST_WIDTH ? (int)(4 * side) : LEAST_WIDTH;
    struct level_job job = { .from = from, .to = to };
    make_taps(sigma, job.taps);
    if (!image_init(to, host, width, width / 2, 3)) return false;
    parallel_for((size_t)to->height, 4, level_row, &job);
    return true;
}

// ---- faces

// Direction of a place on a face, −1…1 (Vulkan 1.3, "Cube Map Face Selection").
static vec3s face_direction(int face, float s, float t)
{
    switch (face) {
    case 0:
        return vec3_of(1, -t, -s);
    case 1:
        return vec3_of(-1, -t, s);
    case 2:
        return vec3_of(s, 1, t);
    case 3:
        return vec3_of(s, -1, -t);
    case 4:
        return vec3_of(s, -t, 1);
    default:
        return vec3_of(-s, -t, -1);
    }
}

static void fill_face(const struct environment_map *level, int face, uint32_t side, float scale,
                      uint16_t *out)
{
    for (uint32_t y = 0; y < side; y++)
        for (uint32_t x = 0; x < side; x++, out += 4) {
            const float s = (2.0f * (float)x + 1.0f) / (float)side - 1.0f;
            const float t = (2.0f * (float)y + 1.0f) / (float)side - 1.0f;
            const vec3s direction = glms_vec3_normalize(face_direction(face, s, t));
            const vec3s radiance = environment_map_radiance(level, direction);
            for (int c = 0; c < 3; c++) out[c] = half_from_float(radiance.raw[c] * scale);
            out[3] = half_from_float(1.0f);
        }
}

static bool upload_level(struct frame_environment *e, const struct environment_map *level,
                         uint32_t mip)
{
    const uint32_t side = e->side >> mip;
    const size_t count = (size_t)4 * side * side;
    uint16_t *texels = host_alloc(e->host, count, sizeof *texels);
    bool ok = texels;
    for (int face = 0; ok && face < FACES; face++) {
        fill_face(level, face, side, e->texel_scale, texels);
        ok = gpu_image_upload(e->gpu, e->cube, mip, (uint32_t)face, texels, count * sizeof *texels);
    }
    host_free(e->host, texels);
    return ok;
}

static bool upload_levels(struct frame_environment *e, const struct environment_map *map)
{
    struct environment_map level = { .radiance = map->radiance }, next = { 0 };
    bool ok = upload_level(e, map, 0);
    for (uint32_t mip = 1; ok && mip < levels_of(e->side); mip++) {
        const float sigma = GLM_PI_4f / (float)(e->side >> mip);
        // Variances of successive lobes add up.
        const float rest = mip == 1 ? sigma : sigma * sqrtf(0.75f);
        ok = blur(e->host, &level, e->side >> mip, rest, &next.radiance) &&
             upload_level(e, &next, mip);
        if (mip > 1) image_finish(&level.radiance, e->host);
        level.radiance = next.radiance;
        next.radiance = (struct image){ 0 };
    }
    if (level.radiance.pixels != map->radiance.pixels) image_finish(&level.radiance, e->host);
    return ok;
}

// ---- the cube

static float scale_of(float peak)
{
    int exponent;
    if (!(peak > 0.0f)) return 1.0f;
    frexpf(peak, &exponent);
    return ldexpf(1.0f, PEAK_EXPONENT - exponent);
}

static bool create(struct frame_environment *e, const struct environment_map *map)
{
    e->side = map ? side_of(map->radiance.width) : 1;
    e->texel_scale = map ? scale_of(map->peak) : 1.0f;
    const struct gpu_image_desc desc = { .name = "scene.environment",
                                         .dimension = GPU_CUBE,
                                         .format = GPU_RGBA16F,
                                         .width = e->side,
                                         .height = e->side,
                                         .mips = levels_of(e->side),
                                         .usage = GPU_SAMPLED };
    const uint16_t black[4] = { 0 };
    if (!gpu_image_create(e->gpu, &desc, &e->cube)) return false;
    if (map) return upload_levels(e, map);
    for (uint32_t face = 0; face < FACES; face++)
        if (!gpu_image_upload(e->gpu, e->cube, 0, face, black, sizeof black)) return false;
    return true;
}

bool frame_environment_init(struct frame_environment *e, struct host *host, struct gpu *gpu)
{
    const struct gpu_sampler_desc sampler = { .name = "frame.environment",
                                              .filter = GPU_LINEAR,
                                              .mip_filter = GPU_LINEAR,
                                              .wrap_u = GPU_CLAMP,
                                              .wrap_v = GPU_CLAMP,
                                              .wrap_w = GPU_CLAMP };
    *e = (struct frame_environment){ .host = host, .gpu = gpu };
    return gpu_sampler_get(gpu, &sampler, &e->sampler) && create(e, NULL);
}

void frame_environment_finish(struct frame_environment *e)
{
    if (!e->gpu) return;
    gpu_image_destroy(e->gpu, &e->cube);
    environment_map_release(e->map);
    *e = (struct frame_environment){ 0 };
}

bool frame_environment_prepare(struct frame_environment *e, const struct environment *environment)
{
    if (e->cube.id && e->map == environment->map) return true;
    gpu_image_destroy(e->gpu, &e->cube);
    environment_map_release(e->map);
    e->map = NULL;
    if (!create(e, environment->map)) {
        gpu_image_destroy(e->gpu, &e->cube);
        return false;
    }
    e->map = environment->map;
    environment_map_retain(e->map);
    return true;
}

uint64_t frame_environment_follow(struct frame_environment *e,
                                  const struct environment *environment)
{
    const uint64_t key = environment_key(environment);
    if (!e->known || key != e->key) {
        environment_sh(environment, 3, e->sh);
        environment_patches(environment, e->patches);
    }
    e->known = true;
    e->key = key;
    return key;
}

void frame_environment_constants(const struct frame_environment *e,
                                 const struct environment *environment, struct frame_constants *out)
{
    const float scale = out->radiance_scale;
    for (int i = 0; i < SH_COUNT(3); i++)
        out->environment_sh[i] =
            glms_vec3_scale(vec3_of(e->sh[0][i], e->sh[1][i], e->sh[2][i]), scale);
    out->uniform_sky = glms_vec3_scale(environment->sky, scale);
    out->environment_scale = e->map ? environment->strength * scale / e->texel_scale : 0.0f;
    out->environment_cos = cosf(environment->rotation_rad);
    out->environment_sin = sinf(environment->rotation_rad);
    out->environment_side = (float)e->side;
}
