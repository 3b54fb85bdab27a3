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
        GPU_PIPELINE, #member, offsetof(struct lpv_pipelines, member),                             \
            .consts = (bits), .shader = (when) ? &shader_lpv_##name##_comp : NULL                  \
    }

void lpv_add_pipelines(const struct lpv_options *o, struct gpu_objects *out)
{
    const bool bounces = o->bounces > 0, maps = o->geometry == LPV_GEOMETRY_MAPS,
               scene = o->geometry == LPV_GEOMETRY_SCENE;
    fill_constants(o, out->constants);
    GPU_ADD(out, offsetof(struct lpv_cascades, levels[0].pipelines),
            PIPELINE(inject, true, inject, LIGHT | GEOMETRY),
            PIPELINE(inject_emitters, true, inject_emitters, LIGHT | GEOMETRY),
            PIPELINE(resolve, true, inject_resolve, LIGHT),
            PIPELINE(propagate, true, propagate, LIGHT | GEOMETRY | NEIGHBOURS | CLOSURE),
            PIPELINE(apply, !o->specular, apply_diffuse, APPLY),
            PIPELINE(apply, o->specular, apply_specular, APPLY),
            PIPELINE(apply_damped, !o->specular, apply_diffuse, APPLY | DAMPED),
            PIPELINE(apply_damped, o->specular, apply_specular, APPLY | DAMPED),
            PIPELINE(debug, true, debug, LIGHT | GEOMETRY),
            PIPELINE(refine, o->cascades > 1, refine, LIGHT | GEOMETRY),
            PIPELINE(probes, o->probes, probes, BANDS | GEOMETRY),
            PIPELINE(surfaces, bounces, surfaces, CLOSURE),
            PIPELINE(masked_surfaces, bounces, surfaces, CLOSURE | MASKED),
            PIPELINE(bounce, bounces, bounce, LIGHT | GEOMETRY | CLOSURE),
            PIPELINE(geometry_transmittance, maps || scene, geometry_transmittance,
                     GEOMETRY | NEIGHBOURS),
            PIPELINE(geometry_light, maps, geometry_light, 0),
            PIPELINE(geometry_camera, maps, geometry_camera, 0),
            PIPELINE(geometry_merge, maps, geometry_merge, 0),
            PIPELINE(geometry_coverage, scene, geometry_coverage, 0),
            PIPELINE(masked_coverage, scene, geometry_coverage, MASKED),
            PIPELINE(geometry_faces, scene, geometry_faces, 0));
}
