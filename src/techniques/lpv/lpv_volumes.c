// Sizes, images and buffers of all volumes.
#include "techniques/lpv/lpv_volumes.h"

#include "techniques/common/probes/volume.h"
#include "techniques/lpv/lpv_state.h"

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

static uint64_t cells(const struct lpv_options *options)
{
    const uint64_t dim = (uint64_t)options->dim;
    return dim * dim * dim;
}

static struct gpu_image_desc image(const struct lpv_options *options, enum gpu_format format,
                                   uint32_t slabs)
{
    const uint32_t dim = (uint32_t)options->dim;
    return (struct gpu_image_desc){ .dimension = GPU_3D,
                                    .format = format,
                                    .width = slabs > 0 ? dim : 0,
                                    .height = dim,
                                    .depth = dim * slabs,
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

static uint32_t probe_slabs(const struct lpv_options *options)
{
    if (!options->probes) return 0;
    return options->geometry == LPV_GEOMETRY_SCENE ? PROBE_SLABS_WITH_WALLS : FRAME_PROBE_SLABS;
}

#define CASCADE(member) offsetof(struct lpv_cascade, member)

static void add_cascade(const struct lpv_options *o, size_t base, struct gpu_objects *out)
{
    const bool maps = o->geometry == LPV_GEOMETRY_MAPS, scene = o->geometry == LPV_GEOMETRY_SCENE;
    const size_t n = cells(o), coverage = scene ? n * LPV_COVERAGE_BYTES : 0;
    GPU_ADD(
        out, base,
        { GPU_IMAGE, "light", CASCADE(light), .image = image(o, GPU_RGBA16F, lpv_slabs(o)) },
        { GPU_BUFFER, "surfaces", CASCADE(surfaces.areas),
          .bytes = o->bounces > 0 ? n * LPV_SURFACE_BYTES : 0 },
        { GPU_IMAGE, "geometry", CASCADE(geometry.volume),
          .image = image(o, GPU_RGBA16F,
                         maps    ? 1
                         : scene ? 2
                                 : 0) },
        { GPU_BUFFER, "transmittance", CASCADE(geometry.transmittance),
          .bytes = maps || scene ? n * transmittance_bytes(o) : 0 },
        { GPU_BUFFER, "walls", CASCADE(geometry.walls), .bytes = scene ? n * 4 : 0 },
        { GPU_BUFFER, "surfels", CASCADE(geometry.surfels),
          .bytes = maps ? n * LPV_SURFEL_BYTES : 0 },
        { GPU_BUFFER, "static_coverage", CASCADE(geometry.static_coverage), .bytes = coverage },
        { GPU_BUFFER, "moving_coverage", CASCADE(geometry.moving_coverage), .bytes = coverage });
}

#define LPV(member) offsetof(struct lpv, member)

void lpv_add_volumes(const struct lpv_options *o, struct gpu_objects *out)
{
    const bool half = o->precision == LPV_PRECISION_HALF;
    const enum gpu_format step = half ? GPU_RGBA16F : GPU_RGBA32F;
    const uint32_t slabs = lpv_slabs(o);
    GPU_ADD(
        out, 0, { GPU_BUFFER, "sums", LPV(injection.sums), .bytes = cells(o) * lpv_sum_bytes(o) },
        { GPU_IMAGE, "injected", LPV(injection.injected), .image = image(o, step, slabs) },
        { GPU_IMAGE, "step_even", LPV(propagation.steps[0]), .image = image(o, step, slabs) },
        { GPU_IMAGE, "step_odd", LPV(propagation.steps[1]),
          .image = image(o, step, half ? 0 : slabs) },
        { GPU_IMAGE, "probes", LPV(probes.image), .image = image(o, GPU_RGBA16F, probe_slabs(o)) },
        { GPU_IMAGE, "sent", LPV(propagation.sent),
          .image = image(o, step, o->bounces > 0 ? slabs : 0) },
        { GPU_SAMPLER, "linear", .member = LPV(linear) });
    for (int i = 0; i < o->cascades; i++)
        add_cascade(o, LPV(cascades) + (size_t)i * sizeof(struct lpv_cascade), out);
}
