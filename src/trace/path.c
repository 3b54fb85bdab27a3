// A path tracer (Kajiya 1986, "The Rendering Equation") with next-event estimation of punctual
// lights, emitters and the environment (next_event.c) and BSDF sampling, combined by the power
// heuristic (Veach 1997, sec. 9.2.4). Russian roulette ends paths by their throughput (Arvo & Kirk
// 1990).
#include "trace/path.h"

#include "trace/next_event.h"

#include "core/rng.h"

#include <math.h>

enum { ROULETTE_DEPTH = 3 };             // bounces before Russian roulette
static const float MAX_SURVIVAL = 0.95f; // so that paths end in a furnace, too
// Guided paths of less than this share of the pixel's light end at random; each costs more, so
// that the noise of their ends matters more.
static const float GUIDED_DEATH = 0.5f;
static const float MIN_SURVIVAL = 0.1f;       // of them, where the guide expects little light
static const float DIFFUSE_SHARE = 0.25f;     // least share of diffuse samples at the primary hit
static const float BACK_FACE_STEP = 0x1p-20f; // relative step past a culled back face

// ---- primary hit

static bool is_visible_to_camera(const struct trace_scene *scene, const struct surface *s)
{
    return s->front || scene->meshes[s->mesh].material->double_sided;
}

static bool first_surface(const struct path_settings *settings, struct ray ray,
                          const struct pixel_footprint *footprint, struct surface *out,
                          uint64_t *rays)
{
    struct ray_hit hit;
    for (;;) {
        ++*rays;
        if (!embree_closest(settings->scene->embree, &ray, footprint, true, &hit)) return false;
        surface_at(settings->scene, &ray, &hit, footprint, out);
        if (is_visible_to_camera(settings->scene, out)) return true;
        float near = nextafterf(hit.distance * (1.0f + BACK_FACE_STEP), INFINITY);
        if (!(near > ray.near && near < ray.far)) return false; // so that the loop ends
        ray.near = near;
    }
}

struct path_start path_begin(const struct path_settings *settings, const struct ray *ray,
                             const struct pixel_footprint *footprint, uint64_t *rays)
{
    const struct environment *environment = &settings->scene->lights.environment;
    const vec3s to_viewer = glms_vec3_normalize(glms_vec3_negate(ray->direction));
    struct path_start start = { .radiance = environment_radiance(environment,
                                                                 glms_vec3_negate(to_viewer)) };
    start.hit = first_surface(settings, *ray, footprint, &start.surface, rays);
    if (start.hit) {
        start.bsdf = surface_bsdf(&start.surface, to_viewer, settings->diffuse_only);
        bsdf_reserve_diffuse_samples(&start.bsdf, DIFFUSE_SHARE);
        if (settings->direct && start.surface.unlit)
            start.radiance =
                glms_vec3_scale(start.surface.material.albedo, settings->scene->lights.unlit_white);
        else if (settings->direct)
            start.radiance = glms_vec3_add(
                start.surface.emission,
                next_event_all_punctual(settings->scene, &start.surface, &start.bsdf, rays));
    }
    if (!settings->direct) start.radiance = vec3_of(0, 0, 0);
    return start;
}

// ---- path state

// A sampled direction at a path vertex, with the BSDF of the light arriving along it.
struct step {
    struct ray ray;
    vec3s f;     // 1/sr
    float scale; // cosine / pdf, sr
    float pdf;   // 1/sr
};

// The throughput to the camera is first_weight · throughput, that to the irradiance at the primary
// hit is first_irradiance_weight · throughput.
struct path {
    const struct path_settings *settings;
    struct path_sample *sample;
    uint64_t *rays;
    uint64_t key; // of the random sequence
    struct surface surface;
    struct guided_bsdf bsdf;
    struct path_vertex *vertex; // record of the step; NULL: none
    vec3s next_event;           // reflected at this vertex, cd/m²
    struct step step;
    struct ray_hit hit;            // of the step
    bool has_hit;                  // the step hit a surface
    vec3s first_weight;            // f · cosine / pdf of the first step
    float first_irradiance_weight; // cosine / pdf of the first step, sr
    vec3s throughput;              // of all later steps
    vec3s later_throughput;        // of those after the second
    vec3s end_diffuse;             // diffuse lobe at the end of the first step, 1/sr
    vec3s second_f;                // BSDF of the second step, 1/sr
    float second_scale;            // cosine / pdf of it, sr
    float first_radiance;          // expected at the primary hit, cd/m²; 0: unknown
    int depth;                     // bounces so far
};

static void add_to(vec3s *sum, vec3s light)
{
    *sum = glms_vec3_add(*sum, light);
}

// Indirect light arriving at the primary hit, with the weights of its direction.
static void add_indirect(struct path *p, vec3s arriving, vec3s weight, float irradiance_weight)
{
    vec3s radiance = glms_vec3_mul(weight, arriving);
    vec3s irradiance = glms_vec3_scale(arriving, irradiance_weight);
    add_to(&p->sample->light.indirect, radiance);
    add_to(&p->sample->light.indirect_emitters_sky, radiance);
    add_to(&p->sample->light.irradiance, irradiance);
    add_to(&p->sample->light.irradiance_emitters_sky, irradiance);
}

// Light reflected by the surface at the end of the first step.
static void add_to_end(struct path *p, const struct arriving_light *g)
{
    struct path_end *end = p->sample->end;
    struct arriving_light there = *g;
    vec3s diffuse = p->bsdf.bsdf.diffuse;
    if (p->depth > 1) {
        there.irradiance = glms_vec3_scale(g->radiance, p->second_scale);
        there.radiance = glms_vec3_mul(p->second_f, there.irradiance);
        diffuse = p->end_diffuse;
    }
    there.radiance = glms_vec3_sub(there.radiance, glms_vec3_mul(diffuse, there.irradiance));
    add_to(&end->irradiance, glms_vec3_mul(p->later_throughput, there.irradiance));
    add_to(&end->rest, glms_vec3_mul(p->later_throughput, there.radiance));
}

// Light reflected at a secondary vertex back along the path.
static void add_reflected(struct path *p, const struct arriving_light *g)
{
    if (p->sample->end)
        add_to_end(p, g);
    else
        add_indirect(p, glms_vec3_mul(p->throughput, g->radiance), p->first_weight,
                     p->first_irradiance_weight);
}

// Light arriving directly from an emitter or the sky.
static void add_arriving(struct path *p, const struct arriving_light *g)
{
    if (p->depth > 0) {
        add_reflected(p, g);
    } else if (p->settings->direct) {
        add_to(&p->sample->light.direct, g->radiance);
        add_to(&p->sample->light.indirect_emitters_sky, g->radiance);
        add_to(&p->sample->light.irradiance_emitters_sky, g->irradiance);
    }
}

// Random dimensions per vertex. Samples of an image are independent, so that their variance gives
// the standard error of the mean. Sobol points at the primary hit have less variance, a tenth less
// error in an image and two fifths less variance in a light map; at later vertices they gain
// nothing.
enum dimension { DIM_CHOICES, DIM_LIGHT, DIM_STEP, DIM_LATER, DIM_COUNT };

// Increment of SplitMix64; the sample's key is its initial state.
static const uint64_t SPLITMIX_INCREMENT = UINT64_C(0x9e3779b97f4a7c15);

static uint64_t pixel_key(const struct path_settings *settings, uint32_t pixel)
{
    return rng_mix((uint64_t)settings->seed << 32 | pixel);
}

static uint64_t key_of(const struct path_settings *settings, uint32_t pixel, uint32_t sample)
{
    return rng_mix(pixel_key(settings, pixel) + sample);
}

vec2s path_subpixel(const struct path_settings *settings, uint32_t pixel, uint32_t sample)
{
    return rng_pair(rng_mix(key_of(settings, pixel, sample)));
}

static vec2s stratified_pair(const struct path *p, uint64_t number, uint32_t pixel, uint32_t sample)
{
    const uint64_t key = pixel_key(p->settings, pixel) + number * SPLITMIX_INCREMENT;
    return sobol_2d_padded(sample, (uint32_t)rng_mix(key) | 1u);
}

static vec2s numbered_pair(const struct path *p, uint64_t number)
{
    if (p->settings->stratified && p->depth == 0)
        return stratified_pair(p, number, p->sample->pixel, p->sample->sample);
    return rng_pair(rng_mix(p->key + number * SPLITMIX_INCREMENT));
}

static vec2s random_pair(const struct path *p, enum dimension dimension)
{
    return numbered_pair(p, (uint64_t)(DIM_COUNT * p->depth + (int)dimension) + 1);
}

static vec2s random_step(const struct path *p)
{
    const struct path_end *end = p->sample->end;
    if (end && p->settings->stratified && p->depth == 0)
        return stratified_pair(p, DIM_STEP + 1, end->pixel, end->sample);
    return random_pair(p, DIM_STEP);
}

// A dimension beside the others, whose numbers do not depend on whether there is a map.
static vec2s random_direction_pair(const struct path *p)
{
    return numbered_pair(p, (UINT64_C(1) << 32) + (uint64_t)p->depth);
}

// Light found at the end of the recorded step.
static void record_light(struct path *p, vec3s light)
{
    if (p->vertex) add_to(&p->vertex->light, light);
}

static void record_next_event(struct path *p, vec3s light)
{
    add_to(&p->next_event, light);
    if (p->depth > 0) record_light(p, light);
}

// At a later hit.
static void sample_punctual(struct path *p)
{
    const struct path_settings *settings = p->settings;
    const struct bsdf *bsdf = &p->bsdf.bsdf;
    struct bsdf wide;
    if (p->surface.material.roughness < settings->min_punctual_roughness) {
        struct surface rough = p->surface;
        rough.material.roughness = settings->min_punctual_roughness;
        wide = surface_bsdf(&rough, bsdf->to_viewer, settings->diffuse_only);
        bsdf = &wide;
    }
    const struct arriving_light g = next_event_one_punctual(settings->scene, &p->surface, bsdf,
                                                            random_pair(p, DIM_LATER).x, p->rays);
    record_next_event(p, g.radiance);
    add_reflected(p, &g);
}

static void sample_lights(struct path *p, float choice)
{
    const struct trace_scene *scene = p->settings->scene;
    if (p->depth == 0 && !p->settings->direct) return;
    const float directions = p->depth == 0 && p->sample->end ? p->sample->end->directions : 1.0f;
    if (p->depth > 0 && scene->lights.punctual_count > 0) sample_punctual(p);
    if (environment_table_has_light(&scene->lights.environment_table)) {
        struct arriving_light g = next_event_environment(
            scene, &p->surface, &p->bsdf, random_direction_pair(p), directions, p->rays);
        record_next_event(p, g.radiance);
        add_arriving(p, &g);
    }
    if (!scene->lights.has_emitters) return;
    struct arriving_light g = next_event_one_emitter(
        scene, &p->surface, &p->bsdf, choice, random_pair(p, DIM_LIGHT), directions, p->rays);
    record_next_event(p, g.radiance);
    add_arriving(p, &g);
}

// The last vertex: the sampled direction only adds the emission it hits.
static bool is_last(const struct path *p)
{
    return p->depth == (p->settings->indirect ? p->settings->bounces : 0);
}

// ---- steps

// False at the end of the trail.
static bool record_vertex(struct path *p)
{
    struct path_trail *trail = p->sample->trail;
    if (!trail) return true;
    if (trail->count == PATH_TRAIL) return false;
    vec3s throughput = p->throughput;
    if (p->depth > 0) throughput = glms_vec3_mul(throughput, p->first_weight);
    p->vertex = &trail->vertices[trail->count++];
    *p->vertex = (struct path_vertex){ .position = p->surface.position,
                                       .normal = p->bsdf.bsdf.normal,
                                       .throughput = luminance(throughput),
                                       .direct = p->next_event,
                                       .share = guided_share(&p->bsdf.bsdf, 1.0f) };
    return true;
}

static void record_step(struct path *p, float cosine, float bsdf_pdf)
{
    if (!p->vertex) return;
    p->vertex->direction = p->step.ray.direction;
    p->vertex->cosine = cosine;
    p->vertex->f = p->step.f;
    p->vertex->bsdf_pdf = bsdf_pdf;
    p->vertex->pdf = p->step.pdf;
}

static bool sample_direction(struct path *p, float choice)
{
    const struct bsdf *bsdf = &p->bsdf.bsdf;
    vec3s to_light = guided_sample(&p->bsdf, choice, random_step(p));
    float cosine = glms_vec3_dot(bsdf->normal, to_light);
    if (!(cosine > 0.0f) || !(glms_vec3_dot(p->surface.geometric, to_light) > 0.0f)) return false;
    struct reflection r = bsdf_reflect(bsdf, to_light);
    float pdf = guided_pdf(&p->bsdf, to_light, r.pdf);
    if (!(pdf > 0.0f)) return false;
    struct ray ray = { surface_leave(&p->surface, to_light), to_light, 0.0f, INFINITY };
    p->step = (struct step){ .ray = ray, .f = r.f, .scale = cosine / pdf, .pdf = pdf };
    record_step(p, cosine, r.pdf);
    return true;
}

// Samples lights and the next direction; false where the path ends.
static bool sample_vertex(struct path *p)
{
    const struct light_table *lights = &p->settings->scene->lights;
    vec2s choices = random_pair(p, DIM_CHOICES);
    p->next_event = vec3_of(0, 0, 0);
    sample_lights(p, choices.x);
    if (is_last(p) && !lights->has_emitters && !lights->has_sky) return false;
    return record_vertex(p) && sample_direction(p, choices.y);
}

static void trace_step(struct path *p)
{
    ++*p->rays;
    p->has_hit = embree_closest(p->settings->scene->embree, &p->step.ray, NULL, false, &p->hit);
    trace_watch(p->settings->scene, &p->step.ray, p->has_hit ? p->hit.distance : INFINITY);
    if (p->has_hit) surface_prefetch(p->settings->scene, &p->hit);
}

vec3s path_environment(const struct trace_scene *scene, vec3s direction, float pdf)
{
    const struct light_table *lights = &scene->lights;
    const struct environment *environment = &lights->environment;
    if (!environment->map) return environment->sky;
    const float other = environment_pdf(&lights->environment_table, environment, direction);
    return glms_vec3_muladds(environment_map_light(environment, direction),
                             power_heuristic(pdf, other), environment->sky);
}

// Radiance of the environment or emitter at the end of the step, weighted against next-event
// estimation.
static vec3s hit_radiance(const struct path *p)
{
    const struct surface *end = &p->surface;
    if (!p->has_hit)
        return path_environment(p->settings->scene, p->step.ray.direction, p->step.pdf);
    if (is_black(end->emission)) return end->emission;
    float cosine = -glms_vec3_dot(end->geometric, p->step.ray.direction);
    float other =
        light_emitter_pdf(p->settings->scene, end->mesh, end->triangle, p->hit.distance, cosine);
    return glms_vec3_scale(end->emission, power_heuristic(p->step.pdf, other));
}

// The probability to go on: the throughput; with a guide, the share of the pixel's light that the
// path still carries, by the estimates of what leaves both surfaces, over GUIDED_DEATH.
static float survival(const struct path *p)
{
    float largest = glms_vec3_max(p->throughput);
    if (!p->bsdf.cell) return fminf(largest, MAX_SURVIVAL);
    if (!(p->first_radiance > 0.0f)) return fminf(largest / GUIDED_DEATH, MAX_SURVIVAL);
    float throughput = luminance(glms_vec3_mul(p->first_weight, p->throughput));
    float share = throughput * p->bsdf.cell->radiance / p->first_radiance;
    return fminf(fmaxf(share, MIN_SURVIVAL) / GUIDED_DEATH, MAX_SURVIVAL);
}

// Russian roulette; the survivor's throughput is divided by its probability.
static bool survives(struct path *p)
{
    if (p->depth < ROULETTE_DEPTH || p->sample->trail) return true;
    float choice = random_pair(p, DIM_LATER).y;
    float probability = survival(p);
    if (!(choice < probability)) return false;
    p->throughput = glms_vec3_scale(p->throughput, 1.0f / probability);
    p->later_throughput = glms_vec3_scale(p->later_throughput, 1.0f / probability);
    return true;
}

static void advance(struct path *p)
{
    vec3s weight = glms_vec3_scale(p->step.f, p->step.scale);
    if (p->depth == 0) {
        p->first_weight = weight;
        p->first_irradiance_weight = p->step.scale;
    } else {
        p->throughput = glms_vec3_mul(p->throughput, weight);
        if (p->depth == 1) {
            p->second_f = p->step.f;
            p->second_scale = p->step.scale;
            p->end_diffuse = p->bsdf.bsdf.diffuse;
        } else {
            p->later_throughput = glms_vec3_mul(p->later_throughput, weight);
        }
    }
    p->depth++;
    struct bsdf bsdf = surface_bsdf(&p->surface, glms_vec3_negate(p->step.ray.direction),
                                    p->settings->diffuse_only);
    p->bsdf = guided_bsdf_of(&bsdf, p->settings->guide, p->surface.position);
}

static void begin_end(const struct path *p)
{
    struct path_end *end = p->sample->end;
    end->sampled = true;
    end->hit = p->has_hit;
    end->direction = p->step.ray.direction;
    if (p->has_hit) end->surface = p->surface;
}

static void add_light_of_step(struct path *p)
{
    if (p->depth == 0 && p->sample->end) {
        begin_end(p);
        return;
    }
    vec3s light = hit_radiance(p);
    if (p->depth > 0 || p->settings->direct) record_light(p, light);
    struct arriving_light g = light_arriving(p->step.f, light, p->step.scale);
    add_arriving(p, &g);
}

// Moves to the end of the step; false where the path ends.
static bool arrive(struct path *p)
{
    bool last = is_last(p);
    if (p->has_hit) surface_at(p->settings->scene, &p->step.ray, &p->hit, NULL, &p->surface);
    add_light_of_step(p);
    if (last || !p->has_hit) return false;
    advance(p);
    return survives(p);
}

// ---- batches

struct batch {
    struct path paths[PATH_BATCH];
    struct path *active[PATH_BATCH]; // paths that have not ended
    int count;
};

static void keep_active(struct batch *batch, bool (*continues)(struct path *path))
{
    int kept = 0;
    for (int i = 0; i < batch->count; i++)
        if (continues(batch->active[i])) batch->active[kept++] = batch->active[i];
    batch->count = kept;
}

static void begin(struct batch *batch, const struct path_settings *settings,
                  struct path_sample *sample, uint64_t *rays)
{
    const struct path_start *start = sample->start;
    sample->light = (struct path_light){ .direct = start->radiance };
    if (sample->end) {
        sample->end->sampled = false;
        sample->end->irradiance = sample->end->rest = vec3_of(0, 0, 0);
    }
    if (!start->hit || start->surface.unlit) return;
    struct path *p = batch->active[batch->count] = &batch->paths[batch->count];
    p->settings = settings;
    p->sample = sample;
    p->rays = rays;
    p->surface = start->surface;
    p->bsdf = guided_bsdf_of(&start->bsdf, settings->guide, start->surface.position);
    p->first_radiance = p->bsdf.cell ? p->bsdf.cell->radiance : 0.0f;
    p->vertex = NULL;
    p->key = key_of(settings, sample->pixel, sample->sample);
    p->throughput = p->later_throughput = vec3_of(1, 1, 1);
    p->depth = 0;
    batch->count++;
}

void path_trace(const struct path_settings *settings, struct path_sample *samples, int count,
                uint64_t *rays)
{
    struct batch batch;
    batch.count = 0;
    for (int i = 0; i < count; i++) begin(&batch, settings, &samples[i], rays);
    while (batch.count > 0) {
        keep_active(&batch, sample_vertex);
        for (int i = 0; i < batch.count; i++) trace_step(batch.active[i]);
        for (int i = 0; i < batch.count; i++)
            if (batch.active[i]->has_hit)
                surface_prefetch_corners(settings->scene, &batch.active[i]->hit);
        for (int i = 0; i < batch.count; i++)
            if (batch.active[i]->has_hit)
                surface_prefetch_texels(settings->scene, &batch.active[i]->hit);
        keep_active(&batch, arrive);
    }
}
