// A path tracer with next-event estimation (Kajiya 1986, "The Rendering Equation"): at each surface
// the punctual lights and a point on an emitter are asked for their light (gather.c), then a
// direction is sampled. What glows is found both ways, weighted by the power heuristic (Veach 1997,
// sec. 9.2.4). Chance ends paths by what they still carry (Arvo & Kirk 1990).
#include "trace/path.h"

#include "trace/gather.h"

#include "core/rng.h"

#include <math.h>

enum { FIRST_ROULETTE = 3 };                 // bounces that always happen
static const float MAX_SURVIVAL = 0.95f;     // so that every path ends, in a furnace too
static const float IRRADIANCE_SHARE = 0.25f; // of samples that go by the cosine at the surface seen
static const float STEP_THROUGH = 0x1p-20f;  // relative, beyond a surface that the eye does not see

// ---- the surface that the eye sees

static bool is_seen(const struct trace_scene *scene, const struct surface *s)
{
    return s->front || scene->meshes[s->mesh].material->double_sided;
}

static bool first_surface(const struct path_rules *rules, struct ray ray,
                          const struct pixel_footprint *footprint, struct surface *out,
                          uint64_t *rays)
{
    struct ray_hit hit;
    for (;;) {
        ++*rays;
        if (!embree_closest(rules->scene->embree, &ray, footprint, true, &hit)) return false;
        surface_at(rules->scene, &ray, &hit, footprint, out);
        if (is_seen(rules->scene, out)) return true;
        ray.near = nextafterf(hit.distance * (1.0f + STEP_THROUGH), INFINITY);
    }
}

static struct bsdf bsdf_at(const struct path_rules *rules, const struct surface *s, vec3s to_eye)
{
    return bsdf_of(s->normal, to_eye, s->albedo, s->metallic, s->roughness, rules->diffuse_only);
}

struct path_start path_begin(const struct path_rules *rules, const struct ray *ray,
                             const struct pixel_footprint *footprint, uint64_t *rays)
{
    struct path_start start = { .seen = rules->scene->lights.sky };
    start.hit = first_surface(rules, *ray, footprint, &start.surface, rays);
    if (start.hit) {
        vec3s to_eye = glms_vec3_normalize(glms_vec3_negate(ray->direction));
        start.bsdf = bsdf_at(rules, &start.surface, to_eye);
        bsdf_sample_evenly(&start.bsdf, IRRADIANCE_SHARE);
        if (rules->direct)
            start.seen =
                glms_vec3_add(start.surface.emission,
                              gather_all_punctual(rules->scene, &start.surface, &start.bsdf, rays));
    }
    if (!rules->direct) start.seen = vec3_of(0, 0, 0);
    return start;
}

// ---- the walk

// A step of the path and what it reflects of the light that will arrive along it.
struct step {
    struct ray ray;
    vec3s f;     // 1/sr
    float scale; // cosine / pdf, sr
    float pdf;   // 1/sr
};

// Radiance at the surface seen is `share` times what arrives along the first sampled direction;
// `carried` is what of it comes from further on. The two shares are the same light as seen by the
// eye and as irradiance.
struct walk {
    const struct path_rules *rules;
    struct path_sample *sample;
    uint64_t *rays;
    uint64_t key; // of its numbers
    struct surface surface;
    struct bsdf bsdf;
    struct step step;
    struct ray_hit hit;     // of the step
    bool met;               // there is a hit
    vec3s share;            // of the first step, for the eye
    float irradiance_share; // and for irradiance
    vec3s carried;          // of all later steps
    int depth;              // bounces so far
};

static void add_to(vec3s *sum, vec3s light)
{
    *sum = glms_vec3_add(*sum, light);
}

// Light reflected at a later surface towards where the walk came from.
static void collect(struct walk *w, vec3s light)
{
    vec3s arriving = glms_vec3_mul(w->carried, light);
    vec3s seen = glms_vec3_mul(w->share, arriving);
    vec3s falling = glms_vec3_scale(arriving, w->irradiance_share);
    add_to(&w->sample->light.indirect, seen);
    add_to(&w->sample->light.indirect_emitters_sky, seen);
    add_to(&w->sample->light.irradiance, falling);
    add_to(&w->sample->light.irradiance_emitters_sky, falling);
}

// Light straight from an emitter or the sky, at any surface.
static void collect_gathered(struct walk *w, const struct gathered *g)
{
    if (w->depth > 0) {
        collect(w, g->radiance);
    } else if (w->rules->direct) {
        add_to(&w->sample->light.direct, g->radiance);
        add_to(&w->sample->light.indirect_emitters_sky, g->radiance);
        add_to(&w->sample->light.irradiance_emitters_sky, g->irradiance);
    }
}

// What numbers are drawn for at each surface. They are independent, so that the spread of a pixel's
// samples says how far their mean is off; evenly spread ones (Owen-scrambled Sobol points) are off
// by a tenth less and can no longer tell.
enum draw { DRAW_CHOICES, DRAW_LIGHT, DRAW_STEP, DRAW_LATER, DRAW_COUNT };

// Words of SplitMix64, each in its place of the sequence that the sample's key begins.
static const uint64_t STRIDE = UINT64_C(0x9e3779b97f4a7c15);

static uint64_t key_of(const struct path_rules *rules, uint32_t pixel, uint32_t sample)
{
    return rng_mix(rng_mix((uint64_t)rules->seed << 32 | pixel) + sample);
}

vec2s path_place(const struct path_rules *rules, uint32_t pixel, uint32_t sample)
{
    return rng_pair(rng_mix(key_of(rules, pixel, sample)));
}

static vec2s draw(const struct walk *w, enum draw what)
{
    uint64_t number = (uint64_t)(DRAW_COUNT * w->depth + (int)what) + 1;
    return rng_pair(rng_mix(w->key + number * STRIDE));
}

static void ask_lights(struct walk *w, float choice)
{
    const struct trace_scene *scene = w->rules->scene;
    if (w->depth == 0 && !w->rules->direct) return;
    if (w->depth > 0 && scene->lights.punctual_count > 0)
        collect(w,
                gather_one_punctual(scene, &w->surface, &w->bsdf, draw(w, DRAW_LATER).x, w->rays));
    if (!scene->lights.has_emitters) return;
    struct gathered g =
        gather_one_emitter(scene, &w->surface, &w->bsdf, choice, draw(w, DRAW_LIGHT), w->rays);
    collect_gathered(w, &g);
}

static bool choose_step(struct walk *w, float choice)
{
    vec3s to_light = bsdf_sample(&w->bsdf, choice, draw(w, DRAW_STEP));
    float cosine = glms_vec3_dot(w->bsdf.normal, to_light);
    if (!(cosine > 0.0f) || !(glms_vec3_dot(w->surface.geometric, to_light) > 0.0f)) return false;
    struct reflection r = bsdf_reflect(&w->bsdf, to_light);
    if (!(r.pdf > 0.0f)) return false;
    struct ray ray = { surface_leave(&w->surface, to_light), to_light, 0.0f, INFINITY };
    w->step = (struct step){ .ray = ray, .f = r.f, .scale = cosine / r.pdf, .pdf = r.pdf };
    return true;
}

// The last surface of a path: only what its sampled direction meets still counts.
static bool is_last(const struct walk *w)
{
    return w->depth == (w->rules->indirect ? w->rules->bounces : 0);
}

// What lies at the surface, and where to go on from it; false where the path ends.
static bool leave(struct walk *w)
{
    const struct light_table *lights = &w->rules->scene->lights;
    vec2s choices = draw(w, DRAW_CHOICES);
    ask_lights(w, choices.x);
    if (is_last(w) && !lights->has_emitters && !lights->has_sky) return false;
    return choose_step(w, choices.y);
}

static void trace_step(struct walk *w)
{
    ++*w->rays;
    w->met = embree_closest(w->rules->scene->embree, &w->step.ray, NULL, false, &w->hit);
    if (w->met) surface_expect(w->rules->scene, &w->hit);
}

// Light that the step meets at its end: the sky, or what the surface there emits.
static vec3s met_light(const struct walk *w)
{
    const struct surface *end = &w->surface;
    if (!w->met) return w->rules->scene->lights.sky;
    if (gather_is_black(end->emission)) return end->emission;
    float cosine = -glms_vec3_dot(end->geometric, w->step.ray.direction);
    float other =
        light_emitter_pdf(w->rules->scene, end->mesh, end->triangle, w->hit.distance, cosine);
    return glms_vec3_scale(end->emission, gather_weight(w->step.pdf, other));
}

// Survives with a chance of what it carries, and carries the more.
static bool survives(struct walk *w)
{
    if (w->depth < FIRST_ROULETTE) return true;
    float choice = draw(w, DRAW_LATER).y;
    float most = glms_vec3_max(w->carried);
    float chance = fminf(most, MAX_SURVIVAL);
    if (!(choice < chance)) return false;
    w->carried = glms_vec3_scale(w->carried, 1.0f / chance);
    return true;
}

static void advance(struct walk *w)
{
    vec3s weight = glms_vec3_scale(w->step.f, w->step.scale);
    if (w->depth == 0) {
        w->share = weight;
        w->irradiance_share = w->step.scale;
    } else {
        w->carried = glms_vec3_mul(w->carried, weight);
    }
    w->depth++;
    w->bsdf = bsdf_at(w->rules, &w->surface, glms_vec3_negate(w->step.ray.direction));
}

// At the step's end; false where the path does.
static bool arrive(struct walk *w)
{
    bool last = is_last(w);
    if (w->met) surface_at(w->rules->scene, &w->step.ray, &w->hit, NULL, &w->surface);
    struct gathered g = gather_arriving(w->step.f, met_light(w), w->step.scale);
    collect_gathered(w, &g);
    if (last || !w->met) return false;
    advance(w);
    return survives(w);
}

// ---- many together

struct batch {
    struct walk walks[PATH_BATCH];
    struct walk *going[PATH_BATCH]; // those that have not ended
    int count;
};

static void keep_those(struct batch *batch, bool (*go_on)(struct walk *walk))
{
    int kept = 0;
    for (int i = 0; i < batch->count; i++)
        if (go_on(batch->going[i])) batch->going[kept++] = batch->going[i];
    batch->count = kept;
}

static void begin(struct batch *batch, const struct path_rules *rules, struct path_sample *sample,
                  uint64_t *rays)
{
    const struct path_start *start = sample->start;
    sample->light = (struct path_light){ .direct = start->seen };
    if (!start->hit) return;
    struct walk *w = batch->going[batch->count] = &batch->walks[batch->count];
    w->rules = rules;
    w->sample = sample;
    w->rays = rays;
    w->surface = start->surface;
    w->bsdf = start->bsdf;
    w->key = key_of(rules, sample->pixel, sample->sample);
    w->carried = vec3_of(1, 1, 1);
    w->depth = 0;
    batch->count++;
}

void path_trace(const struct path_rules *rules, struct path_sample *samples, int count,
                uint64_t *rays)
{
    struct batch batch;
    batch.count = 0;
    for (int i = 0; i < count; i++) begin(&batch, rules, &samples[i], rays);
    while (batch.count > 0) {
        keep_those(&batch, leave);
        for (int i = 0; i < batch.count; i++) trace_step(batch.going[i]);
        for (int i = 0; i < batch.count; i++)
            if (batch.going[i]->met) surface_expect_corners(rules->scene, &batch.going[i]->hit);
        for (int i = 0; i < batch.count; i++)
            if (batch.going[i]->met) surface_expect_texels(rules->scene, &batch.going[i]->hit);
        keep_those(&batch, arrive);
    }
}
