// Reverse reprojection and temporal refinement (Hong 2015, sec. 4.3): the mean over the frames in
// which a surface has been seen. With the weight w of the history and 1 for a frame,
//     new = (w · old + now)/(w + 1),   w ← min(w + 1, most),   w = 0 where the reprojection is
//     rejected.
// Each frame has other cones, so that the mean is over more directions than a frame has.
//
// Differs from the paper in `most`: while nothing changes it grows with the time for which nothing
// has, so that a still picture comes to rest instead of wavering within 1/most of each frame's
// noise for ever. What moves finds it as it is given.
#include "techniques/vct/cones/temporal.h"

#include "techniques/vct/vct_state.h"

#include "technique_shaders.h"

#include <math.h>

static const enum gpu_format NOW_FORMAT = GPU_RGBA16F, LIGHT_FORMAT = GPU_RGBA32F,
                             SURFACE_FORMAT = GPU_RG32F;
static const float STILL_FRAMES = 4096.0f; // weight at most, while nothing changes

// ---- Life ---------------------------------------------------------------------------------------

bool vct_temporal_create(struct vct_temporal *t, struct gpu *gpu)
{
    return vct_create_compute(t->owner, gpu, "temporal", &shader_vct_cones_temporal_comp, NULL, 0,
                              &t->filter);
}

static bool create_image(const struct vct_temporal *t, struct gpu *gpu, const char *name,
                         enum gpu_format format, uint32_t width, uint32_t height, gpu_image *out)
{
    const struct gpu_image_desc desc = { .name = name,
                                         .format = format,
                                         .width = width,
                                         .height = height,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    return vct_create_image(t->owner, gpu, desc, out);
}

bool vct_temporal_resize(struct vct_temporal *t, struct gpu *gpu, uint32_t width, uint32_t height)
{
    vct_temporal_forget(t);
    for (int i = 0; i < 2; i++)
        if (!create_image(t, gpu, "history", LIGHT_FORMAT, width, height, &t->light[i]) ||
            !create_image(t, gpu, "seen", SURFACE_FORMAT, width, height, &t->surface[i]))
            return false;
    return create_image(t, gpu, "now", NOW_FORMAT, width, height, &t->now);
}

void vct_temporal_destroy(struct vct_temporal *t, struct gpu *gpu)
{
    gpu_pipeline_destroy(gpu, &t->filter);
    gpu_image_destroy(gpu, &t->now);
    for (int i = 0; i < 2; i++) {
        gpu_image_destroy(gpu, &t->light[i]);
        gpu_image_destroy(gpu, &t->surface[i]);
    }
}

uint64_t vct_temporal_memory(uint32_t width, uint32_t height)
{
    const int pixel = gpu_format_bytes(NOW_FORMAT) +
                      2 * (gpu_format_bytes(LIGHT_FORMAT) + gpu_format_bytes(SURFACE_FORMAT));
    return (uint64_t)width * height * (uint64_t)pixel;
}

void vct_temporal_forget(struct vct_temporal *t)
{
    t->known = false;
}

// ---- A frame ------------------------------------------------------------------------------------

static bool same(vec3s a, vec3s b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static bool same_camera(const struct world_camera *a, const struct world_camera *b)
{
    return same(a->eye, b->eye) && same(a->forward, b->forward) && same(a->up, b->up) &&
           a->vertical_fov_rad == b->vertical_fov_rad && a->near_m == b->near_m;
}

static bool stands_still(const struct vct_temporal *t, const struct frame_view *view)
{
    const bool same_light = !view->lights_changed && same(t->sky, view->constants->sky);
    return !view->geometry_moved && same_camera(&t->camera, &view->camera) &&
           (t->unlit || same_light);
}

// The last picture's geometry: the point at the distance d along the axis that is seen at a pixel
// (whole numbers: centres) is d · (forward + x · right + y · down), seen from the eye.
static void place_picture(const struct world_camera *camera, uint32_t width, uint32_t height,
                          struct vct_history_params *out)
{
    const float pixel = 2.0f * tanf(0.5f * camera->vertical_fov_rad) / (float)height;
    out->right = glms_vec3_scale(glms_vec3_cross(camera->forward, camera->up), pixel);
    out->down = glms_vec3_scale(camera->up, -pixel);
    out->forward = camera->forward;
    out->forward = glms_vec3_muladds(out->right, -0.5f * (float)(width - 1), out->forward);
    out->forward = glms_vec3_muladds(out->down, -0.5f * (float)(height - 1), out->forward);
    out->pixel = pixel;
}

// Once ten times `most` frames have left nothing (e⁻¹⁰) of what was before the last change, all
// frames from then on weigh the same.
static float weight_at_rest(uint32_t still, int32_t most)
{
    const float grown = (float)still - 9.0f * (float)most;
    return fmaxf((float)most, fminf(grown, STILL_FRAMES));
}

void vct_temporal_begin(struct vct_temporal *t, const struct frame_view *view, int32_t most,
                        float clamp)
{
    const bool known = t->known && !view->camera_cut && view->index == t->index + 1;
    t->number = known ? t->number + 1 : 0;
    t->still = known && stands_still(t, view) ? t->still + 1 : 0;
    t->params = (struct vct_history_params){ .known = known, .clamp = clamp };
    t->params.scale = t->unlit ? 1.0f : view->constants->previous_scale_ratio;
    t->params.most = weight_at_rest(t->still, most);
    place_picture(&t->camera, view->width, view->height, &t->params);
    t->known = true;
    t->index = view->index;
    t->camera = view->camera;
    t->sky = view->constants->sky;
    t->newest = 1 - t->newest;
}

static int common_factor(int a, int b)
{
    while (b) {
        const int rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

// A step through `count` things that meets all of them and whose first ones lie far apart.
static int step_through(int count)
{
    int step = (int)(0.618 * (double)count);
    while (step > 1 && common_factor(step, count) != 1) step--;
    return step > 1 ? step : 1;
}

void vct_temporal_turn(const struct vct_temporal *t, struct vct_cone_params *params)
{
    const int count = (int)params->cone_count;
    vec3s lines[VCT_MAX_CONES];
    for (int i = 0; i < count; i++)
        lines[i] = vec3_of(params->cones[i].x, params->cones[i].y, params->cones[i].z);
    vct_turn_lines(t->number, count, lines);
    const int first = (int)((uint64_t)t->number * (uint64_t)step_through(count) % (uint64_t)count);
    for (int i = 0; i < count; i++) // each keeps its share of the pixels that trace it
        params->cones[i] = vec4_of(lines[(first + i) % count], params->cones[i].w);
}

void vct_temporal_record(struct vct_temporal *t, struct gpu_cmd *cmd, const struct frame_view *view,
                         gpu_image result)
{
    const int newest = t->newest, last = 1 - newest;
    vct_pass_begin(t->owner, cmd, "temporal");
    gpu_dispatch(cmd, t->filter,
                 GPU_BIND(view->constants_binding,
                          gpu_transient(cmd, "vct_history", &t->params, sizeof t->params),
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "motion", .image = view->layers[FRAME_MOTION] },
                          { .name = "now", .image = t->now },
                          { .name = "last_light", .image = t->light[last] },
                          { .name = "last_surface", .image = t->surface[last] },
                          { .name = "light", .image = t->light[newest] },
                          { .name = "surface", .image = t->surface[newest] },
                          { .name = "irradiance", .image = result }),
                 NULL, 0, gpu_groups(view->width, VCT_LOCAL_2D),
                 gpu_groups(view->height, VCT_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}
