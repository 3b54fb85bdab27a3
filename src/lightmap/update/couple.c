// Tables of lights in which equal random numbers choose equal lights of both scenes.
#include "lightmap/update/update.h"

#include <math.h>
#include <string.h>

// ---- punctual lights

// The lights of `was` that `now` has, in its order, then the others.
static bool replace_punctual(struct trace_scene *before, struct host *host,
                             const struct trace_scene *now, const struct lightmap_record *was)
{
    struct light_table *t = &before->lights;
    struct world_light *lights = host_alloc(host, was->light_count, sizeof *lights);
    bool *taken = host_alloc(host, was->light_count, sizeof *taken);
    const bool ok = lights && taken;
    int count = 0;
    for (int i = 0; ok && i < now->lights.punctual_count; i++)
        for (uint32_t k = 0; k < was->light_count; k++) {
            if (taken[k] || !update_same_light(&was->lights[k], &now->lights.punctual[i])) continue;
            taken[k] = true;
            lights[count++] = was->lights[k];
            break;
        }
    for (uint32_t k = 0; ok && k < was->light_count; k++)
        if (!taken[k]) lights[count++] = was->lights[k];
    host_free(host, taken);
    host_free(host, ok ? t->punctual : lights);
    if (ok) {
        t->punctual = lights;
        t->punctual_count = count;
    }
    return ok;
}

// ---- emitters

// The first emitter of an instance; NULL: it emits nothing, or is not there.
static const struct emitter *emitters_of(const struct trace_scene *s, int instance, uint32_t *count)
{
    *count = 0;
    if (instance >= s->scene->instance_count || s->mesh_of[instance] == UINT32_MAX) return NULL;
    const struct trace_mesh *mesh = &s->meshes[s->mesh_of[instance]];
    if (mesh->emitter_first == NO_EMITTER) return NULL;
    *count = mesh->mesh->index_count / 3;
    return &s->lights.emitters[mesh->emitter_first];
}

static bool have_same_emitters(const struct trace_scene *a, const struct trace_scene *b)
{
    const struct light_table *s = &a->lights, *t = &b->lights;
    if (s->emitter_count != t->emitter_count) return false;
    for (uint32_t i = 0; i < s->emitter_count; i++)
        if (s->emitters[i].stay != t->emitters[i].stay ||
            s->emitters[i].alias != t->emitters[i].alias ||
            memcmp(s->emitters[i].corner.raw, t->emitters[i].corner.raw, sizeof(vec3s)) != 0)
            return false;
    return true;
}

static double area_of(const struct emitter *e)
{
    return 0.5 * (double)glms_vec3_norm(glms_vec3_cross(e->edges[0], e->edges[1]));
}

// Powers of both scenes, so that each finds its own emitters.
static double power_of(const struct trace_scene *s, const struct emitter *e)
{
    const double power = (double)e->density * area_of(e) * (double)s->lights.flux;
    return isfinite(power) ? power : 0.0;
}

static uint32_t common_count(const struct trace_scene *before, const struct trace_scene *now,
                             int instance)
{
    uint32_t a, b;
    emitters_of(before, instance, &a);
    emitters_of(now, instance, &b);
    return a > b ? a : b;
}

static void add_powers(const struct trace_scene *s, int instance, double *power)
{
    uint32_t count;
    const struct emitter *e = emitters_of(s, instance, &count);
    for (uint32_t i = 0; i < count; i++) power[i] += power_of(s, &e[i]);
}

static void place(const struct trace_scene *s, int instance, struct trace_scene *view,
                  const double *power, double total, uint32_t first, struct emitter *table)
{
    uint32_t count;
    const struct emitter *e = emitters_of(s, instance, &count);
    for (uint32_t i = 0; i < count; i++) {
        const double area = area_of(&e[i]);
        table[first + i] = e[i];
        table[first + i].density =
            power[first + i] > 0.0 ? (float)(power[first + i] / total / area) : 0.0f;
    }
    if (e) view->meshes[s->mesh_of[instance]].emitter_first = first;
}

// Both tables get the choices of the first.
static bool choose(struct host *host, struct emitter *const tables[2], uint32_t count,
                   double *power, double total)
{
    uint32_t *work = host_alloc(host, count, sizeof *work);
    for (uint32_t i = 0; work && i < count; i++) power[i] *= (double)count / total;
    if (work) light_table_build_alias(tables[0], count, power, work);
    for (uint32_t i = 0; work && i < count; i++) {
        tables[1][i].stay = tables[0][i].stay;
        tables[1][i].alias = tables[0][i].alias;
    }
    host_free(host, work);
    return work != NULL;
}

// The view owns its meshes and emitters.
static bool copy_view(struct trace_scene *view, struct host *host, const struct trace_scene *of,
                      uint32_t emitters)
{
    *view = *of;
    view->meshes = host_alloc(host, of->mesh_count, sizeof *view->meshes);
    view->lights.emitters = host_alloc(host, emitters, sizeof *view->lights.emitters);
    view->lights.emitter_count = emitters;
    if (!view->meshes || !view->lights.emitters) return false;
    if (of->mesh_count > 0) memcpy(view->meshes, of->meshes, of->mesh_count * sizeof *view->meshes);
    return true;
}

static bool merge(struct update_coupled *c, const struct trace_scene *before,
                  const struct trace_scene *now, uint32_t count, double *power)
{
    struct emitter *const tables[2] = { c->before.lights.emitters, c->now.lights.emitters };
    const int instances = before->scene->instance_count; // all of now's and those that are gone
    uint32_t first = 0;
    double total = 0.0;
    for (int i = 0; i < instances; first += common_count(before, now, i++)) {
        add_powers(before, i, power + first);
        add_powers(now, i, power + first);
    }
    for (uint32_t i = 0; i < count; i++) total += power[i];
    const bool some = total > 0.0;
    c->before.lights.has_emitters = c->now.lights.has_emitters = some;
    first = 0;
    for (int i = 0; some && i < instances; first += common_count(before, now, i++)) {
        place(before, i, &c->before, power, total, first, tables[0]);
        place(now, i, &c->now, power, total, first, tables[1]);
    }
    return !some || choose(c->host, tables, count, power, total);
}

static uint32_t count_emitters(const struct trace_scene *before, const struct trace_scene *now)
{
    uint32_t count = 0;
    for (int i = 0; i < before->scene->instance_count; i++) count += common_count(before, now, i);
    return count;
}

bool update_coupled_init(struct update_coupled *out, struct host *host, struct trace_scene *before,
                         const struct trace_scene *now, const struct lightmap_record *was)
{
    *out = (struct update_coupled){ .host = host };
    if (!replace_punctual(before, host, now, was)) return false;
    out->before = *before;
    out->now = *now;
    if (have_same_emitters(before, now)) return true;
    const uint32_t count = count_emitters(before, now);
    double *power = host_alloc(host, count, sizeof *power);
    out->own_tables = true;
    out->before.meshes = out->now.meshes = NULL;
    out->before.lights.emitters = out->now.lights.emitters = NULL;
    const bool ok = power && copy_view(&out->before, host, before, count) &&
                    copy_view(&out->now, host, now, count) && merge(out, before, now, count, power);
    host_free(host, power);
    return ok;
}

void update_coupled_finish(struct update_coupled *c)
{
    if (c->own_tables) {
        host_free(c->host, c->before.meshes);
        host_free(c->host, c->before.lights.emitters);
        host_free(c->host, c->now.meshes);
        host_free(c->host, c->now.lights.emitters);
    }
    *c = (struct update_coupled){ 0 };
}
