#include "techniques/common/light_map/emission.h"

#include "bake/tensors.h"
#include "techniques/common/light_map/tensors.h"

#include "technique_shaders.h"

#include <stddef.h>
#include <string.h>

// Four columns in an entry.
static void fill_fluence(const float *from, size_t columns, size_t texels, vec4s *to)
{
    for (size_t i = 0; i < texels; i++)
        for (size_t k = 0; k < columns; k++)
            to[k / 4 * texels + i].raw[k % 4] = from[i * columns + k];
}

bool light_map_emission_upload(struct light_map_emission *out, struct host *host, struct gpu *gpu,
                               const struct emission_basis *basis, uint32_t texels,
                               const struct tensors *bake, bool fluence)
{
    const uint64_t rows = light_map_rows(texels), columns = emission_basis_rows(basis);
    const float *from =
        TENSORS_EXPECT(host, bake, LIGHT_MAP_EMISSION, TENSOR_F32, rows, columns, 4);
    const float *from_fluence =
        fluence ? TENSORS_EXPECT(host, bake, LIGHT_MAP_EMISSION_FLUENCE, TENSOR_F32, rows, columns)
                : NULL;
    const size_t of_light = (size_t)columns * texels;
    const size_t entries = of_light + (fluence ? (columns + 3) / 4 * texels : 0);
    out->count = (uint32_t)basis->count;
    out->texels = texels;
    out->has_fluence = fluence;
    out->pending = true;
    const bool found = from && (from_fluence || !fluence);
    vec4s *table =
        found ? host_alloc(host, light_map_table_capacity(entries), sizeof *table) : NULL;
    for (size_t i = 0; table && i < texels; i++)
        for (size_t k = 0; k < columns; k++)
            memcpy(&table[k * texels + i], from + 4 * (i * columns + k), sizeof *table);
    if (table && fluence) fill_fluence(from_fluence, columns, texels, table + of_light);
    return found && light_map_table_upload(host, gpu, "emission", GPU_RGBA32F, table, entries,
                                           &out->columns);
}

void light_map_emission_list(size_t at, struct gpu_objects *out)
{
    GPU_ADD(out, 0, { GPU_IMAGE, .member = at + offsetof(struct light_map_emission, columns) },
            { GPU_PIPELINE, "emission", at + offsetof(struct light_map_emission, sum),
              .shader = &shader_common_light_map_emission_comp },
            { GPU_PIPELINE, "rows", at + offsetof(struct light_map_emission, set_rows),
              .shader = &shader_common_light_map_rows_comp });
}

void light_map_emission_set(struct light_map_emission *e, const struct emission_basis *basis,
                            const struct scene *scene)
{
    vec3s weights[EMISSION_COLUMNS];
    emission_basis_weights(basis, scene, weights);
    for (int k = 0; k < basis->count; k++) e->weights[k] = vec4_of(weights[k], 0.0f);
    e->pending = true;
}

bool light_map_emission_record(struct light_map_emission *e, struct gpu_cmd *cmd, gpu_image texels)
{
    const struct light_map_emission_push push = { e->texels, e->count, e->has_fluence };
    if (!e->pending) return false;
    e->pending = false;
    if (e->count == 0 || e->texels == 0) return true;
    gpu_scope_begin(cmd, "emission");
    gpu_dispatch(cmd, e->sum,
                 GPU_BIND(gpu_transient(cmd, "light_map_emission_weights", e->weights,
                                        e->count * sizeof *e->weights),
                          { .name = "light_map_emission", .image = e->columns },
                          { .name = "light_map_texels", .image = texels }),
                 &push, sizeof push, gpu_groups(push.texels, LIGHT_MAP_LOCAL), 1, 1);
    gpu_scope_end(cmd);
    return true;
}

void light_map_record_rows(const struct light_map_emission *e, struct gpu_cmd *cmd, gpu_image table,
                           uint32_t first, const vec4s *rows, uint32_t count)
{
    const struct light_map_rows_push push = { first, count };
    if (count == 0) return;
    gpu_dispatch(cmd, e->set_rows,
                 GPU_BIND(gpu_transient(cmd, "light_map_new_rows", rows, count * sizeof *rows),
                          { .name = "light_map_table", .image = table }),
                 &push, sizeof push, gpu_groups(push.count, LIGHT_MAP_LOCAL), 1, 1);
}
