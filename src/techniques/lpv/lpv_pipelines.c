// All compute pipelines, from one table.
#include "techniques/lpv/lpv_pipelines.h"

#include "techniques/lpv/lpv_state.h"

#include "frame/scene_gpu.h"
#include "technique_shaders.h"

enum { MAX_CONSTANTS = 8 };

// Specialization constants by bit.
enum {
    BANDS = 1 << LPV_CONSTANT_BANDS,
    HALF = 1 << LPV_CONSTANT_HALF,
    GEOMETRY = 1 << LPV_CONSTANT_GEOMETRY,
    NEIGHBOURS = 1 << LPV_CONSTANT_NEIGHBOURS,
    CUBIC = 1 << LPV_CONSTANT_CUBIC,
    DAMPED = 1 << LPV_CONSTANT_DAMPED,
    CLOSURE = 1 << LPV_CONSTANT_CLOSURE,
    LIGHT = BANDS | HALF, // shaders that include lpv_light.glsl
    MASKED = 1 << 7,      // SCENE_CONSTANT_MASKED
};

struct pipeline {
    gpu_pipeline *out;
    const char *name;
    const struct gpu_shader *shader;
    uint32_t constants;
};

static struct gpu_constant constant_of(const struct lpv_options *options, uint32_t bit)
{
    switch (bit) {
    case BANDS:
        return (struct gpu_constant){ LPV_CONSTANT_BANDS, (uint32_t)options->bands };
    case HALF:
        return (struct gpu_constant){ LPV_CONSTANT_HALF, options->precision == LPV_PRECISION_HALF };
    case GEOMETRY:
        return (struct gpu_constant){ LPV_CONSTANT_GEOMETRY, (uint32_t)options->geometry };
    case NEIGHBOURS:
        return (struct gpu_constant){ LPV_CONSTANT_NEIGHBOURS,
                                      options->neighbours == LPV_SIX ? 6 : 26 };
    case CLOSURE:
        return (struct gpu_constant){ LPV_CONSTANT_CLOSURE, lpv_closure_of(options) };
    case CUBIC:
        return (struct gpu_constant){ LPV_CONSTANT_CUBIC, options->reconstruction == LPV_CUBIC };
    case DAMPED:
        return (struct gpu_constant){ LPV_CONSTANT_DAMPED, 1 };
    default:
        return (struct gpu_constant){ SCENE_CONSTANT_MASKED, 1 };
    }
}

static bool create(struct lpv *lpv, const struct pipeline *pipeline)
{
    struct gpu_constant constants[MAX_CONSTANTS];
    int count = 0;
    for (uint32_t bit = 1; bit <= MASKED; bit <<= 1)
        if (pipeline->constants & bit) constants[count++] = constant_of(&lpv->options, bit);
    return gpu_compute_pipeline_create(lpv->gpu, pipeline->name, pipeline->shader, constants, count,
                                       pipeline->out);
}

static bool create_all(struct lpv *lpv, const struct pipeline *pipelines, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!create(lpv, &pipelines[i])) return false;
    return true;
}

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static bool create_stages(struct lpv *lpv)
{
    struct lpv_pipelines *p = &lpv->pipelines;
    const uint32_t step = LIGHT | GEOMETRY | NEIGHBOURS | CLOSURE;
    const struct pipeline stages[] = {
        { &p->inject, "inject", &shader_lpv_inject_comp, LIGHT },
        { &p->inject_emitters, "inject_emitters", &shader_lpv_inject_emitters_comp, LIGHT },
        { &p->resolve, "resolve", &shader_lpv_inject_resolve_comp, LIGHT },
        { &p->propagate, "propagate", &shader_lpv_propagate_comp, step },
        { &p->apply, "apply", &shader_lpv_apply_comp, LIGHT | GEOMETRY | CUBIC | CLOSURE },
        { &p->apply_damped, "apply", &shader_lpv_apply_comp,
          LIGHT | GEOMETRY | CUBIC | CLOSURE | DAMPED },
        { &p->debug, "debug", &shader_lpv_debug_comp, LIGHT | GEOMETRY },
    };
    const struct pipeline refine = { &p->refine, "refine", &shader_lpv_refine_comp,
                                     LIGHT | GEOMETRY };
    const struct pipeline probes = { &p->probes, "probes", &shader_lpv_probes_comp, BANDS };
    const struct lpv_options *options = &lpv->options;
    return create_all(lpv, stages, COUNT(stages)) &&
           (options->cascades == 1 || create(lpv, &refine)) &&
           (!options->probes || create(lpv, &probes));
}

static bool create_bounces(struct lpv *lpv)
{
    struct lpv_pipelines *p = &lpv->pipelines;
    const struct pipeline bounces[] = {
        { &p->surfaces, "surfaces", &shader_lpv_surfaces_comp, 0 },
        { &p->masked_surfaces, "masked_surfaces", &shader_lpv_surfaces_comp, MASKED },
        { &p->bounce, "bounce", &shader_lpv_bounce_comp, LIGHT | GEOMETRY | CLOSURE },
    };
    return lpv->options.bounces == 0 || create_all(lpv, bounces, COUNT(bounces));
}

static bool create_geometry(struct lpv *lpv)
{
    struct lpv_pipelines *p = &lpv->pipelines;
    const struct pipeline transmittance = { &p->geometry_transmittance, "geometry_transmittance",
                                            &shader_lpv_geometry_transmittance_comp,
                                            GEOMETRY | NEIGHBOURS };
    const struct pipeline maps[] = {
        { &p->geometry_light, "geometry_light", &shader_lpv_geometry_light_comp, 0 },
        { &p->geometry_camera, "geometry_camera", &shader_lpv_geometry_camera_comp, 0 },
        { &p->geometry_merge, "geometry_merge", &shader_lpv_geometry_merge_comp, 0 },
    };
    const struct pipeline scene[] = {
        { &p->geometry_coverage, "geometry_coverage", &shader_lpv_geometry_coverage_comp, 0 },
        { &p->masked_coverage, "masked_coverage", &shader_lpv_geometry_coverage_comp, MASKED },
        { &p->geometry_faces, "geometry_faces", &shader_lpv_geometry_faces_comp, 0 },
    };
    switch (lpv->options.geometry) {
    case LPV_GEOMETRY_MAPS:
        return create(lpv, &transmittance) && create_all(lpv, maps, COUNT(maps));
    case LPV_GEOMETRY_SCENE:
        return create(lpv, &transmittance) && create_all(lpv, scene, COUNT(scene));
    default:
        return true;
    }
}

bool lpv_pipelines_create(struct lpv *lpv)
{
    return create_stages(lpv) && create_bounces(lpv) && create_geometry(lpv);
}

void lpv_pipelines_destroy(struct lpv *lpv)
{
    struct lpv_pipelines *p = &lpv->pipelines;
    gpu_pipeline *const all[] = {
        &p->inject,
        &p->inject_emitters,
        &p->resolve,
        &p->surfaces,
        &p->masked_surfaces,
        &p->bounce,
        &p->refine,
        &p->propagate,
        &p->apply,
        &p->apply_damped,
        &p->probes,
        &p->debug,
        &p->geometry_light,
        &p->geometry_camera,
        &p->geometry_merge,
        &p->geometry_coverage,
        &p->masked_coverage,
        &p->geometry_faces,
        &p->geometry_transmittance,
    };
    _Static_assert(COUNT(all) == sizeof *p / sizeof *all[0], "each member is listed");
    for (size_t i = 0; i < COUNT(all); i++) gpu_pipeline_destroy(lpv->gpu, all[i]);
}
