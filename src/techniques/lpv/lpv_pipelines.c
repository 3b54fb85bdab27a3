// All compute pipelines.
#include "techniques/lpv/lpv_pipelines.h"

#include "techniques/lpv/lpv_state.h"

#include "frame/scene/scene_gpu.h"
#include "technique_shaders.h"

// Specialization constants by bit.
enum {
    BANDS = 1 << LPV_CONSTANT_BANDS,
    HALF = 1 << LPV_CONSTANT_HALF,
    GEOMETRY = 1 << LPV_CONSTANT_GEOMETRY,
    NEIGHBOURS = 1 << LPV_CONSTANT_NEIGHBOURS,
    CUBIC = 1 << LPV_CONSTANT_CUBIC,
    DAMPED = 1 << LPV_CONSTANT_DAMPED,
    CLOSURE = 1 << LPV_CONSTANT_CLOSURE,
    MASKED = 1 << 7,      // SCENE_CONSTANT_MASKED
    LIGHT = BANDS | HALF, // shaders that include lpv_light.glsl
    APPLY = LIGHT | GEOMETRY | CUBIC | CLOSURE,
};

static void fill_constants(const struct lpv_options *o, struct gpu_constant *out)
{
    const struct gpu_constant constants[] = {
        { LPV_CONSTANT_BANDS, (uint32_t)o->bands },
        { LPV_CONSTANT_HALF, o->precision == LPV_PRECISION_HALF },
        { LPV_CONSTANT_GEOMETRY, (uint32_t)o->geometry },
        { LPV_CONSTANT_NEIGHBOURS, o->neighbours == LPV_SIX ? 6 : 26 },
        { LPV_CONSTANT_CUBIC, o->reconstruction == LPV_CUBIC },
        { LPV_CONSTANT_DAMPED, 1 },
        { LPV_CONSTANT_CLOSURE, lpv_closure_of(o) },
    };
    for (size_t i = 0; i < sizeof constants / sizeof *constants; i++)
        out[constants[i].id] = constants[i];
    out[7] = (struct gpu_constant){ SCENE_CONSTANT_MASKED, 1 };
}

#define PIPELINE(member, when, name, bits)                                                         \
    {                                                                                              \
        GPU_PIPELINE, #name, offsetof(struct lpv, member),                                         \
            .consts = (bits), .shader = (when) ? &shader_lpv_##name##_comp : NULL                  \
    }

void lpv_add_pipelines(const struct lpv_options *o, struct gpu_objects *out)
{
    const bool bounces = o->bounces > 0, maps = o->geometry == LPV_GEOMETRY_MAPS,
               scene = o->geometry == LPV_GEOMETRY_SCENE;
    fill_constants(o, out->constants);
    GPU_ADD(
        out, 0, PIPELINE(injection.rsm, true, inject, LIGHT | GEOMETRY),
        PIPELINE(injection.emitters, true, inject_emitters, LIGHT | GEOMETRY),
        PIPELINE(injection.resolve, true, inject_resolve, LIGHT),
        PIPELINE(propagation.propagate, true, propagate, LIGHT | GEOMETRY | NEIGHBOURS | CLOSURE),
        PIPELINE(application.plain, !o->specular, apply_diffuse, APPLY),
        PIPELINE(application.plain, o->specular, apply_specular, APPLY),
        PIPELINE(application.damped, !o->specular, apply_diffuse, APPLY | DAMPED),
        PIPELINE(application.damped, o->specular, apply_specular, APPLY | DAMPED),
        PIPELINE(debug, true, debug, LIGHT | GEOMETRY),
        PIPELINE(propagation.refine, o->cascades > 1, propagate_refine, LIGHT | GEOMETRY),
        PIPELINE(probes.pipeline, o->probes, probes, BANDS | GEOMETRY),
        PIPELINE(surfaces.opaque, bounces, surfaces, CLOSURE),
        PIPELINE(surfaces.masked, bounces, surfaces, CLOSURE | MASKED),
        PIPELINE(propagation.bounce, bounces, propagate_bounce, LIGHT | GEOMETRY | CLOSURE),
        PIPELINE(geometry.transmittance, maps || scene, geometry_transmittance,
                 GEOMETRY | NEIGHBOURS),
        PIPELINE(geometry.light, maps, geometry_light, 0),
        PIPELINE(geometry.camera, maps, geometry_camera, 0),
        PIPELINE(geometry.merge, maps, geometry_merge, 0),
        PIPELINE(geometry.coverage, scene, geometry_coverage, 0),
        PIPELINE(geometry.masked_coverage, scene, geometry_coverage, MASKED),
        PIPELINE(geometry.faces, scene, geometry_faces, 0));
}
