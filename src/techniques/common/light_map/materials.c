#include "techniques/common/light_map/materials.h"

#include <string.h>

static struct material *copy_of(struct host *host, const struct scene *scene)
{
    const size_t count = (size_t)scene->material_count;
    struct material *copy = host_alloc(host, count, sizeof *copy);
    if (copy && count > 0) memcpy(copy, scene->materials, count * sizeof *copy);
    return copy;
}

bool light_map_materials_init(struct light_map_materials *out, struct host *host,
                              const char *technique, unsigned follows,
                              const struct scene_statics *statics)
{
    const struct scene *scene = &statics->scene;
    *out = (struct light_map_materials){ .host = host,
                                         .technique = technique,
                                         .follows = follows,
                                         .count = scene->material_count,
                                         .revision = scene->revisions.materials };
    out->known = copy_of(host, scene);
    out->baked = copy_of(host, scene);
    out->of_instance = host_alloc(host, (size_t)scene->instance_count, sizeof *out->of_instance);
    out->used = host_alloc(host, (size_t)scene->material_count, sizeof *out->used);
    if (!out->known || !out->baked || !out->of_instance || !out->used) return false;
    for (int i = 0; i < scene->instance_count; i++) {
        out->of_instance[i] = -1;
        if (scene->instances[i].mesh < 0) continue;
        out->of_instance[i] = scene_mesh_of(scene, i)->material;
        out->used[out->of_instance[i]] = true;
    }
    return emission_basis_init(&out->emission, host, &statics->pose);
}

void light_map_materials_finish(struct light_map_materials *m)
{
    if (!m->host) return;
    host_free(m->host, m->known);
    host_free(m->host, m->baked);
    host_free(m->host, m->of_instance);
    host_free(m->host, m->used);
    emission_basis_finish(&m->emission);
    *m = (struct light_map_materials){ 0 };
}

// ---- changes

static bool same_emission(const struct material *a, const struct material *b)
{
    return a->emissive.x == b->emissive.x && a->emissive.y == b->emissive.y &&
           a->emissive.z == b->emissive.z;
}

// Sides, holes and normals.
static bool same_surface(const struct material *a, const struct material *b)
{
    const bool same_alpha = a->alpha_mode == ALPHA_OPAQUE || (a->base_color.w == b->base_color.w &&
                                                              a->alpha_cutoff == b->alpha_cutoff);
    return a->double_sided == b->double_sided && same_alpha &&
           (a->normal_map.image < 0 || a->normal_scale == b->normal_scale);
}

static void warn_once(struct light_map_materials *m, bool *warned, int material, const char *what)
{
    if (!*warned)
        host_log(m->host, LOG_WARNING, "%s: material %s: %s; bake the changed scene", m->technique,
                 m->known[material].name ? m->known[material].name : "", what);
    *warned = true;
}

static void warn_of_emission(struct light_map_materials *m, int i)
{
    const struct emission_part *part = &m->emission.parts[i];
    if (same_emission(&m->known[i], &m->baked[i])) return;
    if (!(m->follows & LIGHT_MAP_FOLLOWS_EMISSION))
        warn_once(m, &m->warned_emission, i, "its emission changed, but light of it stays");
    else if (part->count == 0)
        warn_once(m, &m->warned_emission, i,
                  "it emits, but did not when it was baked: it lights nothing");
    else if (part->shared)
        warn_once(m, &m->warned_emission, i,
                  "its emission changed, but the scene has more emissive materials than a bake "
                  "keeps apart, and this one's light stays");
}

static void warn_of(struct light_map_materials *m, int i)
{
    warn_of_emission(m, i);
    if (!(m->follows & LIGHT_MAP_FOLLOWS_REFLECTANCE) &&
        !material_reflects_alike(&m->known[i], &m->baked[i]))
        warn_once(m, &m->warned_reflectance, i,
                  "its reflectance changed, but the indirect light that it reflects stays");
    if (!same_surface(&m->known[i], &m->baked[i]))
        warn_once(m, &m->warned_surface, i,
                  "its sides, alpha or normals changed, but indirect light keeps the former ones");
}

static unsigned change_of(struct light_map_materials *m, int i, const struct material *now)
{
    unsigned changes = 0;
    if (m->emission.parts[i].count > 0 && !same_emission(&m->known[i], now))
        changes |= LIGHT_MAP_FOLLOWS_EMISSION;
    if (!material_reflects_alike(&m->known[i], now)) changes |= LIGHT_MAP_FOLLOWS_REFLECTANCE;
    m->known[i] = *now;
    warn_of(m, i);
    return changes;
}

unsigned light_map_materials_update(struct light_map_materials *m, const struct scene *scene)
{
    unsigned changes = 0;
    if (!m->known || scene->revisions.materials == m->revision) return 0;
    m->revision = scene->revisions.materials;
    for (int i = 0; i < m->count; i++)
        if (m->used[i]) changes |= change_of(m, i, &scene->materials[i]);
    return changes & m->follows;
}
