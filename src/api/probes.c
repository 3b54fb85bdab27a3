// Probe volumes: downloaded, sampled on the CPU, or passed on as a Vulkan image.
#include "api/renderer/state.h"

#include "techniques/common/probes/copy.h"

// The probe volume of the newest frame.
static enum ag_result find(const char *function, struct ag_renderer *r, struct probe_volume *out)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_FOR(function, context, r, "renderer is NULL");
    AG_REQUIRE_FOR(function, context, r->main.rendered, "no frame has been rendered");
    return api_done(context, gi_probes(r->gi, out));
}

static void grid_of(const struct frame_probes *grid, float first[3], float *spacing, int counts[3])
{
    api_store(first, grid->first_m);
    *spacing = grid->spacing_m;
    counts[0] = grid->count_x;
    counts[1] = grid->count_y;
    counts[2] = grid->count_z;
}

// Probes keep their context, which their memory comes from.
struct owned_probes {
    struct ag_probes probes; // first: programs have its address
    struct probe_copy copy;
    struct ag_context *context;
};

static struct ag_probes *create(struct ag_renderer *r, const struct probe_volume *volume)
{
    struct ag_context *context = renderer_context(r);
    struct owned_probes *own = host_alloc(&context->host, 1, sizeof *own);
    if (!own) return NULL;
    if (!probe_copy_create(&context->host, r->device->gpu, volume,
                           frame_radiance_scale(r->main.frame), &own->copy)) {
        host_free(&context->host, own);
        return NULL;
    }
    struct ag_probes *probes = &own->probes;
    grid_of(&volume->grid, probes->first, &probes->spacing, probes->counts);
    probes->coefficients = own->copy.coefficients;
    own->context = context;
    api_context_use(context);
    return probes;
}

enum ag_result ag_renderer_read_probes(struct ag_renderer *r, struct ag_probes **out)
{
    struct ag_context *context = renderer_context(r);
    struct probe_volume volume;
    AG_REQUIRE_OUT(context, out);
    enum ag_result result = find(__func__, r, &volume);
    if (result == AG_OK) result = ag_renderer_wait(r);
    if (result != AG_OK) return result;
    *out = create(r, &volume);
    return api_done(context, *out != NULL);
}

void ag_probes_destroy(struct ag_context *context, struct ag_probes *probes)
{
    (void)context; // may be destroyed
    if (!probes) return;
    struct owned_probes *own = (struct owned_probes *)probes;
    struct ag_context *owner = own->context;
    probe_copy_finish(&owner->host, &own->copy);
    host_free(&owner->host, own);
    api_context_release(owner);
}

void ag_probes_irradiance(const struct ag_probes *probes, const float *position,
                          const float *normal, float *out)
{
    const struct owned_probes *own = (const struct owned_probes *)probes;
    if (!probes || !position || !normal || !out) return;
    probe_copy_irradiance(&own->copy, api_vec3(position), api_vec3(normal), out);
}

_Static_assert(AG_PROBES_VISIBILITY_DEPTHS == PROBE_VISIBILITY_DEPTHS &&
                   AG_PROBES_VISIBILITY_WALLS == PROBE_VISIBILITY_WALLS,
               "programs pass them to lookup.glsl");

void ag_probes_get_visibility(const struct ag_probes *probes, struct ag_probes_visibility *out)
{
    const struct owned_probes *own = (const struct owned_probes *)probes;
    if (out) *out = (struct ag_probes_visibility){ .kind = AG_PROBES_VISIBILITY_NONE };
    if (!probes || !out) return;
    out->kind = (enum ag_probes_visibility_kind)own->copy.visibility;
    out->tile_side = own->copy.depths ? PROBE_DEPTH_TILE : 0;
    out->offsets = own->copy.offsets;
    out->depths = own->copy.depths;
    out->walls = own->copy.walls;
}

enum ag_result ag_renderer_probes_handle(struct ag_renderer *r, struct ag_probes_handle *out)
{
    struct ag_context *context = renderer_context(r);
    struct probe_volume volume;
    AG_REQUIRE_POINTER(context, out);
    *out = (struct ag_probes_handle){ 0 };
    enum ag_result result = find(__func__, r, &volume);
    if (result != AG_OK) return result;
    struct gpu *gpu = r->device->gpu;
    grid_of(&volume.grid, out->first, &out->spacing, out->counts);
    out->slab = volume.grid.slab;
    out->vk_image = gpu_image_handle(gpu, volume.image, &out->vk_layout);
    if (volume.depth.id)
        out->vk_depth_image = gpu_image_handle(gpu, volume.depth, &out->vk_depth_layout);
    out->visibility = (uint32_t)probe_volume_visibility(&volume);
    out->scale = frame_radiance_scale(r->main.frame);
    return api_done(context, true);
}
