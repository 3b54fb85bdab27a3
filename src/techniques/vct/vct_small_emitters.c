// A group is represented by a point for each of its parts: see cones/small_emitters.glsl.
#include "techniques/vct/vct_small_emitters.h"

#include "core/rng.h"
#include "frame/scene/scene_gpu.h"

#include <math.h>

// Largest extent, as a fraction of the scene's. Cones sample larger emitters well, and from nearby
// better than points do.
static const float LARGEST = 0.25f;

static double flux_of(const struct frame_view *view, int light)
{
    const vec3s flux = view->emitters[light].flux;
    return (double)flux.x + (double)flux.y + (double)flux.z;
}

// ---- Selection, once per scene ------------------------------------------------------------------

static float largest_extent(const struct frame_view *view)
{
    return LARGEST * glms_vec3_norm(box3_size(view->bounds));
}

static bool fits(const struct frame_view *view, const struct scene_draw *draw)
{
    return glms_vec3_norm(box3_size(draw->bounds)) <= largest_extent(view);
}

// The voxels of a draw are sampled all or none: most of its flux is from small connected parts.
static bool is_small_emitter(const struct frame_view *view, const struct scene_draw *draw)
{
    const vec3s e = view->pose->scene->materials[draw->material].emissive;
    if (!(fmaxf(e.x, fmaxf(e.y, e.z)) > 0.0f) || draw->variant & VARIANT_MASKED) return false;
    double small = 0.0, all = 0.0;
    for (int i = 0; i < view->emitter_count; i++) {
        const struct frame_emitter_origin *origin = &view->emitter_origins[i];
        if (origin->instance != draw->instance) continue;
        all += flux_of(view, i);
        if (fits(view, draw) || origin->part_extent_m <= largest_extent(view))
            small += flux_of(view, i);
    }
    return all > 0.0 && small > 0.5 * all;
}

static void choose_draws(struct vct_small_emitters *s, const struct frame_view *view)
{
    s->draw_count = 0;
    for (int i = 0; i < view->scene->draw_count && s->draw_count < VCT_MAX_EMITTER_LIGHTS; i++)
        if (is_small_emitter(view, &view->scene->draws[i])) s->draws[s->draw_count++] = i;
}

// ---- Groups, once per scene and after changes of the frame's lights -----------------------------

// Lights of the front sides; the points of double-sided surfaces emit to both sides. Lights of a
// small draw that face one way have one key: a surface takes points of those that face it.
static void add_lights(struct vct_small_emitters *s, const struct frame_view *view,
                       const struct scene_draw *draw)
{
    const int first = s->light_count;
    vec3s sum[VCT_LIGHT_SIDES] = { 0 };
    float count[VCT_LIGHT_SIDES] = { 0 };
    for (int i = 0; i < view->emitter_count && s->light_count < VCT_MAX_EMITTER_LIGHTS; i++) {
        const double flux = flux_of(view, i);
        if (view->emitter_origins[i].instance != draw->instance || view->emitter_origins[i].back ||
            !(flux > 0.0))
            continue;
        const vec3s at = view->emitters[i].position;
        const int side = vct_light_side(view->emitters[i].normal);
        s->lights[s->light_count++] = (struct vct_light){ at, at, flux, i };
        sum[side] = glms_vec3_add(sum[side], at);
        count[side] += 1.0f;
    }
    if (!fits(view, draw)) return;
    for (int i = first; i < s->light_count; i++) {
        const int side = vct_light_side(view->emitters[s->lights[i].index].normal);
        s->lights[i].key = glms_vec3_scale(sum[side], 1.0f / count[side]);
    }
}

// The light at `flux` of the group's flux, in order; *before: flux of the lights before `at`.
static int light_at(const struct vct_light *lights, int count, double flux, int at, double *before)
{
    while (at + 1 < count && *before + lights[at].flux < flux) *before += lights[at++].flux;
    return at;
}

static int middle_of(const struct vct_light *lights, int first, int last)
{
    vec3s sum = vec3_of(0, 0, 0);
    double flux = 0.0;
    for (int i = first; i <= last; i++) {
        sum = glms_vec3_muladds(lights[i].position, (float)lights[i].flux, sum);
        flux += lights[i].flux;
    }
    const vec3s centroid = glms_vec3_scale(sum, (float)(1.0 / flux));
    int middle = first;
    float least = INFINITY;
    for (int i = first; i <= last; i++) {
        const float distance = glms_vec3_distance2(lights[i].position, centroid);
        if (distance < least) middle = i;
        least = fminf(least, distance);
    }
    return middle;
}

static double group_flux(const struct vct_light *lights, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) sum += lights[i].flux;
    return sum;
}

static void find_middles(const struct vct_light *lights, int count, int middles[VCT_EMITTER_POINTS])
{
    const double part = group_flux(lights, count) / VCT_EMITTER_POINTS;
    double before = 0.0;
    for (int k = 0, at = 0; k < VCT_EMITTER_POINTS; k++) {
        const int first = at;
        at = light_at(lights, count, (k + 1) * part, at, &before);
        middles[k] = middle_of(lights, first, at);
    }
}

static void make_groups(struct vct_small_emitters *s, const struct frame_view *view)
{
    s->light_count = 0;
    for (int i = 0; i < s->draw_count; i++) add_lights(s, view, &view->scene->draws[s->draws[i]]);
    s->count = vct_group_lights(s->lights, s->light_count, VCT_MAX_SMALL_EMITTERS, s->groups);
    for (int i = 0; i < s->count; i++)
        find_middles(s->lights + s->groups[i].first, s->groups[i].count, s->middles[i]);
    for (int i = 0; i < s->light_count; i++)
        s->instances[i] = view->emitter_origins[s->lights[i].index].instance;
}

// The frame has the same lights at other places. False: it has allocated them to other surfaces.
static bool update_lights(struct vct_small_emitters *s, const struct frame_view *view)
{
    for (int i = 0; i < s->light_count; i++) {
        struct vct_light *light = &s->lights[i];
        if (light->index >= view->emitter_count ||
            view->emitter_origins[light->index].instance != s->instances[i])
            return false;
        light->flux = flux_of(view, light->index);
    }
    return true;
}

// ---- Sample points, each frame ------------------------------------------------------------------

// flux: of the part of the group.
static void place_point(struct vct_small_emitter *emitter, int point, const struct frame_view *view,
                        const struct vct_light *light, double flux)
{
    const struct frame_emitter *from = &view->emitters[light->index];
    const int instance = view->emitter_origins[light->index].instance;
    const struct scene *scene = view->pose->scene;
    const int material = scene_mesh_of(scene, instance)->material;
    emitter->positions[point] = from->position;
    emitter->normals[point] = from->normal;
    emitter->intensities[point] =
        glms_vec3_scale(from->flux, (float)(flux / (light->flux * GLM_PI)));
    if (scene->materials[material].double_sided) emitter->both_sides |= 1u << point;
}

static void place_points(struct vct_small_emitter *emitter, const struct vct_light *lights,
                         const struct vct_emitter_group *group,
                         const int middles[VCT_EMITTER_POINTS], const struct frame_view *view,
                         uint32_t frame)
{
    const struct vct_light *first = lights + group->first;
    const double part = group_flux(first, group->count) / VCT_EMITTER_POINTS;
    double area = 0.0, before = 0.0;
    for (int i = 0; i < group->count; i++)
        area += (double)view->emitter_origins[first[i].index].area_m2;
    *emitter = (struct vct_small_emitter){ .area_m2 = (float)(area / VCT_EMITTER_POINTS) };
    for (int k = 0, at = 0; k < VCT_EMITTER_POINTS; k++) {
        const float within = r2_sequence(frame * VCT_EMITTER_POINTS + (uint32_t)k).x;
        at = light_at(first, group->count, (k + (double)within) * part, at, &before);
        place_point(emitter, k, view, &first[frame == 0 ? middles[k] : at], part);
    }
}

void vct_small_emitters_update(struct vct_small_emitters *s, const struct frame_view *view,
                               uint32_t frame)
{
    const bool chosen = s->chosen;
    if (!chosen) choose_draws(s, view);
    if (!chosen || !update_lights(s, view)) make_groups(s, view);
    s->chosen = true;
    for (int i = 0; i < s->count; i++)
        place_points(&s->list[i], s->lights, &s->groups[i], s->middles[i], view, frame);
}

bool vct_small_emitters_have(const struct vct_small_emitters *s, int draw)
{
    int low = 0, high = s->count > 0 ? s->draw_count : 0;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (s->draws[middle] == draw) return true;
        if (s->draws[middle] < draw)
            low = middle + 1;
        else
            high = middle;
    }
    return false;
}
