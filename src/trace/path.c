// A path tracer (Kajiya 1986, "The Rendering Equation") with next-event estimation of punctual
// lights and emitters (next_event.c) and BSDF sampling, combined by the power heuristic (Veach
// 1997, sec. 9.2.4). Russian roulette ends paths by their throughput (Arvo & Kirk 1990).
#include "trace/path.h"

#include "trace/next_event.h"

#include "core/rng.h"

#include <math.h>

enum { ROULETTE_DEPTH = 3 };                  // bounces before Russian roulette
static const float MAX_SURVIVAL = 0.95f;      // so that paths end in a furnace, too
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
        ray.near = nextafterf(hit.distance * (1.0f + BACK_FACE_STEP), INFINITY);
    }
}

struct path_start path_begin(const struct path_settings *settings, const struct ray *ray,
                             const struct pixel_footprint *footprint, uint64_t *rays)
{
    struct path_start start = { .radiance = settings->scene->lights.sky };
    start.hit = first_surface(settings, *ray, footprint, &start.surface, rays);
    if (start.hit) {
        vec3s to_viewer = glms_vec3_normalize(glms_vec3_negate(ray->direction));
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
    struct bsdf bsdf;
    const struct guide_cell *cell; // NULL: no guided rays
    struct path_vertex *vertex;    // record of the step; NULL: none
    struct step step;
    float near_weight;             // of the step's near light, against guided rays
    struct ray_hit hit;            // of the step
    bool has_hit;                  // the step hit a surface
    vec3s first_weight;            // f · cosine / pdf of the first step
    float first_irradiance_weight; // cosine / pdf of the first step, sr
    vec3s throughput;              // of all later steps
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

// Radiance reflected at a secondary vertex back along the path.
static void add_reflected(struct path *p, vec3s light)
{
    add_indirect(p, glms_vec3_mul(p->throughput, light), p->first_weight,
                 p->first_irradiance_weight);
}

// Light arriving directly from an emitter or the sky.
static void add_arriving(struct path *p, const struct arriving_light *g)
{
    if (p->depth > 0) {
        add_reflected(p, g->radiance);
    } else if (p->settings->direct) {
        add_to(&p->sample->light.direct, g->radiance);
        add_to(&p->sample->light.indirect_emitters_sky, g->radiance);
        add_to(&p->sample->light.irradiance_emitters_sky, g->irradiance);
    }
}

// Random dimensions per vertex. Samples are independent, so that their variance gives the standard
// error of the mean; Owen-scrambled Sobol points have a tenth less error but no such estimate.
enum dimension { DIM_CHOICES, DIM_LIGHT, DIM_STEP, DIM_LATER, DIM_COUNT };
// Guided rays have random numbers of their own, so that paths are the same without them.
static const uint64_t GUIDE_KEY = UINT64_C(0x6775696465642072);

// Increment of SplitMix64; the sample's key is its initial state.
static const uint64_t SPLITMIX_INCREMENT = UINT64_C(0x9e3779b97f4a7c15);

static uint64_t key_of(const struct path_settings *settings, uint32_t pixel, uint32_t sample)
{
    return rng_mix(rng_mix((uint64_t)settings->seed << 32 | pixel) + sample);
}

vec2s path_subpixel(const struct path_settings *settings, uint32_t pixel, uint32_t sample)
{
    return rng_pair(rng_mix(key_of(settings, pixel, sample)));
}

static vec2s random_of_key(const struct path *p, uint64_t key, enum dimension dimension)
{
    uint64_t number = (uint64_t)(DIM_COUNT * p->depth + (int)dimension) + 1;
    return rng_pair(rng_mix(key + number * SPLITMIX_INCREMENT));
}

static vec2s random_pair(const struct path *p, enum dimension dimension)
{
    return random_of_key(p, p->key, dimension);
}

static void sample_lights(struct path *p, float choice)
{
    const struct trace_scene *scene = p->settings->scene;
    if (p->depth == 0 && !p->settings->direct) return;
    if (p->depth > 0 && scene->lights.punctual_count > 0) {
        vec3s light = next_event_one_punctual(scene, &p->surface, &p->bsdf,
                                              random_pair(p, DIM_LATER).x, p->rays);
        if (p->vertex) p->vertex->found[PATH_BSDF].light = light;
        add_reflected(p, glms_vec3_scale(light, p->near_weight));
    }
    if (!scene->lights.has_emitters) return;
    struct arriving_light g = next_event_one_emitter(scene, &p->surface, &p->bsdf, choice,
                                                     random_pair(p, DIM_LIGHT), p->rays);
    add_arriving(p, &g);
}

// The last vertex: the sampled direction only adds the emission it hits.
static bool is_last(const struct path *p)
{
    return p->depth == (p->settings->indirect ? p->settings->bounces : 0);
}

// ---- guided rays

static void record_vertex(struct path *p)
{
    struct path_trail *trail = p->sample->trail;
    p->vertex = NULL;
    if (!trail || trail->count == PATH_TRAIL) return;
    vec3s throughput = p->throughput;
    if (p->depth > 0) throughput = glms_vec3_mul(throughput, p->first_weight);
    p->vertex = &trail->vertices[trail->count++];
    *p->vertex = (struct path_vertex){ .position = p->surface.position,
                                       .normal = p->bsdf.normal,
                                       .throughput = luminance(throughput) };
}

static void record_sample(struct path *p, enum path_technique technique, vec3s direction,
                          const struct reflection *r, float guide_pdf)
{
    if (!p->vertex) return;
    p->vertex->found[technique] = (struct path_found){
        .direction = direction,
        .cosine = glms_vec3_dot(p->bsdf.normal, direction),
        .f = r->f,
        .bsdf_pdf = r->pdf,
        .pdf = r->pdf + guide_pdf,
    };
}

static bool counts_sky(const struct path *p)
{
    return p->depth > 0 || p->settings->direct;
}

static void add_near(struct path *p, const struct near_light *light, vec3s f, float scale)
{
    if (light->sky) {
        struct arriving_light g = light_arriving(f, light->radiance, scale);
        add_arriving(p, &g);
    } else if (p->depth > 0) {
        add_reflected(p, glms_vec3_mul(glms_vec3_scale(f, scale), light->radiance));
    } else {
        add_indirect(p, light->radiance, glms_vec3_scale(f, scale), scale);
    }
}

// A second ray from the vertex for near light, weighted against BSDF sampling.
static void sample_guide(struct path *p)
{
    if (!p->cell) return;
    uint64_t key = rng_mix(p->key ^ GUIDE_KEY);
    vec3s to_light = guide_sample(p->cell, random_of_key(p, key, DIM_STEP));
    float cosine = glms_vec3_dot(p->bsdf.normal, to_light), pdf = guide_pdf(p->cell, to_light);
    if (!(cosine > 0.0f) || !(glms_vec3_dot(p->surface.geometric, to_light) > 0.0f) ||
        !(pdf > 0.0f))
        return;
    struct reflection r = bsdf_reflect(&p->bsdf, to_light);
    const struct near_query query = {
        .ray = { surface_leave(&p->surface, to_light), to_light, 0.0f, INFINITY },
        .sky = counts_sky(p),
        .reflected = !is_last(p),
        .diffuse_only = p->settings->diffuse_only,
        .choice = random_of_key(p, key, DIM_LATER).x,
    };
    struct near_light light = next_event_near(p->settings->scene, &query, p->rays);
    record_sample(p, PATH_GUIDE, to_light, &r, pdf);
    if (p->vertex) p->vertex->found[PATH_GUIDE].light = light.radiance;
    add_near(p, &light, r.f, cosine / pdf * power_heuristic(pdf, r.pdf));
}

static void weigh_near(struct path *p, const struct reflection *r)
{
    float pdf = p->cell ? guide_pdf(p->cell, p->step.ray.direction) : 0.0f;
    p->near_weight = power_heuristic(r->pdf, pdf);
    record_sample(p, PATH_BSDF, p->step.ray.direction, r, pdf);
}

// ---- steps

static bool sample_direction(struct path *p, float choice)
{
    vec3s to_light = bsdf_sample(&p->bsdf, choice, random_pair(p, DIM_STEP));
    float cosine = glms_vec3_dot(p->bsdf.normal, to_light);
    if (!(cosine > 0.0f) || !(glms_vec3_dot(p->surface.geometric, to_light) > 0.0f)) return false;
    struct reflection r = bsdf_reflect(&p->bsdf, to_light);
    if (!(r.pdf > 0.0f)) return false;
    struct ray ray = { surface_leave(&p->surface, to_light), to_light, 0.0f, INFINITY };
    p->step = (struct step){ .ray = ray, .f = r.f, .scale = cosine / r.pdf, .pdf = r.pdf };
    weigh_near(p, &r);
    return true;
}

// Samples lights and the next direction; false where the path ends.
static bool sample_vertex(struct path *p)
{
    const struct light_table *lights = &p->settings->scene->lights;
    vec2s choices = random_pair(p, DIM_CHOICES);
    sample_lights(p, choices.x);
    if (is_last(p) && !lights->has_emitters && !lights->has_sky) return false;
    record_vertex(p);
    sample_guide(p);
    return sample_direction(p, choices.y);
}

static void trace_step(struct path *p)
{
    ++*p->rays;
    p->has_hit = embree_closest(p->settings->scene->embree, &p->step.ray, NULL, false, &p->hit);
    if (p->has_hit) surface_prefetch(p->settings->scene, &p->hit);
}

// Radiance of the sky or emitter at the end of the step, weighted against next-event estimation.
static vec3s hit_radiance(const struct path *p)
{
    const struct surface *end = &p->surface;
    if (!p->has_hit) return glms_vec3_scale(p->settings->scene->lights.sky, p->near_weight);
    if (is_black(end->emission)) return end->emission;
    float cosine = -glms_vec3_dot(end->geometric, p->step.ray.direction);
    float other =
        light_emitter_pdf(p->settings->scene, end->mesh, end->triangle, p->hit.distance, cosine);
    return glms_vec3_scale(end->emission, power_heuristic(p->step.pdf, other));
}

// Russian roulette; the survivor's throughput is divided by its probability.
static bool survives(struct path *p)
{
    if (p->depth < ROULETTE_DEPTH || p->sample->trail) return true;
    float choice = random_pair(p, DIM_LATER).y;
    float largest = glms_vec3_max(p->throughput);
    float probability = fminf(largest, MAX_SURVIVAL);
    if (!(choice < probability)) return false;
    p->throughput = glms_vec3_scale(p->throughput, 1.0f / probability);
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
    }
    p->depth++;
    p->bsdf = surface_bsdf(&p->surface, glms_vec3_negate(p->step.ray.direction),
                           p->settings->diffuse_only);
    p->cell = guide_find(p->settings->guide, p->surface.position, p->bsdf.normal);
}

// Moves to the end of the step; false where the path ends.
static bool arrive(struct path *p)
{
    bool last = is_last(p);
    if (p->has_hit) surface_at(p->settings->scene, &p->step.ray, &p->hit, NULL, &p->surface);
    if (p->vertex && !p->has_hit && counts_sky(p))
        p->vertex->found[PATH_BSDF].light = p->settings->scene->lights.sky;
    struct arriving_light g = light_arriving(p->step.f, hit_radiance(p), p->step.scale);
    add_arriving(p, &g);
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

static void keep_active(struct batch *batch, bool (*go_on)(struct path *path))
{
    int kept = 0;
    for (int i = 0; i < batch->count; i++)
        if (go_on(batch->active[i])) batch->active[kept++] = batch->active[i];
    batch->count = kept;
}

static void begin(struct batch *batch, const struct path_settings *settings,
                  struct path_sample *sample, uint64_t *rays)
{
    const struct path_start *start = sample->start;
    sample->light = (struct path_light){ .direct = start->radiance };
    if (!start->hit || start->surface.unlit) return;
    struct path *p = batch->active[batch->count] = &batch->paths[batch->count];
    p->settings = settings;
    p->sample = sample;
    p->rays = rays;
    p->surface = start->surface;
    p->bsdf = start->bsdf;
    p->cell = guide_find(settings->guide, start->surface.position, start->bsdf.normal);
    p->vertex = NULL;
    p->key = key_of(settings, sample->pixel, sample->sample);
    p->throughput = vec3_of(1, 1, 1);
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
