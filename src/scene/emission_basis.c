#include "scene/emission_basis.h"

#include <math.h>

static bool emits(const struct material *m)
{
    return glms_vec3_max(m->emissive) > 0.0f && !m->unlit;
}

// ---- areas

static vec3s corner_of(const struct scene_pose *pose, int instance, const mat4s *world,
                       uint32_t vertex)
{
    const vec3s *deformed = pose->deformed[instance].positions;
    if (deformed) return deformed[vertex];
    return glms_mat4_mulv3(*world, scene_mesh_of(pose->scene, instance)->positions[vertex], 1.0f);
}

static double area_of(const struct scene_pose *pose, int instance)
{
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    const mat4s world = pose_world_from_instance(pose, instance);
    double sum = 0.0;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        const vec3s a = corner_of(pose, instance, &world, mesh->indices[i]);
        const vec3s b = corner_of(pose, instance, &world, mesh->indices[i + 1]);
        const vec3s c = corner_of(pose, instance, &world, mesh->indices[i + 2]);
        const vec3s twice = glms_vec3_cross(glms_vec3_sub(b, a), glms_vec3_sub(c, a));
        sum += 0.5 * (double)glms_vec3_norm(twice);
    }
    return sum;
}

// [materials] m² of emissive ones; 0: no instance has it, or it does not emit.
static double *areas_of(struct host *host, const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    double *area = host_alloc(host, (size_t)scene->material_count, sizeof *area);
    for (int i = 0; area && i < scene->instance_count; i++) {
        const struct mesh *mesh = scene_mesh_of(scene, i);
        if (mesh->index_count > 0 && emits(&scene->materials[mesh->material]))
            area[mesh->material] += area_of(pose, i);
    }
    return area;
}

// ---- columns

static int columns_of(const struct material *m)
{
    return m->emissive_map.image >= 0 ? 3 : 1;
}

static int count_columns(const struct scene *scene, const double *area)
{
    int count = 0;
    for (int m = 0; m < scene->material_count; m++)
        if (area[m] > 0.0) count += columns_of(&scene->materials[m]);
    return count;
}

static void add_columns(struct emission_basis *out, int material, int count)
{
    for (int k = 0; k < count; k++)
        out->columns[out->count++] = (struct emission_column){ material, count > 1 ? k : -1 };
}

static float unit_of(double power)
{
    const float unit = (float)(1.0 / power);
    return isnormal(unit) ? unit : 1.0f;
}

static void add_own(struct emission_basis *out, const struct scene *scene, const double *area,
                    int most)
{
    for (int m = 0; m < out->material_count; m++) {
        const int count = columns_of(&scene->materials[m]);
        if (!(area[m] > 0.0) || out->count + count > most) continue;
        out->parts[m] = (struct emission_part){ out->count, count, false, unit_of(area[m]) };
        add_columns(out, m, count);
    }
}

static void add_shared(struct emission_basis *out, const struct scene *scene, const double *area)
{
    const int first = out->count;
    double power = 0.0;
    for (int m = 0; m < out->material_count; m++) {
        if (!(area[m] > 0.0) || out->parts[m].count > 0) continue;
        power += area[m] * (double)luminance(scene->materials[m].emissive);
        out->shared++;
    }
    if (out->shared == 0) return;
    add_columns(out, -1, 3);
    for (int m = 0; m < out->material_count; m++)
        if (area[m] > 0.0 && out->parts[m].count == 0)
            out->parts[m] = (struct emission_part){ first, 3, true, unit_of(power) };
}

bool emission_basis_init(struct emission_basis *out, struct host *host,
                         const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    *out = (struct emission_basis){ .host = host, .material_count = scene->material_count };
    out->parts = host_alloc(host, (size_t)scene->material_count, sizeof *out->parts);
    double *area = areas_of(host, pose);
    const bool ok = out->parts && area;
    if (ok) {
        const bool all = count_columns(scene, area) <= EMISSION_COLUMNS;
        add_own(out, scene, area, all ? EMISSION_COLUMNS : EMISSION_COLUMNS - 3);
        add_shared(out, scene, area);
    }
    host_free(host, area);
    return ok;
}

void emission_basis_finish(struct emission_basis *basis)
{
    if (basis->host) host_free(basis->host, basis->parts);
    *basis = (struct emission_basis){ 0 };
}

// ---- use

vec3s emission_basis_unit(const struct emission_basis *basis, const struct scene *scene,
                          int material)
{
    const struct emission_part *part = &basis->parts[material];
    const vec3s emissive = scene->materials[material].emissive;
    if (part->count == 0) return vec3_of(0, 0, 0);
    return part->shared ? glms_vec3_scale(emissive, part->unit)
                        : vec3_of(part->unit, part->unit, part->unit);
}

static vec3s emission_of(const struct scene *scene, int material)
{
    return material < 0 ? vec3_of(1, 1, 1) : scene->materials[material].emissive;
}

void emission_basis_weights(const struct emission_basis *basis, const struct scene *scene,
                            vec3s weights[EMISSION_COLUMNS])
{
    for (int k = 0; k < basis->count; k++) {
        const struct emission_column *column = &basis->columns[k];
        const vec3s emission = emission_of(scene, column->material);
        weights[k] = column->channel < 0 ? emission : vec3_of(0, 0, 0);
        if (column->channel >= 0) weights[k].raw[column->channel] = emission.raw[column->channel];
    }
}
