// Probe volumes: downloaded, sampled on the CPU, or passed on as a Vulkan image.
#include "api/renderer_state.h"

#include "core/sh.h"

#include <string.h>

enum { COEFFICIENTS = 9, NUMBERS = 3 * COEFFICIENTS };

// The probe volume of the newest frame.
static enum ag_result find(const char *function, struct ag_renderer *r, struct probe_volume *out)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_FOR(function, context, r, "renderer is NULL");
    AG_REQUIRE_FOR(function, context, r->main.rendered, "no frame has been rendered");
    return api_done(context, gi_probes(r->gi, out));
}

static void grid_of(const struct probe_volume *volume, float first[3], float *spacing,
                    int counts[3])
{
    const struct frame_probes *grid = &volume->grid;
    api_store(first, grid->first_m);
    *spacing = grid->spacing_m;
    counts[0] = grid->count_x;
    counts[1] = grid->count_y;
    counts[2] = grid->count_z;
}

// Converts slabs of texels (frame/probes.glsl) to arrays of coefficients.
static void unpack(const struct ag_probes *probes, const float *texels,
                   const struct gpu_image_desc *size, const struct frame_probes *grid, float scale)
{
    float *out = probes->coefficients;
    for (int z = 0; z < probes->counts[2]; z++)
        for (int y = 0; y < probes->counts[1]; y++)
            for (int x = 0; x < probes->counts[0]; x++)
                for (int k = 0; k < NUMBERS; k++) {
                    size_t row = (size_t)(z + k / 4 * grid->slab) * size->height + (size_t)y;
                    *out++ = texels[4 * (row * size->width + (size_t)x) + (size_t)(k % 4)] / scale;
                }
}

// Probes keep their context, which their memory comes from.
struct owned_probes {
    struct ag_probes probes; // first: programs have its address
    struct ag_context *context;
};

static struct ag_probes *create(struct ag_context *context, const struct probe_volume *volume)
{
    struct host *host = &context->host;
    struct owned_probes *own = host_alloc(host, 1, sizeof *own);
    if (!own) return NULL;
    struct ag_probes *probes = &own->probes;
    grid_of(volume, probes->first, &probes->spacing, probes->counts);
    size_t count =
        (size_t)probes->counts[0] * (size_t)probes->counts[1] * (size_t)probes->counts[2];
    probes->coefficients = host_alloc(host, count, NUMBERS * sizeof *probes->coefficients);
    if (!probes->coefficients) {
        host_free(host, own);
        return NULL;
    }
    own->context = context;
    api_context_use(context);
    return probes;
}

static bool download(struct ag_renderer *r, const struct probe_volume *volume,
                     const struct ag_probes *probes)
{
    struct host *host = &renderer_context(r)->host;
    struct gpu *gpu = r->device->gpu;
    const struct gpu_image_desc *size = gpu_image_info(gpu, volume->image);
    size_t texels = (size_t)size->width * size->height * size->depth;
    float *values = host_alloc(host, texels, 4 * sizeof *values);
    bool ok = values && gpu_image_download_float(gpu, volume->image, 0, 0, values, 4, 4 * texels);
    if (ok) unpack(probes, values, size, &volume->grid, frame_radiance_scale(r->main.frame));
    host_free(host, values);
    return ok;
}

enum ag_result ag_renderer_read_probes(struct ag_renderer *r, struct ag_probes **out)
{
    struct ag_context *context = renderer_context(r);
    struct probe_volume volume;
    AG_REQUIRE_OUT(context, out);
    enum ag_result result = find(__func__, r, &volume);
    if (result == AG_OK) result = ag_renderer_wait(r);
    if (result != AG_OK) return result;
    struct ag_probes *probes = create(context, &volume);
    if (!probes || !download(r, &volume, probes)) {
        result = api_done(context, false);
        ag_probes_destroy(context, probes);
        return result;
    }
    *out = probes;
    return api_done(context, true);
}

void ag_probes_destroy(struct ag_context *context, struct ag_probes *probes)
{
    (void)context; // may be destroyed
    if (!probes) return;
    struct owned_probes *own = (struct owned_probes *)probes;
    struct ag_context *owner = own->context;
    host_free(&owner->host, probes->coefficients);
    host_free(&owner->host, own);
    api_context_release(owner);
}

// Trilinear interpolation: the eight probes around a point and their weights.
struct corner {
    size_t probe;
    float weight;
};

static void corners_of(const struct ag_probes *probes, const float *position, struct corner out[8])
{
    int low[3];
    float share[3];
    for (int axis = 0; axis < 3; axis++) {
        float last = (float)(probes->counts[axis] - 1);
        float at = (position[axis] - probes->first[axis]) / probes->spacing;
        at = at > 0.0f ? fminf(at, last) : 0.0f; // NaN too
        low[axis] = (int)at;
        share[axis] = at - (float)low[axis];
    }
    for (int c = 0; c < 8; c++) {
        size_t cell[3];
        out[c].weight = 1.0f;
        for (int axis = 0; axis < 3; axis++) {
            bool high = (c >> axis) & 1;
            cell[axis] = (size_t)(low[axis] + (high && low[axis] + 1 < probes->counts[axis]));
            out[c].weight *= high ? share[axis] : 1.0f - share[axis];
        }
        size_t row = cell[2] * (size_t)probes->counts[1] + cell[1];
        out[c].probe = row * (size_t)probes->counts[0] + cell[0];
    }
}

void ag_probes_irradiance(const struct ag_probes *probes, const float *position,
                          const float *normal, float *out)
{
    struct corner corners[8];
    float basis[COEFFICIENTS], sum[3] = { 0 };
    if (!probes || !position || !normal || !out) return;
    corners_of(probes, position, corners);
    sh_eval(3, api_vec3(normal), basis);
    for (int c = 0; c < 8; c++) {
        const float *numbers = probes->coefficients + NUMBERS * corners[c].probe;
        for (int k = 0; k < NUMBERS; k++)
            sum[k % 3] += corners[c].weight * basis[k / 3] * numbers[k];
    }
    for (int k = 0; k < 3; k++) out[k] = fmaxf(sum[k], 0.0f);
}

enum ag_result ag_renderer_probes_handle(struct ag_renderer *r, struct ag_probes_handle *out)
{
    struct ag_context *context = renderer_context(r);
    struct probe_volume volume;
    AG_REQUIRE_POINTER(context, out);
    *out = (struct ag_probes_handle){ 0 };
    enum ag_result result = find(__func__, r, &volume);
    if (result != AG_OK) return result;
    grid_of(&volume, out->first, &out->spacing, out->counts);
    out->slab = volume.grid.slab;
    out->vk_image = gpu_image_handle(r->device->gpu, volume.image, &out->vk_layout);
    out->scale = frame_radiance_scale(r->main.frame);
    return api_done(context, true);
}
