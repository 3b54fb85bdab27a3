// Frames of a renderer: submitted by the library, or recorded into a caller's command buffer.
#include "api/renderer_gbuffer.h"
#include "api/renderer_scene.h"
#include "api/renderer_state.h"

#include "gpu/gpu.h"

#include <string.h>

// The library cannot wait for what a caller submits.
static enum ag_result idle_check(const char *function, const struct ag_renderer *r)
{
    AG_REQUIRE_FOR(function, renderer_context(r), r->recorded_count == 0,
                   "a recorded frame is unfinished: call ag_renderer_recorded_done first");
    return AG_OK;
}

void ag_frame_desc_default(struct ag_frame_desc *desc)
{
    if (desc) *desc = (struct ag_frame_desc){ .auto_exposure = true };
}

static enum ag_result frame_check(const char *function, const struct ag_renderer *r,
                                  const struct ag_frame_desc *desc)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_FOR(function, context, desc, "desc is NULL");
    AG_REQUIRE_KNOWN(function, context, desc);
    AG_REQUIRE_FOR(function, context, r->sized, "the last resize failed");
    AG_REQUIRE_FOR(function, context, api_animation_exists(r->scene, desc->animation),
                   "animation %d is not one of %d", desc->animation,
                   r->scene->scene->animation_count);
    AG_REQUIRE_FOR(function, context, isfinite(desc->time_s), "time_s is not finite");
    AG_REQUIRE_FOR(function, context, desc->auto_exposure || isfinite(desc->exposure_ev),
                   "exposure_ev is not finite");
    AG_REQUIRE_FOR(function, context,
                   !desc->pick || (desc->pick[0] >= 0 && desc->pick[0] < r->width &&
                                   desc->pick[1] >= 0 && desc->pick[1] < r->height),
                   "pick %d, %d is not in an image of %d×%d", desc->pick[0], desc->pick[1],
                   r->width, r->height);
    enum ag_result checked = renderer_gbuffer_check(function, r, desc);
    return checked != AG_OK ? checked : api_camera_check(context, function, &desc->camera);
}

static void warn_of_animation(const struct ag_renderer *r)
{
    if (r->scene->scene->animation_count > 0 && gi_would_warn_of_movement(r->gi) &&
        pose_surfaces_hash(&r->pose) != r->created_surfaces)
        gi_warn_of_movement(r->gi);
}

// All steps that may allocate; recording must not.
static bool prepare(struct ag_renderer *r, const struct ag_frame_desc *desc,
                    const struct frame_gbuffer *gbuffer, struct frame_input *input,
                    struct frame_indirect *hook)
{
    if (!api_pose_at(r->scene, &r->pose, desc->animation, desc->time_s)) return false;
    const uint32_t changes = renderer_scene_changes(r);
    if (changes) gi_invalidate(r->gi, changes);
    warn_of_animation(r);
    *input = (struct frame_input){ .pose = &r->pose,
                                   .camera = api_camera(&desc->camera),
                                   .lights = r->lights,
                                   .light_count = renderer_scene_lights(r),
                                   .sky = r->scene->scene->sky,
                                   .auto_exposure = desc->auto_exposure,
                                   .exposure_ev = desc->exposure_ev,
                                   .camera_cut = desc->camera_cut,
                                   .want_indirect_layer = r->indirect_layer,
                                   .want_motion_layer = r->motion_layer,
                                   .want_id_layer = r->id_layer,
                                   .pick = desc->pick != NULL,
                                   .pick_x = desc->pick ? (uint32_t)desc->pick[0] : 0,
                                   .pick_y = desc->pick ? (uint32_t)desc->pick[1] : 0,
                                   .want_display = r->display_layer,
                                   .shown = &r->shown,
                                   .gbuffer = desc->gbuffer ? gbuffer : NULL };
    r->shown.image = r->shows_debug ? gi_debug_image(r->gi) : (gpu_image){ 0 };
    *hook = gi_hook(r->gi);
    return frame_prepare(r->frame, input, hook);
}

static bool fail_lost(struct ag_renderer *r)
{
    struct host *host = renderer_host(r);
    if (host->failure != FAIL_NONE) return false; // already reported
    return host_fail(host, FAIL_DEVICE, "cannot render a frame on %s: the device is lost",
                     gpu_info(r->device->gpu)->name);
}

// Into a caller's command buffer, or to be submitted if that is NULL. *cmd is NULL if recording has
// not begun.
static bool record(struct ag_renderer *r, const struct ag_frame_desc *desc, void *commands,
                   struct gpu_cmd **cmd)
{
    struct gpu *gpu = r->device->gpu;
    struct frame_input input;
    struct frame_indirect hook;
    struct frame_gbuffer gbuffer;
    *cmd = NULL;
    renderer_enter(r);
    bool ok = renderer_gbuffer_open(r, desc->gbuffer, &gbuffer) &&
              prepare(r, desc, &gbuffer, &input, &hook);
    if (ok) {
        *cmd = commands ? gpu_frame_begin_adopted(gpu, commands) : gpu_frame_begin(gpu);
        if (*cmd) frame_record(r->frame, *cmd, &input, &hook);
        ok = (*cmd && gpu_frame_end(gpu, *cmd)) || fail_lost(r);
    }
    renderer_gbuffer_finish(r, &gbuffer);
    renderer_leave(r);
    return ok;
}

enum ag_result ag_renderer_render(struct ag_renderer *r, const struct ag_frame_desc *desc)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    enum ag_result checked = frame_check(__func__, r, desc);
    if (checked == AG_OK) checked = idle_check(__func__, r);
    if (checked != AG_OK) return checked;
    struct gpu_cmd *cmd;
    bool ok = record(r, desc, NULL, &cmd);
    if (ok) r->rendered++;
    return api_done(context, ok);
}

enum ag_result ag_renderer_record(struct ag_renderer *r, const struct ag_frame_desc *desc,
                                  void *vk_command_buffer, uint64_t *frame)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_POINTER(context, frame);
    *frame = 0;
    AG_REQUIRE(context, r, "renderer is NULL");
    AG_REQUIRE_POINTER(context, vk_command_buffer);
    AG_REQUIRE(context, r->device->adopted, "the device is not an adopted one");
    enum ag_result checked = frame_check(__func__, r, desc);
    if (checked != AG_OK) return checked;
    struct gpu_cmd *cmd;
    bool ok = record(r, desc, vk_command_buffer, &cmd);
    if (!cmd) return api_done(context, ok);
    *frame = frame_number(r->frame);
    r->recorded[r->recorded_count++] = (struct recorded_frame){ cmd, *frame };
    r->rendered++;
    return api_done(context, ok);
}

void renderer_recordings_done(struct ag_renderer *r, uint64_t number)
{
    int done = 0;
    while (done < r->recorded_count && r->recorded[done].number <= number)
        gpu_frame_adopted_done(r->device->gpu, r->recorded[done++].cmd);
    r->recorded_count -= done;
    memmove(r->recorded, r->recorded + done, (size_t)r->recorded_count * sizeof *r->recorded);
}

enum ag_result ag_renderer_recorded_done(struct ag_renderer *r, uint64_t frame)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    bool pending = false;
    for (int i = 0; i < r->recorded_count; i++) pending |= r->recorded[i].number == frame;
    AG_REQUIRE(context, pending, "frame %llu is not recorded and unfinished",
               (unsigned long long)frame);
    renderer_recordings_done(r, frame);
    return api_done(context, true);
}

enum ag_result ag_renderer_wait(struct ag_renderer *r)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    enum ag_result checked = idle_check(__func__, r);
    if (checked != AG_OK) return checked;
    return api_done(context, gpu_wait(r->device->gpu) || fail_lost(r));
}
