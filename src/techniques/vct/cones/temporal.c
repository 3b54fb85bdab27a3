// Temporal accumulation with reverse reprojection (Hong 2015, sec. 4.3): the mean over the frames
// in which a surface was visible. With the weight w of the history, in frames,
//     new = (w · old + now)/(w + 1),   w ← min(w + 1, most),   w = 0 where the history is rejected.
// Each frame rotates the cones, so that the mean covers more directions than one frame.
//
// Differs from the paper in `most`, which grows while nothing changes, so that a static image
// converges, where a constant limit keeps 1/most of each frame's noise; and in that the history
// follows a change of light. Two frames of one rotation, before and after the change, have the same
// noise but for the change, and are a control variate of the history:
//     old ← after + c · (old − before),   1/w ← c²/w + 1 − c². (1)
// c estimates the correlation of their noise by 1 − |after − before|/max(after, before): the error
// is zero where no light has changed or all light is scaled down, and that of one frame where the
// light is another. Temporal gradients of SVGF (Schied et al. 2018) also compare samples of equal
// random numbers, but only to shorten the history.
//
// While light changes, the rotation is therefore held in three of four frames. In the fourth one
// (1) takes the last difference as expected, and its possible error reduces w. Each of the four
// adds a quarter of a frame to the mean: a rotation's noise, added by one of them alone, would be a
// pulse. A rotation from before the change has been added already.
#include "techniques/vct/cones/temporal.h"

#include "techniques/vct/vct_state.h"

#include <math.h>

// Radius of the filter, over the longest side of the scene: beyond it light is another, however few
// pixels are between. After a change of light few frames are left of a mean whose deviation is
// known.
static const float RADIUS = 0.07f, CHANGED_RADIUS = 0.14f;
// Deviations of the mean in which two pixels differ by noise alone; those of the further passes
// fall to zero over the first frames of a history.
static const float DEVIATIONS = 4.0f, FURTHER_DEVIATIONS = 3.0f;
static const float STILL_FRAMES = 4096.0f; // maximum weight while nothing changes
// Maxima of reflections, whose history does not follow changes of light.
static const float STILL_LOBE_FRAMES = 64.0f, MOVED_LOBE_FRAMES = 4.0f, MIRROR_FRAMES = 1.0f;

void vct_temporal_invalidate(struct vct_temporal *t)
{
    t->kept.known = false;
}

// ---- A frame ------------------------------------------------------------------------------------

// The previous frame's: see struct vct_history_params.
static void previous_image_plane(const struct frame_camera *camera, uint32_t width, uint32_t height,
                                 struct vct_history_params *out)
{
    const vec3s right = frame_camera_right(camera);
    const float pixel_x = (camera->right - camera->left) / (float)width;
    const float pixel_y = (camera->top - camera->bottom) / (float)height;
    out->right = glms_vec3_scale(right, pixel_x);
    out->down = glms_vec3_scale(camera->up, -pixel_y);
    out->corner = glms_vec3_muladds(right, camera->left + 0.5f * pixel_x,
                                    glms_vec3_scale(camera->up, camera->top - 0.5f * pixel_y));
    out->forward = camera->forward;
    out->pixel = frame_camera_pixel(camera, width, height);
    out->perspective = camera->orthographic ? 0.0f : 1.0f;
}

// After ten times `most` frames a fraction e⁻¹⁰ of the light before the last change is left. From
// then on all frames weigh the same.
static float history_weight(uint32_t still, int32_t most)
{
    const float grown = (float)still - 9.0f * (float)most;
    return fmaxf((float)most, fminf(grown, STILL_FRAMES));
}

// Selects the rotation of this frame, its weight in the mean and how the history follows.
static void follow(struct vct_temporal *t, bool moves, bool settles)
{
    t->held = moves && t->held < VCT_ROTATION_FRAMES - 1 ? t->held + 1 : 0;
    t->params.follow = t->held > 0 ? VCT_FOLLOW_KNOWN
                       : moves     ? VCT_FOLLOW_EXPECTED
                       : settles   ? VCT_SETTLE
                                   : VCT_KEEP;
    const bool first = t->held == 0;
    if (first) t->whole = !moves;
    t->params.added = !t->whole ? 1.0f / (float)VCT_ROTATION_FRAMES : first ? 1.0f : 0.0f;
}

void vct_temporal_begin(struct vct_temporal *t, const struct frame_view *view, uint32_t block,
                        int32_t most, float clamp, bool settles)
{
    kept_update(&t->kept, view, view->light_hash);
    const bool known = t->kept.follows && !view->camera_cut;
    const bool moves = known && !(t->unlit ? t->kept.still : t->kept.same);
    t->still = known && !moves && !settles && frame_camera_equals(&t->camera, &view->camera)
                   ? t->still + 1
                   : 0;
    t->params = (struct vct_history_params){
        .known = known,
        .change_known = t->params.follow != VCT_KEEP,
        .clamp = clamp,
        .block = (int32_t)block,
    };
    t->params.scale = t->unlit ? 1.0f : view->constants->previous_scale_ratio;
    t->params.most = history_weight(t->still, most);
    const float lobe = fminf((float)most, moves || settles ? MOVED_LOBE_FRAMES : (float)most);
    t->params.most_of_lobe = t->still > 0 ? STILL_LOBE_FRAMES : lobe;
    t->params.most_of_mirror = t->still > 0 ? STILL_LOBE_FRAMES : fminf(lobe, MIRROR_FRAMES);
    follow(t, moves, known && settles);
    t->number = known ? t->number + (t->held == 0) : 0;
    t->frame = known ? t->frame + 1 : 0;
    previous_image_plane(&t->camera, view->width, view->height, &t->params);
    t->camera = view->camera;
    t->newest = 1 - t->newest;
}

static int common_divisor(int a, int b)
{
    while (b) {
        const int remainder = a % b;
        a = b;
        b = remainder;
    }
    return a;
}

// A step coprime with `count`, near the golden ratio: it visits all indices, the first ones far
// apart.
static int step_through(int count)
{
    int step = (int)(0.618 * (double)count);
    while (step > 1 && common_divisor(step, count) != 1) step--;
    return step > 1 ? step : 1;
}

void vct_temporal_rotate_cones(const struct vct_temporal *t, struct vct_cone_params *params)
{
    const int count = (int)params->cone_count;
    vec3s lines[VCT_MAX_CONES];
    for (int i = 0; i < count; i++)
        lines[i] = vec3_of(params->cones[i].x, params->cones[i].y, params->cones[i].z);
    vct_rotate_cone_axes(t->number, count, lines);
    const int first = (int)((uint64_t)t->number * (uint64_t)step_through(count) % (uint64_t)count);
    // The weight belongs to the index: it depends on the number of pixels that trace it.
    for (int i = 0; i < count; i++)
        params->cones[i] = vec4_of(lines[(first + i) % count], params->cones[i].w);
}

gpu_image vct_temporal_now(const struct vct_temporal *t)
{
    return t->now[t->newest];
}

// `follow` also clamps.
static gpu_pipeline pipeline_of(const struct vct_temporal *t,
                                const struct vct_temporal_pipelines *pipelines)
{
    if (!t->params.known) return pipelines->first;
    return t->params.follow != VCT_KEEP || t->params.clamp > 0.0f ? pipelines->follow
                                                                  : pipelines->keep;
}

void vct_temporal_record(struct vct_temporal *t, const struct vct_temporal_pipelines *pipelines,
                         struct gpu_cmd *cmd, const struct frame_view *view, gpu_image result)
{
    const int newest = t->newest, previous = 1 - newest;
    gpu_scope_begin(cmd, "temporal");
    gpu_dispatch(cmd, pipeline_of(t, pipelines),
                 GPU_BIND(view->constants_binding,
                          gpu_transient(cmd, "vct_history", &t->params, sizeof t->params),
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "motion", .image = view->layers[FRAME_MOTION] },
                          { .name = "now", .image = t->now[newest] },
                          { .name = "last_now", .image = t->now[previous] },
                          { .name = "last_change", .image = t->change[previous] },
                          { .name = "change", .image = t->change[newest] },
                          { .name = "last_light", .image = t->light[previous] },
                          { .name = "last_surface", .image = t->surface[previous] },
                          { .name = "light", .image = t->light[newest] },
                          { .name = "surface", .image = t->surface[newest] },
                          { .name = "irradiance", .image = result }),
                 NULL, 0, gpu_groups(view->width, VCT_LOCAL_2D),
                 gpu_groups(view->height, VCT_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}

static void record_pass(const struct vct_temporal *t, gpu_pipeline pass, struct gpu_cmd *cmd,
                        const struct frame_view *view, const struct vct_denoise_push *push,
                        gpu_image from, gpu_image to)
{
    gpu_dispatch(cmd, pass,
                 GPU_BIND(view->constants_binding, { .name = "light", .image = from },
                          { .name = "surface", .image = t->surface[t->newest] },
                          { .name = "irradiance", .image = to }),
                 push, sizeof *push, gpu_groups(view->width, VCT_LOCAL_2D),
                 gpu_groups(view->height, VCT_LOCAL_2D), 1);
}

// A pass along rows and columns, and one along diagonals. Between them the light is in an image
// that the next frame begins to write.
static void record_passes(const struct vct_temporal *t,
                          const struct vct_temporal_pipelines *pipelines, struct gpu_cmd *cmd,
                          const struct frame_view *view, const int32_t strides[2], float deviations,
                          float scene_m, gpu_image from, gpu_image to)
{
    const float pixel = frame_camera_pixel(&view->camera, view->width, view->height);
    const float radius = t->params.follow == VCT_KEEP ? RADIUS : CHANGED_RADIUS;
    const gpu_image between = t->light[1 - t->newest];
    for (int i = 0; i < 2; i++) {
        const struct vct_denoise_push push = { strides[i], (float)strides[i] * pixel,
                                               radius * scene_m, deviations };
        record_pass(t, pipelines->denoise[i], cmd, view, &push, i == 0 ? from : between,
                    i == 0 ? between : to);
    }
}

// Strides of 0.8 and 1.2 blocks: pixels of a block share the noise of its rays, and the taps have
// other places in their blocks, so that the mean shows no lattice of them.
//
// The first frames of a history have more noise than 25 pixels average: a block of which a ray
// meets a small bright surface would become a star of 25 bright spots. Wider passes average 25
// times as many pixels, and narrow ones fill the gaps between their taps.
void vct_temporal_denoise(const struct vct_temporal *t,
                          const struct vct_temporal_pipelines *pipelines, struct gpu_cmd *cmd,
                          const struct frame_view *view, float scene_m, int32_t wide_frames,
                          gpu_image result)
{
    const int32_t block = t->params.block, fifth = (block + 4) / 5;
    const int32_t strides[3][2] = { { block > 1 ? block - fifth : 1, block + fifth },
                                    { 2 * block - 1, 13 * block / 5 },
                                    { 1, 2 } };
    gpu_scope_begin(cmd, "denoise");
    record_passes(t, pipelines, cmd, view, strides[0], DEVIATIONS, scene_m, t->light[t->newest],
                  result);
    const float left = 1.0f - (float)t->frame / fmaxf((float)wide_frames, 1e-3f);
    for (int i = 1; i < 3 && wide_frames > 0 && left > 0.0f; i++)
        record_passes(t, pipelines, cmd, view, strides[i], left * FURTHER_DEVIATIONS, scene_m,
                      result, result);
    gpu_scope_end(cmd);
}
