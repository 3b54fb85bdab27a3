// Begin of a frame: constants and lights in scaled units, and change flags.
#include "frame/frame_state.h"

#include "frame/frame_scale.h"

#include "core/hash.h"
#include "scene/unlit.h"

#include <string.h>

static struct frame_light scaled_light(const struct world_light *light, float scale)
{
    static const uint32_t types[] = {
        [LIGHT_SUN] = FRAME_LIGHT_SUN,
        [LIGHT_POINT] = FRAME_LIGHT_POINT,
        [LIGHT_SPOT] = FRAME_LIGHT_SPOT,
    };
    return (struct frame_light){
        .position = light->position,
        .type = types[light->type],
        .direction = light->direction,
        .range_m = light->range_m,
        .intensity = glms_vec3_scale(light->intensity, scale),
        .cos_inner = light->cos_inner,
        .cos_outer = light->cos_outer,
        .shadow_first = -1,
    };
}

static void begin_lights(struct frame *f, const struct frame_input *input, float scale)
{
    int count = input->light_count < FRAME_MAX_LIGHTS ? input->light_count : FRAME_MAX_LIGHTS;
    uint64_t hash = (uint64_t)count;
    for (int i = 0; i < count; i++) {
        const struct frame_light physical = scaled_light(&input->lights[i], 1.0f);
        hash = hash_bytes(&physical, sizeof physical, hash);
        f->lights[i] = scaled_light(&input->lights[i], scale);
    }
    f->lights_changed = f->index == 0 || hash != f->lights_hash;
    f->lights_hash = hash;
    f->light_count = count;
}

static struct frame_camera jittered(const struct frame *f, const struct frame_camera *camera)
{
    return frame_camera_jittered(camera, f->jitter, f->width, f->height);
}

// A change between perspective and orthographic is a cut, too. Both matrices of motion have the
// jitter of this frame, which so cancels: a static surface has motion 0.
static void begin_camera(struct frame *f, const struct frame_input *input)
{
    struct frame_constants *c = &f->constants;
    const struct frame_camera previous = f->unjittered;
    const vec2s previous_jitter = f->jitter;
    f->unjittered =
        input->projected ? *input->projected : frame_camera_of(&input->camera, f->width, f->height);
    f->camera_cut =
        input->camera_cut || f->index == 0 || previous.orthographic != f->unjittered.orthographic;
    f->camera_still = !f->camera_cut && frame_camera_equals(&previous, &f->unjittered);
    f->jitter = frame_jitter(f, input);
    f->camera = jittered(f, &f->unjittered);
    const struct frame_camera before = f->camera_cut ? f->camera : jittered(f, &previous);
    frame_camera_constants(&f->camera, f->width, f->height, c);
    c->previous_clip_from_world = frame_camera_clip_from_world(&before);
    c->previous_axis = frame_camera_axis(&before);
    c->jitter_step_x = f->camera_cut ? 0.0f : f->jitter.x - previous_jitter.x;
    c->jitter_step_y = f->camera_cut ? 0.0f : f->jitter.y - previous_jitter.y;
}

static uint64_t light_hash(const struct frame *f)
{
    const struct frame_constants *c = &f->constants;
    uint64_t hash = hash_bytes(&c->radiance_scale, sizeof c->radiance_scale, f->lights_hash);
    hash = hash_bytes(&f->environment_key, sizeof f->environment_key, hash);
    return hash_bytes(&f->common->options.shadow_filter, sizeof(int32_t), hash);
}

static float emissive_scale(const struct frame_constants *c, const struct frame_input *input)
{
    const bool own = !input->gbuffer || !(input->gbuffer->emissive_scale > 0.0f);
    return own ? 1.0f : c->radiance_scale / input->gbuffer->emissive_scale;
}

static struct gpu_binding patches_of(struct gpu_cmd *cmd, const struct frame_environment *e,
                                     float scale)
{
    _Static_assert(FRAME_ENVIRONMENT_PATCHES == ENVIRONMENT_PATCHES, "one layout");
    vec4s scaled[ENVIRONMENT_PATCHES];
    for (int i = 0; i < ENVIRONMENT_PATCHES; i++)
        scaled[i] = vec4_of(glms_vec3_scale(e->patches[i], scale), 0.0f);
    return gpu_transient(cmd, "frame_environment_patches", scaled, sizeof scaled);
}

void frame_begin(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input)
{
    struct frame_constants *c = &f->constants;
    float previous_scale = c->radiance_scale;
    begin_camera(f, input);
    const struct scale_input light = {
        .lights = input->lights,
        .light_count = input->light_count,
        .sky = environment_mean(&input->environment),
        .max_emissive = f->common->scene.max_emissive,
        .emitted_flux = f->common->emitters.flux,
        .painted = input->painted,
        .bounds = input->pose->bounds,
    };
    c->radiance_scale = frame_scale(&light);
    c->unlit_white =
        c->radiance_scale * unlit_white(input->lights, input->light_count, light.sky,
                                        luminance(f->common->emitters.flux), input->pose->bounds);
    f->fallback_luminance = frame_fallback_luminance(&light) * c->radiance_scale;
    // If all visible surfaces are unlit, their white exposes to 1.
    if (f->common->scene.has_unlit) f->fallback_luminance = 0.18f * c->unlit_white;
    c->emissive_scale = emissive_scale(c, input);
    c->previous_scale_ratio = f->index == 0 ? 1.0f : c->radiance_scale / previous_scale;
    c->sky = glms_vec3_scale(light.sky, c->radiance_scale);
    f->environment_key = frame_environment_follow(&f->common->environment, &input->environment);
    frame_environment_constants(&f->common->environment, &input->environment, c);
    f->emitted_irradiance = glms_vec3_scale(
        emitters_irradiance(&f->common->emitters, input->pose->bounds), c->radiance_scale);
    c->width = f->width;
    c->height = f->height;
    c->frame_index = (uint32_t)f->index;
    begin_lights(f, input, c->radiance_scale);
    c->light_count = (uint32_t)f->light_count;
    f->light_hash = light_hash(f);
    shadow_place(&f->common->shadow, f->lights, f->light_count,
                 &(struct shadow_view){
                     .camera = f->unjittered, // so that jitter alone moves no map
                     .bounds = input->pose->bounds,
                     .cascade_blend = f->common->options.cascade_blend,
                     .filter_radius = f->common->options.shadow_filter,
                 });
    rsm_place(&f->common->rsm, f->lights, f->light_count, input->pose->bounds);
    f->constants_binding = gpu_transient(cmd, "frame_constants", c, sizeof *c);
    f->patches_binding = patches_of(cmd, &f->common->environment, c->radiance_scale);
    // Whole: direct.comp has a uniform block of this size.
    f->lights_binding = gpu_transient(cmd, "frame_lights", f->lights, sizeof f->lights);
}

// The history continues if this view was recorded in the frame before, too.
void frame_begin_view(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input)
{
    const struct frame *first = f->common->views[0];
    const float previous_scale = f->constants.radiance_scale;
    struct frame_constants *c = &f->constants;
    struct frame_input own = *input;
    own.camera_cut |= f->number + 1 != first->number || first->camera_cut;
    begin_camera(f, &own);
    const struct frame_constants *shared = &first->constants;
    c->sky = shared->sky;
    c->uniform_sky = shared->uniform_sky;
    c->environment_scale = shared->environment_scale;
    c->environment_cos = shared->environment_cos;
    c->environment_sin = shared->environment_sin;
    c->environment_side = shared->environment_side;
    memcpy(c->environment_sh, shared->environment_sh, sizeof c->environment_sh);
    c->radiance_scale = shared->radiance_scale;
    c->unlit_white = shared->unlit_white;
    c->light_count = shared->light_count;
    c->previous_scale_ratio = f->camera_cut ? 1.0f : c->radiance_scale / previous_scale;
    c->emissive_scale = emissive_scale(c, input);
    c->width = f->width;
    c->height = f->height;
    c->frame_index = (uint32_t)f->index;
    f->fallback_luminance = first->fallback_luminance;
    f->light_count = first->light_count;
    f->lights_binding = first->lights_binding;
    f->constants_binding = gpu_transient(cmd, "frame_constants", c, sizeof *c);
}
