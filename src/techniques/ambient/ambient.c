// Ambient term: irradiance of the environment at the normal n, without occlusion, and a term
// derived from the scene's flux that is the same at every surface,
//     E = (E_environment(n) + Σ Φ ℓ̄ / (4V)) · strength.
// The sum is over virtual lights of flux Φ (lumen): texels of reflective shadow maps and points on
// emissive surfaces. V is the volume of the scene's bounding box, ℓ̄ = ⅔ d the mean path length, d
// the distance along the light's normal to the box (Cauchy's mean chord of a cube). README.md says
// when that is exact.
#include "techniques/ambient/ambient.h"

#include "techniques/ambient/ambient_shared.h"

#include "technique_shaders.h"

#include <math.h>
#include <stddef.h>

struct ambient_options {
#define OPTION OPTION_FIELD
#include "techniques/ambient/ambient_options.def"
#undef OPTION
};

static const struct option_row option_rows[] = {
#define OPTION(...) OPTION_ROW(struct ambient_options, __VA_ARGS__)
#include "techniques/ambient/ambient_options.def"
#undef OPTION
};

struct ambient {
    struct ambient_options options;
    gpu_pipeline sum, total, fill;
    gpu_pipeline mirror; // of `fill`, with specular light, if the option `specular` is set
    gpu_buffer partials; // vec3 each: scaled lumen
    gpu_buffer result;   // vec3: scaled lux
};

enum { VEC3_BYTES = 12, LOCAL = 8 };

static const float MEAN_PATH = 2.0f / 3.0f; // over the distance along the normal

#define MEMBER(member) offsetof(struct ambient, member)

static void ambient_objects(const void *options, int view, uint32_t width, uint32_t height,
                            struct gpu_objects *out)
{
    const struct ambient_options *o = options;
    (void)view, (void)width, (void)height;
    GPU_ADD(out, 0,
            { GPU_BUFFER, "partials", MEMBER(partials), .bytes = AMBIENT_GROUPS * VEC3_BYTES },
            { GPU_BUFFER, "result", MEMBER(result), .bytes = VEC3_BYTES },
            { GPU_PIPELINE, "sum", MEMBER(sum), .shader = &shader_ambient_sum_comp },
            { GPU_PIPELINE, "total", MEMBER(total), .shader = &shader_ambient_total_comp },
            { GPU_PIPELINE, "fill", MEMBER(fill), .shader = &shader_ambient_fill_diffuse_comp });
    if (o->specular)
        GPU_ADD(out, 0,
                { GPU_PIPELINE, "mirror", MEMBER(mirror),
                  .shader = &shader_ambient_fill_specular_comp });
}

// 1/m³; 0 for a flat or empty box, which has no mean path.
static float per_path(struct box3 box)
{
    if (box3_is_empty(box)) return 0.0f;
    const vec3s size = box3_size(box);
    const float volume = size.x * size.y * size.z;
    return volume > 0.0f && isfinite(volume) ? MEAN_PATH / (4.0f * volume) : 0.0f;
}

static struct ambient_push push_of(const struct ambient *ambient, const struct frame_view *view)
{
    const uint32_t across = gpu_groups(view->rsm_size, AMBIENT_TEXELS);
    return (struct ambient_push){
        .uniform_irradiance = view->emitted_irradiance,
        .per_path = per_path(view->bounds),
        .box_min = view->bounds.min,
        .box_max = view->bounds.max,
        .strength = ambient->options.strength,
        .rsm_size = view->rsm_size,
        .blocks_across = across,
        .blocks = across * across * (uint32_t)view->rsm_face_count,
        .width = view->width,
        .height = view->height,
        .has_dielectric = view->layers[FRAME_DIELECTRIC].id != 0,
    };
}

static void ambient_update(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct ambient *ambient = state;
    const struct ambient_push push = push_of(ambient, view);
    const struct gpu_binding partials = { .name = "ambient_partials", .buffer = ambient->partials };
    const struct gpu_binding result = { .name = "ambient_result", .buffer = ambient->result };
    gpu_scope_begin(cmd, "sum");
    if (push.blocks > 0) {
        gpu_dispatch(cmd, ambient->sum,
                     GPU_BIND(view->rsm_faces_binding,
                              { .name = "rsm_depth", .image = view->rsm_depth },
                              { .name = "rsm_normal", .image = view->rsm_normal },
                              { .name = "rsm_flux", .image = view->rsm_flux }, partials),
                     &push, sizeof push, AMBIENT_GROUPS, 1, 1);
    }
    gpu_dispatch(cmd, ambient->total, GPU_BIND(partials, result), &push, sizeof push, 1, 1, 1);
    gpu_scope_end(cmd);
}

static void ambient_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct ambient *ambient = state;
    const struct ambient_push push = push_of(ambient, view);
    const struct gpu_binding result = { .name = "ambient_result", .buffer = ambient->result };
    const bool mirrors = ambient->options.specular && view->environment->map;
    gpu_scope_begin(cmd, "fill");
    gpu_dispatch(cmd, mirrors ? ambient->mirror : ambient->fill,
                 GPU_BIND(result, FRAME_SURFACE_BINDINGS(view), view->environment_binding,
                          { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] },
                          { .name = "specular", .image = view->layers[FRAME_SPECULAR] }),
                 &push, sizeof push, gpu_groups(view->width, LOCAL),
                 gpu_groups(view->height, LOCAL), 1);
    gpu_scope_end(cmd);
}

static uint32_t more_needs(const void *options)
{
    const struct ambient_options *o = options;
    return o->specular ? FRAME_WRITES_SPECULAR_OF_MAP : 0;
}

const struct technique technique_ambient = {
    .name = "ambient",
    .title = "uniform ambient irradiance from the reflected flux",
    .paper = "mean fluence in a box, mean chord after Cauchy; flux as in Martin 2012, sec. 3.1",
    .role = ROLE_SOURCE,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS | MAKES_SPECULAR | GATHERS_EMISSION,
    .needs = FRAME_NEEDS_RSM | FRAME_NEEDS_EMITTERS | FRAME_WRITES_IRRADIANCE,
    .options = OPTION_TABLE(struct ambient_options, option_rows, NULL),
    .state_size = sizeof(struct ambient),
    .more_needs = more_needs,
    .objects = ambient_objects,
    .update = ambient_update,
    .record = ambient_record,
};
