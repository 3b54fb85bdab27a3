// Frames of a renderer: submitted by the library, or recorded into a caller's command buffer.
#include "api/renderer/gbuffer.h"
#include "api/renderer/scene.h"
#include "api/renderer/state.h"
#include "api/renderer/view_matrices.h"

#include "core/sampling.h"
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

void ag_jitter(int index, int count, float jitter[2])
{
    if (!jitter) return;
    const vec2s offset = sample_jitter(index, count);
    jitter[0] = offset.x;
    jitter[1] = offset.y;
}

// One view of a frame, while it is recorded.
struct shot {
    struct ag_view *view;
    const struct ag_camera *camera;
    const struct ag_view_matrices *matrices; // in place of the camera; or NULL
    struct api_view by_matrices;             // of them
    bool auto_exposure, camera_cut;
    float exposure_ev;
    const float *jitter; // x, y
    const struct ag_gbuffer *gbuffer;
    struct frame_gbuffer images; // of gbuffer
    struct gbuffer_encoding encoding;
    struct frame_input input;
};
struct shots {
    struct shot list[FRAME_MAX_VIEWS];
    int count;
};

// desc has been checked.
static void list_shots(struct ag_renderer *r, const struct ag_frame_desc *desc, struct shots *out)
{
    out->count = 1 + desc->view_count;
    out->list[0] = (struct shot){ .view = &r->main,
                                  .camera = &desc->camera,
                                  .matrices = desc->matrices,
                                  .auto_exposure = desc->auto_exposure,
                                  .camera_cut = desc->camera_cut,
                                  .exposure_ev = desc->exposure_ev,
                                  .jitter = desc->jitter,
                                  .gbuffer = desc->gbuffer };
    for (int i = 0; i < desc->view_count; i++) {
        const struct ag_view_frame *own = &desc->views[i];
        out->list[1 + i] = (struct shot){ .view = own->view,
                                          .camera = &own->camera,
                                          .matrices = own->matrices,
                                          .auto_exposure = own->auto_exposure,
                                          .camera_cut = own->camera_cut,
                                          .exposure_ev = own->exposure_ev,
                                          .jitter = own->jitter,
                                          .gbuffer = own->gbuffer };
    }
}

static enum ag_result shot_check(const char *function, struct shot *shot)
{
    struct ag_context *context = view_context(shot->view);
    AG_REQUIRE_FOR(function, context, shot->view->sized, "the last resize failed");
    AG_REQUIRE_FOR(function, context, shot->auto_exposure || isfinite(shot->exposure_ev),
                   "exposure_ev is not finite");
    for (int i = 0; i < 2; i++)
        AG_REQUIRE_FOR(function, context, fabsf(shot->jitter[i]) <= 0.5f,
                       "jitter[%d] is %g, not -0.5 to 0.5", i, (double)shot->jitter[i]);
    enum ag_result checked = renderer_gbuffer_check(function, shot->view, shot->gbuffer);
    if (checked != AG_OK) return checked;
    if (!shot->matrices) return api_camera_check(context, function, shot->camera);
    checked = api_view_of_matrices(context, function, shot->matrices, &shot->by_matrices);
    return checked != AG_OK || !shot->gbuffer
               ? checked
               : renderer_depth_check(function, shot->view, &shot->by_matrices);
}

static enum ag_result views_check(const char *function, const struct ag_renderer *r,
                                  const struct ag_frame_desc *desc)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_FOR(function, context, desc->view_count >= 0 && desc->view_count <= r->life.users,
                   "view_count is %d, and the renderer has %d views", desc->view_count,
                   r->life.users);
    AG_REQUIRE_FOR(function, context, desc->view_count == 0 || desc->views, "views is NULL");
    for (int i = 0; i < desc->view_count; i++) {
        const struct ag_view *view = desc->views[i].view;
        AG_REQUIRE_FOR(function, context, view && view->renderer == r,
                       "views[%d] is NULL or of another renderer", i);
        AG_REQUIRE_KNOWN(function, context, &desc->views[i]);
        for (int k = 0; k < i; k++)
            AG_REQUIRE_FOR(function, context, desc->views[k].view != view,
                           "views[%d] and views[%d] are the same", k, i);
    }
    return AG_OK;
}

static enum ag_result pick_check(const char *function, const struct ag_renderer *r,
                                 const struct ag_frame_desc *desc)
{
    struct ag_context *context = renderer_context(r);
    if (!desc->pick) return AG_OK;
    AG_REQUIRE_FOR(function, context, !desc->gbuffer,
                   "pick needs the layer id, which the program's own G-buffer does not have");
    AG_REQUIRE_FOR(function, context,
                   desc->pick[0] >= 0 && desc->pick[0] < r->main.width && desc->pick[1] >= 0 &&
                       desc->pick[1] < r->main.height,
                   "pick %d, %d is not in an image of %d×%d", desc->pick[0], desc->pick[1],
                   r->main.width, r->main.height);
    return AG_OK;
}

// Lists the shots of a description that is right.
static enum ag_result frame_check(const char *function, struct ag_renderer *r,
                                  const struct ag_frame_desc *desc, struct shots *shots)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_FOR(function, context, desc, "desc is NULL");
    AG_REQUIRE_KNOWN(function, context, desc);
    AG_REQUIRE_FOR(function, context, api_animation_exists(r->scene, desc->animation),
                   "animation %d is not one of %d", desc->animation,
                   r->scene->scene->animation_count);
    AG_REQUIRE_FOR(function, context, isfinite(desc->time_s), "time_s is not finite");
    enum ag_result checked = pick_check(function, r, desc);
    if (checked == AG_OK) checked = views_check(function, r, desc);
    if (checked != AG_OK) return checked;
    list_shots(r, desc, shots);
    for (int i = 0; i < shots->count && checked == AG_OK; i++)
        checked = shot_check(function, &shots->list[i]);
    return checked;
}

static bool prepare_shot(struct shot *shot, const struct frame_input *common,
                         const struct frame_indirect *hook)
{
    struct ag_view *view = shot->view;
    const struct api_view *by_matrices = shot->matrices ? &shot->by_matrices : NULL;
    if (!renderer_gbuffer_open(view, shot->gbuffer, by_matrices, &shot->encoding, &shot->images))
        return false;
    shot->input = *common;
    if (by_matrices)
        shot->input.projected = &by_matrices->camera;
    else
        shot->input.camera = api_camera(shot->camera);
    shot->input.auto_exposure = shot->auto_exposure;
    shot->input.exposure_ev = shot->exposure_ev;
    shot->input.camera_cut = shot->camera_cut;
    shot->input.jitter = (vec2s){ { shot->jitter[0], shot->jitter[1] } };
    shot->input.want_indirect_layer = view->indirect_layer;
    shot->input.want_motion_layer = view->motion_layer;
    shot->input.want_id_layer = view->id_layer;
    shot->input.want_display = view->display_layer;
    shot->input.keep_layers = view->all_layers;
    shot->input.shown = &view->shown;
    shot->input.gbuffer = shot->gbuffer ? &shot->images : NULL;
    view->shown.image = view->shows_debug ? gi_debug_image(view->renderer->gi) : (gpu_image){ 0 };
    return frame_prepare(view->frame, &shot->input, hook);
}

static void warn_of_animation(const struct ag_renderer *r)
{
    if (r->scene->scene->animation_count > 0 && gi_would_warn_of_movement(r->gi) &&
        pose_surfaces_hash(&r->pose) != r->created_surfaces)
        gi_warn_of_movement(r->gi);
}

// All steps that may allocate; recording must not.
static bool prepare(struct ag_renderer *r, const struct ag_frame_desc *desc, struct shots *shots,
                    struct frame_indirect *hook)
{
    if (!api_pose_at(r->scene, &r->pose, desc->animation, desc->time_s)) return false;
    const uint32_t changes = renderer_scene_changes(r);
    if (changes) gi_invalidate(r->gi, changes);
    warn_of_animation(r);
    gi_follow(r->gi, &r->pose, r->wait_for_updates);
    struct frame_input common = { .pose = &r->pose,
                                  .lights = r->lights,
                                  .light_count = renderer_scene_lights(r),
                                  .environment = r->scene->scene->environment,
                                  .painted = gi_painted(r->gi) };
    *hook = gi_hook(r->gi);
    for (int i = 0; i < shots->count; i++) {
        common.pick = i == 0 && desc->pick;
        common.pick_x = common.pick ? (uint32_t)desc->pick[0] : 0;
        common.pick_y = common.pick ? (uint32_t)desc->pick[1] : 0;
        if (!prepare_shot(&shots->list[i], &common, hook)) return false;
    }
    return true;
}

static bool fail_lost(struct ag_renderer *r)
{
    struct host *host = renderer_host(r);
    if (host->failure != FAIL_NONE) return false; // already reported
    return host_fail(host, FAIL_DEVICE, "cannot render a frame on %s: the device is lost",
                     gpu_info(r->device->gpu)->name);
}

// The first one last: other views share the memory of its layers.
static void record_shots(struct shots *shots, struct gpu_cmd *cmd,
                         const struct frame_indirect *hook)
{
    struct shot *first = &shots->list[0];
    frame_record_light(first->view->frame, cmd, &first->input, hook);
    for (int i = 1; i < shots->count; i++)
        frame_record_view(shots->list[i].view->frame, cmd, &shots->list[i].input, hook);
    frame_record_view(first->view->frame, cmd, &first->input, hook);
}

static void count_shots(struct shots *shots)
{
    for (int i = 0; i < shots->count; i++) shots->list[i].view->rendered++;
}

// Shots have been checked. Into a caller's command buffer, or to be submitted if that is NULL. *cmd
// is NULL if recording has not begun.
static bool record(struct ag_renderer *r, const struct ag_frame_desc *desc, struct shots *shots,
                   void *commands, struct gpu_cmd **cmd)
{
    struct gpu *gpu = r->device->gpu;
    struct frame_indirect hook;
    *cmd = NULL;
    renderer_enter(r);
    bool ok = prepare(r, desc, shots, &hook);
    if (ok) {
        *cmd = commands ? gpu_frame_begin_adopted(gpu, commands) : gpu_frame_begin(gpu);
        if (*cmd) record_shots(shots, *cmd, &hook);
        ok = (*cmd && gpu_frame_end(gpu, *cmd)) || fail_lost(r);
    }
    for (int i = 0; i < shots->count; i++)
        renderer_gbuffer_finish(shots->list[i].view, &shots->list[i].images);
    renderer_leave(r);
    if (ok || (*cmd && commands)) count_shots(shots);
    return ok;
}

enum ag_result ag_renderer_render(struct ag_renderer *r, const struct ag_frame_desc *desc)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    struct shots shots;
    enum ag_result checked = frame_check(__func__, r, desc, &shots);
    if (checked == AG_OK) checked = idle_check(__func__, r);
    if (checked != AG_OK) return checked;
    struct gpu_cmd *cmd;
    bool ok = record(r, desc, &shots, NULL, &cmd);
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
    struct shots shots;
    enum ag_result checked = frame_check(__func__, r, desc, &shots);
    if (checked != AG_OK) return checked;
    struct gpu_cmd *cmd;
    bool ok = record(r, desc, &shots, vk_command_buffer, &cmd);
    if (!cmd) return api_done(context, ok);
    *frame = frame_number(r->main.frame);
    r->recorded[r->recorded_count++] = (struct recorded_frame){ cmd, *frame };
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
