// Materials that change at run time: emission by the columns of the bake, reflectance by factors.
#include "techniques/radiosity/radiosity_state.h"

void radiosity_follow_materials(struct radiosity *s, const struct scene *scene)
{
    const unsigned changes = light_map_materials_update(&s->materials, scene);
    if (changes & LIGHT_MAP_FOLLOWS_EMISSION)
        light_map_emission_set(&s->emission, &s->materials.emission, scene);
    if (!(changes & LIGHT_MAP_FOLLOWS_REFLECTANCE) || s->map.texel_count == 0) return;
    radiosity_reflectance_update(&s->reflectance, s->materials.known);
    s->reflectance_changed = true;
}

static void record_reflectance(struct radiosity *s, struct gpu_cmd *cmd)
{
    const uint32_t texels = s->map.texel_count;
    gpu_scope_begin(cmd, "reflectance");
    light_map_record_rows(&s->emission, cmd, s->tables.texels, TEXEL_REFLECTANCE * texels,
                          s->reflectance.texels, texels);
    light_map_record_rows(&s->emission, cmd, s->tables.clusters, 0, s->reflectance.clusters,
                          s->map.cluster_count);
    gpu_scope_end(cmd);
    s->reflectance_changed = false;
    s->spectral_radius = s->reflectance.spectral_radius;
}

bool radiosity_has_new_materials(const struct radiosity *s)
{
    return s->map.texel_count > 0 && (s->reflectance_changed || s->emission.pending);
}

void radiosity_record_materials(struct radiosity *s, struct gpu_cmd *cmd)
{
    if (s->reflectance_changed) record_reflectance(s, cmd);
    light_map_emission_record(&s->emission, cmd, s->tables.texels);
}
