// Sizes, images and buffers of all volumes. One table serves creation and the memory estimate.
#include "techniques/lpv/lpv_volumes.h"

#include "techniques/lpv/lpv_state.h"

#include <string.h>

enum { MAX_VOLUMES = 16 };

// dim³ cells of a member of struct lpv_volumes.
struct volume {
    const char *name;
    size_t offset;          // of the member
    enum gpu_format format; // GPU_FORMAT_NONE: a buffer
    size_t size;            // slabs of an image, bytes of a buffer's cell; 0: not needed
    bool of_each_cascade;   // others are shared by all cascades
};

uint32_t lpv_slabs(const struct lpv_options *options)
{
    return options->bands == 3 ? 7 : 3;
}

size_t lpv_sum_bytes(const struct lpv_options *options)
{
    return 4 * (size_t)lpv_slabs(options) * 8;
}

size_t lpv_cell_count(const struct lpv_grid *grid)
{
    return (size_t)grid->cells[0] * (size_t)grid->cells[1] * (size_t)grid->cells[2];
}

static size_t transmittance_bytes(const struct lpv_options *options)
{
    return 4 * (size_t)(options->neighbours == LPV_SIX ? LPV_TRANSMITTANCE_WORDS_6
                                                       : LPV_TRANSMITTANCE_WORDS_26);
}

#define MEMBER(member) offsetof(struct lpv_volumes, member)

// The volumes that the options need; of a coarser cascade those of its own.
static int list_volumes(const struct lpv_options *options, bool coarser,
                        struct volume out[MAX_VOLUMES])
{
    const bool half = options->precision == LPV_PRECISION_HALF, bounces = options->bounces > 0,
               maps = options->geometry == LPV_GEOMETRY_MAPS,
               scene = options->geometry == LPV_GEOMETRY_SCENE;
    const enum gpu_format step = half ? GPU_RGBA16F : GPU_RGBA32F;
    const size_t slabs = lpv_slabs(options);
    const size_t transmittance = maps || scene ? transmittance_bytes(options) : 0;
    const struct volume all[] = {
        { "sums", MEMBER(sums), GPU_FORMAT_NONE, lpv_sum_bytes(options), false },
        { "injected", MEMBER(injected), step, slabs, false },
        { "step_even", MEMBER(steps[0]), step, slabs, false },
        { "step_odd", MEMBER(steps[1]), step, half ? 0 : slabs, false },
        { "light", MEMBER(light), GPU_RGBA16F, slabs, true },
        { "probes", MEMBER(probes), GPU_RGBA16F, options->probes ? FRAME_PROBE_SLABS : 0, false },
        { "sent", MEMBER(sent), step, bounces ? slabs : 0, false },
        { "surfaces", MEMBER(surfaces), GPU_FORMAT_NONE, bounces ? LPV_SURFACE_BYTES : 0, true },
        { "geometry", MEMBER(geometry), GPU_RGBA16F,
          maps    ? 1
          : scene ? 2
                  : 0,
          true },
        { "transmittance", MEMBER(transmittance), GPU_FORMAT_NONE, transmittance, true },
        { "walls", MEMBER(walls), GPU_FORMAT_NONE, scene ? 4 : 0, true },
        { "surfels", MEMBER(surfels), GPU_FORMAT_NONE, maps ? LPV_SURFEL_BYTES : 0, true },
        { "static_coverage", MEMBER(static_coverage), GPU_FORMAT_NONE,
          scene ? LPV_COVERAGE_BYTES : 0, true },
        { "moving_coverage", MEMBER(moving_coverage), GPU_FORMAT_NONE,
          scene ? LPV_COVERAGE_BYTES : 0, true },
    };
    int count = 0;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (all[i].size > 0 && (!coarser || all[i].of_each_cascade)) out[count++] = all[i];
    return count;
}

static bool create_image(struct lpv *lpv, const struct volume *volume, gpu_image *out)
{
    const uint32_t dim = (uint32_t)lpv->options.dim;
    const struct gpu_image_desc desc = { .name = volume->name,
                                         .dimension = GPU_3D,
                                         .format = volume->format,
                                         .width = dim,
                                         .height = dim,
                                         .depth = dim * (uint32_t)volume->size,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    return gpu_image_create(lpv->gpu, &desc, out);
}

static bool create_buffer(struct lpv *lpv, const struct volume *volume, gpu_buffer *out)
{
    const size_t dim = (size_t)lpv->options.dim;
    const struct gpu_buffer_desc desc = { .name = volume->name,
                                          .bytes = dim * dim * dim * volume->size,
                                          .usage = GPU_BUFFER_STORAGE };
    return gpu_buffer_create(lpv->gpu, &desc, out);
}

static void *member_of(struct lpv *lpv, const struct volume *volume)
{
    return (char *)&lpv->volumes + volume->offset;
}

static bool is_buffer(const struct volume *volume)
{
    return volume->format == GPU_FORMAT_NONE;
}

// A coarser cascade's handles are copies of the finest's: cleared, so that a failure does not
// destroy these twice.
static void clear_handles(struct lpv *lpv, const struct volume *volumes, int count)
{
    for (int i = 0; i < count; i++)
        memset(member_of(lpv, &volumes[i]), 0,
               is_buffer(&volumes[i]) ? sizeof(gpu_buffer) : sizeof(gpu_image));
}

static bool create(struct lpv *lpv, bool coarser)
{
    struct volume volumes[MAX_VOLUMES];
    const int count = list_volumes(&lpv->options, coarser, volumes);
    clear_handles(lpv, volumes, count);
    for (int i = 0; i < count; i++) {
        void *member = member_of(lpv, &volumes[i]);
        if (is_buffer(&volumes[i]) ? !create_buffer(lpv, &volumes[i], member)
                                   : !create_image(lpv, &volumes[i], member))
            return false;
    }
    return true;
}

static void destroy(struct lpv *lpv, bool coarser)
{
    struct volume volumes[MAX_VOLUMES];
    const int count = list_volumes(&lpv->options, coarser, volumes);
    for (int i = 0; i < count; i++) {
        void *member = member_of(lpv, &volumes[i]);
        if (is_buffer(&volumes[i]))
            gpu_buffer_destroy(lpv->gpu, member);
        else
            gpu_image_destroy(lpv->gpu, member);
    }
}

bool lpv_volumes_create(struct lpv *lpv)
{
    return create(lpv, false);
}

bool lpv_volumes_create_coarser(struct lpv *lpv)
{
    return create(lpv, true);
}

void lpv_volumes_destroy(struct lpv *lpv)
{
    destroy(lpv, false);
}

void lpv_volumes_destroy_coarser(struct lpv *lpv)
{
    destroy(lpv, true);
}

uint64_t lpv_volumes_bytes(const struct lpv_options *options)
{
    struct volume volumes[MAX_VOLUMES];
    const int count = list_volumes(options, false, volumes);
    const uint64_t dim = (uint64_t)options->dim;
    uint64_t of_cell = 0;
    for (int i = 0; i < count; i++) {
        const uint64_t copies = volumes[i].of_each_cascade ? (uint64_t)options->cascades : 1;
        const uint64_t unit =
            is_buffer(&volumes[i]) ? 1 : (uint64_t)gpu_format_bytes(volumes[i].format);
        of_cell += copies * unit * volumes[i].size;
    }
    return dim * dim * dim * of_cell;
}
