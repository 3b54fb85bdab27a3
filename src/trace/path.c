// A path tracer with next-event estimation (Kajiya 1986, "The Rendering Equation"): at each surface
// the punctual lights and a point on an emitter are asked for their light, then a direction is
// sampled. What glows is found both ways, weighted by the power heuristic (Veach 1997, sec. 9.2.4).
// Chance ends paths by what they still carry (Arvo & Kirk 1990).
#include "trace/path.h"

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
        *out = surface_at(rules->scene, &ray, &hit, footprint);
        if (is_seen(rules->scene, out)) return true;
        ray.near = nextafterf(hit.distance * (1.0f + STEP_THROUGH), INFINITY);
    }
}

static bool is_black(vec3s v)
{
    return !(v.x > 0.0f || v.y > 0.0f || v.z > 0.0f);
}

// The light of a punctual light that a surface would reflect, were nothing between; 0 where it
// faces away.
static vec3s reflected(const struct surface *s, const struct bsdf *b,
                       const struct punctual_light *p)
{
    float cosine = glms_vec3_dot(b->normal, p->to_light);
    if (!(cosine > 0.0f) || !(glms_vec3_dot(s->geometric, p->to_light) > 0.0f))
        return vec3_of(0, 0, 0);
    vec3s f = bsdf_reflect(b, p->to_light).f;
    return glms_vec3_scale(glms_vec3_mul(f, p->illuminance), cosine);
}

static bool is_visible(const struct trace_scene *scene, const struct surface *s,
                       const struct punctual_light *p, uint64_t *rays)
{
    struct ray ray = { surface_leave(s, p->to_light), p->to_light, 0.0f, p->distance_m };
    ++*rays;
    return !embree_occluded(scene->embree, &ray);
}

static vec3s all_punctual(const struct path_rules *rules, const struct path_start *start,
                          uint64_t *rays)
{
    const struct light_table *lights = &rules->scene->lights;
    vec3s sum = vec3_of(0, 0, 0);
    for (int i = 0; i < lights->punctual_count; i++) {
        struct punctual_light p = light_punctual(&lights->punctual[i], start->surface.position);
        vec3s light = reflected(&start->surface, &start->bsdf, &p);
        if (!is_black(light) && is_visible(rules->scene, &start->surface, &p, rays))
            sum = glms_vec3_add(sum, light);
    }
    return sum;
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
            start.seen = glms_vec3_add(start.surface.emission, all_punctual(rules, &start, rays));
    }
    if (!rules->direct) start.seen = vec3_of(0, 0, 0);
    return start;
}

// ---- light at a surface of the path

// One light, chosen by what it would give, stands for all.
static vec3s one_punctual(const struct path_rules *rules, const struct surface *s,
                          const struct bsdf *b, float choice, uint64_t *rays)
{
    const struct light_table *lights = &rules->scene->lights;
    struct punctual_light chosen = { 0 };
    vec3s light = vec3_of(0, 0, 0);
    float total = 0.0f, weight = 0.0f;
    // Reservoir sampling (Chao 1982): each replaces the one before with its share of the sum so
    // far.
    for (int i = 0; i < lights->punctual_count; i++) {
        struct punctual_light p = light_punctual(&lights->punctual[i], s->position);
        vec3s candidate = reflected(s, b, &p);
        float w = luminance(candidate);
        if (!(w > 0.0f)) continue;
        total += w;
        float share = w / total;
        if (choice < share) {
            choice /= share;
            chosen = p;
            light = candidate;
            weight = w;
        } else {
            choice = (choice - share) / (1.0f - share);
        }
    }
    if (!(weight > 0.0f) || !is_visible(rules->scene, s, &chosen, rays)) return vec3_of(0, 0, 0);
    return glms_vec3_scale(light, total / weight);
}

// Power heuristic with an exponent of 2; a ratio, so that nothing overflows.
static float mis_weight(float pdf, float other)
{
    float ratio = other / pdf;
    return 1.0f / (1.0f + ratio * ratio);
}

// Light on a surface and what of it goes on towards where the path came from.
struct gathered {
    vec3s irradiance, radiance;
};

static struct gathered gathered_of(vec3s f, vec3s radiance, float scale)
{
    struct gathered g = { .irradiance = glms_vec3_scale(radiance, scale) };
    g.radiance = glms_vec3_mul(f, g.irradiance);
    return g;
}

static struct gathered one_emitter(const struct path_rules *rules, const struct surface *s,
                                   const struct bsdf *b, float choice, vec2s u, uint64_t *rays)
{
    struct gathered none = { 0 };
    struct emitter_sample e = light_sample_emitter(rules->scene, s->position, choice, u);
    float cosine = glms_vec3_dot(b->normal, e.to_light);
    if (is_black(e.radiance) || !(e.pdf > 0.0f) || !(cosine > 0.0f) ||
        !(glms_vec3_dot(s->geometric, e.to_light) > 0.0f))
        return none;
    vec3s from = surface_leave(s, e.to_light);
    struct ray ray = { from, glms_vec3_sub(e.position, from), 0.0f, 1.0f };
    ++*rays;
    if (embree_occluded(rules->scene->embree, &ray)) return none;
    struct reflection r = bsdf_reflect(b, e.to_light);
    return gathered_of(r.f, e.radiance, cosine / e.pdf * mis_weight(e.pdf, r.pdf));
}

// ---- the path

// Radiance at the surface seen is `share` times what arrives along the first sampled direction;
// `carried` is what of it comes from further on. The two shares are the same light as seen by the
// eye and as irradiance.
struct walk {
    const struct path_rules *rules;
    uint64_t *rays;
    struct surface surface;
    struct bsdf bsdf;
    vec3s share;            // of the first step, for the eye
    float irradiance_share; // and for irradiance
    vec3s carried;          // of all later steps
    int depth;              // bounces so far
    struct path_light light;
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
    add_to(&w->light.indirect, seen);
    add_to(&w->light.gathered, seen);
    add_to(&w->light.irradiance, falling);
    add_to(&w->light.gathered_irradiance, falling);
}

// Light straight from an emitter or the sky, at any surface.
static void collect_gathered(struct walk *w, const struct gathered *g)
{
    if (w->depth > 0) {
        collect(w, g->radiance);
    } else if (w->rules->direct) {
        add_to(&w->light.direct, g->radiance);
        add_to(&w->light.gathered, g->radiance);
        add_to(&w->light.gathered_irradiance, g->irradiance);
    }
}

static void ask_lights(struct walk *w, struct rng *rng)
{
    const struct light_table *lights = &w->rules->scene->lights;
    float choice = rng_float(rng);
    vec2s u = rng_vec2(rng);
    if (w->depth == 0 && !w->rules->direct) return;
    if (w->depth > 0 && lights->punctual_count > 0)
        collect(w, one_punctual(w->rules, &w->surface, &w->bsdf, rng_float(rng), w->rays));
    if (!lights->has_emitters) return;
    struct gathered g = one_emitter(w->rules, &w->surface, &w->bsdf, choice, u, w->rays);
    collect_gathered(w, &g);
}

// A step of the path and what it reflects of the light that will arrive along it.
struct step {
    struct ray ray;
    vec3s f;     // 1/sr
    float scale; // cosine / pdf, sr
    float pdf;   // 1/sr
};

static bool choose_step(const struct walk *w, struct rng *rng, struct step *out)
{
    float choice = rng_float(rng);
    vec3s to_light = bsdf_sample(&w->bsdf, choice, rng_vec2(rng));
    float cosine = glms_vec3_dot(w->bsdf.normal, to_light);
    if (!(cosine > 0.0f) || !(glms_vec3_dot(w->surface.geometric, to_light) > 0.0f)) return false;
    struct reflection r = bsdf_reflect(&w->bsdf, to_light);
    if (!(r.pdf > 0.0f)) return false;
    out->pdf = r.pdf;
    out->f = r.f;
    out->scale = cosine / r.pdf;
    out->ray = (struct ray){ surface_leave(&w->surface, to_light), to_light, 0.0f, INFINITY };
    return true;
}

// Light that the step meets at its end: the sky, or what glows there.
static vec3s met_light(const struct walk *w, const struct step *step, const struct ray_hit *hit,
                       const struct surface *end)
{
    if (!hit) return w->rules->scene->lights.sky;
    if (is_black(end->emission)) return end->emission;
    float cosine = -glms_vec3_dot(end->geometric, step->ray.direction);
    float other =
        light_emitter_pdf(w->rules->scene, end->mesh, end->triangle, hit->distance, cosine);
    return glms_vec3_scale(end->emission, mis_weight(step->pdf, other));
}

// Survives with a chance of what it carries, and carries the more.
static bool survives(struct walk *w, struct rng *rng)
{
    float choice = rng_float(rng);
    if (w->depth < FIRST_ROULETTE) return true;
    float most = glms_vec3_max(w->carried);
    float chance = fminf(most, MAX_SURVIVAL);
    if (!(choice < chance)) return false;
    w->carried = glms_vec3_scale(w->carried, 1.0f / chance);
    return true;
}

static void advance(struct walk *w, const struct step *step, const struct surface *end)
{
    vec3s weight = glms_vec3_scale(step->f, step->scale);
    if (w->depth == 0) {
        w->share = weight;
        w->irradiance_share = step->scale;
    } else {
        w->carried = glms_vec3_mul(w->carried, weight);
    }
    w->depth++;
    w->surface = *end;
    w->bsdf = bsdf_at(w->rules, end, glms_vec3_negate(step->ray.direction));
}

// Whether the last surface's sampled direction can still meet light.
static bool light_is_met(const struct path_rules *rules)
{
    return rules->scene->lights.has_emitters || rules->scene->lights.has_sky;
}

// One more surface; false where the path ends.
static bool walk_on(struct walk *w, struct rng *rng)
{
    int bounces = w->rules->indirect ? w->rules->bounces : 0;
    ask_lights(w, rng);
    bool last = w->depth == bounces;
    if (last && !light_is_met(w->rules)) return false;
    struct step step;
    if (!choose_step(w, rng, &step)) return false;
    struct ray_hit hit;
    struct surface end;
    ++*w->rays;
    bool met = embree_closest(w->rules->scene->embree, &step.ray, NULL, false, &hit);
    if (met) end = surface_at(w->rules->scene, &step.ray, &hit, NULL);
    vec3s light = met_light(w, &step, met ? &hit : NULL, &end);
    struct gathered g = gathered_of(step.f, light, step.scale);
    collect_gathered(w, &g);
    if (last || !met) return false;
    advance(w, &step, &end);
    return survives(w, rng);
}

struct path_light path_sample(const struct path_rules *rules, const struct path_start *start,
                              uint32_t pixel, uint32_t sample, uint64_t *rays)
{
    struct walk w = { .rules = rules,
                      .rays = rays,
                      .surface = start->surface,
                      .bsdf = start->bsdf,
                      .carried = { { 1, 1, 1 } },
                      .light = { .direct = start->seen } };
    if (!start->hit) return w.light;
    for (bool goes_on = true; goes_on;) {
        // Each surface has a sequence of its own: what happens at one does not shift the next
        // one's.
        struct rng rng = rng_for(pixel, sample, rules->seed + (uint32_t)w.depth);
        goes_on = walk_on(&w, &rng);
    }
    return w.light;
}
